// hybrid8 entity by entity: the stiffness of its stress modes.
#pragma once

#include <array>

#include "brick.hpp"
#include "dovetail/fem/laws/materials.hpp"

namespace dovetail::fem::detail {

/// H⁻¹ with H = ∫ w Pᵀ C⁻¹ P dV, w interpolated from `fraction`, row-major 18 × 18, where P are the modes pushed
/// forward by the Jacobian at the centre, S = J0 Ŝ J0ᵀ.
std::array<double, 324> hybridStiffness(const BrickCorners& corners, const CornerValues& fraction,
                                        const Material& material);

}  // namespace dovetail::fem::detail
