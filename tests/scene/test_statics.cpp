// Static stages: load steps, paths of equilibria, natural modes.
#include <cmath>
#include <filesystem>
#include <numbers>

#include "../io/scratch_folder.hpp"
#include "dovetail/fem/elements/solid.hpp"
#include "dovetail/fem/terms/contact_plane.hpp"
#include "dovetail/io/time_series.hpp"
#include "dovetail/scene/execute.hpp"
#include "loaded_bars.hpp"

namespace dovetail::scene::test {
namespace {

TEST(SceneStatics, ABarIsStretchedByWhatItIsPulledWith) {
  for (const char* const stage : {R"({"do": "statics", "load_steps": 4})", R"({"do": "statics", "time": 2})"}) {
    Built built = loaded(staticScene(bar(pulled), stage));
    const double l = 1.0 + displacementAt(built, {0, 0, 4}).z / 4.0;  // E λ (λ² − 1)/2 = 1000
    EXPECT_NEAR(1e6 * l * (l * l - 1.0) / 2.0, 1000.0, 1e-5);
    const coupling::Reactions reactions = built.run->reactions(0);
    Vec3 sum;
    for (const Vec3& f : reactions.supports) sum += f;
    EXPECT_NEAR(sum.z, -1000.0, 1e-5);
  }
}

TEST(SceneStatics, TimePassesIfAsked) {
  EXPECT_EQ(loaded(staticScene(bar(pulled), R"({"do": "statics"})")).run->time(), 0.0);
  EXPECT_NEAR(loaded(staticScene(bar(pulled), R"({"do": "statics", "time": 2})")).run->time(), 2.0, 1e-12);
}

/// Half of the work that gravity and loads could do is held back on the way, if all is linear.
TEST(SceneStatics, TheLedgerClosesToSecondOrderOfTheLoadSteps) {
  const auto of = [](int steps) {
    Built built = loaded(staticScene(
        R"("gravity": [0, 0, -9.81],)" + bar(R"("loads": [{"on": "z+", "type": "pressure", "pressure": 5e4}])"),
        R"({"do": "statics", "load_steps": )" + std::to_string(steps) + "}"));
    EXPECT_GT(channel(built, "bar: load steps"), 0.0);
    return std::abs(built.run->ledger().residual() / channel(built, "bar: load steps"));
  };
  const double coarse = of(4), fine = of(16);
  EXPECT_LT(coarse, 1e-2);
  EXPECT_GT(coarse, 1e-7);
  EXPECT_NEAR(coarse / fine, 16.0, 2.0);
}

TEST(SceneStatics, ASolidStaysWhereItsLoadsHaveBroughtIt) {
  for (const char* const stepping : {"explicit", "implicit"}) {
    const std::string keys = pulled + R"(, "velocity": [0, 0, 0.1], "stepping": ")" + stepping + "\"";
    Built built = loaded(staticScene(bar(keys), R"({"do": "statics"}, {"do": "run", "time": 0.01})"));
    EXPECT_GT(channel(built, "kinetic damping"), 0.0);
    const double before = displacementAt(built, {0, 0, 4}).z, residual = built.run->ledger().residual();
    built.run->advance(100);
    EXPECT_NEAR(displacementAt(built, {0, 0, 4}).z, before, 1e-10);
    EXPECT_NEAR(norm(built.run->totals().residual.linear), 0.0, 1e-9);
    EXPECT_NEAR(built.run->ledger().residual(), residual, 1e-11);
  }
}

void expectToGoOn(const Scene& scene) {
  Built whole = started(scene), parted = started(scene), rest = started(scene), last = started(scene);
  for (int k = 0; k < 6; ++k) whole.run->loadStep(k, 6, 1.0 / 6.0);
  for (int k = 0; k < 2; ++k) parted.run->loadStep(k, 6, 1.0 / 6.0);
  rest.run->load(parted.run->save());
  for (int k = 2; k < 6; ++k) rest.run->loadStep(k, 6, 1.0 / 6.0);
  whole.run->advance(50);
  rest.run->advance(50);
  last.run->load(whole.run->save());
  EXPECT_TRUE(whole.run->save() == rest.run->save());
  EXPECT_EQ(whole.run->ledger().residual(), rest.run->ledger().residual());
  EXPECT_NEAR(whole.run->ledger().residual(), last.run->ledger().residual(), 1e-12);
}

TEST(SceneStatics, LoadStepsGoOnFromAState) {
  const std::string stages = R"({"do": "statics", "load_steps": 6, "time": 1}, {"do": "run", "time": 0.01})";
  expectToGoOn(staticScene(bar(R"("loads": [{"on": "z+", "type": "pressure", "pressure": 5e4}])"), stages));
  if (!WITH_EXPRESSIONS) return;
  // Nothing is held back, and much is dissipated.
  std::string keys = bar("\"gravity\": true", R"--({"on": "z-"}, {"on": "z+", "displacement": [0, 0, "0.02*t"]})--");
  const std::string elastic = R"("law": "St-Venant-Kirchhoff")";
  keys.replace(keys.find(elastic), elastic.size(), R"("law": "J2", "yield_stress": 1e3)");
  expectToGoOn(staticScene(keys, stages));
}

TEST(SceneStatics, WhatCannotBeIsRefused) {
  const std::string grains = law + R"("particles": [{"from": "list", "density": 1000,
      "spheres": [{"at": [0.5, 0.5, 9], "radius": 0.1}]}],)";
  EXPECT_EQ(refusalOf(staticScene(grains + bar(pulled), R"({"do": "statics"}, {"do": "run", "time": 1})")), "");
  expectParts(refusalOf(staticScene(grains + bar(pulled), R"({"do": "statics", "time": 1})")),
              {"time passes", "leave \"time\" out", "stages.0"});
  expectParts(refusalOf(staticScene(grains + bar(pulled), R"({"do": "run", "time": 1}, {"do": "statics"})")),
              {"may lie on the solids", "first ones", "stages.1"});
  expectParts(refusalOf(staticScene(grains, R"({"do": "statics"})")), {"the scene has none"});
  const std::string overlap = R"("couplings": [{"type": "overlap", "solid": "bar", "solid_border": 4,
      "particle_border": 2}],)";
  expectParts(refusalOf(staticScene(grains + bar(pulled) + overlap, R"({"do": "statics"})")),
              {"overlap ties them", "initial_equilibrium"});
}

TEST(SceneStatics, GrainsOnASolidAreTold) {
  const auto with = [](double z) {
    return staticScene(law + R"("particles": [{"from": "list", "density": 1000,
      "spheres": [{"at": [0.5, 0.5, )" +
                           std::to_string(z) + R"(], "radius": 0.1}]}],
      "couplings": [{"type": "surface", "solid": "bar", "on": "z+", "kernel": "none"}],)" +
                           bar(R"("loads": [{"on": "z+", "type": "traction", "traction": [0, 0, 30000]}])"),
                       R"({"do": "statics"}, {"do": "run", "time": 1})");
  };
  EXPECT_NO_THROW(loaded(with(4.5)));
  EXPECT_THROW(loaded(with(4.09)), InputError);  // from the start
  EXPECT_THROW(loaded(with(4.15)), InputError);  // the bar grows into it
}

TEST(SceneStatics, WithoutEquilibriumTheLoadStepIsNamed) {
  const Scene scene = staticScene(bar(pulled, ""), R"({"do": "statics"})");
  try {
    loaded(scene);
    FAIL();
  } catch (const NumericalError& error) {
    expectParts(error.what(), {"\"bar\"", "load step 1 of 10"});
  }
}

/// The path of a bar that has no limit point leads to where load steps do.
TEST(SceneArcLength, EndsWhereLoadStepsEnd) {
  const std::string keys = R"("loads": [{"on": "z+", "type": "traction", "traction": [100, 0, 2e5]}])";
  const Scene scene = staticScene(bar(keys), R"({"do": "statics", "load_steps": 8, "control": "arc-length"})");
  Built path = started(scene), steps = loaded(staticScene(bar(keys), R"({"do": "statics"})"));
  EXPECT_EQ(path.run->loadFactor(0), 0.0);
  double before = 0.0;
  for (int k = 0; path.run->loadFactor(0) < 1.0; ++k) {
    ASSERT_LT(k, 30);
    path.run->followLoads(k, 8);
    EXPECT_GT(path.run->loadFactor(0), before);
    before = path.run->loadFactor(0);
    if (k == 0) {
      EXPECT_NEAR(before, 0.125, 0.02);
    }
  }
  EXPECT_EQ(path.run->loadFactor(0), 1.0);
  EXPECT_LT(norm(displacementAt(path, {1, 1, 4}) - displacementAt(steps, {1, 1, 4})), 1e-9);
  EXPECT_LT(std::abs(path.run->ledger().residual()), 2e-2 * channel(path, "bar: load steps"));
  EXPECT_EQ(path.run->time(), 0.0);
}

/// An unloaded solid is there at once.
TEST(SceneArcLength, WithoutALoadThereIsNoPath) {
  Built built = started(staticScene(bar("\"gravity\": true"), R"({"do": "statics", "control": "arc-length"})"));
  EXPECT_TRUE(built.run->followLoads(0, 10).empty());
  EXPECT_EQ(built.run->loadFactor(0), 1.0);
}

TEST(SceneArcLength, WhatCannotBeIsRefused) {
  expectParts(refusalOf(staticScene(bar(pulled), R"({"do": "statics", "time": 1, "control": "arc-length"})")),
              {"time never does", "leave \"time\" out", "stages.0"});
  expectParts(refusalOf(staticScene(bar(pulled + R"(, "linear_solver": "conjugate-gradients")"),
                                    R"({"do": "statics", "control": "arc-length"})")),
              {"conjugate gradients", "\"bar\"", "stages.0"});
}

/// Nothing holds the bar along its load: it must not be in equilibrium where forces are lost in round-off.
TEST(SceneStatics, ABodyThatGetsAwayIsInNoEquilibrium) {
  const std::string sides = R"({"on": "z-", "components": ["x", "y"]}, {"on": "z+", "components": ["x", "y"]})";
  for (const char* const stage : {R"({"do": "statics"})", R"({"do": "statics", "load_steps": 4, "time": 1})"})
    EXPECT_THROW(loaded(staticScene(bar(pulled, sides), stage)), NumericalError);
}

/// Nothing that a user of scenes cannot write.
TEST(SceneStatics, WithoutEquilibriumTheMessageSaysWhatCanBeDone) {
  std::string keys = bar(R"("loads": [{"on": "z+", "type": "traction", "traction": [0, 0, 2e3]}])");
  const std::string elastic = R"("law": "St-Venant-Kirchhoff")";
  keys.replace(keys.find(elastic), elastic.size(), R"("law": "J2", "yield_stress": 1e3)");
  try {
    loaded(staticScene(keys, R"({"do": "statics"})"));
    FAIL();
  } catch (const NumericalError& error) {
    expectParts(error.what(), {"there is no equilibrium", "\"bar\"", "load step ", "take more load steps"});
    for (const char* const name : {"followPath", "solveStatics", "firstStep"})
      EXPECT_EQ(std::string(error.what()).find(name), std::string::npos) << error.what();
  }
}

/// π² E h²/(12 (2 L)²) for h = 1 and L = 40; the bar stays straight either way.
TEST(SceneStatics, EquilibriaThatWouldBuckleAreNamed) {
  const auto unstable = [](double stress) {
    std::string keys = bar(R"("loads": [{"on": "z+", "type": "traction", "traction": [0, 0, )" +
                           std::to_string(-stress) + R"(]}], "formulation": "enhanced")");
    const std::string box = R"("cells": [1, 1, 4], "box": [[0, 0, 0], [1, 1, 4]])";
    keys.replace(keys.find(box), box.size(), R"("cells": [1, 1, 40], "box": [[0, 0, 0], [1, 1, 40]])");
    Built built = started(staticScene(keys, R"({"do": "statics"})"));
    return built.run->loadStep(0, 1, 0.0);
  };
  const double buckling = std::numbers::pi * std::numbers::pi * 1e6 / (12.0 * 6400.0);
  EXPECT_TRUE(unstable(0.95 * buckling).empty());
  EXPECT_EQ(unstable(1.05 * buckling), std::vector<std::string>{"bar"});
}

/// Half of a load step's viscous work is in no channel: of the first, where rates start from none. Supports do none.
TEST(SceneStatics, ViscositiesAreInTheLedgerToFirstOrder) {
  const auto of = [](int steps) {
    std::string keys = bar(R"("loads": [{"on": "z+", "type": "traction", "traction": [0, 0, 1000]}])");
    keys.replace(keys.find("\"density\""), 0, R"("damping_time": 0.02, )");
    Built built =
        loaded(staticScene(keys, R"({"do": "statics", "time": 1, "load_steps": )" + std::to_string(steps) + "}"));
    const double dissipated = channel(built, "bar: dissipated in load steps");
    EXPECT_GT(dissipated, 0.0);
    for (const auto& one : built.run->ledger().channels())
      if (one.name == "bar: supports") {
        EXPECT_NEAR(one.joules, 0.0, 1e-3 * dissipated);
      }
    return built.run->ledger().residual() / dissipated;
  };
  EXPECT_NEAR(of(10), 0.05, 0.01);
  EXPECT_NEAR(of(20), 0.025, 0.005);
}

TEST(SceneModes, OfAllStagesAreInOneFile) {
  const std::string dead = R"("loads": [{"on": "z+", "type": "traction", "traction": [0, 0, 1e5]}])";
  const Scene scene = staticScene(
      bar(dead), R"({"do": "modes", "count": 2}, {"do": "statics", "load_steps": 2}, {"do": "modes", "count": 3})");
  const io::test::ScratchFolder folder;
  std::ostringstream log;
  for (int again = 0; again < 2; ++again) {
    ASSERT_TRUE(run(scene, {.folder = folder.path(), .progress = false}, log));
    const io::TimeSeries modes = io::readCsv(folder / "modes.csv");
    ASSERT_EQ(modes.rows(), 5U);
    EXPECT_EQ(modes.column("stage")[1], 1.0);
    EXPECT_EQ(modes.column("stage")[2], 3.0);
    EXPECT_EQ(modes.column("mode")[4], 3.0);
    EXPECT_GT(modes.column("frequency_Hz")[2], 1.01 * modes.column("frequency_Hz")[0]);  // under tension
  }
}

TEST(SceneModes, ABuiltBarRefusesWhatHasNone) {
  const std::string stage = R"({"do": "modes", "count": 2})";
  const auto following = [&](const char* follows) {
    try {
      started(staticScene(bar(std::string(R"("loads": [{"on": "z+", "type": "pressure", "pressure": 10, "follows": )") +
                              follows + "}]"),
                          stage));
      return std::string();
    } catch (const InputError& error) {
      return std::string(error.what());
    }
  };
  EXPECT_EQ(following("false"), "");
  expectParts(following("true"), {"\"load 0 on z+\" of \"bar\" is not symmetric", "stages.0", "\"follows\": false"});
  EXPECT_EQ(refusalOf(staticScene(bar(pulled), stage)), "");
  expectParts(refusalOf(staticScene("", stage)), {"the scene has none", "stages.0"});
}

#if WITH_EXPRESSIONS
/// The limit of a shallow arch and its least load behind it (Fung & Kaplan 1952), less what the pins give way.
TEST(SceneArcLength, LeadsAnArchThroughItsSnap) {
  const Scene scene = readScene(std::filesystem::path(SCENES) / "arch.json");
  Built whole = started(scene);
  const std::size_t crown = nodeAt(whole, {0.5, 0, 0.03});
  double limit = 0.0, least = 1.0, sunk = 0.0;
  bool passed = false;
  for (int k = 0; whole.run->loadFactor(0) < 1.0; ++k) {
    ASSERT_LT(k, 400);
    whole.run->followLoads(k, 20);
    const double factor = whole.run->loadFactor(0);
    passed = passed || factor < limit;
    if (!passed) limit = factor;
    if (passed) least = std::min(least, factor);
    const double u = whole.run->solid(0).nodes().u[crown].z;
    EXPECT_LT(u, sunk);
    sunk = u;
  }
  EXPECT_NEAR(limit, 0.4999, 0.02 * 0.4999);
  EXPECT_NEAR(least, -0.1713, 0.05 * 0.1713);
  EXPECT_NEAR(sunk, -66.41e-3, 0.002 * 66.41e-3);
  EXPECT_LT(std::abs(whole.run->ledger().residual()), 1e-3 * channel(whole, "arch: elements"));
  // In the middle of the snap, from a state.
  Built first = started(scene), rest = started(scene);
  for (int k = 0; k < 60; ++k) first.run->followLoads(k, 20);
  EXPECT_LT(first.run->loadFactor(0), 0.45);
  rest.run->load(first.run->save());
  for (int k = 60; k < 70; ++k) first.run->followLoads(k, 20), rest.run->followLoads(k, 20);
  EXPECT_TRUE(first.run->save() == rest.run->save());
}
#endif

}  // namespace
}  // namespace dovetail::scene::test
