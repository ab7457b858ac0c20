// Solids that are brought to rest with what a scene does not say: their weight, their steps, their elements.
#include "../../src/scene/warnings/warnings.hpp"
#include "dovetail/core/ledger.hpp"
#include "dovetail/coupling/run.hpp"
#include "scene_parts.hpp"

namespace dovetail::scene::test {
namespace {

std::string solidOf(const std::string& keys) {
  return R"("solids": [{"name": "b", "mesh": "box",
      "material": {"law": "St-Venant-Kirchhoff", "youngs_modulus": 1e6, "poisson_ratio": 0.3, "density": 1000},)" +
         keys + "}],";
}
Scene relaxing(const std::string& gravity, const std::string& keys, const std::string& dt) {
  return sceneFromText(R"({"gravity": [0, 0, )" + gravity + "], " + solidOf(keys) + R"("steps": {"dt": )" + dt +
                           R"(}, "stages": [{"do": "relax"}]})",
                       "s.json", "/");
}

TEST(SceneSettling, ColumnsOfSecondOrderSagUnderTheirWeight) {
  for (const char* const cells : {R"("cell": "tet10", "cells": [2, 2, 6])", R"("cell": "hex20", "cells": [1, 1, 3])"}) {
    Built built = started(relaxing("-9.81",
                                   std::string(cells) +
                                       R"(, "box": [[0, 0, 0], [0.5, 0.5, 2]], "stepping": "implicit",
                                          "supports": [{"on": "z-"}])",
                                   "0.02"));
    ASSERT_TRUE(coupling::relax(*built.run, {.tolerance = 1e-12, .steps = 500}).atRest) << cells;
    double sum = 0.0;
    const std::vector<int>& top = built.meshes[0].nodeSets.at("z+");
    for (const int n : top) {
      const double sag = -built.run->solid(0).nodes().u[static_cast<std::size_t>(n)].z;
      EXPECT_NEAR(sag, 0.0195, 0.01 * 0.0195) << cells;  // of eight times finer elements
      sum += sag;
    }
    EXPECT_NEAR(sum / static_cast<double>(top.size()), 0.0195, 0.01 * 0.0195) << cells;
  }
}

TEST(SceneSettling, LumpedMassesThatWeighOtherwiseAreTold) {
  const auto notesOf = [](const std::string& cell, const std::string& keys, const std::string& gravity = "-9.81") {
    std::string all;
    const Built built = build(relaxing(gravity,
                                       R"("cell": ")" + cell + R"(", "cells": [1, 1, 1],
        "box": [[0, 0, 0], [1, 1, 1]], "supports": [{"on": "z-"}])" +
                                           keys,
                                       "1e-4"));
    for (const std::string& note : built.notes) all += note + "\n";
    return all;
  };
  const std::string told = "has lumped masses";
  for (const char* const cell : {"tet10", "hex20"}) {
    expectParts(notesOf(cell, ""), {"WARNING", "\"b\"", cell, told.c_str(), "\"consistent_mass\": 1", "\"implicit\""});
    expectParts(notesOf(cell, R"(, "stepping": "implicit", "consistent_mass": 0)"),
                {told.c_str(), "\"consistent_mass\": 1"});
    for (const char* const right :
         {R"(, "stepping": "implicit")", R"(, "consistent_mass": 1)", R"(, "gravity": false)"})
      EXPECT_EQ(notesOf(cell, right).find(told), std::string::npos) << cell << right;
    EXPECT_EQ(notesOf(cell, "", "0").find(told), std::string::npos);
    const Built flies = build(relaxing("-9.81", R"("cell": ")" + std::string(cell) + R"(", "cells": [1, 1, 1],
        "box": [[0, 0, 0], [1, 1, 1]])",
                                       "1e-4"));
    for (const std::string& note : flies.notes) EXPECT_EQ(note.find(told), std::string::npos) << cell;
  }
  for (const char* const cell : {"hex8", "hex27", "tet4"})
    EXPECT_EQ(notesOf(cell, "").find(told), std::string::npos) << cell;
}

TEST(SceneSettling, WhatNothingLoadsIsAtRest) {
  for (const char* const stepping : {"explicit", "implicit"})
    for (const char* const elements :
         {R"("cell": "hex8")", R"("cell": "hex8", "formulation": "enhanced")",
          R"("cell": "hex8", "formulation": "reduced")", R"("cell": "hex8", "formulation": "mean-dilatation")",
          R"("cell": "hex8", "formulation": "assumed-stress")", R"("cell": "tet10")", R"("cell": "hex20")"})
      for (const char* const supports : {R"(, "supports": [{"on": "z-"}])", ""}) {
        Built built = started(relaxing("0",
                                       std::string(elements) + R"(, "cells": [2, 1, 3], "stepping": ")" + stepping +
                                           R"(", "box": [[7.1, 0.3, 1e3], [7.8, 0.6, 1001.3]])" + supports,
                                       "1e-3"));
        const RestReport report = coupling::relax(*built.run, {.tolerance = 1e-8, .steps = 100});
        EXPECT_TRUE(report.atRest) << stepping << elements << supports;
        EXPECT_EQ(report.residual, 0.0) << stepping << elements << supports;
      }
}

TEST(SceneSettling, WhatFallsFreelyIsNotAtRest) {
  Built built = started(relaxing("-9.81", R"("cells": [1, 1, 1], "box": [[0, 0, 0], [1, 1, 1]])", "1e-3"));
  EXPECT_FALSE(coupling::relax(*built.run, {.tolerance = 1e-8, .steps = 50}).atRest);
}

class ImplicitStack : public testing::TestWithParam<const char*> {};

TEST_P(ImplicitStack, ComesToRestWhateverTheStep) {
  Built built = started(relaxing("0", R"("cells": [2, 2, 4], "box": [[0, 0, 0], [1, 1, 2]], "stepping": "implicit",
      "supports": [{"on": "z-"}], "loads": [{"type": "traction", "on": "z+", "traction": [300, 0, -1000]}])",
                                 GetParam()));
  ASSERT_TRUE(coupling::relax(*built.run, {.tolerance = 1e-12, .steps = 20000}).atRest);
  const Vec3 held = [&] {
    Vec3 sum;
    for (const Vec3& one : built.run->reactions(0).supports) sum += one;
    return sum;
  }();
  EXPECT_LT(norm(held - Vec3{-300, 0, 1000}), 1e-2);
  const coupling::Totals totals = built.run->totals();
  EXPECT_LT(norm(totals.residual.linear), 1e-9 * totals.turnedOver);
  EXPECT_LT(std::abs(built.run->ledger().residual()),
            0.05 * built.run->ledger().joules("b: dissipation of the scheme"));
}
INSTANTIATE_TEST_SUITE_P(Steps, ImplicitStack, testing::Values("1e-3", "0.02", "0.5"));

TEST(SceneSettling, ARunAfterItLosesNothing) {
  Built built = started(relaxing("-9.81", R"("cells": [1, 1, 4], "box": [[0, 0, 0], [0.5, 0.5, 2]],
      "stepping": "implicit", "supports": [{"on": "z-"}])",
                                 "0.02"));
  coupling::relax(*built.run, {.tolerance = 1e-6, .steps = 500});
  const double lost = built.run->ledger().joules("b: dissipation of the scheme");
  EXPECT_GT(lost, 0.0);
  built.run->advance(50);
  EXPECT_NEAR(built.run->ledger().joules("b: dissipation of the scheme"), lost, 1e-9 * lost);
}

TEST(SceneSettling, WhatHourglassStiffnessStoresHasAChannelAndIsTold) {
  for (const char* const stepping : {"explicit", "implicit"})
    for (const int layers : {1, 6}) {
      const std::string n = std::to_string(layers);
      Built built = started(relaxing("0",
                                     R"("cells": [12, 1, )" + n + R"(], "box": [[0, 0, 0], [6, 1, 1]],
        "formulation": "reduced", "stepping": ")" +
                                         stepping + R"(", "supports": [{"on": "x-"}],
        "loads": [{"type": "traction", "on": "x+", "traction": [0, 0, -10]}])",
                                     "2e-3"));
      coupling::relax(*built.run, {.tolerance = 1e-6, .steps = 5000});
      const EnergyLedger& ledger = built.run->ledger();
      const double hourglass = ledger.joules("b: hourglass of elements"), own = ledger.joules("b: elements");
      const Lines told = hourglassIn(built);
      if (layers == 1) {
        EXPECT_GT(hourglass, 0.8 * (own + hourglass)) << stepping;
        ASSERT_EQ(told.size(), 1U) << stepping;
        expectParts(told[0], {"\"b\"", "% is in the hourglass stiffness", "\"enhanced\""});
      } else {
        EXPECT_GT(hourglass, 0.0) << stepping;
        EXPECT_LT(hourglass, 0.1 * (own + hourglass)) << stepping;
        EXPECT_TRUE(told.empty()) << stepping;
      }
      EXPECT_LT(std::abs(ledger.residual()), 0.02 * (own + hourglass)) << stepping << layers;
    }
}

}  // namespace
}  // namespace dovetail::scene::test
