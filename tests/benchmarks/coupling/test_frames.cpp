// A scene is the same scene wherever it is laid: turned, far from the origin, small and large.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
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

/// Places of grains, by their ids, and nodes, laid back, m.
std::vector<Vec3> places(const coupling::CoupledRun& run, const Placement& at) {
  const dem::Particles& p = run.grains.particles;
  std::vector<Vec3> x(p.size());
  for (std::size_t i = 0; i < p.size(); ++i) x.at(static_cast<std::size_t>(p.id[i])) = p.x[i];
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
  static Case scene(MacroSteps macroSteps) {
    return {Element::hex8, SolidLaw::neoHookean, std::get<0>(GetParam()), ContactKind::frictional, macroSteps};
  }
  static const Frame& frame() { return std::get<1>(GetParam()); }
  static std::vector<Vec3> after(const Case& c, const Placement& at, int macroSteps) {
    const auto run = makeScene(c, at);
    startAt(*run, c, 0.05);
    run->advance(macroSteps);
    return places(*run, at);
  }
  /// Under weight, at full rest: with rolling resistance, without which spheres roll on for ever.
  static std::vector<Vec3> resting(Joint joint, const Placement& at) {
    const auto run =
        makeScene({Element::hex8, SolidLaw::neoHookean, joint, ContactKind::rolling, MacroSteps::explicit1}, at);
    std::ranges::fill(run->grains.particles.v, Vec3{});
    startAt(*run, {.joint = joint}, 0.6);
    const RestReport rest = relax(*run, {.tolerance = 1e-18, .steps = 8000});
    EXPECT_TRUE(rest.atRest) << rest.residual;
    return places(*run, at);
  }
};

/// Before contacts begin or end, to round-off.
TEST_P(Frames, ShortRunsAreTheSame) {
  for (const MacroSteps macroSteps : {MacroSteps::explicit1, MacroSteps::implicit1}) {
    const Case c = scene(macroSteps);
    EXPECT_LE(largestDifference(after(c, {}, 40), after(c, frame().at, 40)), frame().tolerance * element) << nameOf(c);
  }
}

TEST_P(Frames, EquilibriaUnderWeightAreTheSame) {
  static std::map<Joint, std::vector<Vec3>> known;
  const Joint joint = std::get<0>(GetParam());
  if (!known.contains(joint)) known[joint] = resting(joint, {});
  // Condition of the equilibria: round-off of places has grown some hundred times on the way.
  const double tolerance = std::max(10.0 * frame().tolerance, 1e-12);
  EXPECT_LE(largestDifference(known[joint], resting(joint, frame().at)), tolerance * element);
}

std::vector<Frame> frames() {
  const Vec3 far{1e3 * element, -1e3 * element, 1e3 * element};
  return {{"turned90", {.turn = turned(90, {0, 0, 1})}, 1e-12},
          {"turned180", {.turn = turned(180, {1, 0, 0})}, 1e-12},
          {"turned90UnderLoad", {.turn = turned(90, {0, 1, 0}), .byDisplacement = true}, 1e-10},
          {"turned180UnderLoad", {.turn = turned(180, {1, 0, 0}), .byDisplacement = true}, 1e-10},
          {"far", {.shift = far}, 1e-9},
          {"small", {.length = 0x1p-20}, 1e-15},
          {"large", {.length = 0x1p10}, 1e-15},
          {"micrometres", {.length = 1e-6}, 1e-12},
          {"kilometres", {.length = 1e3}, 1e-12}};
}

std::string testName(const testing::TestParamInfo<std::tuple<Joint, Frame>>& info) {
  const auto& [joint, frame] = info.param;
  return levelName(2, static_cast<int>(joint)) + "_" + frame.name;
}

INSTANTIATE_TEST_SUITE_P(Placements, Frames,
                         testing::Combine(testing::Values(Joint::surface, Joint::penalty, Joint::multipliers),
                                          testing::ValuesIn(frames())),
                         testName);

}  // namespace
}  // namespace dovetail::coupling_matrix
