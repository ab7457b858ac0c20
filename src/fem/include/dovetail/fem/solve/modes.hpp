// Free vibrations about the present state of a model.
#pragma once

#include <vector>

#include "dovetail/fem/model/model.hpp"
#include "dovetail/linalg/definite_solver.hpp"

namespace dovetail::fem {

struct ModesOptions {
  int count = 6;
  double massFraction = 1.0;  ///< of the consistent mass
  linalg::LinearOptions linear{};
};

struct Modes {
  std::vector<double> frequency;         ///< ascending, Hz; 0 of rigid motions
  std::vector<std::vector<Vec3>> shape;  ///< per mode and node; the largest displacement is 1
};

/// The lowest frequencies of K x = ω² M x with the tangent of the present state, stresses included; prescribed motion
/// stands. By subspace iteration (Bathe & Wilson 1972) to a relative change of 1e-10 of ω².
/// @throws InputError for a count below 1 or above the free components, nodes without mass, or a tangent that is not
///         symmetric; NumericalError if the state is not stable (the mode is named), or if it does not settle
Modes modesOf(Model& model, const ModesOptions& options = {});

}  // namespace dovetail::fem
