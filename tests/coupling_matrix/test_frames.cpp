// A scene is the same scene wherever it is laid: turned, far from the origin, small and large.
#include <gtest/gtest.h>

#include <numbers>

#include "dovetail/core/error.hpp"
#include "matrix_scene.hpp"

namespace dovetail::coupling_matrix {
namespace {

constexpr double element = 0.2;  // m

struct Frame {
  const char* name;
  Placement at;
  double tolerance;  ///< of places over the element's size: round-off times the ratio of coordinates to moves
};
void PrintTo(const Frame& frame, std::ostream* out) { *out << frame.name; }

Quaternion turned(double degrees, const Vec3& axis) {
  return fromRotationVector((degrees * std::numbers::pi / 180.0) * axis);
}

/// Places of grains and nodes, laid back, m.
std::vector<Vec3> places(const coupling::CoupledRun& run, const Placement& at) {
  std::vector<Vec3> x = run.grains.particles.x;
  const fem::Nodes& nodes = run.solid(0).nodes();
  for (std::size_t n = 0; n < nodes.X.size(); ++n) x.push_back(nodes.X[n] + nodes.u[n]);
  for (Vec3& place : x) place = (1.0 / at.length) * rotateBack(at.turn, place - at.shift);
  return x;
}

double largestDifference(const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
  double largest = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) largest = std::max(largest, norm(a[i] - b[i]));
  return largest;
}

class Frames : public testing::TestWithParam<std::tuple<Joint, Frame>> {
protected:
  static Case scene(Windows windows) {
    return {Element::hex8, SolidLaw::neoHookean, std::get<0>(GetParam()), ContactKind::frictional, windows};
  }
  static const Frame& frame() { return std::get<1>(GetParam()); }
  static std::vector<Vec3> after(const Case& c, const Placement& at, int windows) {
    const auto run = makeScene(c, at);
    startAt(*run, c, 0.05);
    run->advance(windows);
    return places(*run, at);
  }
  static std::vector<Vec3> atRest(const Case& c, const Placement& at) {
    const auto run = makeScene(c, at);
    startAt(*run, c, 0.2);
    const coupling::RestReport report = settle(*run, {.kinetic = 1e-6, .windows = 20000});
    EXPECT_TRUE(report.atRest) << report.kinetic;
    return places(*run, at);
  }
};

/// Before contacts begin or end, to round-off.
TEST_P(Frames, ShortRunsAreTheSame) {
  for (const Windows windows : {Windows::explicit1, Windows::implicit1}) {
    const Case c = scene(windows);
    EXPECT_LT(largestDifference(after(c, {}, 40), after(c, frame().at, 40)), frame().tolerance * element + 1e-300)
        << nameOf(c);
  }
}

INSTANTIATE_TEST_SUITE_P(
    Placements, Frames,
    testing::Combine(
        testing::Values(Joint::surface, Joint::penalty, Joint::multipliers),
        testing::Values(Frame{"turned90", {.turn = turned(90, {0, 0, 1})}, 1e-12},
                        Frame{"turned180", {.turn = turned(180, {1, 0, 0})}, 1e-12},
                        Frame{"turned90UnderLoad", {.turn = turned(90, {0, 1, 0}), .byDisplacement = true}, 1e-10},
                        Frame{"turned180UnderLoad", {.turn = turned(180, {1, 0, 0}), .byDisplacement = true}, 1e-10},
                        Frame{"far", {.shift = {1e3 * element, -1e3 * element, 1e3 * element}}, 1e-9},
                        Frame{"small", {.length = 0x1p-20}, 0.0}, Frame{"large", {.length = 0x1p10}, 0.0},
                        Frame{"micrometres", {.length = 1e-6}, 1e-12}, Frame{"kilometres", {.length = 1e3}, 1e-12})),
    [](const auto& p) {
      const char* const joints[] = {"surface", "penalty", "multipliers"};
      return std::string(joints[static_cast<int>(std::get<0>(p.param))]) + "_" + std::get<1>(p.param).name;
    });

}  // namespace
}  // namespace dovetail::coupling_matrix
