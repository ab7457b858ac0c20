// A motion of the nodes to rest, without any matrix.
#pragma once

#include <functional>
#include <vector>

#include "dovetail/fem/model/model_mass.hpp"
#include "equilibrium.hpp"

namespace dovetail::fem::detail {

/// The nodes relax in a motion of their own with the lumped masses in nodes.mass, damped critically for the
/// frequency ω² = uᵀΔf/uᵀMu that the displacement u since the whole load acts and the force Δf that it cost show, or
/// for the last that was real. Terms see model time.
class DynamicRelaxation {
public:
  /// @param step  of the motion, s; 0 = nine tenths of stableStep(model) at the start of each
  /// @throws InputError for nodes without mass
  DynamicRelaxation(Balance& balance, double step);

  /// Called at every state of the motion, whose forces are those of the balance.
  using Visitor = std::function<void()>;
  /// From rest to rest at the instant.
  /// @param comesOn  prescribed motion and loads come on over the first iterations @param visitor  histories go along:
  ///   it accepts them, and instants begin at the state before
  NewtonResult relax(const Instant& end, bool comesOn, int maxIterations, const Visitor& visitor = {});

  /// Of the half step before the present state, J.
  double kineticEnergy() const { return mass_.kineticEnergy(velocity_); }

private:
  Instant instantOf(const Instant& end, bool comesOn, int iteration, bool remembers) const;
  void findFrequency(std::span<const Vec3> f0);
  void oscillate(double omega);

  Balance& balance_;
  ModelMass mass_;
  double step_, h_, omega_ = 0.0;
  std::vector<Vec3> velocity_, acceleration_, momentum_, reference_;
};

/// Motion to rest with histories that go along, from the last equilibrium of a step that Newton's method could not
/// make; if it does not come to rest, model and report are as before. Balanced to the tolerance of the balance.
NewtonResult moveToRest(Balance& balance, DynamicRelaxation& relaxation, const Instant& end, int maxIterations,
                        int maxAugmentations, StaticReport& report);

}  // namespace dovetail::fem::detail
