// Solids with the energy of the gradient of F, beside all that they can meet.
#include "../threads.hpp"
#include "build/changes.hpp"
#include "dovetail/coupling/rest.hpp"
#include "dovetail/scene/read.hpp"
#include "loaded_bars.hpp"
#include "warning_parts.hpp"

namespace dovetail::scene::test {
namespace {

/// A block of 4 × 4 × 4 bricks of soil on a floor.
std::string soil(const std::string& keys, const std::string& cell = "hex8") {
  return R"("solids": [{"name": "soil", "mesh": "box", "cell": ")" + cell +
         R"(", "cells": [4, 4, 4], "box": [[0, 0, 0], [0.4, 0.4, 0.4]], "gravity": false,
      "material": {"law": "Drucker-Prager", "youngs_modulus": 1e6, "poisson_ratio": 0.3, "density": 2000,
                   "cohesion": 1000, "cohesion_curve": [{"plastic_strain": 0.2, "cohesion": 500}],
                   "friction_angle": 0.3}, "supports": [{"on": "z-"}], )" +
         keys + "}],";
}
/// The same in plane strain.
std::string sheet(const std::string& keys, const std::string& cell = "quad8") {
  return R"("solids": [{"name": "soil", "mesh": "box", "cell": ")" + cell +
         R"(", "cells": [4, 8, 1], "box": [[0, 0, 0], [1, 2, 1]],
      "material": {"law": "Drucker-Prager", "youngs_modulus": 50e6, "poisson_ratio": 0.3, "density": 2000,
                   "cohesion": 50e3, "cohesion_curve": [{"plastic_strain": 0.25, "cohesion": 20e3}],
                   "friction_angle": 0.3}, )" +
         keys + "}],";
}
/// The same of material points, from its border up.
std::string pointsOf(const std::string& keys) {
  return R"("solids": [{"name": "soil", "mesh": "points", "points": {"from": "box", "box": [[0, 0, 0], [1, 2, 1]]},
      "grid": {"spacing": 0.25, "plane_strain": true, "borders": [{"side": "y-", "at": 0}]},
      "material": {"law": "Drucker-Prager", "youngs_modulus": 50e6, "poisson_ratio": 0.3, "density": 2000,
                   "cohesion": 50e3, "cohesion_curve": [{"plastic_strain": 0.25, "cohesion": 20e3}],
                   "friction_angle": 0.3}, )" +
         keys + "}],";
}
const std::string gradient = R"("gradient": {"modulus": "100 N"})";
const std::string reduced = R"("formulation": "reduced", )" + gradient;
const std::string plate = R"("planes": [{"on": "y+", "point": [0, 2, 0], "normal": [0, -1, 0],
    "velocity": [0, -1, 0], "friction": 0.5}])";
const std::string pressed = R"("supports": [{"on": "y-"}, {"on": "y+", "displacement": [0, "-0.1*t", 0]}])";

TEST(SolidGradient, StoresItsEnergyInAChannelOfItsOwn) {
  Built built = started(sceneOf(sheet(reduced + ", " + pressed)));
  built.run->advance(100);
  EXPECT_GT(channel(built, "soil: gradient of F"), 0.0);
  EXPECT_LT(std::abs(built.run->ledger().residual()), 1e-3 * std::abs(channel(built, "soil: supports")));
  Built ofPoints = started(sceneOf(pointsOf(gradient + ", " + plate)));
  ofPoints.run->advance(400);
  EXPECT_GT(channel(ofPoints, "soil: gradient of F"), 0.0);
  EXPECT_LT(std::abs(ofPoints.run->ledger().residual()), 1e-3 * channel(ofPoints, "soil: points"));
}

TEST(SolidGradient, IsRefusedWhereThereIsNone) {
  for (const char* const cell : {"hex20", "hex27", "tet4", "tet10"})
    expectParts(refusalOf(sceneOf(soil(gradient, cell))), {"no energy of gradients", cell, "solids.0"});
  expectParts(refusalOf(sceneOf(sheet(gradient + ", " + pressed))), {"2 x 2", "\"formulation\": \"reduced\""});
  EXPECT_EQ(refusalOf(sceneOf(sheet(gradient + ", " + pressed, "quad4"))), "");
  for (const char* const modulus : {"0", "-1", "\"1 kPa\""})
    expectParts(
        refusal("{" + law + sheet(R"("gradient": {"modulus": )" + std::string(modulus) + "}, " + pressed) + end + "}"),
        {"modulus"});
}

TEST(SolidGradient, SoftensByItsCohesionCurve) {
  expectParts(refusalOf(sceneOf(R"("solids": [{"name": "soil", "mesh": "box", "cells": [1, 1, 1],
      "box": [[0, 0, 0], [1, 1, 1]], "material": {"law": "Drucker-Prager", "youngs_modulus": 1e6, "poisson_ratio": 0.3,
      "density": 2000, "cohesion": 1e5, "cohesion_curve": [{"plastic_strain": 1e-3, "cohesion": 10}],
      "friction_angle": 0.3}}],)")),
              {"falls faster", "solids.0"});
}

/// Grains fall onto it, an overlap shares it with others; on one thread and two, and gone on with, all digits are the
/// same.
std::vector<Vec3> placesAfter(const std::string& middle, bool goesOn) {
  Built built = started(sceneOf(middle));
  built.run->advance(60);
  if (goesOn) {
    const std::vector<char> state = built.run->save();
    built = started(sceneOf(middle));
    built.run->load(state);
  }
  built.run->advance(60);
  std::vector<Vec3> places = built.run->solid(0).nodes().u;
  places.insert(places.end(), built.run->grains.particles.x.begin(), built.run->grains.particles.x.end());
  return places;
}

const std::string ball = R"("particles": [{"from": "list", "density": 2500,
    "spheres": [{"at": [0.21, 0.2, 0.4495], "radius": 0.05, "velocity": [0, 0, -2]}]}],)";
const std::string onSkin = R"("couplings": [{"type": "surface", "solid": "soil", "kernel": 0.1}],)";
const std::string layerOfGrains = R"("particles": [{"from": "lattice", "box": [[0.01, 0.01, 0.21], [0.39, 0.39, 0.7]],
    "radius": 0.02, "density": 2500}], "couplings": [{"type": "overlap", "solid": "soil", "solid_border": 0.4,
    "particle_border": 0.2}],)";

TEST(SolidGradient, HasTheSameDigitsForAnyThreadsAndAfterARestart) {
  for (const std::string& middle : {soil(gradient) + ball + onSkin, soil(gradient) + layerOfGrains,
                                    soil(gradient + R"(, "planes": [{"on": "z+", "point": [0, 0, 0.4],
                                       "normal": [0, 0, -1], "velocity": [0, 0, -1]}])"),
                                    sheet(reduced + ", " + pressed), pointsOf(gradient + ", " + plate)}) {
    const std::vector<Vec3> one = onThreads(1, [&] { return placesAfter(middle, false); });
    EXPECT_GT(norm(one.front() - one.back()), 0.0);
    EXPECT_TRUE(placesAfter(middle, true) == one);
    EXPECT_TRUE(onThreads(2, [&] { return placesAfter(middle, false); }) == one);
  }
}

TEST(SolidGradient, StepsImplicitlyInMacroSteps) {
  const std::string implicit = R"(, "stepping": "implicit", )";
  Built built = started(sceneFromText("{" + law + sheet(reduced + implicit + pressed) +
                                          R"("steps": {"dt": 1e-4, "per_macro_step": 5},
                                             "stages": [{"do": "run", "time": 1}]})",
                                      "s.json", "/"));
  built.run->advance(200);
  EXPECT_GT(channel(built, "soil: gradient of F"), 0.0);
}

TEST(SolidGradient, IsLoadedInStepsAndAlongItsPath) {
  const std::string loads = R"(, "supports": [{"on": "y-"}], "loads": [{"on": "y+", "type": "traction",
      "traction": [0, "-20 kPa", 0]}])";
  Built ofPoints = loaded(staticScene(pointsOf(gradient + R"(, "loads": [{"on": "y+", "type": "traction",
      "traction": ["5 kPa", "-20 kPa", 0]}], "planes": [{"on": "x+", "point": [1, 0, 0], "normal": [-1, 0, 0]}])"),
                                      R"({"do": "statics", "load_steps": 3})"));
  EXPECT_GT(channel(ofPoints, "soil: gradient of F"), 0.0);
  for (const char* const stage :
       {R"({"do": "statics", "load_steps": 3})", R"({"do": "statics", "load_steps": 3, "control": "arc-length"})"}) {
    Built built = started(staticScene(sheet(reduced + loads), stage));
    EXPECT_NO_THROW(built.run->loadStep(0, 3, 0.0)) << stage;
    EXPECT_GT(channel(built, "soil: gradient of F"), 0.0);
  }
}

TEST(SolidGradient, CountsAsElasticOnTheWayToRest) {
  Built built = started(sceneOf(sheet(R"("formulation": "reduced", "gradient": {"modulus": "1 MN"},
      "supports": [{"on": "y-"}], "loads": [{"on": "y+", "type": "traction", "traction": [0, "-20 kPa", 0]}])")));
  const RestReport report = coupling::relax(*built.run, {.tolerance = 1e-9, .steps = 20});
  const double elements = channel(built, "soil: elements"), inGradient = channel(built, "soil: gradient of F");
  EXPECT_GT(inGradient, 0.1 * elements);
  EXPECT_NEAR(report.residual, built.run->kineticEnergy() / (elements + inGradient), 1e-9 * report.residual);
}

TEST(SolidGradient, SetsTheStepAndIsNamedForIt) {
  const std::string stiff = R"("formulation": "reduced", "gradient": {"modulus": 1e12}, )";
  expectParts(refusalOfRun(sheet(stiff + pressed)), {"gradient of F", "soil"});
  expectParts(refusalOfRun(pointsOf(R"("gradient": {"modulus": 1e12}, )" + plate)), {"gradient of F", "soil"});
}

TEST(SolidGradient, NarrowBandsAndElementsThatLockAreTold) {
  EXPECT_EQ(
      warningsOf(sheet(R"("formulation": "reduced", "gradient": {"modulus": "10 kN"}, )" + pressed)).find("bands"),
      std::string::npos);
  expectParts(warningsOf(sheet(reduced + ", " + pressed)), {"gets bands about", "of its elements", "gradient modulus"});
  expectParts(warningsOf(pointsOf(gradient + ", " + plate)), {"gets bands about", "cells of its grid"});
  expectParts(warningsOf(sheet(gradient + ", " + pressed, "quad4")), {"too stiff in bands", "quad8"});
}

TEST(SolidGradient, EndsAtTiesWhichIsTold) {
  const std::string tied = R"(, "sets": [{"name": "some", "place": "box", "box": [[0.9, 0.9, -1], [1.1, 1.1, 1]]}],
      "ties": [{"nodes": "some", "faces": "x-", "tolerance": 2}], "supports": [{"on": "y-"}])";
  expectParts(warningsOf(sheet(reduced + tied)), {"gradient", "soil", "ends at its ties"});
  EXPECT_EQ(warningsOf(sheet(R"("formulation": "reduced")" + tied)).find("ends at its ties"), std::string::npos);
}

/// Beside elastic and softer parts, as supports take another speed and go.
TEST(SolidGradient, KeepsItsBooksInRegionsAndThroughChanges) {
  const std::string regions = R"(, "sets": [{"name": "top", "place": "box", "box": [[0, 1.5, -1], [1, 2, 1]]},
      {"name": "spot", "place": "box", "box": [[0, 0.25, -1], [0.5, 0.75, 1]]}],
      "regions": [{"elements": "top", "material": {"law": "neo-Hookean", "youngs_modulus": 1e8, "poisson_ratio": 0.2,
                   "density": 2500}},
                  {"elements": "spot", "material": {"law": "Drucker-Prager", "youngs_modulus": 50e6,
                   "poisson_ratio": 0.3, "density": 2000, "cohesion": 40e3, "cohesion_curve":
                   [{"plastic_strain": 0.2, "cohesion": 20e3}], "friction_angle": 0.3}}],
      "supports": [{"on": "y-"}, {"on": "y+", "velocity": [0, -1, 0]}])";
  const auto stage = [](const std::string& change) {
    return R"({"do": "run", "time": 1, "changes": {"supports": [{"solid": "soil", "on": "y+", )" + change + "}]}}";
  };
  const std::string stiff = R"("formulation": "reduced", "gradient": {"modulus": "100 kN"})";
  const Scene scene =
      sceneFromText("{" + sheet(stiff + regions) + R"("steps": {"dt": 2e-5}, "stages": [{"do": "run", "time": 1}, )" +
                        stage(R"("velocity": [0.5, -0.5, 0])") + ", " + stage(R"("present": false)") + "]}",
                    "s.json", "/");
  Built built = started(scene);
  double before = 0.0, work = 0.0;
  for (std::size_t k = 0; k < 3; ++k) {
    if (k > 0) beginStage(built, scene, k, startOf(built, scene, k), Grains::areThere);
    EXPECT_NEAR(channel(built, "soil: gradient of F"), before, 1e-12) << "stage " << k;
    built.run->advance(500);
    before = channel(built, "soil: gradient of F");
    work = std::max(work, std::abs(channel(built, "soil: supports")));
    EXPECT_GT(before, 0.0) << "stage " << k;
    EXPECT_LT(std::abs(built.run->ledger().residual()), 1e-3 * work) << "stage " << k << ", gradient " << before;
  }
}

}  // namespace
}  // namespace dovetail::scene::test
