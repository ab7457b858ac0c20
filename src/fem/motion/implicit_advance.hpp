// Implicit steps that are cut until they converge.
#pragma once

#include <functional>

#include "dovetail/fem/motion/implicit_motion.hpp"
#include "implicit_step.hpp"

namespace dovetail::fem {

/// What ImplicitMotion and ImplicitIntegrator share.
struct ImplicitMotion::Impl {
  Model& model;
  ImplicitOptions options;
  DofMap dofs;
  ModelMass mass;
  Profile profile{true};
  detail::ImplicitStep solver;
  std::int64_t steps = 0, cuts = 0, iterations = 0;
  double largestResidual = 0.0;
  bool begun = false;

  Impl(Model& model, const ImplicitOptions& options);
  /// The end of a part of length h that is over.
  Instant accepted(double h) const { return {model.t, h, &mass, !options.scheme.conserving}; }
  /// Takes the present state as the start of a step of dt.
  void begin(double dt);
  /// v += dt M⁻¹ f on the free components.
  void kick(std::span<const Vec3> f, double dt);
  /// Steps by h, halved until it works.
  /// @param accept  called with each part after it has converged, before the time moves on: commits the terms
  void advance(double h, const std::function<void(double)>& accept, int depth = 0);
};

}  // namespace dovetail::fem
