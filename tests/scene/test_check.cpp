// Starts, and what is refused or told before any step.
#include <gtest/gtest.h>

#include <cstdint>
#include <cstring>
#include <sstream>

#include "dovetail/scene/execute.hpp"
#include "refusal.hpp"
#include "scene_parts.hpp"

namespace dovetail::scene::test {
namespace {

const std::string grain =
    R"("particles": [{"from": "list", "density": 2500, "spheres": [{"at": [0.1, 0.1, 0.1], "radius": 0.02}]}],)";
const std::string runs = R"({"do": "run", "time": 1e-3})", settles = R"({"do": "settle", "windows": 3})";

/// A block of 0.2 m × 0.2 m × 0.1 m below z = 0, from x on.
std::string block(double x, const std::string& name = "b", const std::string& motion = "") {
  return R"({"name": ")" + name + R"(", "mesh": "box", "cells": [2, 2, 2], "box": [[)" + std::to_string(x) +
         ", 0, -0.1], [" + std::to_string(x + 0.2) +
         R"(, 0.2, 0]], "material": {"law": "neo-Hookean", "youngs_modulus": 1e7, "poisson_ratio": 0.3, "density": 1200},
         "supports": [{"on": "z-")" +
         motion + "}]}";
}

Scene whole(const std::string& parts, const std::string& stages = runs) {
  return sceneFromText("{" + law + grain + parts + R"("stages": [)" + stages + "]}", "s.json", SCENES);
}
std::string textOfCheck(const Scene& scene) {
  std::ostringstream log;
  check(scene, log);
  return log.str();
}
std::string refusalOfCheck(const std::string& parts, const std::string& stages = runs) {
  try {
    textOfCheck(whole(parts, stages));
    return "";
  } catch (const InputError& error) {
    return error.what();
  }
}

/// Looking for the step leaves nothing in the books.
TEST(SceneStart, AutomaticStepsBookAllImpulses) {
  if (!WITH_EXPRESSIONS) GTEST_SKIP() << "the support follows an expression";
  Built built =
      started(whole(R"("solids": [)" + block(0.0, "b", R"(, "displacement": [0, 0, "5*t - 900*t^2"])") + "],"));
  built.run->advance(50);
  const coupling::Totals totals = built.run->totals();
  EXPECT_GT(norm(totals.momentum), 0.1);
  EXPECT_LT(norm(totals.residual.linear), 1e-13 * totals.turnedOver);
  EXPECT_THROW(built.run->limitAtStart(), InputError);
}

TEST(SceneStart, SteadyMotionIsRefusedWhereAStageSettles) {
  const auto wall = [](const std::string& motion) {
    return R"("walls": [{"shape": "plane", "point": [0, 0, 0], "normal": [0, 0, 1])" + motion + "}],";
  };
  const auto support = [](const std::string& motion) { return R"("solids": [)" + block(0.0, "b", motion) + "],"; };
  for (const std::string& parts : {wall(R"(, "velocity": [0, 0, 0.1])"), wall(R"(, "angular_velocity": [0, 0, 1])"),
                                   support(R"(, "velocity": [0, 0, 0.1])")}) {
    expectParts(refusalOfCheck(parts, runs + "," + settles), {"has a steady velocity", "s.json:", "run for a time"});
    EXPECT_EQ(refusalOfCheck(parts), "");
  }
  EXPECT_EQ(refusalOfCheck(wall(""), settles), "");
}

/// What a run would refuse after its start.
TEST(SceneCheck, RefusesWhatARunRefuses) {
  const auto output = [](const std::string& keys) { return R"("output": {)" + keys + "},"; };
  expectParts(refusalOfCheck(output(R"("series": 1e-4, "probes": [{"name": "p", "of": "wall", "wall": 3}])")),
              {"no wall 3", "s.json:"});
  expectParts(refusalOfCheck(output(R"("probes": [{"name": "p", "of": "grain", "at": [0, 0, 0]}])")), {"no series"});
  if (WITH_FRAMES)
    expectParts(refusalOfCheck(output(R"("frames": 1e-4, "contents": ["grains", "stress"])")), {"no \"solids\""});
  expectParts(refusalOfCheck(R"("steps": {"dt": 1e-30},)"), {"more than 1e15 windows", "stages.0"});
  expectParts(refusalOfCheck(R"("solids": [)" + block(0.0, std::string(200, 'x')) + "],"), {"too long"});
}

TEST(SceneCheck, CountsWindowsOfAllStages) {
  const std::string text = textOfCheck(whole(R"("steps": {"dt": 1e-5},)", runs + "," + settles + "," + runs));
  expectParts(text, {": 200 windows of 1 steps", "at most 3 windows"});
}

TEST(SceneCheck, TellsBodiesThatLieInEachOther) {
  if (!WITH_FCL) GTEST_SKIP() << "audits are FCL's";
  const auto of = [](double x) {
    return textOfCheck(whole(R"("solids": [)" + block(0.0, "one") + "," + block(x, "other") + "],"));
  };
  expectParts(of(0.19), {R"("one" and "other" overlap at the start)"});
  for (const double x : {0.2, 0.3}) EXPECT_EQ(of(x).find("overlap at the start"), std::string::npos) << x;
  const std::string wall =
      R"("walls": [{"shape": "mesh", "file": "bucket.stl", "scale": 0.001, "shift": [0, 0, -0.05]}],)";
  expectParts(textOfCheck(whole(wall + R"("solids": [)" + block(-0.1, "one") + "],")), {R"("one" and walls.0 overlap)"});
}

/// Numbers within a state are looked at before they are used: the bytes of a checkpoint may be whole and still not fit.
TEST(SceneState, NumbersOutOfRangeAreRefused) {
  const std::string wall = R"("walls": [{"shape": "plane", "point": [0.081, 0, 0], "normal": [1, 0, 0]}],)";
  const std::string touched = replaced(block(0.0), "0.2, 0]]", "0.2, 0.081]]");
  Built built = started(whole(wall + R"("solids": [)" + touched +
                              R"(], "couplings": [{"type": "surface", "solid": "b"}], "steps": {"dt": 1e-5},)"));
  const auto goOn = [&] {
    built.run->advance(3);
    return built.run->save();
  };
  const std::vector<char> good = goOn(), later = goOn();
  std::size_t refused = 0;
  for (std::size_t at = 0; at + 4 <= good.size(); at += 4) {
    std::vector<char> bytes = good;
    const std::int32_t number = 1 << 24;
    std::memcpy(&bytes[at], &number, sizeof number);
    try {
      built.run->load(bytes);
      built.run->advance(1);
    } catch (const Error&) {
      ++refused;
    }
    built.run->load(good);
  }
  EXPECT_GT(refused, 100U);
  EXPECT_EQ(goOn(), later);
}

}  // namespace
}  // namespace dovetail::scene::test
