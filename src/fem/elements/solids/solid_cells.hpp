// The elements of a solid, four side by side.
#pragma once

#include <algorithm>
#include <array>
#include <span>
#include <string>
#include <vector>

#include "dovetail/core/vec3.hpp"
#include "elements/lanes/lane.hpp"
#include "mesh/shapes.hpp"

namespace dovetail::fem::detail {

/// The elements of one shape that a solid consists of. A batch that is not full repeats its last element with zero
/// weight.
struct SolidCells {
  ElementShape shape;
  std::size_t nodes;                                           ///< per element
  double thickness;                                            ///< of plane cells, m
  std::vector<int> number;                                     ///< in the mesh, per element
  std::vector<Vec3> X;                                         ///< of the mesh, m
  std::vector<double> fraction;                                ///< of the mesh, weight of every integral; empty = 1
  std::vector<std::array<std::int32_t, laneCount>> batchNode;  ///< [nodes b + a]

  std::size_t size() const { return number.size(); }
  std::size_t batches() const { return (size() + laneCount - 1) / laneCount; }
  std::size_t inUse(std::size_t batch) const { return std::min<std::size_t>(laneCount, size() - laneCount * batch); }
  int nodeOf(std::size_t e, std::size_t a) const { return batchNode[nodes * (e / laneCount) + a][e % laneCount]; }
};

/// @throws InputError unless there is none, or one per node within 0 … 1
void requireFraction(std::span<const double> fraction, std::size_t nodes);
/// The elements of a set, of all if its name is empty, but those whose nodes all have the fraction 0.
/// @throws InputError if they are of several shapes, or none is left
SolidCells cellsOf(const SolidMesh& mesh, const std::string& set, std::span<const double> fraction);

/// Leaves these elements, ascending.
void keep(SolidCells& cells, std::span<const int> elements);

/// ∂ξ/∂X, row-major, and weight (det ∂X/∂ξ times that of the rule and the fraction; 0 in lanes that repeat) at one
/// point of a batch.
struct alignas(laneBytes) PointGeometry {
  std::array<Lane, 9> map;
  Lane weight;
};

/// Geometry at every point of a rule, [points b + q].
std::vector<PointGeometry> geometryAt(const SolidCells& cells, const CellRule& rule);

/// ∫w ρ ψ_a dV of one element, kg: row sums of its consistent mass.
std::vector<double> rowSumsOfMass(const SolidCells& cells, std::size_t element, double density);
/// The same, or for hex20, tet10 and quad8, whose row sums are negative at corners, the diagonal scaled to the
/// element's mass (Hinton, Rock & Zienkiewicz 1976), kg.
std::vector<double> lumpedMass(const SolidCells& cells, std::size_t element, double density);
/// ∫w ρ ψ_a ψ_b dV of one element, row-major, kg.
std::vector<double> consistentMass(const SolidCells& cells, std::size_t element, double density);

}  // namespace dovetail::fem::detail
