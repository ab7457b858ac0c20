// Overlaps whose solid begins in equilibrium.
#include <algorithm>
#include <cmath>

#include "refusal.hpp"
#include "scene_parts.hpp"

namespace dovetail::scene::test {
namespace {

/// A column of squeezed grains, periodic sideways, on a solid: 2 N in every vertical contact.
std::string column(const std::string& more, double modulus) {
  return R"({"contact": {"law": "linear", "stiffness": 1e4},
    "periodic": {"box": [[0, 0, -2], [0.3992, 0.3992, 2]], "axes": ["x", "y"]},
    "particles": [{"from": "lattice", "lattice": "simple-cubic", "radius": 0.05, "distance": 0.0998, "density": 2500,
                   "box": [[0, 0, 0], [0.3993, 0.3993, 1.2]]}],
    "solids": [{"name": "soil", "mesh": "box", "cells": [1, 1, 8], "box": [[0, 0, -0.4], [0.3992, 0.3992, 0.4]],
      "material": {"law": "St-Venant-Kirchhoff", "poisson_ratio": 0, "density": 1300, "youngs_modulus": )" +
         std::to_string(modulus) + R"(},
      "supports": [{"on": "z-"}, {"on": "x-", "components": ["x"]}, {"on": "x+", "components": ["x"]},
                   {"on": "y-", "components": ["y"]}, {"on": "y+", "components": ["y"]}]}],
    "couplings": [{"type": "overlap", "solid": "soil", "solid_border": 0.4, "particle_border": 0)" +
         more + R"(}],
    "steps": {"dt": 1e-5}, "stages": [{"do": "run", "time": 1e-3}]})";
}

double highestDisplacement(const Built& built) {
  double most = 0.0;
  for (const Vec3& u : built.run->solid(0).nodes().u) most = std::max(most, std::abs(u.z));
  return most;
}

TEST(SceneTakeOver, StressesTheSolidAsItsGrainsAre) {
  constexpr double force = 1e4 * 2e-4, stress = force / (0.0998 * 0.0998), modulus = 2e5;  // N, Pa
  const Built without = build(sceneFromText(column("", modulus), "s.json", "/"));
  EXPECT_EQ(highestDisplacement(without), 0.0);
  const Built with = build(sceneFromText(column(R"(, "initial_equilibrium": true)", modulus), "s.json", "/"));
  EXPECT_NEAR(highestDisplacement(with), 0.8 * stress / modulus, 0.02 * 0.8 * stress / modulus);
  ASSERT_FALSE(with.notes.empty());
  EXPECT_NE(with.notes.back().find("\"soil\" reached its initial equilibrium"), std::string::npos);
}

// A soil sinks under its own weight, and the overlap with it: a layer of grains that was beyond the border stays.
TEST(SceneTakeOver, TheOverlapGoesDownWithTheSoil) {
  std::string text = column(R"(, "initial_equilibrium": true)", 3e5);
  text.insert(1, R"("gravity": [0, 0, -9.81], )");
  const std::string from = R"("box": [[0, 0, 0], [0.3993)", to = R"("box": [[0, 0, -0.053], [0.3993)";
  text.replace(text.find(from), from.size(), to);
  const Built built = build(sceneFromText(text, "s.json", "/"));
  double lowest = 1.0;
  for (const Vec3& x : built.run->grains.particles.x) lowest = std::min(lowest, x.z);
  EXPECT_NEAR(lowest, -0.003, 1e-9);
}

/// A load that grows acts in the initial state with its value at that time.
TEST(SceneTakeOver, LoadsAreThoseOfTheStatesTime) {
  if (!WITH_EXPRESSIONS) GTEST_SKIP();
  const auto sunkUnder = [](const std::string& pressure) {
    std::string text = column(R"(, "initial_equilibrium": true)", 2e5);
    const std::string at = R"("supports": [)";
    text.insert(text.find(at),
                R"("loads": [{"type": "traction", "on": "z+", "traction": [0, 0, ")" + pressure + R"("]}], )");
    return highestDisplacement(build(sceneFromText(text, "s.json", "/")));
  };
  const double still = sunkUnder("0"), half = sunkUnder("-500");
  EXPECT_GT(half, 1.1 * still);
  EXPECT_NEAR(sunkUnder("t < 0.1 ? -1000*t/0.1 : -1000"), still, 1e-9 * still);
  EXPECT_NEAR(sunkUnder("t < 0.05 ? -1000*(t + 0.05)/0.1 : -1000"), half, 1e-9 * half);
}

}  // namespace
}  // namespace dovetail::scene::test
