// Moduli of a material that has never been loaded.
#pragma once

#include "dovetail/fem/laws/point_material.hpp"

namespace dovetail::fem::detail {

/// At F = 1, Pa: ∂P_00/∂F_00 and ∂P_01/∂F_01.
struct ModuliAtRest {
  double confined, shear;
};
ModuliAtRest moduliAtRest(const PointMaterial& material);

}  // namespace dovetail::fem::detail
