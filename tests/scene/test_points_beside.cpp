// Material points in scenes beside what else a scene may say: grains, sub-steps, periods, relaxation, other points.
#include <gtest/gtest.h>

#include <cmath>

#include "dovetail/coupling/rest.hpp"
#include "point_scenes.hpp"

namespace dovetail::scene::test::points {
namespace {

struct Beside {
  const char* name;
  bool cells = false;               ///< of grains, in place of a law
  const char* coupling = "points";  ///< or "surface", by faces
  const char* more = "";            ///< keys of the scene
  const char* steps = R"("dt": 1e-4)";
  const char* solid = "";  ///< keys of the solid
  bool relaxes = false;
  const char* on = "y+";  ///< of the faces
};
void PrintTo(const Beside& one, std::ostream* out) { *out << one.name; }

/// A bed in plane strain that three discs drop on.
Scene bedUnderDiscs(const Beside& c) {
  const bool faces = std::string(c.coupling) == "surface";
  const std::string material =
      c.cells ? R"("material": {"law": "cells", "cells": "sand"})"
              : R"("material": {"law": "neo-Hookean", "youngs_modulus": 1e6, "poisson_ratio": 0.3, "density": 1600})";
  const std::string sand = c.cells ? R"("cells": [{"name": "sand", "grains": "discs", "count": 30, "thickness": 0.1,
                  "radius": {"smallest": 3e-4, "largest": 7e-4}, "density": 2650,
                  "contact": {"law": "linear", "modulus": 1e8, "friction": 0.5},
                  "prepare": [{"pressure": 1000, "friction": 0.1}]}],)"
                                   : "";
  return sceneFromText(
      R"({"gravity": [0, -9.81, 0], "contact": {"law": "linear", "stiffness": 1e5, "restitution": 0.8, "friction": 0.3},
          "particles": [{"from": "list", "density": 2500, "spheres": [
            {"at": [0.1, 0.242, 0], "radius": 0.04, "velocity": [0.3, -1, 0]},
            {"at": [0.2, 0.242, 0], "radius": 0.04, "velocity": [0.3, -1, 0]},
            {"at": [0.3, 0.242, 0], "radius": 0.04, "velocity": [0.3, -1, 0]}]}],)" +
          sand + c.more +
          body(R"("from": "box", "box": [[0, 0, 0], [0.4, 0.2, 0.1]])",
               plane + R"(, "transfer": "apic", "borders": [{"side": "y-", "at": 0, "kind": "held"}])",
               c.solid + material) +
          R"("couplings": [{"type": ")" + c.coupling + R"(", "solid": "snow")" +
          (faces ? std::string(R"(, "on": ")") + c.on + '"' : "") + R"(}], "steps": {)" + c.steps +
          R"(}, "stages": [{"do": ")" + (c.relaxes ? "relax" : "run") +
          (c.relaxes ? R"("}]})" : R"(", "time": 0.03}]})"),
      "s.json", "/");
}

class PointsBeside : public testing::TestWithParam<Beside> {};

/// Energy and momenta close, discs are turned back, and nothing goes through.
TEST_P(PointsBeside, Balance) {
  Built built = started(bedUnderDiscs(GetParam()));
  coupling::CoupledRun& run = *built.run;
  const double moved = run.kineticEnergy();
  if (GetParam().relaxes) coupling::relax(run, {.tolerance = 1e-3, .steps = 200});
  run.advance(std::llround(0.03 / run.macroStep()));
  const coupling::Totals totals = run.totals();
  EXPECT_LE(norm(totals.residual.linear), 1e-11 * totals.turnedOver);
  EXPECT_LE(norm(totals.residual.angular), 1e-11 * totals.turnedOverAngular);
  EXPECT_LE(std::abs(run.ledger().residual()), 1e-3 * moved);
  EXPECT_LT(run.kineticEnergy(), 0.999 * moved);
  const dem::Particles& particles = run.grains.particles;
  for (std::size_t i = 0; i < particles.size(); ++i)
    if (!particles.isOfSolid(i)) {
      EXPECT_GT(particles.x[i].y, 0.2);
    }
}

constexpr const char* inFours = R"("dt": 2.5e-5, "per_macro_step": 4)";
/// A plane comes down on one part of the faces, discs on the other.
constexpr const char* inParts =
    R"("sets": [{"name": "pressed", "place": "box", "box": [[-1, 0.19, -1], [0.05, 0.21, 1]]},
                                            {"name": "hit", "place": "box", "box": [[0.05, 0.19, -1], [1, 0.21, 1]]}],
      "planes": [{"on": "pressed", "point": [0, 0.2, 0], "normal": [0, -1, 0], "velocity": [0, -0.05, 0],
                  "friction": 0.5}], )";
constexpr const char* wide = R"("gradient": {"modulus": 20}, )";
constexpr const char* periods = R"("periodic": {"box": [[-0.3, -0.1, -0.05], [0.7, 1, 0.05]], "axes": ["x"]},)";
INSTANTIATE_TEST_SUITE_P(
    Scenes, PointsBeside,
    testing::Values(Beside{"FacesInFours", false, "surface", "", inFours},
                    Beside{"FacesImplicitInFours", false, "surface", "", inFours, R"("stepping": "implicit", )"},
                    Beside{"FacesInPeriods", false, "surface", periods},
                    Beside{"FacesInParts", false, "surface", "", R"("dt": 1e-4)", inParts, false, "hit"},
                    Beside{"CellsWithFacesInParts", true, "surface", "", R"("dt": 1e-4)", inParts, false, "hit"},
                    Beside{"FacesWithGradient", false, "surface", "", inFours, wide},
                    Beside{"FacesImplicitWithGradient", false, "surface", "", inFours,
                           R"("gradient": {"modulus": 20}, "stepping": "implicit", )"},
                    Beside{"Gradient", false, "points", "", R"("dt": 1e-4)", wide},
                    Beside{"GradientInPeriods", false, "points", periods, R"("dt": 1e-4)", wide},
                    Beside{"CellsWithGradient", true, "points", "", R"("dt": 1e-4)", wide},
                    Beside{"FacesRelax", false, "surface", "", R"("dt": 1e-4)", "", true}, Beside{"Cells", true},
                    Beside{"CellsWithFaces", true, "surface"}, Beside{"CellsInFours", true, "points", "", inFours},
                    Beside{"CellsInPeriods", true, "points", periods},
                    Beside{"CellsRelax", true, "points", "", R"("dt": 1e-4)", "", true}),
    [](const auto& one) { return std::string(one.param.name); });

}  // namespace
}  // namespace dovetail::scene::test::points
