// Probes say what is there, and reactions balance weights.
#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "../../src/scene/run/probes.hpp"
#include "dovetail/core/error.hpp"
#include "dovetail/coupling/run.hpp"
#include "scene_parts.hpp"

namespace dovetail::scene::test {
namespace {

/// A block that hangs on its upper side, and another that stands with grains on it; `more` are keys of the second.
std::string scene(const std::string& steps, const std::string& more) {
  return R"({"gravity": [0, 0, -9.81],
    "contact": {"law": "linear", "stiffness": 2e4, "restitution": 0.5, "friction": 0.4},
    "particles": [{"from": "list", "density": 2500, "spheres": [{"at": [0.3, 0.3, 1.0995], "radius": 0.1},
       {"at": [0.7, 0.6, 1.0995], "radius": 0.1}, {"at": [5, 5, 0.0999], "radius": 0.1}]}],
    "walls": [{"shape": "plane", "point": [0, 0, -9], "normal": [0, 0, 1]},
              {"shape": "box", "box": [[-9, -9, 0], [9, 9, 9]], "open": ["z+"]}],
    "solids": [{"name": "block", "mesh": "box", "cells": [2, 2, 2], "box": [[0, 0, 0], [1, 1, 1]],
      "material": {"law": "neo-Hookean", "youngs_modulus": 1e5, "poisson_ratio": 0.2, "density": 500})" +
         more + R"(, "supports": [{"on": "z-"}]}],
    "couplings": [{"type": "surface", "solid": "block", "on": "z+", "kernel": "none"}],
    "steps": {)" +
         steps + R"(}, "stages": [{"do": "run", "time": 1}],
    "output": {"series": 1, "probes": [
      {"name": "foot", "of": "support", "solid": "block", "on": "z-"},
      {"name": "floor", "of": "wall", "wall": 1}, {"name": "far", "of": "wall", "wall": 0},
      {"name": "ball", "of": "grain", "at": [5, 5, 0]}, {"name": "top", "of": "node", "solid": "block", "at": [0.9, 1, 9]},
      {"name": "all", "of": "region", "box": [[0, 0, 0], [1, 1, 2]]}]}})";
}

std::map<std::string, double> valuesOf(const Probes& probes, const Built& built) {
  std::vector<double> row;
  probes.add(built, row);
  std::map<std::string, double> values;
  for (std::size_t k = 0; k < row.size(); ++k) values[probes.names().at(k)] = row[k];
  EXPECT_EQ(row.size(), probes.names().size());
  return values;
}

class ProbesAtRest : public testing::TestWithParam<std::pair<const char*, const char*>> {};

TEST_P(ProbesAtRest, CarryTheWeight) {
  const auto& [steps, more] = GetParam();
  const Scene file = sceneFromText(scene(steps, more), "s.json", "/");
  Built built = started(file);
  const Probes probes(built, file);
  coupling::relax(*built.run, {.tolerance = 1e-12, .steps = 40000});
  const double grain = 2500.0 * 4.0 / 3.0 * std::acos(-1.0) * 1e-3 * 9.81;
  auto values = valuesOf(probes, built);
  EXPECT_NEAR(values["foot_z_N"], 500.0 * 9.81 + 2.0 * grain, 1e-3 * grain);
  EXPECT_NEAR(values["foot_x_N"], 0.0, 1e-2 * grain);
  EXPECT_NEAR(values["floor_z_N"], -grain, 1e-3 * grain);
  EXPECT_EQ(values["far_z_N"], 0.0);
  EXPECT_EQ(values["ball_x_m"], 5.0);
  EXPECT_NEAR(values["ball_z_m"], 0.1 - grain / 2e4, 1e-6);
  EXPECT_LT(values["top_uz_m"], -500.0 * 9.81 / 2.0 / 1e5 * 0.8);
  EXPECT_EQ(values["all_particles"], 2.0);
}
INSTANTIATE_TEST_SUITE_P(
    All, ProbesAtRest,
    testing::Values(std::pair{R"("dt": 2e-4)", ""}, std::pair{R"("dt": 1e-4, "per_macro_step": 3)", ""},
                    std::pair{R"("dt": 2e-4, "per_macro_step": 4)", R"(, "stepping": "implicit")"}));

TEST(Probes, FollowTheirGrainAndTellThatItLeft) {
  const Scene file = sceneOf(R"("domain": {"box": [[-1, -1, -1], [1, 1, 1]], "escape": "remove"},
    "particles": [{"from": "list", "density": 2500, "spheres": [{"at": [0.9, 0, 0], "radius": 0.01, "velocity": [20, 0, 0]},
       {"at": [0, 0, 0], "radius": 0.01, "velocity": [1, 2, 3]}, {"at": [0, 0.5, 0], "radius": 0.02, "velocity": [3, 4, 5]}]}],
    "output": {"probes": [{"name": "a", "of": "grain", "at": [1, 0, 0]}, {"name": "b", "of": "grain", "at": [0, 0, 0.1]},
      {"name": "r", "of": "region", "box": [[-1, -1, -1], [0.5, 1, 1]]}]},)");
  Built built = started(file);
  const Probes probes(built, file);
  auto values = valuesOf(probes, built);
  EXPECT_EQ(values["a_vx_m_per_s"], 20.0);
  EXPECT_NEAR(values["r_vx_m_per_s"], (1.0 + 8.0 * 3.0) / 9.0, 1e-14);
  built.run->advance(2000);
  values = valuesOf(probes, built);
  EXPECT_TRUE(std::isnan(values["a_x_m"]));
  EXPECT_NEAR(values["b_z_m"], 3.0 * 2e-2, 1e-12);
}

TEST(Probes, MeanOverARegionOfASolidIsThatOfItsVolume) {
  const Vec3 shift{1.0, 2.0, 3.0}, along{0.5, -1.0, 2.0};
  for (const char* const cell : {"hex8", "tet10", "hex20"}) {
    const Scene file = sceneOf(R"("solids": [{"name": "bar", "mesh": "box", "cell": ")" + std::string(cell) +
                               R"(", "cells": [2, 1, 7], "box": [[0, 0, 0], [1, 1, 3]],
         "material": {"law": "neo-Hookean", "youngs_modulus": 1e5, "poisson_ratio": 0.2, "density": 500}}],
       "output": {"probes": [{"name": "slab", "of": "region", "solid": "bar", "box": [[-9, 0.5, 1.1], [0.5, 9, 1.9]]}]},)");
    Built built = started(file);
    // Stretched before the probe looks: what lies in the region is then another part.
    fem::Nodes& nodes = built.run->solid(0).model->nodes;
    for (std::size_t n = 0; n < nodes.X.size(); ++n) nodes.u[n] = 0.25 * nodes.X[n];
    const Probes probes(built, file);
    for (std::size_t n = 0; n < nodes.X.size(); ++n) {
      const Vec3 x = nodes.X[n] + nodes.u[n];
      nodes.v[n] = shift + Vec3{along.x * x.z, along.y * x.x, along.z * x.y};
      nodes.u[n] = {};  // it follows its part
    }
    auto values = valuesOf(probes, built);
    EXPECT_EQ(values.size(), 3u);
    const Vec3 centre{0.25, 0.875, 1.5};
    EXPECT_NEAR(values["slab_vx_m_per_s"], shift.x + along.x * centre.z, 1e-12) << cell;
    EXPECT_NEAR(values["slab_vy_m_per_s"], shift.y + along.y * centre.x, 1e-12) << cell;
    EXPECT_NEAR(values["slab_vz_m_per_s"], shift.z + along.z * centre.y, 1e-12) << cell;
  }
}

TEST(Probes, OfWhatIsNotThereAreRefused) {
  const auto refusal = [](const std::string& probe) -> std::string {
    const Scene file = sceneOf(R"("output": {"probes": [)" + probe + "]},");
    Built built = started(file);
    try {
      Probes(built, file);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_NE(refusal(R"({"name": "a", "of": "grain", "at": [0, 0, 0]})").find("no grains"), std::string::npos);
  EXPECT_NE(refusal(R"({"name": "a", "of": "node", "solid": "b", "at": [0, 0, 0]})").find("no solid \"b\""),
            std::string::npos);
  EXPECT_NE(refusal(R"({"name": "a", "of": "wall", "wall": 3})").find("no wall 3"), std::string::npos);
  const Scene solid =
      sceneOf(R"("solids": [{"name": "bar", "mesh": "box", "cells": [1, 1, 1], "box": [[0, 0, 0], [1, 1, 1]],
         "material": {"law": "neo-Hookean", "youngs_modulus": 1e5, "poisson_ratio": 0.2, "density": 500}}],
       "output": {"probes": [{"name": "r", "of": "region", "solid": "bar", "box": [[2, 0, 0], [3, 1, 1]]}]},)");
  Built built = started(solid);
  EXPECT_THROW(Probes(built, solid), InputError);
  EXPECT_NE(refusal(R"({"name": "a b", "of": "region", "box": [[0, 0, 0], [1, 1, 1]]})").find("a b"),
            std::string::npos);
}

}  // namespace
}  // namespace dovetail::scene::test
