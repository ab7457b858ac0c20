// What the hand-written kernels of bricks keep of the elements of a solid.
#pragma once

#include "brick.hpp"
#include "dovetail/fem/laws/materials.hpp"
#include "elements/lanes/lane.hpp"
#include "elements/solids/solid_cells.hpp"

namespace dovetail::fem::detail {

/// Local node of a binary corner (bit 0, 1, 2 set: +ξ, +η, +ζ), and the corner of a local node.
inline constexpr std::array<std::size_t, 8> brickNode = {0, 1, 3, 2, 4, 5, 7, 6};

/// The nodes of element e of a solid of hex8.
std::array<int, 8> brickNodes(const SolidCells& cells, std::size_t e);

/// @param assumedStress  the hybrid elements of Pian & Tong; material is then StVenantKirchhoff
BrickCache makeBrickCache(const SolidCells& cells, const Material& material, bool assumedStress);

}  // namespace dovetail::fem::detail
