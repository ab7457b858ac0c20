// hybrid8 entity by entity: the compliance of its stress modes, and its tangent.
#pragma once

#include <array>

#include "brick.hpp"
#include "dovetail/fem/laws/materials.hpp"

namespace dovetail::fem::detail {

/// H⁻¹ with H = ∫ w Pᵀ C⁻¹ P dV, w interpolated from `share`, row-major 18 × 18, where P are the modes pushed forward
/// by the Jacobian at the centre, S = J0 Ŝ J0ᵀ.
std::array<double, 324> hybridStiffness(const BrickCorners& corners, const CornerValues& share,
                                        const Material& material);

/// Row-major 24 × 24 tangent of one element with corners displaced by u, rows 3a + c, N/m.
std::array<double, 576> hybridTangent(const BrickCorners& corners, const CornerValues& share, const BrickCorners& u,
                                      const Material& material);

}  // namespace dovetail::fem::detail
