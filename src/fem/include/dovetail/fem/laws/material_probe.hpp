// Moduli of a material that has never been loaded.
#pragma once

#include "dovetail/fem/laws/point_material.hpp"

namespace dovetail::fem {

/// At F = 1, Pa: ∂P_00/∂F_00 and ∂P_01/∂F_01.
struct ModuliAtRest {
  double confined, shear;
};
ModuliAtRest moduliAtRest(const PointMaterial& material);

/// Young's modulus, Pa: of a law of the hand-written kernels its own, else that of an isotropic law with these moduli.
double youngsModulus(const PointMaterial& material);

}  // namespace dovetail::fem
