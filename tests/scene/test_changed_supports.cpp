// Supports that stages take away, add and move.
#include <filesystem>

#include "build/changes.hpp"
#include "dovetail/coupling/rest.hpp"
#include "warning_parts.hpp"

namespace dovetail::scene::test {
namespace {

/// A bar of 1 × 1 × 4 along z, E = 1 MPa, ν = 0, 4000 kg.
Scene barScene(const std::string& supports, const std::string& stages, const std::string& keys = "",
               const std::string& rest = R"("steps": {"dt": 1e-4})") {
  return sceneFromText(R"({"solids": [{"name": "bar", "mesh": "box", "cells": [1, 1, 4], "box": [[0, 0, 0], [1, 1, 4]],
      "material": {"law": "St-Venant-Kirchhoff", "youngs_modulus": 1e6, "poisson_ratio": 0, "density": 1000},
      "supports": [)" + supports +
                           "]" + keys + "}]," + rest + R"(, "stages": [)" + stages + "]}",
                       "s.json", "/");
}
std::string changed(const std::string& supports) {
  return R"({"do": "run", "time": 0.1}, {"do": "run", "time": 0.1, "changes": {"supports": [)" + supports + "]}}";
}
void begin(Built& built, const Scene& scene, std::size_t stage) {
  beginStage(built, scene, stage, startOf(built, scene, stage), Grains::areThere);
}
double channel(Built& built, const std::string& name) { return built.run->ledger().joules(name); }
Vec3 momentum(Built& built) { return built.run->totals().momentum; }
const std::string letGo = R"({"solid": "bar", "on": "z+", "present": false})";

class ChangedSupports : public testing::TestWithParam<const char*> {
protected:
  /// With the steps of the parameter.
  Scene scene(const std::string& supports, const std::string& stages, const std::string& keys = "") const {
    return barScene(supports, stages, keys + ", \"stepping\": " + GetParam());
  }
};

/// A bar that is stretched by a load keeps its energy and momentum as its end is let go, and then moves by the load.
TEST_P(ChangedSupports, ThatLetGoAddNothing) {
  const Scene bar = scene(R"({"on": "z-"}, {"on": "z+"})", changed(letGo),
                          R"(, "loads": [{"on": "z+", "type": "traction", "traction": [0, 0, 1000]}])");
  Built built = started(bar);
  built.run->advance(100);
  EXPECT_EQ(norm(built.run->solid(0).nodes().u[19]), 0.0);
  const double before = built.run->ledger().residual();
  begin(built, bar, 1);
  EXPECT_NEAR(channel(built, "changes (minus)"), 0.0, 1e-12);
  EXPECT_NEAR(built.run->ledger().residual(), before, 1e-12);
  EXPECT_NEAR(norm(momentum(built)), 0.0, 1e-12);
  // The end moves as that of a long bar, with σ/(ρ c), until the wave is back: all of it is at rest before.
  built.run->advance(250);
  const double c = std::sqrt(1e6 / 1000.0), t = 0.025;
  EXPECT_NEAR(built.run->solid(0).nodes().u[19].z, 1000.0 / (1000.0 * c) * t, 3e-4);
  EXPECT_LT(norm(built.run->totals().residual.linear), 1e-9);
  EXPECT_LT(std::abs(built.run->ledger().residual()), 1e-3);
  EXPECT_GT(channel(built, "bar: elements"), 0.1);
}

/// What is held of a flying bar stops at once: an inelastic impact of its nodes.
TEST_P(ChangedSupports, ThatStopNodesAreBooked) {
  const Scene bar = scene("", changed(R"({"solid": "bar", "on": "z-", "components": ["z"]})"),
                          R"(, "velocity": [0, 0.2, 0.1], "consistent_mass": 0)");
  Built built = started(bar);
  built.run->advance(100);
  begin(built, bar, 1);
  EXPECT_NEAR(channel(built, "changes (minus)"), 0.5 * 500.0 * 0.01, 1e-6);
  EXPECT_NEAR(momentum(built).z, 3500.0 * 0.1, 1e-6);
  EXPECT_NEAR(momentum(built).y, 4000.0 * 0.2, 1e-6);
  built.run->advance(500);
  EXPECT_LT(norm(built.run->totals().residual.linear), 1e-8);
  EXPECT_LT(std::abs(built.run->ledger().residual()), 1e-3);
  EXPECT_NEAR(built.run->solid(0).nodes().u[0].z, 1e-3, 1e-9);
}

#if WITH_EXPRESSIONS
/// t counts from the stage, and the nodes go on from where they are.
TEST_P(ChangedSupports, MoveOnFromWhereTheNodesAre) {
  const std::string first = R"--({"on": "z-", "displacement": ["0.1*t", 0, 0]}, {"on": "z+", "components": ["z"]})--";
  const Scene bar = scene(first, changed(R"--({"solid": "bar", "on": "z-", "displacement": ["0.1*t + t^2", 0, 0]},
      {"solid": "bar", "on": "z+", "components": ["x"], "velocity": ["3*t", 0, 0]})--"));
  Built built = started(bar);
  built.run->advance(500);
  const double tip = built.run->solid(0).nodes().u[19].x;
  begin(built, bar, 1);
  built.run->advance(1000);
  EXPECT_NEAR(built.run->solid(0).nodes().u[0].x, 0.1 * 0.05 + 0.1 * 0.1 + 0.01, 1e-12);
  EXPECT_NEAR(built.run->solid(0).nodes().u[19].x, tip + 1.5 * 0.01, 1e-9);
  EXPECT_EQ(built.run->solid(0).nodes().u[19].z, 0.0);
  EXPECT_LT(norm(built.run->totals().residual.linear), 1e-8 * built.run->totals().turnedOver);
}

TEST_P(ChangedSupports, GoOnFromAState) {
  const Scene free =
      scene(R"--({"on": "z-"}, {"on": "z+", "displacement": [0, "0.1*t", 0]})--",
            changed(letGo + R"--(, {"solid": "bar", "on": "z-", "turn": {"axis": [0, 0, 1], "angle": "0.3*t"},
      "point": [0.5, 0.5, 0]})--"),
            R"(, "loads": [{"on": "x+", "type": "pressure", "pressure": "1e3*t"}])");
  Built whole = started(free), rest = started(free);
  whole.run->advance(60);
  const StageStart start = startOf(whole, free, 1);
  beginStage(whole, free, 1, start, Grains::areThere);
  whole.run->advance(40);
  const std::vector<char> state = whole.run->save();
  whole.run->advance(60);
  beginStage(rest, free, 1, start, Grains::follow);
  rest.run->load(state);
  rest.run->advance(60);
  EXPECT_TRUE(whole.run->save() == rest.run->save());
  EXPECT_EQ(whole.run->ledger().residual(), rest.run->ledger().residual());
}
#endif
INSTANTIATE_TEST_SUITE_P(Steps, ChangedSupports, testing::Values("\"explicit\"", "\"implicit\""));

/// What is dissipated before a change is booked once, though the solid may not dissipate any more.
TEST_P(ChangedSupports, LeaveWhatWasDissipatedBefore) {
  const std::string pull = R"({"on": "z-"}, {"on": "z+", "velocity": [0, 0, 0.5]})";
  const Scene scene = sceneFromText(
      R"({"solids": [{"name": "bar", "mesh": "box", "cells": [1, 1, 4], "box": [[0, 0, 0], [1, 1, 4]], "material":
      {"law": "J2", "youngs_modulus": 1e6, "poisson_ratio": 0, "density": 1000, "yield_stress": 5e3, "hardening": 1e5},
      "stepping": )" +
          std::string(GetParam()) + R"(, "supports": [)" + pull +
          R"(]}], "steps": {"dt": 1e-3}, "stages": [{"do": "run", "time": 0.2}, {"do": "run", "time": 0.01,
      "changes": {"supports": [{"solid": "bar", "on": "z+", "velocity": [0, 0, -0.5]}]}}]})",
      "s.json", "/");
  Built built = started(scene);
  built.run->advance(200);
  const double dissipated = channel(built, "bar: dissipated by elements"), before = built.run->ledger().residual();
  const double kinetic = channel(built, "bar: kinetic");
  EXPECT_GT(dissipated, 10.0);
  beginStage(built, scene, 1, startOf(built, scene, 1), Grains::areThere);
  EXPECT_EQ(channel(built, "bar: dissipated by elements"), 0.0);
  EXPECT_NEAR(built.run->ledger().residual(), before, 1e-9 * dissipated);
  EXPECT_NEAR(channel(built, "changes (minus)"), kinetic - channel(built, "bar: kinetic"), 1e-9 * dissipated);
  built.run->advance(10);
  EXPECT_LT(std::abs(built.run->ledger().residual() - before), 1e-3 * dissipated);
}

TEST(ChangedSupportsAre, RefusedWhereTheyCannotBe) {
  const std::string both = R"({"on": "z-"}, {"on": "z+"})";
  EXPECT_EQ(refusalOf(barScene(both, changed(letGo))), "");
  expectParts(refusalOf(barScene(R"({"on": "z-"})", changed(letGo))), {"no support on \"z+\"", "stages.1"});
  expectParts(refusalOf(barScene(both, changed(R"({"solid": "rod", "on": "z+"})"))), {"no solid \"rod\""});
  expectParts(refusalOf(barScene(both, changed(R"({"solid": "bar", "on": "top"})"))), {"top", "stages.1"});
  expectParts(refusalOf(barScene(both, changed(R"({"solid": "bar", "on": "z+", "present": false,
      "velocity": [1, 0, 0]})"))),
              {"lets nodes go and moves them"});
  expectParts(refusalOf(barScene(both, changed(R"({"solid": "bar", "on": "x+", "velocity": [1, 0, 0]})"))),
              {"here, and held by supports item 0", "stages.1"});
  expectParts(refusalOf(barScene(both, R"({"do": "relax", "changes": {"supports": [{"solid": "bar", "on": "z+",
      "velocity": [1, 0, 0]}]}})")),
              {"steady velocity"});
  expectParts(refusalOf(barScene(both, R"({"do": "run", "time": 1, "changes": {"supports": [{"solid": "bar",
      "on": "z+", "velocity": [1, 0, 0]}]}}, {"do": "relax"})")),
              {"steady velocity"});
  if (!WITH_EXPRESSIONS) return;
  expectParts(
      refusalOf(barScene(both, changed(R"--({"solid": "bar", "on": "z+", "displacement": [0, 0, "0.1 + t"]})--"))),
      {"at once", "start at 0"});
}

// ---- planes

std::string planeOf(const std::string& motion) {
  return R"(, "planes": [{"on": "z+", "point": [0, 0, 4], "normal": [0, 0, -1], "stiffness": 1e7)" + motion + "}]";
}
std::string pressedAt(const std::string& motion, const std::string& first = R"({"do": "run", "time": 0.1})") {
  return first + R"(, {"do": "run", "time": 0.1, "changes": {"planes": [{"solid": "bar", "plane": 0, )" + motion +
         "}]}}";
}

/// To the last bit: the plane goes on from where it was, with its own time.
TEST(ChangedPlanes, GoAsThoseThatWereToldBefore) {
  if (!WITH_EXPRESSIONS) GTEST_SKIP();
  const auto movedBy = [&](const std::string& plane, const std::string& stages) {
    const Scene bar = barScene(R"({"on": "z-"})", stages, planeOf(plane));
    Built built = started(bar);
    built.run->advance(1000);
    if (bar.stages.back().changes) begin(built, bar, 1);
    built.run->advance(1000);
    EXPECT_LT(std::abs(built.run->ledger().residual()), 1e-3 * built.run->ledger().stored());
    return std::as_const(*built.run).solid(0).nodes().u;
  };
  const auto both = R"({"do": "run", "time": 0.1}, {"do": "run", "time": 0.1})";
  const auto byChange = movedBy("", pressedAt(R"("velocity": [0, 0, -0.5])"));
  const auto byTime = movedBy(R"--(, "displacement": [0, 0, "t < 0.1 ? 0 : -0.5*(t - 0.1)"])--", both);
  const auto further = movedBy(R"(, "velocity": [0, 0, -0.5])", pressedAt(R"("displacement": [0, 0, "-0.5*t"])"));
  const auto straight = movedBy(R"(, "velocity": [0, 0, -0.5])", both);
  ASSERT_LT(byChange.back().z, -0.01);
  ASSERT_LT(straight.back().z, -0.05);
  for (std::size_t n = 0; n < byChange.size(); ++n) {
    EXPECT_LT(norm(byChange[n] - byTime[n]), 1e-12);
    EXPECT_LT(norm(further[n] - straight[n]), 1e-12);
  }
}

TEST(ChangedPlanes, ThatFlyAreTold) {
  const Scene bar = barScene(R"({"on": "z-"})", pressedAt(R"("velocity": [0, 0, -50])"), planeOf(""));
  expectParts(warningsOf(bar), {"stages.1.changes.planes.0 moves at up to 50 m/s"});
}

TEST(ChangedPlanes, ThatCannotBeAreRefused) {
  const auto refused = [&](const std::string& stages, const std::string& plane = "") {
    try {
      const Scene bar = barScene(R"({"on": "z-"})", stages, planeOf(plane));
      Built built = started(bar);
      requireChanges(built, bar);
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  const std::string relax = R"({"do": "relax"})";
  expectParts(refused(R"({"do": "run", "time": 0.1}, {"do": "run", "time": 0.1, "changes":
      {"planes": [{"solid": "bar", "plane": 1, "velocity": [0, 0, -1]}]}})"),
              {"has 1 planes", "stages.1.changes.planes.0"});
  expectParts(refused(R"({"do": "run", "time": 0.1}, {"do": "run", "time": 0.1, "changes":
      {"planes": [{"solid": "rod", "plane": 0, "velocity": [0, 0, -1]}]}})"),
              {"rod"});
  expectParts(refused(pressedAt(R"("displacement": [0, 0, -1])")), {"moves at once"});
  expectParts(refused(relax, R"(, "velocity": [0, 0, -1])"), {"a plane has a steady velocity", "solids.0.planes.0"});
  expectParts(refused(pressedAt(R"("velocity": [0, 0, -1])") + ", " + relax),
              {"a plane has a steady velocity", "stages.1.changes.planes.0"});
  const std::string once = R"({"solid": "bar", "plane": 0, "velocity": [0, 0, -1]})";
  expectParts(refused(R"({"do": "run", "time": 0.1, "changes": {"planes": [)" + once + ", " + once + "]}}"),
              {"changes twice", "stages.0.changes.planes.1"});
  EXPECT_EQ(refused(pressedAt(R"("velocity": [0, 0, -1])", relax)), "");
  EXPECT_EQ(refused(pressedAt(R"("velocity": [0, 0, 0])") + ", " + relax, R"(, "velocity": [0, 0, -1])"), "");
}

}  // namespace
}  // namespace dovetail::scene::test
