// A steel strip, clamped at one end, sags under its weight and a load at the other: a first static computation.
#include <cmath>
#include <cstdio>
#include <iostream>

#include "common/options.hpp"
#include "dovetail/fem/elements/material_point.hpp"
#include "dovetail/fem/laws/point_laws.hpp"
#include "dovetail/fem/mesh/mesh_places.hpp"
#include "dovetail/fem/solve/statics.hpp"
#include "dovetail/fem/terms/loads.hpp"

namespace {

using namespace dovetail;
using namespace dovetail::fem;

constexpr double length = 1.0, width = 0.05, height = 0.05;                    // m
constexpr double young = 210e9, poisson = 0.3, density = 7850.0;               // Pa, 1, kg/m³
constexpr double gravityConstant = 9.81, load = 1000.0;                        // m/s², N
constexpr double stiffness = young * width * height * height * height / 12.0;  // of bending, N m²
constexpr double weight = density * gravityConstant * width * height;          // per length, N/m

/// Timoshenko's beam with shear factor 5/6.
double sagOfABeam() {
  const double shear = 5.0 / 6.0 * young / (2.0 * (1.0 + poisson)) * width * height;
  return weight * std::pow(length, 4) / (8.0 * stiffness) + load * std::pow(length, 3) / (3.0 * stiffness) +
         0.5 * weight * length * length / shear + load * length / shear;
}
/// Along the beam, on its upper side at half its length.
double stressOfABeam() {
  const double moment = weight * 0.5 * length * 0.25 * length + load * 0.5 * length;
  return moment * 0.5 * height / (stiffness / young);
}

bool expectNear(const char* what, double found, double expected, double tolerance, const char* unit) {
  const double error = std::abs(found / expected - 1.0);
  std::printf("%s: %.4f %s, beam theory %.4f %s, tolerance %.0f %%: %s\n", what, found, unit, expected, unit,
              100.0 * tolerance, error < tolerance ? "ok" : "OFF");
  return error < tolerance;
}

bool bend(const example::Options& options) {
  // 1. A mesh. (readSolid of dovetail::solid_io takes one from Gmsh or Abaqus.)
  // An odd number of cells along: half the length is the middle of one, where its stresses are best.
  const std::array<int, 3> cells = options.quick ? std::array{41, 2, 2} : std::array{61, 3, 4};
  const SolidMesh mesh = boxOf(ElementShape::hex8, cells, {0, 0, 0}, {length, width, height});
  Model model = makeModel(mesh);

  // 2. What acts: elements of a material, their weight, a load at the end; both grow over one unit of time. Bricks that
  // bend want Formulation::enhanced.
  const auto steel = pointMaterial(StVenantKirchhoff{young, poisson, density});
  const auto solid = makeSolid(mesh, steel, {.formulation = Formulation::enhanced, .name = "strip"});
  model.add(solid);
  model.add(gravity([](double t) { return Vec3{0, 0, -gravityConstant * t}; }));
  const std::vector<Face> end = facesWhere(mesh, [](const Vec3& X) { return X.x > length - 1e-9; });
  model.add(deadTraction(mesh, end, {0, 0, -load / (width * height)}, ramp(1.0, 1.0), "load"));
  addMass(model);  // without masses there is no weight

  // 3. What is held.
  model.constraints.hold(nodesWhere(mesh, [](const Vec3& X) { return X.x < 1e-9; }));

  // 4. The equilibria from t = 0, without any load, to all of it at t = 1.
  const MaterialPoint tip(mesh, {length, 0.5 * width, 0.5 * height}), middle(mesh, {0.5 * length, 0.5 * width, height});
  std::printf("     t   iterations   sag, mm\n");
  const StaticReport report =
      solveStatics(model, 1.0, {.firstStep = 0.25}, [&](const Model& now, const StaticStep& step) {
        std::printf("%6.3f %12d %9.4f\n", step.t, step.iterations, -1e3 * tip.valueOf(now.nodes.u).z);
        return true;
      });
  std::cout << '\n' << report;

  // 5. Values at points.
  const auto stress = middle.stress(solid->sample(model.nodes, {model.t, 0.0}));
  const double sag = -1e3 * tip.valueOf(model.nodes.u).z;
  const bool sagIsRight = expectNear("sag", sag, 1e3 * sagOfABeam(), 0.01, "mm");
  return expectNear("stress at half the length", 1e-6 * stress[0], 1e-6 * stressOfABeam(), 0.01, "MPa") && sagIsRight;
}

}  // namespace

int main(int argc, char** argv) {
  return example::runExample(argc, argv, "strip", "a steel strip sags under its weight and a load (statics)", bend,
                             example::Files::none);
}
