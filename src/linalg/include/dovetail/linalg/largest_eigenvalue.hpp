// The largest eigenvalue of a stiffness and a mass given as operators.
#pragma once

#include <cstddef>
#include <functional>
#include <span>

namespace dovetail::linalg {

/// Symmetric operators on vectors of `size` entries; y is overwritten.
struct StiffnessAndMass {
  using Operator = std::function<void(std::span<const double> x, std::span<double> y)>;
  std::size_t size;
  Operator stiffness, mass, inverseMass;
};

/// λ ≥ the largest λ of K x = λ M x, at most by the accuracy asked for: Lanczos' iteration with implicit restarts
/// (Sorensen 1992) on at most 40 vectors, its bound on the error added to what it finds. 0 without unknowns.
/// @param accuracy  relative
/// @throws NumericalError if K or M are not finite, or if it does not settle
double largestEigenvalue(const StiffnessAndMass& pair, double accuracy);

}  // namespace dovetail::linalg
