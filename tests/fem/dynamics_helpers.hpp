// Oscillators and small bodies for the tests of integrators.
#pragma once

#include "dovetail/fem/model/model_mass.hpp"
#include "dovetail/fem/motion/dynamics.hpp"
#include "dovetail/fem/terms/loads.hpp"
#include "solid_helpers.hpp"

namespace dovetail::fem {

/// A mass for every node.
class PointMasses : public Term {
public:
  explicit PointMasses(double mass) : mass_(mass) {}
  std::string name() const override { return "masses"; }
  void addForces(const Nodes&, const Instant&, std::span<Vec3>) override {}
  void addMass(std::span<double> mass) const override {
    for (double& m : mass) m += mass_;
  }
  void addConsistentMass(linalg::NodeMatrix& M) const override {
    for (int n = 0; n < static_cast<int>(M.nodes()); ++n) M.add(std::array{n}, std::array{mass_});
  }

private:
  double mass_;
};

/// One node of mass 2 kg on springs of ω = 3, 4 and 5 rad/s.
inline Model oscillator() {
  SolidMesh point;
  point.X = {{0.1, 0.2, 0.3}};
  Model model = makeModel(point);
  model.add(std::make_shared<PointMasses>(2.0));
  model.add(groundSprings(std::array{0}, {18.0, 32.0, 50.0}));
  addMass(model);
  model.nodes.u[0] = {0.1, -0.2, 0.3};
  model.nodes.v[0] = {0.4, 0.3, -0.2};
  return model;
}

/// A block of neo-Hookean bricks, E about 2.6 MPa, 1000 kg/m³.
inline SolidMesh smallMesh(ElementShape shape = ElementShape::hex8) {
  return boxOf(shape, {3, 1, 1}, {}, {0.3, 0.1, 0.1});
}
inline Model smallBody(const SolidMesh& mesh, Formulation formulation = Formulation::standard) {
  Model model = makeModel(mesh);
  model.add(makeSolid(mesh, std::make_shared<PlainNeoHookean>(1e6, 1e6), {.formulation = formulation}));
  addMass(model);
  return model;
}
/// Time for a pressure wave to cross a brick of smallMesh, about the largest explicit step.
inline constexpr double crossing = 0.1 / 54.8;

inline double largestDifference(const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
  double most = 0.0;
  for (std::size_t n = 0; n < a.size(); ++n) most = std::max(most, norm(a[n] - b[n]));
  return most;
}

}  // namespace dovetail::fem
