// Load steps of solids, and what they are made with: regions, turning supports, loads of place and time, planes.
#include <cmath>
#include <filesystem>
#include <numbers>

#include "../io/scratch_folder.hpp"
#include "dovetail/fem/elements/solid.hpp"
#include "dovetail/fem/terms/contact_plane.hpp"
#include "dovetail/io/time_series.hpp"
#include "dovetail/scene/execute.hpp"
#include "scene_parts.hpp"

namespace dovetail::scene::test {
namespace {

/// A bar of 1 × 1 × 4 along z, E = 1 MPa, ν = 0, held at z-.
std::string bar(const std::string& keys, const std::string& support = R"({"on": "z-"})") {
  return R"("solids": [{"name": "bar", "mesh": "box", "cells": [1, 1, 4], "box": [[0, 0, 0], [1, 1, 4]],
      "material": {"law": "St-Venant-Kirchhoff", "youngs_modulus": 1e6, "poisson_ratio": 0, "density": 1000},
      "supports": [)" +
         support + "], " + keys + "}],";
}
Scene staticScene(const std::string& middle, const std::string& stages) {
  return sceneFromText("{" + middle + R"("steps": {"dt": 1e-4}, "stages": [)" + stages + "]}", "s.json", "/");
}
/// All load steps of the first stage.
Built loaded(const Scene& scene) {
  Built built = started(scene);
  const auto& stage = std::get<Statics>(scene.stages.front().kind);
  for (std::int64_t k = 0; k < stage.loadSteps; ++k)
    built.run->loadStep(k, stage.loadSteps, stage.time.value_or(0.0) / static_cast<double>(stage.loadSteps));
  return built;
}
std::size_t nodeAt(const Built& built, const Vec3& at) {
  const std::vector<Vec3>& X = built.meshes[0].X;
  return static_cast<std::size_t>(std::ranges::min_element(X, {}, [&](const Vec3& x) { return squaredNorm(x - at); }) -
                                  X.begin());
}
Vec3 displacementAt(const Built& built, const Vec3& at) { return built.run->solid(0).nodes().u[nodeAt(built, at)]; }
double channel(Built& built, const std::string& name) {
  for (const auto& one : built.run->ledger().channels())
    if (one.name == name) return one.joules;
  ADD_FAILURE() << "no channel " << name;
  return 0.0;
}
const std::string pulled = R"("loads": [{"on": "z+", "type": "traction", "traction": [0, 0, 1000]}])";
std::string refusalOf(const Scene& scene) {
  try {
    build(scene);
    return "";
  } catch (const InputError& error) {
    return error.what();
  }
}

TEST(SceneStatics, ABarIsStretchedByWhatItIsPulledWith) {
  for (const char* const stage : {R"({"do": "statics", "load_steps": 4})", R"({"do": "statics", "time": 2})"}) {
    Built built = loaded(staticScene(bar(pulled), stage));
    const double l = 1.0 + displacementAt(built, {0, 0, 4}).z / 4.0;  // E λ (λ² − 1)/2 = 1000
    EXPECT_NEAR(1e6 * l * (l * l - 1.0) / 2.0, 1000.0, 1e-5);
    const coupling::Reactions reactions = built.run->reactions(0);
    Vec3 sum;
    for (const Vec3& f : reactions.supports) sum += f;
    EXPECT_NEAR(sum.z, -1000.0, 1e-5);
  }
}

TEST(SceneStatics, TimePassesIfAsked) {
  EXPECT_EQ(loaded(staticScene(bar(pulled), R"({"do": "statics"})")).run->time(), 0.0);
  EXPECT_NEAR(loaded(staticScene(bar(pulled), R"({"do": "statics", "time": 2})")).run->time(), 2.0, 1e-12);
}

/// Half of the work that gravity and loads could do is held back on the way, if all is linear.
TEST(SceneStatics, TheLedgerClosesToSecondOrderOfTheLoadSteps) {
  const auto of = [](int steps) {
    Built built = loaded(staticScene(
        R"("gravity": [0, 0, -9.81],)" + bar(R"("loads": [{"on": "z+", "type": "pressure", "pressure": 5e4}])"),
        R"({"do": "statics", "load_steps": )" + std::to_string(steps) + "}"));
    EXPECT_GT(channel(built, "bar: load steps"), 0.0);
    return std::abs(built.run->ledger().residual() / channel(built, "bar: load steps"));
  };
  const double coarse = of(4), fine = of(16);
  EXPECT_LT(coarse, 1e-2);
  EXPECT_GT(coarse, 1e-7);
  EXPECT_NEAR(coarse / fine, 16.0, 2.0);
}

TEST(SceneStatics, ASolidStaysWhereItsLoadsHaveBroughtIt) {
  for (const char* const stepping : {"explicit", "implicit"}) {
    const std::string keys = pulled + R"(, "velocity": [0, 0, 0.1], "stepping": ")" + stepping + "\"";
    Built built = loaded(staticScene(bar(keys), R"({"do": "statics"}, {"do": "run", "time": 0.01})"));
    EXPECT_GT(channel(built, "kinetic damping"), 0.0);
    const double before = displacementAt(built, {0, 0, 4}).z, residual = built.run->ledger().residual();
    built.run->advance(100);
    EXPECT_NEAR(displacementAt(built, {0, 0, 4}).z, before, 1e-10);
    EXPECT_NEAR(norm(built.run->totals().residual.linear), 0.0, 1e-9);
    EXPECT_NEAR(built.run->ledger().residual(), residual, 1e-11);
  }
}

void expectToGoOn(const Scene& scene) {
  Built whole = started(scene), parted = started(scene), rest = started(scene), last = started(scene);
  for (int k = 0; k < 6; ++k) whole.run->loadStep(k, 6, 1.0 / 6.0);
  for (int k = 0; k < 2; ++k) parted.run->loadStep(k, 6, 1.0 / 6.0);
  rest.run->load(parted.run->save());
  for (int k = 2; k < 6; ++k) rest.run->loadStep(k, 6, 1.0 / 6.0);
  whole.run->advance(50);
  rest.run->advance(50);
  last.run->load(whole.run->save());
  EXPECT_TRUE(whole.run->save() == rest.run->save());
  EXPECT_EQ(whole.run->ledger().residual(), rest.run->ledger().residual());
  EXPECT_NEAR(whole.run->ledger().residual(), last.run->ledger().residual(), 1e-12);
}

TEST(SceneStatics, LoadStepsGoOnFromAState) {
  const std::string stages = R"({"do": "statics", "load_steps": 6, "time": 1}, {"do": "run", "time": 0.01})";
  expectToGoOn(staticScene(bar(R"("loads": [{"on": "z+", "type": "pressure", "pressure": 5e4}])"), stages));
  if (!WITH_EXPRESSIONS) return;
  // Nothing is held back, and much is dissipated.
  std::string keys = bar("\"gravity\": true", R"--({"on": "z-"}, {"on": "z+", "displacement": [0, 0, "0.02*t"]})--");
  const std::string elastic = R"("law": "St-Venant-Kirchhoff")";
  keys.replace(keys.find(elastic), elastic.size(), R"("law": "J2", "yield_stress": 1e3)");
  expectToGoOn(staticScene(keys, stages));
}

TEST(SceneStatics, WhatCannotBeIsRefused) {
  const std::string grains = law + R"("particles": [{"from": "list", "density": 1000,
      "spheres": [{"at": [0.5, 0.5, 9], "radius": 0.1}]}],)";
  EXPECT_EQ(refusalOf(staticScene(grains + bar(pulled), R"({"do": "statics"}, {"do": "run", "time": 1})")), "");
  expectParts(refusalOf(staticScene(grains + bar(pulled), R"({"do": "statics", "time": 1})")),
              {"time passes", "leave \"time\" out", "stages.0"});
  expectParts(refusalOf(staticScene(grains + bar(pulled), R"({"do": "run", "time": 1}, {"do": "statics"})")),
              {"may lie on the solids", "first ones", "stages.1"});
  expectParts(refusalOf(staticScene(grains, R"({"do": "statics"})")), {"the scene has none"});
  const std::string overlap = R"("couplings": [{"type": "overlap", "solid": "bar", "solid_border": 4,
      "particle_border": 2}],)";
  expectParts(refusalOf(staticScene(grains + bar(pulled) + overlap, R"({"do": "statics"})")),
              {"overlap ties them", "initial_equilibrium"});
}

TEST(SceneStatics, GrainsOnASolidAreTold) {
  const auto with = [](double z) {
    return staticScene(law + R"("particles": [{"from": "list", "density": 1000,
      "spheres": [{"at": [0.5, 0.5, )" +
                           std::to_string(z) + R"(], "radius": 0.1}]}],
      "couplings": [{"type": "surface", "solid": "bar", "on": "z+", "kernel": "none"}],)" +
                           bar(R"("loads": [{"on": "z+", "type": "traction", "traction": [0, 0, 30000]}])"),
                       R"({"do": "statics"}, {"do": "run", "time": 1})");
  };
  EXPECT_NO_THROW(loaded(with(4.5)));
  EXPECT_THROW(loaded(with(4.09)), InputError);  // from the start
  EXPECT_THROW(loaded(with(4.15)), InputError);  // the bar grows into it
}

TEST(SceneStatics, WithoutEquilibriumTheLoadStepIsNamed) {
  const Scene scene = staticScene(bar(pulled, ""), R"({"do": "statics"})");
  try {
    loaded(scene);
    FAIL();
  } catch (const NumericalError& error) {
    expectParts(error.what(), {"\"bar\"", "load step 1 of 10"});
  }
}

/// The path of a bar that has no limit point leads to where load steps do.
TEST(SceneArcLength, EndsWhereLoadStepsEnd) {
  const std::string keys = R"("loads": [{"on": "z+", "type": "traction", "traction": [100, 0, 2e5]}])";
  const Scene scene = staticScene(bar(keys), R"({"do": "statics", "load_steps": 8, "control": "arc-length"})");
  Built path = started(scene), steps = loaded(staticScene(bar(keys), R"({"do": "statics"})"));
  EXPECT_EQ(path.run->loadFactor(0), 0.0);
  double before = 0.0;
  for (int k = 0; path.run->loadFactor(0) < 1.0; ++k) {
    ASSERT_LT(k, 30);
    path.run->followLoads(k, 8);
    EXPECT_GT(path.run->loadFactor(0), before);
    before = path.run->loadFactor(0);
    if (k == 0) {
      EXPECT_NEAR(before, 0.125, 0.02);
    }
  }
  EXPECT_EQ(path.run->loadFactor(0), 1.0);
  EXPECT_LT(norm(displacementAt(path, {1, 1, 4}) - displacementAt(steps, {1, 1, 4})), 1e-9);
  EXPECT_LT(std::abs(path.run->ledger().residual()), 2e-2 * channel(path, "bar: load steps"));
  EXPECT_EQ(path.run->time(), 0.0);
}

/// An unloaded solid is there at once.
TEST(SceneArcLength, WithoutALoadThereIsNoPath) {
  Built built = started(staticScene(bar("\"gravity\": true"), R"({"do": "statics", "control": "arc-length"})"));
  EXPECT_TRUE(built.run->followLoads(0, 10).empty());
  EXPECT_EQ(built.run->loadFactor(0), 1.0);
}

TEST(SceneArcLength, WhatCannotBeIsRefused) {
  expectParts(refusalOf(staticScene(bar(pulled), R"({"do": "statics", "time": 1, "control": "arc-length"})")),
              {"time never does", "leave \"time\" out", "stages.0"});
  expectParts(refusalOf(staticScene(bar(pulled + R"(, "linear_solver": "conjugate-gradients")"),
                                    R"({"do": "statics", "control": "arc-length"})")),
              {"conjugate gradients", "\"bar\"", "stages.0"});
}

/// Nothing that a user of scenes cannot write.
TEST(SceneStatics, WithoutEquilibriumTheMessageSaysWhatCanBeDone) {
  std::string keys = bar(R"("loads": [{"on": "z+", "type": "traction", "traction": [0, 0, 2e3]}])");
  const std::string elastic = R"("law": "St-Venant-Kirchhoff")";
  keys.replace(keys.find(elastic), elastic.size(), R"("law": "J2", "yield_stress": 1e3)");
  try {
    loaded(staticScene(keys, R"({"do": "statics"})"));
    FAIL();
  } catch (const NumericalError& error) {
    expectParts(error.what(), {"there is no equilibrium", "\"bar\"", "load step ", "take more load steps"});
    for (const char* const name : {"followPath", "solveStatics", "firstStep"})
      EXPECT_EQ(std::string(error.what()).find(name), std::string::npos) << error.what();
  }
}

/// π² E h²/(12 (2 L)²) for h = 1 and L = 40; the bar stays straight either way.
TEST(SceneStatics, EquilibriaThatWouldBuckleAreNamed) {
  const auto unstable = [](double stress) {
    std::string keys = bar(R"("loads": [{"on": "z+", "type": "traction", "traction": [0, 0, )" +
                           std::to_string(-stress) + R"(]}], "formulation": "enhanced")");
    const std::string box = R"("cells": [1, 1, 4], "box": [[0, 0, 0], [1, 1, 4]])";
    keys.replace(keys.find(box), box.size(), R"("cells": [1, 1, 40], "box": [[0, 0, 0], [1, 1, 40]])");
    Built built = started(staticScene(keys, R"({"do": "statics"})"));
    return built.run->loadStep(0, 1, 0.0);
  };
  const double buckling = std::numbers::pi * std::numbers::pi * 1e6 / (12.0 * 6400.0);
  EXPECT_TRUE(unstable(0.95 * buckling).empty());
  EXPECT_EQ(unstable(1.05 * buckling), std::vector<std::string>{"bar"});
}

/// Springs in series: 2 m of E and 2 m of 4 E.
TEST(SceneRegions, ABarOfTwoMaterials) {
  const std::string stiff = R"("sets": [{"name": "upper", "place": "box", "box": [[0, 0, 2], [1, 1, 4]]}],
      "regions": [{"elements": "upper", "material": {"law": "St-Venant-Kirchhoff", "youngs_modulus": 4e6,
                   "poisson_ratio": 0, "density": 500}}], "loads": [{"on": "z+", "type": "traction", "traction": [0, 0, 1]}])";
  Built built = loaded(staticScene(bar(stiff), R"({"do": "statics"})"));
  EXPECT_NEAR(displacementAt(built, {0, 0, 2}).z, 2e-6, 1e-11);
  EXPECT_NEAR(displacementAt(built, {0, 0, 4}).z, 2.5e-6, 1e-11);
  double mass = 0.0;
  for (const double m : built.run->solid(0).nodes().mass) mass += m;
  EXPECT_NEAR(mass, 2.0 * 1000 + 2.0 * 500, 1e-9);
  expectParts(refusalOf(staticScene(bar(R"("regions": [{"elements": "none", "material": {"law": "neo-Hookean",
      "youngs_modulus": 1, "poisson_ratio": 0, "density": 1}}])"),
                                    R"({"do": "statics"})")),
              {"none", "regions.0"});
  const std::string twice = R"("sets": [{"name": "a", "place": "box", "box": [[0, 0, 2], [1, 1, 4]]},
      {"name": "b", "place": "box", "box": [[0, 0, 1], [1, 1, 3]]}], "regions": [{"elements": "a", "material": )";
  const std::string soft = R"({"law": "neo-Hookean", "youngs_modulus": 1, "poisson_ratio": 0, "density": 1}})";
  expectParts(refusalOf(staticScene(bar(twice + soft + R"(, {"elements": "b", "material": )" + soft + "]"),
                                    R"({"do": "statics"})")),
              {"is in two regions, \"a\" and \"b\"", "regions.1"});
}

TEST(SceneLoads, AForceIsSharedByTheNodes) {
  Built built = loaded(
      staticScene(bar(R"("loads": [{"on": "z+", "type": "force", "force": [0, 0, 1]}])"), R"({"do": "statics"})"));
  EXPECT_NEAR(displacementAt(built, {0, 0, 4}).z, 4e-6, 1e-10);
}

TEST(SceneSets, CylindersFacesAndCommonParts) {
  const std::string sets = R"("sets": [
      {"name": "axis", "place": "cylinder", "point": [0, 0, 0], "axis": [0, 0, 2], "radius": 0.1},
      {"name": "others", "place": "cylinder", "point": [0, 0, 0], "axis": [0, 0, 2], "radius": 9, "inner_radius": 0.1},
      {"name": "top", "place": "faces", "direction": [0, 0, 3], "angle": "10 deg"},
      {"name": "edge", "place": "common", "of": "top", "and": "x+"},
      {"name": "corner", "place": "common", "of": "edge", "and": "axis"}])";
  expectParts(refusalOf(staticScene(bar(sets), R"({"do": "statics"})")), {"nothing in common", "sets.4"});
  const Built built = build(staticScene(bar(sets.substr(0, sets.rfind(",\n")) + "]"), R"({"do": "statics"})"));
  const fem::SolidMesh& mesh = built.meshes[0];
  EXPECT_EQ(mesh.nodeSets.at("axis").size(), 5U);
  EXPECT_EQ(mesh.nodeSets.at("others").size(), 15U);
  EXPECT_EQ(mesh.faceSets.at("top").size(), 1U);
  EXPECT_EQ(mesh.nodeSets.at("top").size(), 4U);
  EXPECT_EQ(mesh.nodeSets.at("edge").size(), 2U);
  EXPECT_FALSE(mesh.faceSets.contains("edge"));
}

/// p = λ − ε g at the plane, and what it bears is what pushes.
TEST(ScenePlanes, CarryWhatIsPushedOntoThem) {
  const std::string plane = R"("planes": [{"on": "z-", "point": [0, 0, 0], "normal": [0, 0, 1], "stiffness": 1e8}],
      "loads": [{"on": "z+", "type": "pressure", "pressure": 1000, "follows": false}])";
  Built built =
      loaded(staticScene(bar(plane, R"({"on": "x-", "components": ["x"]}, {"on": "y-", "components": ["y"]})"),
                         R"({"do": "statics", "load_steps": 2})"));
  EXPECT_NEAR(displacementAt(built, {0, 0, 0}).z, -1e-5, 1e-9);
  EXPECT_NEAR(displacementAt(built, {0, 0, 4}).z + 1e-5, -4e-3, 1e-5);
}

std::string planeAt(double z) {
  return R"("planes": [{"on": "z-", "normal": [0, 0, 1], "point": [0, 0, )" + std::to_string(z) + "]}]";
}
TEST(ScenePlanes, SolidsBehindThemAreSeen) {
  const std::string run = R"({"do": "run", "time": 0.01})";
  expectParts(refusalOf(staticScene(bar(planeAt(5.0)), run)), {"all of \"bar\" lies behind the plane", "planes.0"});
  const auto warned = [&](double z) {
    const Scene scene = staticScene(bar(planeAt(z)), run);
    const Built built = started(scene);
    std::string all;
    for (const std::string& line : warnings(built, scene)) all += line;
    return all;
  };
  expectParts(warned(0.5), {"\"bar\" starts 0.5 m behind solids.0.planes.0"});
  EXPECT_EQ(warned(0.0).find("behind"), std::string::npos);
}

/// A block that just touches its plane, with nothing else along its normal, in the first of its load steps.
TEST(ScenePlanes, ATouchingPlaneHoldsASolidInLoadSteps) {
  const std::string keys = planeAt(0.0) + R"(, "loads": [{"on": "z+", "type": "pressure", "pressure": "1e4*t"}])";
  Built built = loaded(staticScene(bar(keys, R"({"on": "x-", "components": ["x"]}, {"on": "y-", "components": ["y"]})"),
                                   R"({"do": "statics", "load_steps": 4, "time": 1})"));
  EXPECT_NEAR(displacementAt(built, {0, 0, 4}).z - displacementAt(built, {0, 0, 0}).z, -0.04, 1e-3);
  double work = 0.0;
  for (const auto& one : built.run->ledger().channels()) work = std::max(work, std::abs(one.joules));
  EXPECT_LT(std::abs(built.run->ledger().residual()), 1e-3 * work);
}

/// Half of a load step's viscous work is in no channel: of the first, where rates start from none. Supports do none.
TEST(SceneStatics, ViscositiesAreInTheLedgerToFirstOrder) {
  const auto of = [](int steps) {
    std::string keys = bar(R"("loads": [{"on": "z+", "type": "traction", "traction": [0, 0, 1000]}])");
    keys.replace(keys.find("\"density\""), 0, R"("damping_time": 0.02, )");
    Built built =
        loaded(staticScene(keys, R"({"do": "statics", "time": 1, "load_steps": )" + std::to_string(steps) + "}"));
    const double dissipated = channel(built, "bar: dissipated in load steps");
    EXPECT_GT(dissipated, 0.0);
    for (const auto& one : built.run->ledger().channels())
      if (one.name == "bar: supports") {
        EXPECT_NEAR(one.joules, 0.0, 1e-3 * dissipated);
      }
    return built.run->ledger().residual() / dissipated;
  };
  EXPECT_NEAR(of(10), 0.05, 0.01);
  EXPECT_NEAR(of(20), 0.025, 0.005);
}

TEST(SceneDamping, MassDampingSlowsAFreeBody) {
  Built built =
      started(staticScene(bar(R"("mass_damping": 5, "velocity": [1, 0, 0])", ""), R"({"do": "run", "time": 0.1})"));
  built.run->advance(1000);
  EXPECT_NEAR(built.run->solid(0).nodes().v[3].x, std::exp(-0.5), 1e-4);
  EXPECT_NEAR(built.run->ledger().residual(), 0.0, 1e-6);
  EXPECT_THROW(started(staticScene(bar(R"("mass_damping": 1e5)"), R"({"do": "run", "time": 0.1})")), InputError);
}

TEST(SceneDamping, ViscosityShortensExplicitSteps) {
  const auto limitWith = [](double tau) {
    std::string keys = bar("\"gravity\": true");
    keys.replace(keys.find("\"density\""), 0, "\"damping_time\": " + std::to_string(tau) + ", ");
    const Scene scene = sceneFromText("{" + keys + R"("stages": [{"do": "run", "time": 0.1}]})", "s.json", "/");
    Built built = started(scene);
    return limits(built, scene).front().dt;
  };
  const double h = limitWith(0.0), tau = 0.01;
  EXPECT_NEAR(limitWith(tau), std::sqrt(tau * tau + h * h) - tau, 1e-9 * h);
}

TEST(SceneModes, OfAllStagesAreInOneFile) {
  const std::string dead = R"("loads": [{"on": "z+", "type": "traction", "traction": [0, 0, 1e5]}])";
  const Scene scene = staticScene(
      bar(dead), R"({"do": "modes", "count": 2}, {"do": "statics", "load_steps": 2}, {"do": "modes", "count": 3})");
  const io::test::ScratchFolder folder;
  std::ostringstream log;
  for (int again = 0; again < 2; ++again) {
    ASSERT_TRUE(run(scene, {.folder = folder.path(), .progress = false}, log));
    const io::TimeSeries modes = io::readCsv(folder / "modes.csv");
    ASSERT_EQ(modes.rows(), 5U);
    EXPECT_EQ(modes.column("stage")[1], 1.0);
    EXPECT_EQ(modes.column("stage")[2], 3.0);
    EXPECT_EQ(modes.column("mode")[4], 3.0);
    EXPECT_GT(modes.column("frequency_Hz")[2], 1.01 * modes.column("frequency_Hz")[0]);  // under tension
  }
}

TEST(SceneModes, ABuiltBarRefusesWhatHasNone) {
  const std::string stage = R"({"do": "modes", "count": 2})";
  const auto following = [&](const char* follows) {
    try {
      started(staticScene(bar(std::string(R"("loads": [{"on": "z+", "type": "pressure", "pressure": 10, "follows": )") +
                              follows + "}]"),
                          stage));
      return std::string();
    } catch (const InputError& error) {
      return std::string(error.what());
    }
  };
  EXPECT_EQ(following("false"), "");
  expectParts(following("true"), {"\"load 0 on z+\" of \"bar\" is not symmetric", "stages.0", "\"follows\": false"});
  EXPECT_EQ(refusalOf(staticScene(bar(pulled), stage)), "");
  expectParts(refusalOf(staticScene("", stage)), {"the scene has none", "stages.0"});
}

#if WITH_EXPRESSIONS
/// The limit of a shallow arch and its least load behind it (Fung & Kaplan 1952), less what the pins give way.
TEST(SceneArcLength, LeadsAnArchThroughItsSnap) {
  const Scene scene = readScene(std::filesystem::path(SCENES) / "arch.json");
  Built whole = started(scene);
  const std::size_t crown = nodeAt(whole, {0.5, 0, 0.03});
  double limit = 0.0, least = 1.0, sunk = 0.0;
  bool passed = false;
  for (int k = 0; whole.run->loadFactor(0) < 1.0; ++k) {
    ASSERT_LT(k, 400);
    whole.run->followLoads(k, 20);
    const double factor = whole.run->loadFactor(0);
    passed = passed || factor < limit;
    if (!passed) limit = factor;
    if (passed) least = std::min(least, factor);
    const double u = whole.run->solid(0).nodes().u[crown].z;
    EXPECT_LT(u, sunk);
    sunk = u;
  }
  EXPECT_NEAR(limit, 0.4999, 0.02 * 0.4999);
  EXPECT_NEAR(least, -0.1713, 0.05 * 0.1713);
  EXPECT_NEAR(sunk, -66.41e-3, 0.002 * 66.41e-3);
  EXPECT_LT(std::abs(whole.run->ledger().residual()), 1e-3 * channel(whole, "arch: elements"));
  // In the middle of the snap, from a state.
  Built first = started(scene), rest = started(scene);
  for (int k = 0; k < 60; ++k) first.run->followLoads(k, 20);
  EXPECT_LT(first.run->loadFactor(0), 0.45);
  rest.run->load(first.run->save());
  for (int k = 60; k < 70; ++k) first.run->followLoads(k, 20), rest.run->followLoads(k, 20);
  EXPECT_TRUE(first.run->save() == rest.run->save());
}

/// σ_y + (C/γ) (1 − exp(−γ ε_p)), in 400 implicit steps.
TEST(SceneMaterials, RecoveryLetsTheBackStressSaturate) {
  std::string keys = bar("\"formulation\": \"enhanced\"", R"--({"on": "x-", "components": ["x"]},
        {"on": "y-", "components": ["y"]}, {"on": "z-", "components": ["z"]},
        {"on": "z+", "components": ["z"], "displacement": [0, 0, "0.02*t"]})--");
  const std::string elastic = R"("law": "St-Venant-Kirchhoff", "youngs_modulus": 1e6)";
  keys.replace(
      keys.find(elastic), elastic.size(),
      R"("law": "J2", "youngs_modulus": 1e9, "yield_stress": 1e6, "kinematic_modulus": 1e9, "recovery": 1000)");
  Built built = loaded(staticScene(keys, R"({"do": "statics", "load_steps": 400, "time": 1})"));
  double force = 0.0;
  const coupling::Reactions reactions = built.run->reactions(0);
  for (const int n : built.meshes[0].nodeSets.at("z+")) force += reactions.supports[static_cast<std::size_t>(n)].z;
  double stress = 2e6;  // the fixed point of σ = σ_y + (C/γ) (1 − exp(−γ (ε − σ/E)))
  for (int k = 0; k < 100; ++k) stress = 1e6 + 1e6 * (1.0 - std::exp(-1000.0 * (std::log(1.005) - stress / 1e9)));
  EXPECT_NEAR(force / stress, 1.0, 0.01);
  EXPECT_LT(force, 0.98 * (1e6 + 1e9 * 2e-3));  // that of linear hardening
}

/// A plane that pushes a bar and slides along it: Coulomb's law, and the pressure of the springs in series.
TEST(ScenePlanes, MoveAndRub) {
  const std::string plane = R"--("planes": [{"on": "z-", "point": [0, 0, 0], "normal": [0, 0, 1], "stiffness": 1e8,
      "friction": 0.01, "displacement": ["0.05*t", 0, "1e-3*t"]}])--";
  Built built = loaded(staticScene(bar(plane, R"({"on": "z+"})"), R"({"do": "statics", "time": 1})"));
  Vec3 force;
  for (const Vec3& f : built.run->reactions(0).supports) force += f;
  EXPECT_NEAR(force.z, -1e-3 / (4.0 / 1e6 + 1.0 / 1e8), 1e-3 * 250.0);
  EXPECT_NEAR(force.x / force.z, 0.01, 1e-6);
  EXPECT_NEAR(force.y, 0.0, 1e-6);
  EXPECT_GT(channel(built, "bar: dissipated in load steps"), 0.9 * 2.5 * 0.05 / 2.0);
  EXPECT_LT(std::abs(built.run->ledger().residual()), 2e-2 * channel(built, "bar: dissipated in load steps"));
}

/// σ_y + C ε_p on the way up; on the way back it yields after twice σ_y, where isotropic hardening would not yet.
TEST(SceneMaterials, KinematicHardeningAndYieldCurves) {
  const auto stressAt = [](double time, const std::string& hardening) {
    std::string keys = bar("\"formulation\": \"enhanced\"", R"--({"on": "x-", "components": ["x"]},
        {"on": "y-", "components": ["y"]}, {"on": "z-", "components": ["z"]},
        {"on": "z+", "components": ["z"], "displacement": [0, 0, "0.02*(t < 1 ? t : 2 - t)"]})--");
    const std::string elastic = R"("law": "St-Venant-Kirchhoff", "youngs_modulus": 1e6)";
    keys.replace(keys.find(elastic), elastic.size(),
                 R"("law": "J2", "youngs_modulus": 1e9, "yield_stress": 1e6, )" + hardening);
    Built built =
        loaded(staticScene(keys, R"({"do": "statics", "load_steps": 20, "time": )" + std::to_string(time) + "}"));
    double force = 0.0;
    const coupling::Reactions reactions = built.run->reactions(0);
    for (const int n : built.meshes[0].nodeSets.at("z+")) force += reactions.supports[static_cast<std::size_t>(n)].z;
    return force;
  };
  const std::string kinematic = R"("kinematic_modulus": 1e8)", isotropic = R"("hardening": 1e8)",
                    curve = R"("hardening_curve": [{"plastic_strain": 2e-3, "yield_stress": 1.2e6},
                                                   {"plastic_strain": 1, "yield_stress": 1.2e6}])";
  EXPECT_NEAR(stressAt(1.0, kinematic) / 1.3636e6, 1.0, 0.01);
  EXPECT_NEAR(stressAt(1.0, isotropic) / 1.3636e6, 1.0, 0.01);
  EXPECT_NEAR(stressAt(2.0, kinematic) / -0.909e6, 1.0, 0.01);
  // From 1.3636 MPa by 2.7273e-3 to −1.3636 MPa, then by 2.2727e-3 along the tangent.
  EXPECT_NEAR(stressAt(2.0, isotropic) / -1.5702e6, 1.0, 0.01);
  EXPECT_NEAR(stressAt(1.0, curve) / 1.2e6, 1.0, 0.01);
  expectParts(refusalOf(staticScene(
                  [&] {
                    std::string keys = bar(pulled);
                    const std::string law = R"("law": "St-Venant-Kirchhoff")";
                    return keys.replace(keys.find(law), law.size(),
                                        R"("law": "J2", "yield_stress": 1, )" + isotropic + ", " + curve);
                  }(),
                  R"({"do": "statics"})")),
              {"both hardening and a hardening_curve"});
}

/// Hydrostatic pressure on one side: the force is half of ρ g h² per width, a third up.
TEST(SceneLoads, MayDependOnThePlace) {
  for (const char* const follows : {"true", "false"}) {
    const std::string pressure = R"--("loads": [{"on": "x-", "type": "pressure", "pressure": "1e-3*(4 - z)")--";
    Built built = loaded(
        staticScene(bar(pressure + ", \"follows\": " + follows + "}]"), R"({"do": "statics", "load_steps": 1})"));
    Vec3 force, moment;
    const coupling::Reactions reactions = built.run->reactions(0);
    for (std::size_t n = 0; n < reactions.supports.size(); ++n) {
      force += reactions.supports[n];
      moment += cross(built.meshes[0].X[n], reactions.supports[n]);
    }
    EXPECT_NEAR(force.x, -0.5e-3 * 16, 1e-9);
    EXPECT_NEAR(moment.y, -0.5e-3 * 16 * 4 / 3, 1e-7);
  }
  Built built = loaded(staticScene(bar(R"("loads": [{"on": "z+", "type": "traction", "traction": [0, 0, "2*x*y"]}])"),
                                   R"({"do": "statics"})"));
  Vec3 force;
  for (const Vec3& f : built.run->reactions(0).supports) force += f;
  EXPECT_NEAR(force.z, -0.5, 1e-7);
}

TEST(SceneSupports, MayDependOnThePlace) {
  Built built =
      loaded(staticScene(bar("\"gravity\": true", R"({"on": "z-", "displacement": ["1e-4*z*t", "1e-4*x*t", "2e-4*z*t"]},
                                  {"on": "z+", "displacement": ["1e-4*z*t", "1e-4*x*t", "2e-4*z*t"]})"),
                         R"({"do": "statics", "time": 2})"));
  const Vec3 u = displacementAt(built, {1, 0, 4});
  EXPECT_NEAR(u.x, 8e-4, 1e-15);
  EXPECT_NEAR(u.y, 2e-4, 1e-15);
  EXPECT_NEAR(u.z, 16e-4, 1e-15);
  expectParts(
      refusalOfRun(R"("let": {"y": 2},)" + bar("\"gravity\": true", R"({"on": "z-", "displacement": ["y*t", 0, 0]})")),
      {"both a coordinate and a parameter", "another name"});
  expectParts(refusalOfRun(bar("\"gravity\": true", R"({"on": "z-", "velocity": ["y*t", 0, 0]})")), {"velocity"});
}

/// As a rigid body, whatever the angle, from wherever a support stands.
TEST(SceneSupports, TurnNodesAboutAnAxis) {
  const std::string turn = R"("turn": {"axis": [0, 0, 2], "angle": "pi/3*t"}, "point": [0.5, 0.5, 0])";
  Built built =
      loaded(staticScene(bar("\"gravity\": true", R"({"on": "z-", )" + turn + R"(}, {"on": "z+", )" + turn + "}"),
                         R"({"do": "statics", "time": 1})"));
  for (const Vec3 at : {Vec3{1, 0, 0}, Vec3{1, 1, 2}}) {
    const Vec3 r = at - Vec3{0.5, 0.5, at.z}, now = at + displacementAt(built, at) - Vec3{0.5, 0.5, at.z};
    EXPECT_NEAR(now.x, 0.5 * r.x - std::sqrt(0.75) * r.y, 1e-8);
    EXPECT_NEAR(now.y, std::sqrt(0.75) * r.x + 0.5 * r.y, 1e-8);
    EXPECT_NEAR(now.z, 0.0, 1e-8);
  }
  expectParts(refusalOfRun(bar("\"gravity\": true", R"({"on": "z-", "turn": {"axis": [0, 0, 1], "angle": "t"}})")),
              {"no point on its axis"});
  expectParts(refusalOfRun(bar("\"gravity\": true", R"({"on": "z-"}, {"on": "x-", )" + turn + "}")),
              {"turned by pi/3*t", "supports item 0"});
}
#endif

}  // namespace
}  // namespace dovetail::scene::test
