// Grains in a box within a solid.
#include <algorithm>
#include <cmath>

#include "refusal.hpp"
#include "warning_parts.hpp"

namespace dovetail::scene::test {
namespace {

/// A lattice of 10 x 10 x 10 grains, of which a solid with a hole holds the outer ones. Open at the top.
std::string pit(const std::string& velocity, const std::string& more = "") {
  return R"({"contact": {"law": "linear", "stiffness": 1e4},
    "particles": [{"from": "lattice", "lattice": "simple-cubic", "radius": 0.05, "density": 2500,
                   "box": [[0, 0, 0], [1, 1, 1]], "velocity": )" +
         velocity + R"(}],
    "solids": [{"name": "soil", "mesh": "box", "cells": [10, 10, 7], "box": [[-0.5, -0.5, -0.4], [1.5, 1.5, 1]],
      "hole": [[0.3, 0.3, 0.4], [0.7, 0.7, 2]], "velocity": )" +
         velocity + R"(,
      "material": {"law": "St-Venant-Kirchhoff", "poisson_ratio": 0, "density": 1309, "youngs_modulus": 1e5}}],
    "couplings": [{"type": "overlap", "solid": "soil", "solid_box": [[0.3, 0.3, 0.4], [0.7, 0.7, 2]],
                   "particle_box": [[-0.1, -0.1, 0], [1.1, 1.1, 2]]}],)" +
         more + R"("steps": {"dt": 1e-4}, "stages": [{"do": "run", "time": 0.1}]})";
}

double farthest(const std::vector<Vec3>& velocities, const Vec3& from) {
  double most = 0.0;
  for (const Vec3& v : velocities) most = std::max(most, norm(v - from));
  return most;
}

TEST(OverlapBoxes, RigidMotionStaysRigid) {
  Built built = started(sceneFromText(pit("[1, 2, -3]"), "s.json", "/"));
  built.run->advance(200);
  EXPECT_LT(farthest(built.run->grains.particles.v, {1, 2, -3}), 1e-10);
  EXPECT_LT(farthest(built.run->solid(0).nodes().v, {1, 2, -3}), 1e-10);
  EXPECT_LT(std::abs(built.run->ledger().residual()), 1e-10 * built.run->ledger().stored());
}

/// A grain in the middle of the pit is pushed: waves go through all four sides and the bottom.
TEST(OverlapBoxes, AKickInThePitKeepsTheBooks) {
  std::string text = pit("[0, 0, 0]");
  const std::string grains = R"("particles": [)";
  text.insert(text.find(grains) + grains.size(),
              R"({"from": "list", "density": 2500, "spheres": [{"at": [0.5, 0.5, 1.06], "radius": 0.05,
                  "velocity": [0.2, 0.1, -1]}]}, )");
  Built built = started(sceneFromText(text, "s.json", "/"));
  const double energy = built.run->ledger().stored();
  built.run->advance(1000);
  const coupling::Totals after = built.run->totals();
  EXPECT_LT(norm(after.residual.linear), 1e-10 * after.turnedOver);
  EXPECT_LT(norm(after.residual.angular), 1e-10 * after.turnedOverAngular);
  EXPECT_LT(std::abs(built.run->ledger().residual()), 2e-3 * energy);
  double moved = 0.0;
  for (const Vec3& v : built.run->solid(0).nodes().v) moved = std::max(moved, norm(v));
  EXPECT_GT(moved, 1e-4);
}

/// To rounding: the weights are computed otherwise.
TEST(OverlapBoxes, OpenOnAllSidesButTheLowestAreTwoPlanes) {
  const std::string boxes = R"("solid_box": [[0.3, 0.3, 0.4], [0.7, 0.7, 2]],
                   "particle_box": [[-0.1, -0.1, 0], [1.1, 1.1, 2]])";
  const auto endOf = [&](const std::string& borders) {
    std::string text =
        replaced(replaced(pit("[0, 0, 0]"), boxes, borders), R"("hole": [[0.3, 0.3, 0.4], [0.7, 0.7, 2]],)",
                 R"("hole": [[-1, -1, 0.4], [2, 2, 2]], "gravity": false, )");
    text.insert(1, R"("gravity": [0.3, 0, -0.5],)");
    Built built = started(sceneFromText(text, "s.json", "/"));
    built.run->advance(100);
    return built.run->grains.particles.v;
  };
  const std::vector<Vec3> planes = endOf(R"("solid_border": 0.4, "particle_border": 0)");
  const std::vector<Vec3> open =
      endOf(R"("solid_box": [[-1, -1, 0.4], [2, 2, 2]], "particle_box": [[-1, -1, 0], [2, 2, 2]])");
  const std::vector<Vec3> far =
      endOf(R"("solid_box": [[-7, -7, 0.4], [8, 8, 2]], "particle_box": [[-9, -9, 0], [9, 9, 5]])");
  ASSERT_EQ(planes.size(), open.size());
  for (std::size_t i = 0; i < planes.size(); ++i) {
    EXPECT_LT(norm(planes[i] - open[i]), 1e-12);
    EXPECT_LT(norm(planes[i] - far[i]), 1e-12);
  }
}

TEST(OverlapBoxes, WhatCannotBeIsRefused) {
  const auto refused = [](const std::string& borders) {
    return refusalOf(sceneFromText(
        replaced(pit("[0, 0, 0]"), R"("particle_box": [[-0.1, -0.1, 0], [1.1, 1.1, 2]])", borders), "s.json", "/"));
  };
  expectParts(refused(R"("particle_border": 0)"), {"between two planes and between two boxes", "couplings.0"});
  expectParts(refused(R"("axis": "z")"), {"has not got two borders", "solid_box and particle_box"});
  expectParts(refused(R"("particle_box": [[0.4, -0.1, 0], [1.1, 1.1, 2]])"), {"along x", "0.3 m", "0.4 m"});
  expectParts(refused(R"("particle_box": [[0.3, -0.1, 0], [1.1, 1.1, 2]])"), {"x = 0.3 m", "goes on to -0.5 m"});
  const auto holed = [](const std::string& hole) {
    return refusalOf(
        sceneFromText(replaced(pit("[0, 0, 0]"), R"("hole": [[0.3, 0.3, 0.4], [0.7, 0.7, 2]])", hole), "s.json", "/"));
  };
  expectParts(holed(R"("hole": [[5, 5, 5], [6, 6, 6]])"), {"no element has its centre there", "solids.0"});
  expectParts(holed(R"("hole": [[-5, -5, -5], [6, 6, 6]])"), {"all elements"});
}

TEST(OverlapBoxes, AMissingHoleIsTold) {
  const std::string without = replaced(pit("[0, 0, 0]"), R"("hole": [[0.3, 0.3, 0.4], [0.7, 0.7, 2]],)", "");
  expectParts(warningsOf(sceneFromText(without, "s.json", "/")), {"nodes lie in solid_box", "as \"hole\""});
  const std::string all = warningsOf(sceneFromText(pit("[0, 0, 0]"), "s.json", "/"));
  EXPECT_EQ(all.find("solid_box"), std::string::npos) << all;
  const std::string wide = replaced(pit("[0, 0, 0]"), R"("hole": [[0.3, 0.3)", R"("hole": [[0.1, 0.3)");
  expectParts(warningsOf(sceneFromText(wide, "s.json", "/")), {"ends outside of solid_box", "0.5 of the way"});
  const std::string beside = replaced(pit("[0, 0, 0]"), R"("solid_box": [[0.3,)", R"("solid_box": [[0.2,)");
  expectParts(warningsOf(sceneFromText(beside, "s.json", "/")), {"nodes lie in solid_box", "put the box on faces"});
}

TEST(OverlapBoxes, SecondOrderSharesItsWeightsToo) {
  std::string text = replaced(pit("[1, 2, -3]"), R"("cells": [10, 10, 7])", R"("cell": "hex20", "cells": [10, 10, 7])");
  Built built = started(sceneFromText(text, "s.json", "/"));
  built.run->advance(50);
  EXPECT_LT(farthest(built.run->solid(0).nodes().v, {1, 2, -3}), 1e-10);
}

TEST(OverlapBoxes, AcrossOneSideOfAPeriodTheyAreRefused) {
  const auto along = [](const std::string& period) {
    return refusalOf(sceneFromText(
        replaced(pit("[0, 0, 0]"), R"("particles")",
                 R"("periodic": {"box": [[)" + period + R"(, -9, -9], [1.5, 9, 9]], "axes": ["x"]}, "particles")"),
        "s.json", "/"));
  };
  expectParts(along("0"), {"across one side of the period", "couplings.0"});
  EXPECT_EQ(along("-0.5"), "");
}

}  // namespace
}  // namespace dovetail::scene::test
