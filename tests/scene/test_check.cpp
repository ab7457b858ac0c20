// Starts, and what is refused or told before any step.
#include <gtest/gtest.h>

#include <cstdint>
#include <cstring>
#include <sstream>

#include "dovetail/linalg/multigrid.hpp"
#include "dovetail/scene/execute.hpp"
#include "refusal.hpp"
#include "scene_parts.hpp"

namespace dovetail::scene::test {
namespace {

const std::string grain =
    R"("particles": [{"from": "list", "density": 2500, "spheres": [{"at": [0.1, 0.1, 0.1], "radius": 0.02}]}],)";
const std::string runs = R"({"do": "run", "time": 1e-3})", relaxes = R"({"do": "relax", "macro_steps": 3})";

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

/// Looking for the step leaves nothing in the ledger.
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
    expectParts(refusalOfCheck(parts, runs + "," + relaxes), {"has a steady velocity", "s.json:", "run for a time"});
    EXPECT_EQ(refusalOfCheck(parts), "");
  }
  EXPECT_EQ(refusalOfCheck(wall(""), relaxes), "");
}

/// What a run would refuse after its start.
TEST(SceneCheck, RefusesWhatARunRefuses) {
  const auto output = [](const std::string& keys) { return R"("output": {)" + keys + "},"; };
  expectParts(refusalOfCheck(output(R"("series": 1e-4, "probes": [{"name": "p", "of": "wall", "wall": 3}])")),
              {"no wall 3", "s.json:"});
  expectParts(refusalOfCheck(output(R"("probes": [{"name": "p", "of": "grain", "at": [0, 0, 0]}])")), {"no series"});
  if (WITH_FRAMES)
    expectParts(refusalOfCheck(output(R"("frames": 1e-4, "contents": ["grains", "stress"])")), {"no \"solids\""});
  expectParts(refusalOfCheck(R"("steps": {"dt": 1e-30},)"), {"more than 1e15 macro steps", "stages.0"});
  expectParts(refusalOfCheck(R"("solids": [)" + block(0.0, std::string(200, 'x')) + "],"), {"too long"});
}

TEST(SceneCheck, CountsWindowsOfAllStages) {
  const std::string text = textOfCheck(whole(R"("steps": {"dt": 1e-5},)", runs + "," + relaxes + "," + runs));
  expectParts(text, {": 200 macro steps of 1 steps", "at most 3 macro steps"});
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
  expectParts(textOfCheck(whole(wall + R"("solids": [)" + block(-0.1, "one") + "],")),
              {R"("one" and walls.0 overlap)"});
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

/// A cube of which a face is held, under gravity.
std::string heavyCube(int cells, const std::string& keys) {
  const std::string n = std::to_string(cells);
  return R"({"gravity": [0, 0, -9.81], "steps": {"dt": 0.01}, "solids": [{"name": "cube", "mesh": "box", "cells": [)" +
         n + ", " + n + ", " + n + R"(], "box": [[0, 0, 0], [1, 1, 1]],
    "material": {"law": "neo-Hookean", "youngs_modulus": 1e6, "poisson_ratio": 0.3, "density": 1000},
    "supports": [{"on": "z-"}], )" +
         keys + R"(}], "stages": [{"do": "run", "time": 0.05}]})";
}

TEST(SceneLinearSolvers, IterationsDoWhatFactorsDo) {
  const auto tip = [](const std::string& solver) {
    Built built = started(
        sceneFromText(heavyCube(4, R"("stepping": "implicit", "linear_solver": ")" + solver + "\""), "s.json", SCENES));
    EXPECT_EQ(built.forecasts.at(0).method, solver == "conjugate-gradients" ? linalg::LinearMethod::conjugateGradients
                                                                            : linalg::LinearMethod::direct);
    built.run->advance(5);
    return built.run->solid(0).nodes().u.back();
  };
  const Vec3 direct = tip("direct");
  EXPECT_LT(direct.z, -1e-4);
  EXPECT_EQ(direct, tip("auto"));
  EXPECT_LT(norm(direct - tip("conjugate-gradients")), 1e-8 * norm(direct));
}

TEST(SceneLinearSolvers, AreToldAndRefusedWhereNothingIsSolved) {
  const auto told = [](const std::string& keys) {
    return textOfCheck(sceneFromText(heavyCube(3, keys), "s.json", SCENES));
  };
  const std::string text = told(R"("stepping": "implicit", "linear_solver": "conjugate-gradients")");
  EXPECT_NE(text.find("Solid \"cube\" is solved by conjugate gradients."), std::string::npos) << text;
  EXPECT_EQ(told(R"("stepping": "implicit")").find("gradients"), std::string::npos);
  if (!linalg::Multigrid::available()) {
    try {
      told(R"("linear_solver": "multigrid", "stepping": "implicit")");
      ADD_FAILURE();
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find("DOVETAIL_RANKS=ON"), std::string::npos) << error.what();
    }
  }
  try {
    told(R"("linear_solver": "direct", "stepping": "explicit")");
    ADD_FAILURE();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("explicit steps solve no linear systems"), std::string::npos)
        << error.what();
  }
}

}  // namespace
}  // namespace dovetail::scene::test
