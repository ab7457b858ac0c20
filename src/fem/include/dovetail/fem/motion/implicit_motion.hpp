// Implicit steps of a model, without a ledger: for who couples a solid with something else.
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "dovetail/core/profile.hpp"
#include "dovetail/fem/model/model.hpp"
#include "dovetail/fem/model/model_mass.hpp"
#include "dovetail/fem/motion/dynamics.hpp"

namespace dovetail::fem {

/// Steps of an implicit scheme between instants at which other forces kick the nodes. For Newmark's average
/// acceleration (β = ¼, γ = ½), kick by f dt/2 · step(dt) · kick by f dt/2 is a step under the constant load f:
/// u₁ − u₀ = ½dt (v₀ + v₁) and M (v₁ − v₀) = dt f + ½dt (f₀ + f₁) hold term by term.
class ImplicitMotion {
public:
  /// The model must outlive it; terms and constraints are read here. `energyEvery` is of no meaning.
  /// @throws InputError for options out of range or nodes without mass
  explicit ImplicitMotion(Model& model, const ImplicitOptions& options = {});
  ~ImplicitMotion();
  ImplicitMotion(ImplicitMotion&&) noexcept;

  Model& model() const;
  const ModelMass& mass() const;
  const DofMap& dofs() const;

  /// Advances model.nodes and model.t by dt, in parts if it must; materials accept each part.
  /// @throws NumericalError with the reason if the smallest part fails; the model is then as at the end of the last
  ///         accepted part
  void step(double dt);
  /// Forces at the start of the next step are asked anew: after u has changed between steps, or v if a term depends on
  /// it (kicks of a solid of elastic elements need none).
  void restart();
  /// v += dt M⁻¹ f on the free components.
  void kick(std::span<const Vec3> f, double dt);

  /// ½ vᵀMv, J.
  double kineticEnergy() const;
  std::int64_t steps() const;

  struct Impl;

private:
  std::unique_ptr<Impl> impl_;
};

}  // namespace dovetail::fem
