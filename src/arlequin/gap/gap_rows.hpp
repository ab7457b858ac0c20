// Rows of a gap operator while they are made.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "dovetail/arlequin/gap_operator.hpp"

namespace dovetail::arlequin {

using Rows = std::vector<cg::ProjectionRow>;

/// Gap rows of the corners of the overlap's elements.
struct RowNumbers {
  std::vector<int> place;                  // of each element of the mesh among the overlap's, −1 elsewhere
  std::vector<std::array<int, 8>> corner;  // row of each corner of those elements, −1: none

  const std::array<int, 8>& of(int element) const {
    return corner[static_cast<std::size_t>(place[static_cast<std::size_t>(element)])];
  }
};

/// ∫W(x − x_α) ψ_i dx per row and particle in the reach of its kernel, over the overlap's elements, m³ times 1/m³;
/// particles ascend within a row.
/// @param position  of the nodes, m   @param rows  how many there are
Rows kernelIntegrals(const Overlap& overlap, const fem::SolidMesh& mesh, std::span<const Vec3> position,
                     const ProjectionOptions& options, const RowNumbers& row, std::size_t rows);

}  // namespace dovetail::arlequin
