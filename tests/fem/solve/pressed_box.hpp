// A box that multigrid solves, and its comparison with others.
#pragma once

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "dovetail/fem/elements/solid.hpp"
#include "dovetail/fem/laws/point_laws.hpp"
#include "dovetail/fem/model/model.hpp"
#include "dovetail/fem/solve/statics.hpp"

namespace dovetail::fem {

inline constexpr linalg::LinearMethod byMultigrid = linalg::LinearMethod::multigrid;

inline std::vector<int> nodesAt(const SolidMesh& mesh, int component, double value) {
  std::vector<int> found;
  for (std::size_t n = 0; n < mesh.X.size(); ++n)
    if (std::abs(mesh.X[n][component] - value) < 1e-9) found.push_back(static_cast<int>(n));
  return found;
}

/// A box of n³ cells, 1 m wide, far from the origin, held below and pressed and sheared above.
inline Model pressed(int n, const std::shared_ptr<const PointMaterial>& material,
                     ElementShape shape = ElementShape::hex8, Formulation formulation = Formulation::standard,
                     bool onRanks = false) {
  const Vec3 corner{10.0, -20.0, 5.0};
  const SolidMesh mesh = boxOf(shape, {n, n, n}, corner, corner + Vec3{1.0, 1.0, 1.0});
  Model model = makeModel(mesh);
  model.add(makeSolid(mesh, material, {.formulation = formulation, .onRanks = onRanks}));
  model.constraints.hold(nodesAt(mesh, 2, corner.z));
  model.constraints.prescribe(nodesAt(mesh, 2, corner.z + 1.0), 2, [](double t) { return -0.05 * t; });
  model.constraints.prescribe(nodesAt(mesh, 2, corner.z + 1.0), 0, [](double t) { return 0.03 * t; });
  return model;
}

inline double apart(const Model& a, const Model& b) {
  double difference = 0.0, size = 0.0;
  for (std::size_t n = 0; n < a.nodes.u.size(); ++n) {
    difference = std::max(difference, norm(a.nodes.u[n] - b.nodes.u[n]));
    size = std::max(size, norm(a.nodes.u[n]));
  }
  return difference / size;
}

inline StaticReport solve(Model& model, linalg::LinearMethod method) {
  return solveStatics(model, 1.0, {.newton = {.linear = {.method = method}}, .firstStep = 0.25, .largestStep = 0.25});
}

}  // namespace dovetail::fem
