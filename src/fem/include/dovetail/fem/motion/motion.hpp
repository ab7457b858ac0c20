// The verbs of a time step of a model: what the explicit integrator is written with, and who couples a solid with
// something else.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "dovetail/fem/model/model.hpp"
#include "dovetail/fem/model/model_mass.hpp"

namespace dovetail::fem {

/// A velocity Verlet step is
///
///     kick(dt/2) · drift(dt) · forces(dt, withEnergy, true) · kick(dt/2) · commit(dt)
///
/// with whatever else acts on the nodes added to model.nodes.f after forces(), or kicked on its own. The state is the
/// model's; here are caches only. Terms and constraints are read when it is made.
class Motion {
public:
  /// @param massFraction  of the consistent mass
  /// @throws InputError for a node without mass, a fraction outside 0 … 1 or constraints at odds
  explicit Motion(Model& model, double massFraction = 0.0);
  ~Motion();
  Motion(Motion&&) noexcept;

  Model& model() const;
  const DofMap& dofs() const;
  const ModelMass& mass() const;

  /// nodes.f = Σ forces of the terms at u, v, t. @param dt  length of the step that ends here, s
  /// @param willCommit  whether commit(dt) follows with nothing asked for in between: some materials are then spared a
  ///                    copy of their state
  /// @return their stored energy, J, if `withEnergy`, else 0
  double forces(double dt, bool withEnergy = false, bool willCommit = false);
  /// Of the last forces(), by terms: energy, J (if asked for), and force, N, of all but elements that store an energy;
  /// empty for these.
  std::span<const double> energies() const;
  std::span<const std::vector<Vec3>> loads() const;
  /// What loads() was when a state was saved.
  void setLoads(std::vector<std::vector<Vec3>> loads);

  /// f ← M⁻¹ f: accelerations, m/s², 0 at components that are not free.
  void accelerate(std::span<Vec3> f) const { mass().solve(f); }
  /// v += dt M⁻¹ nodes.f. Components that are not free keep their velocity.
  /// @return false if a velocity is not finite any more
  bool kick(double dt);
  /// v += dt a on all components: accelerations of other forces than nodes.f.
  bool kick(std::span<const Vec3> a, double dt);
  /// u += v dt, t += dt, and prescribed and tied components at their new place.
  void drift(double dt);
  /// The materials accept the step of length dt that ends here. @return energy dissipated in it, J
  double commit(double dt);

  /// Nodes have become others (Term::renewNodes): masses and constraints are read again.
  void renew();

  /// ½ vᵀMv, J.
  double kineticEnergy() const;

private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace dovetail::fem
