// Grains, solids and their contacts go on in another scene.
#include <gtest/gtest.h>

#include "../cantilever/program.hpp"
#include "dovetail/io/time_series.hpp"

namespace dovetail::scene {
namespace {

using cantilever::test::runProgram;
using io::test::ScratchFolder;

struct Parts {
  std::string particles = R"({"from": "lattice", "lattice": "simple-cubic", "radius": 0.01, "distance": 0.0199,
      "density": 2500, "box": [[0, 0.03, 0], [0.06, 0.09, 0.03]], "velocity": [0, 0.1, -0.1]})",
              material = R"({"law": "J2", "youngs_modulus": 1e6, "poisson_ratio": 0.4, "density": 1100,
      "yield_stress": 300, "hardening": 1e5})",
              stepping = "explicit", formulation = "enhanced", cells = "[4, 4, 1]", corner = "[0, 0, -0.02]",
              state = {}, name = "plate", lift = "0*t", wall = "[0, 0, 0]", friction = "0.4", perMacroStep = "1",
              time = "0.01";
};

/// A block of grains slides over a plate that yields, and along a wall.
std::string textOf(const Parts& p) {
  return R"({"gravity": [-5, 0, -9.81], "contact": {"law": "linear", "stiffness": 1e4, "friction": )" + p.friction +
         R"(}, "particles": [)" + p.particles + R"(], "walls": [{"shape": "plane", "normal": [1, 0, 0], "point": )" +
         p.wall + R"(}], "solids": [{"name": ")" + p.name + R"(", "mesh": "box", "cells": )" + p.cells +
         R"(, "box": [)" + p.corner + R"(, [0.12, 0.12, 0]], "material": )" + p.material + R"(, "formulation": ")" +
         p.formulation + R"(", "stepping": ")" + p.stepping + R"(", )" + p.state +
         R"("supports": [{"on": "x+", "displacement": [0, 0, ")" + p.lift +
         R"("]}, {"on": "x-"}]}], "couplings": [{"type": "surface", "solid": ")" + p.name +
         R"(", "on": "z+", "kernel": "none"}], "steps": {"dt": 2e-5, "per_macro_step": )" + p.perMacroStep +
         R"(}, "stages": [{"do": "run", "time": )" + p.time +
         R"(}], "output": {"series": 1e-3, "checkpoints": 1, "probes": [{"name": "side", "of": "wall", "wall": 0},
         {"name": "held", "of": "node", "solid": ")" +
         p.name + R"(", "at": [0.12, 0, 0]}]}})";
}

class StatesOfOthers : public ::testing::Test {
protected:
  ScratchFolder scenes, first, whole, next;

  cantilever::test::Outcome runs(const Parts& parts, const ScratchFolder& out) {
    io::test::writeText(scenes / "scene.json", textOf(parts));
    return runProgram({"run", (scenes / "scene.json").string(), "--out", out.path().string(), "--replace"});
  }
  std::string file() const { return (first / "checkpoint.state").string(); }
  Parts after(Parts parts) const {
    parts.particles = R"({"from": "state", "file": ")" + file() + R"("})";
    parts.state = R"("state": {"file": ")" + file() + R"("}, )";
    return parts;
  }
  void expectTheWhole(Parts parts, double tolerance) {
    ASSERT_EQ(runs(parts, first).code, 0);
    const auto outcome = runs(after(parts), next);
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_EQ(outcome.out.find("without the tangential springs"), std::string::npos) << outcome.out;
    parts.time = "0.02";
    ASSERT_EQ(runs(parts, whole).code, 0);
    const io::TimeSeries all = io::readCsv(whole / "series.csv"), rest = io::readCsv(next / "series.csv");
    for (const char* const name : {"particles_kinetic_J", "particles_contacts_J", "plate_kinetic_J", "plate_elements_J",
                                   "on_plate_x_N", "on_plate_y_N", "on_plate_z_N", "side_x_N", "side_y_N"})
      for (const std::size_t row : {0, 10}) {
        const double expected = all.column(name)[10 + row];
        EXPECT_NEAR(rest.column(name)[row], expected, (row == 0 ? 1e-12 : tolerance) * std::abs(expected))
            << name << ", row " << row;
      }
    EXPECT_GT(all.column("plate_dissipated_by_elements_J")[10], 1e-6);
    EXPECT_GT(std::abs(all.column("side_y_N")[10]), 1e-3) << "nothing rubs against the wall";
  }
  std::string refusal(const Parts& parts) {
    const auto outcome = runs(parts, next);
    EXPECT_EQ(outcome.code, 2) << outcome.out;
    return outcome.err;
  }
  void expectRefusal(const Parts& parts, const std::string& words) {
    const std::string told = refusal(parts);
    EXPECT_NE(told.find(words), std::string::npos) << told;
    EXPECT_NE(told.find("scene.json:"), std::string::npos) << told;
  }
};

TEST_F(StatesOfOthers, GoOnWithExplicitSteps) { expectTheWhole({}, 1e-8); }
TEST_F(StatesOfOthers, GoOnWithImplicitSteps) {
  Parts parts;
  parts.stepping = "implicit";
  parts.perMacroStep = "2";
  expectTheWhole(parts, 1e-3);  // iterations end elsewhere within their tolerance
}

TEST_F(StatesOfOthers, AreRefusedByNameWhereTheyDoNotFit) {
  ASSERT_EQ(runs({}, first).code, 0);
  const Parts right = after({});
  Parts other = right;
  other.cells = "[4, 3, 1]";
  expectRefusal(other, "40 nodes, that of the state 50");
  other = right;
  other.corner = "[0, 0, -0.03]";
  expectRefusal(other, "other positions");
  other = right;
  other.material = R"({"law": "neo-Hookean", "youngs_modulus": 1e6, "poisson_ratio": 0.4, "density": 1100})";
  expectRefusal(other, "the material of \"plate\"");
  other = right;
  other.formulation = "standard";
  expectRefusal(other, "write \"formulation\": \"enhanced\"");
  other = right;
  other.name = "plite";
  expectRefusal(other, "no solid \"plite\"");
}

/// Displacements of supports count from where the state has the nodes.
TEST_F(StatesOfOthers, StayWhereSupportsHadThem) {
  Parts parts;
  parts.lift = "1e-3*t/0.01";
  ASSERT_EQ(runs(parts, first).code, 0);
  Parts then = after(parts);
  then.lift = "-1e-3*t/0.01";
  ASSERT_EQ(runs(then, next).code, 0);
  const io::TimeSeries rows = io::readCsv(next / "series.csv");
  EXPECT_NEAR(rows.column("held_uz_m").front(), 1e-3, 1e-15);
  EXPECT_NEAR(rows.column("held_uz_m")[5], 5e-4, 1e-15);
  EXPECT_NEAR(rows.column("held_uz_m").back(), 0.0, 1e-15);
}

/// Grains in a box under a lid that keeps a pressure, and rub against its sides.
std::string underALid(const std::string& particles, const std::string& lid) {
  return R"({"contact": {"law": "linear", "stiffness": 1e4, "friction": 0.4}, "gravity": [0, 0, -9.81],
      "particles": [)" +
         particles + R"(], "walls": [
        {"name": "sides", "shape": "box", "box": [[0, 0, 0], [0.08, 0.08, 1]], "open": ["z+"]},
        {"name": "lid", "shape": "plane", "point": [0, 0, 0.19], "normal": [0, 0, -1], )" +
         lid + R"(}],
      "steps": {"dt": 2e-5}, "stages": [{"do": "run", "time": 0.02}],
      "output": {"series": 1e-3, "checkpoints": 1, "probes": [{"name": "lid", "of": "wall", "wall": "lid"},
        {"name": "sides", "of": "wall", "wall": "sides"}]}})";
}

TEST_F(StatesOfOthers, WallsStartWhereTheyWere) {
  const std::string servo = R"("servo": {"keeps": "pressure", "pressure": 20000, "area": 0.0064, "axis": [0, 0, -1]})",
                    state = R"("state": {"file": ")" + file() + R"("}, )";
  const auto run = [&](const std::string& text, const ScratchFolder& out) {
    io::test::writeText(scenes / "scene.json", text);
    return runProgram({"run", (scenes / "scene.json").string(), "--out", out.path().string(), "--replace"});
  };
  const std::string packing = R"({"from": "packing", "box": [[0, 0, 0], [0.08, 0.08, 0.19]], "density": 2500,
      "radius": {"smallest": 0.008, "largest": 0.01}, "solid_fraction": 0.55})";
  ASSERT_EQ(run(underALid(packing, servo), first).code, 0);
  const std::string grains = R"({"from": "state", "file": ")" + file() + R"("})";
  const auto held = run(underALid(grains, state + R"("velocity": [0, 0, 0])"), next);
  ASSERT_EQ(held.code, 0) << held.err;
  EXPECT_EQ(held.out.find("without the tangential springs"), std::string::npos) << held.out;
  const io::TimeSeries before = io::readCsv(first / "series.csv"), after = io::readCsv(next / "series.csv");
  EXPECT_LT(before.column("lid_uz_m").back(), -1e-3);  // it went down
  EXPECT_GT(before.column("lid_z_N").back(), 1.0);
  for (const char* const name : {"lid_z_N", "lid_x_N", "sides_x_N", "sides_z_N", "particles_contacts_J"})
    EXPECT_NEAR(after.column(name)[0], before.column(name).back(), 1e-12 * std::abs(before.column(name).back()))
        << name;
  EXPECT_EQ(after.column("lid_uz_m")[0], 0.0);

  const std::string whole = underALid(grains, state + R"("velocity": [0, 0, 0])");
  const auto replaced = [&](const std::string& from, const std::string& to) {
    std::string text = whole;
    for (std::size_t at; (at = text.find(from)) != std::string::npos;) text.replace(at, from.size(), to);
    return text;
  };
  const auto refused = [&](const std::string& text, const std::string& part) {
    const auto outcome = run(text, next);
    EXPECT_EQ(outcome.code, 2) << outcome.out;
    EXPECT_NE(outcome.err.find(part), std::string::npos) << outcome.err;
  };
  refused(replaced(R"("lid")", R"("cap")"), "no wall \"cap\"");
  refused(replaced(R"("shape": "plane", "point": [0, 0, 0.19], "normal": [0, 0, -1])",
                   R"("shape": "sphere", "centre": [0, 0, 0.2], "radius": 1)"),
          "another shape in the state");
  refused(replaced("checkpoint.state", "nowhere.state"), "nowhere.state");
  // The box too, whose sides are those that it has there.
  const std::string box = R"("name": "sides", "shape": "box")",
                    there = R"("name": "sides", )" + state + R"("shape": "box")";
  const auto both = run(replaced(box, there), next);
  ASSERT_EQ(both.code, 0) << both.err;
  EXPECT_EQ(io::readCsv(next / "series.csv").column("sides_x_N")[0], after.column("sides_x_N")[0]);
  std::string other = replaced(box, there);
  other.replace(other.find(R"("open": ["z+"])"), 14, R"("open": ["z-"])");
  refused(other, "another shape in the state");
}

TEST_F(StatesOfOthers, TellWhatBeginsWithoutSprings) {
  ASSERT_EQ(runs({}, first).code, 0);
  const Parts right = after({});
  Parts other = right;
  other.wall = "[-0.001, 0, 0]";
  EXPECT_NE(runs(other, next).out.find("lacks 1 of the scene's walls"), std::string::npos);
  other = right;
  other.state.clear();
  EXPECT_NE(runs(other, next).out.find("Contacts of \"grains on plate (z+)\""), std::string::npos);
}

}  // namespace
}  // namespace dovetail::scene
