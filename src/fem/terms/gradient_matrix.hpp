// The matrix of the energy of the gradient of F.
#pragma once

#include "dovetail/linalg/block_matrix.hpp"
#include "elements/solids/solid_cells.hpp"

namespace dovetail::fem::detail {

/// A of ½ Σ_i u_i · A u_i, N/m: see gradientEnergy(). @param cells  quad4, quad8 or hex8
linalg::NodeMatrix gradientMatrix(const SolidCells& cells, double modulus);

}  // namespace dovetail::fem::detail
