// Reactions of supports and ties balance loads and inertia, however components are held, moved or carried.
#include "../../src/scene/run/probes.hpp"
#include "../io/scratch_folder.hpp"
#include "dovetail/coupling/run.hpp"
#include "dovetail/fem/mesh/mesh_shapes.hpp"
#include "dovetail/solid_io/solid_files.hpp"
#include "scene_parts.hpp"

namespace dovetail::scene::test {
namespace {

/// Two bricks, the finer on the x side of the coarser; sets: "start", "end", "coarse" and "fine" where they meet.
void writeTwo(const std::filesystem::path& file) {
  fem::SolidMesh both = fem::boxOf(fem::ElementShape::hex8, {2, 2, 2}, {0, 0, 0}, {1, 1, 1});
  fem::SolidMesh right = fem::boxOf(fem::ElementShape::hex8, {2, 4, 4}, {1, 0, 0}, {2, 1, 1});
  const int offset = static_cast<int>(both.X.size());
  const auto shifted = [&](std::vector<int> set) {
    for (int& n : set) n += offset;
    return set;
  };
  both.X.insert(both.X.end(), right.X.begin(), right.X.end());
  const std::vector<int> more = shifted(right.groups[0].node);
  both.groups[0].node.insert(both.groups[0].node.end(), more.begin(), more.end());
  both.nodeSets = {{"start", both.nodeSets.at("x-")},
                   {"coarse", both.nodeSets.at("x+")},
                   {"fine", shifted(right.nodeSets.at("x-"))},
                   {"end", shifted(right.nodeSets.at("x+"))}};
  both.faceSets = {{"meet", both.faceSets.at("x+")}};
  solid_io::writeSolid(both, file);
}

const std::string tie = R"("ties": [{"nodes": "fine", "faces": "meet", "tolerance": 1e-6}],)";

struct Way {
  const char* name;
  const char* supports;  ///< and ties
  bool needsExpressions = false;
};
const Way ways[] = {
    {"fixed", R"("supports": [{"on": "start"}, {"on": "end", "components": ["y"]}])"},
    {"rollersThatShareEdges",
     R"("supports": [{"on": "start", "components": ["x"]}, {"on": "south", "components": ["y", "x"]},
                     {"on": "foot", "components": ["z", "x"]}])"},
    {"steadyVelocity", R"("supports": [{"on": "start"}, {"on": "end", "velocity": [0.2, 0, 0.1]}])"},
    {"velocityFunction", R"("supports": [{"on": "start"}, {"on": "end", "velocity": ["0.4*t", 0, "-0.2*t"]}])", true},
    {"path", R"("supports": [{"on": "start", "components": ["x"]},
       {"on": "end", "components": ["x", "z"], "displacement": ["0.2*t^2", 0, "0.1*t^2"]}])",
     true},
    {"pathTwice", R"("supports": [{"on": "end", "displacement": ["0.2*t^2", "0*t", 0]},
       {"on": "foot", "components": ["x"], "velocity": ["0.4*t", 0, 0]}])",
     true},
};

class Reactions : public testing::TestWithParam<std::tuple<Way, const char*, bool>> {};

TEST_P(Reactions, BalanceLoadsAndInertia) {
  const auto& [way, stepping, tied] = GetParam();
  if (way.needsExpressions && !WITH_EXPRESSIONS) GTEST_SKIP();
  const io::test::ScratchFolder folder;
  writeTwo(folder / "two.inp");
  const bool coarse = std::string(way.name) == "fixed" && tied;  // masters are held too
  const std::string text =
      R"({"gravity": [0, 1, -9.81], "solids": [{"name": "b", "mesh": "file", "file": "two.inp", "velocity": [0, 0.1, 0],
      "material": {"law": "neo-Hookean", "youngs_modulus": 1e5, "poisson_ratio": 0.3, "density": 1000},)" +
      std::string(stepping) + (tied ? tie : "") +
      R"("sets": [{"name": "foot", "place": "side", "side": "z-"}, {"name": "south", "place": "side", "side": "y-"},
        {"name": "roof", "place": "side", "side": "z+"}, {"name": "all", "place": "box", "box": [[-9, -9, -9], [9, 9, 9]]}],
      "loads": [{"type": "traction", "on": "roof", "traction": [500, 0, -800]}],)" +
      (coarse ? R"("supports": [{"on": "coarse"}])" : way.supports) +
      R"(}], "steps": {"dt": 1e-3}, "stages": [{"do": "run", "time": 1}],
      "output": {"series": 1, "probes": [{"name": "all", "of": "support", "solid": "b", "on": "all"}]}})";
  const Scene scene = sceneFromText(text, "s.json", folder.path());
  Built built = started(scene);
  const Probes probes(built, scene);
  const Vec3 loads = 2000.0 * Vec3{0, 1, -9.81} + 2.0 * Vec3{500, 0, -800};
  const auto forceNow = [&] {
    std::vector<double> row;
    probes.add(built, row);
    return loads + Vec3{row.at(0), row.at(1), row.at(2)};
  };
  built.run->advance();  // how supports begin to move is no parabola
  for (int k = 0; k < 20; ++k) {
    const Vec3 force = forceNow(), momentum = built.run->totals().momentum;
    built.run->advance();
    const Vec3 meant = 0.5 * built.run->macroStep() * (force + forceNow());
    EXPECT_LT(norm(built.run->totals().momentum - momentum - meant), 1e-9 * built.run->macroStep() * norm(loads)) << k;
  }
}
INSTANTIATE_TEST_SUITE_P(All, Reactions,
                         testing::Combine(testing::ValuesIn(ways),
                                          testing::Values(R"("stepping": "explicit",)",
                                                          R"("stepping": "explicit", "consistent_mass": 0.7,)",
                                                          R"("stepping": "implicit", "consistent_mass": 0,)",
                                                          R"("stepping": "implicit", "consistent_mass": 1,)"),
                                          testing::Bool()),
                         [](const auto& one) {
                           std::string stepping = std::get<1>(one.param);
                           std::erase_if(stepping, [](char c) { return !std::isalnum(static_cast<unsigned char>(c)); });
                           return std::string(std::get<0>(one.param).name) + stepping +
                                  (std::get<2>(one.param) ? "Tied" : "");
                         });

double forceAt(Built& built, const Scene& scene, std::size_t column) {
  std::vector<double> row;
  Probes(built, scene).add(built, row);
  return row.at(column);
}

TEST(ReactionProbes, OfTwoEndsThatAreHeldApartAreThoseOfTheStretch) {
  for (const char* const stepping : {"explicit", "implicit"})
    for (const char* const head :
         {R"("displacement": [0, 0, 0.02])", R"("components": ["z"], "displacement": [0, 0, 0.02])"}) {
      const Scene scene = sceneFromText(
          R"({"solids": [{"name": "b", "mesh": "box", "cells": [1, 1, 2], "box": [[0, 0, 0], [1, 1, 2]], "stepping": ")" +
              std::string(stepping) + R"(",
        "material": {"law": "St-Venant-Kirchhoff", "youngs_modulus": 1e6, "poisson_ratio": 0, "density": 1000},
        "supports": [{"on": "z-"}, {"on": "z+", )" +
              head + R"(}]}],
        "steps": {"dt": 5e-3}, "stages": [{"do": "run", "time": 1}],
        "output": {"series": 1, "probes": [{"name": "foot", "of": "support", "solid": "b", "on": "z-"},
                                           {"name": "head", "of": "support", "solid": "b", "on": "z+"}]}})",
          "s.json", "/");
      Built built = started(scene);
      coupling::relax(*built.run, {.tolerance = 1e-20, .steps = 20000});
      const double force = 1e6 * 1.01 * 0.5 * (1.01 * 1.01 - 1.0);
      EXPECT_NEAR(forceAt(built, scene, 8), force, 1e-6 * force) << stepping << head;
      EXPECT_NEAR(forceAt(built, scene, 2), -force, 1e-6 * force) << stepping << head;
    }
}

TEST(ReactionProbes, OfNodesThatTiesCarryAreTheForcesOfTies) {
  const io::test::ScratchFolder folder;
  writeTwo(folder / "two.inp");
  const Scene scene = sceneFromText(R"({"solids": [{"name": "b", "mesh": "file", "file": "two.inp",
      "material": {"law": "St-Venant-Kirchhoff", "youngs_modulus": 1e6, "poisson_ratio": 0, "density": 1000},)" +
                                        tie + R"("supports": [{"on": "coarse"}],
      "sets": [{"name": "side", "place": "side", "side": "x+"}],
      "loads": [{"type": "traction", "on": "side", "traction": [1000, 0, 0]}]}],
      "steps": {"dt": 1e-3}, "stages": [{"do": "run", "time": 1}],
      "output": {"series": 1, "probes": [{"name": "fine", "of": "support", "solid": "b", "on": "fine"},
                                         {"name": "coarse", "of": "support", "solid": "b", "on": "coarse"}]}})",
                                    "s.json", folder.path());
  Built built = started(scene);
  coupling::relax(*built.run, {.tolerance = 1e-20, .steps = 20000});
  EXPECT_NEAR(forceAt(built, scene, 0), -1000.0, 1e-4);
  EXPECT_NEAR(forceAt(built, scene, 6), -1000.0, 1e-4);
}

TEST(ReactionProbes, OfNodesThatNothingHoldsAreRefused) {
  const Scene scene =
      sceneOf(R"("solids": [{"name": "b", "mesh": "box", "cells": [1, 1, 1], "box": [[0, 0, 0], [1, 1, 1]],
      "material": {"law": "neo-Hookean", "youngs_modulus": 1e6, "poisson_ratio": 0.3, "density": 1000},
      "sets": [{"name": "corner", "place": "sphere", "centre": [1, 1, 1], "radius": 0.1}], "supports": [{"on": "z-"}]}],
      "output": {"probes": [{"name": "a", "of": "support", "solid": "b", "on": "corner"}]},)");
  Built built = started(scene);
  EXPECT_THROW(Probes(built, scene), InputError);
}

}  // namespace
}  // namespace dovetail::scene::test
