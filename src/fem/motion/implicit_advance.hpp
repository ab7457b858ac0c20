// Implicit steps that are cut until they converge.
#pragma once

#include <functional>
#include <memory>

#include "dovetail/fem/motion/implicit_motion.hpp"
#include "implicit_step.hpp"

namespace dovetail::fem {

/// What ImplicitMotion and ImplicitIntegrator share.
struct ImplicitMotion::Impl {
  Model& model;
  ImplicitOptions options;
  Profile profile{true};
  /// What belongs to the nodes.
  struct System {
    DofMap dofs;
    ModelMass mass;
    detail::ImplicitStep solver;
    System(Model& model, const ImplicitOptions& options, Profile& profile);
  };
  std::unique_ptr<System> system;
  std::int64_t steps = 0, cuts = 0, iterations = 0;
  std::int64_t factorisationsBefore = 0;  // of systems that are gone
  double largestResidual = 0.0;
  bool begun = false;

  Impl(Model& model, const ImplicitOptions& options);
  const DofMap& dofs() const { return system->dofs; }
  const ModelMass& mass() const { return system->mass; }
  detail::ImplicitStep& solver() const { return system->solver; }
  /// Nodes have become others: masses, constraints and tangents are made anew.
  void renew();
  void makeSystem();
  /// The end of a part of length h that is over.
  Instant accepted(double h) const { return {model.t, h, &mass(), !options.scheme.conserving}; }
  /// Takes the present state as the start of a step of dt.
  void begin(double dt);
  /// v += dt M⁻¹ f on the free components.
  void kick(std::span<const Vec3> f, double dt);
  /// Steps by h, halved until it works.
  /// @param accept  called with each part after it has converged, before the time moves on: commits the terms
  void advance(double h, const std::function<void(double)>& accept, int depth = 0);
};

}  // namespace dovetail::fem
