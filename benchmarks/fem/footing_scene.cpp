#include "footing_scene.hpp"

#include <cmath>
#include <functional>
#include <numbers>

#include "dovetail/fem/mesh/mesh_shapes.hpp"
#include "dovetail/fem/solve/statics.hpp"

namespace dovetail::fem {
namespace {

constexpr double closeness = 1e-9, degree = std::numbers::pi / 180.0, thickness = 0.1;

/// Corners of `cells` cells over `length`, each `growth` times as long as the one before.
std::vector<double> graded(int cells, double length, double growth) {
  std::vector<double> corner = {0.0};
  double piece = 1.0;
  for (int i = 0; i < cells; ++i, piece *= growth) corner.push_back(corner.back() + piece);
  for (double& x : corner) x *= length / corner[static_cast<std::size_t>(cells)];
  return corner;
}

/// Straight between corners, so that nodes amid edges stay there.
double between(const std::vector<double>& corner, double index) {
  const auto cell = std::min(static_cast<std::size_t>(index), corner.size() - 2);
  const double fraction = index - static_cast<double>(cell);
  return (1.0 - fraction) * corner[cell] + fraction * corner[cell + 1];
}

/// x from the symmetry plane, y upwards to the surface at 0.
SolidMesh soilBlock(const Footing& f) {
  std::vector<double> x = graded(f.under, Footing::halfWidth, 0.7);
  const double last = x.back() - x[x.size() - 2], space = Footing::side - Footing::halfWidth;
  double growth = 1.0;  // so that the cells on both sides of the edge are equal
  for (int i = 0; i < 200; ++i) {
    double sum = 0.0, piece = last;
    for (int k = 0; k < f.beside; ++k, piece *= growth) sum += piece;
    growth *= std::pow(space / sum, 1.0 / f.beside);
  }
  for (const double d : graded(f.beside, space, growth))
    if (d > 0.0) x.push_back(Footing::halfWidth + d);
  const std::vector<double> y = graded(f.deep, Footing::side, 1.6);
  const double nx = f.under + f.beside, ny = f.deep;
  return mappedBox(f.shape, {f.under + f.beside, f.deep, 1}, {}, {nx, ny, thickness}, [&](const Vec3& X) {
    return Vec3{between(x, X.x), -between(y, ny - X.y), X.z};
  });
}

std::vector<int> nodesWhere(const SolidMesh& mesh, const std::function<bool(const Vec3&)>& condition) {
  std::vector<int> nodes;
  for (std::size_t n = 0; n < mesh.X.size(); ++n)
    if (condition(mesh.X[n])) nodes.push_back(static_cast<int>(n));
  return nodes;
}

}  // namespace

double Footing::prandtlPressure() const {
  if (friction == 0.0) return (2.0 + std::numbers::pi) * cohesion;
  const double tangent = std::tan(friction * degree), slope = std::tan((45.0 + 0.5 * friction) * degree);
  return cohesion / tangent * (std::exp(std::numbers::pi * tangent) * slope * slope - 1.0);
}

FootingResult settle(const Footing& footing) {
  const SolidMesh mesh = soilBlock(footing);
  Model model = makeModel(mesh);
  model.add(
      makeSolid(mesh,
                pointMaterial(DruckerPrager{Footing::young, 0.3, 1.0, Footing::cohesion, footing.friction * degree,
                                            footing.dilatancy * degree, ConeMatch::planeStrain}),
                {.formulation = footing.formulation}));
  model.constraints.hold(
      nodesWhere(mesh, [](const Vec3& X) { return X.x < closeness || X.x > Footing::side - closeness; }), componentX);
  model.constraints.hold(nodesWhere(mesh, [](const Vec3& X) { return X.y < closeness - Footing::side; }), componentY);
  model.constraints.hold(nodesWhere(mesh, [](const Vec3&) { return true; }), componentZ);
  const std::vector<int> loaded =
      nodesWhere(mesh, [](const Vec3& X) { return X.y > -closeness && X.x < Footing::halfWidth + closeness; });
  model.constraints.prescribe(loaded, 1, [](double t) { return -t; });

  FootingResult result{};
  const double step = footing.settlement / footing.steps;
  const StaticReport report =
      solveStatics(model, footing.settlement, {.firstStep = step, .largestStep = step, .smallestStep = 1e-4 * step},
                   [&](const Model&, const StaticStep& done) {
                     evaluateForces(model, {done.t, 0.0});
                     double down = 0.0;
                     for (const int n : loaded) down += model.nodes.f[static_cast<std::size_t>(n)].y;
                     result.settlement.push_back(done.t);
                     result.pressure.push_back(down / (Footing::halfWidth * thickness));
                     return true;
                   });
  result.iterations = report.iterations;
  result.cuts = report.cuts;
  result.seconds = report.seconds;
  return result;
}

}  // namespace dovetail::fem
