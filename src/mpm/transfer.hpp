// Velocities of points and nodes when the grid is renewed.
#pragma once

#include <span>
#include <vector>

#include "dovetail/core/archive.hpp"
#include "dovetail/core/vec3.hpp"
#include "dovetail/mpm/point_solid.hpp"

namespace dovetail::mpm::detail {

/// What points carry over from one grid to the next.
struct Carried {
  std::vector<double> mass;  ///< kg
  std::vector<Vec3> x, v;    ///< m, m/s
  /// m²/s: Σ w v ⊗ (x_node − x), [9 p + 3 i + j]; empty but for `apic`.
  std::vector<double> moment;
};

/// Points take places and velocities from nodes that have moved by u and have now the velocities v.
/// @param v0  those of the nodes when the grid was laid out  @param keep  of the difference between points and nodes,
/// 0 … 1 (`flip`)
void leaveGrid(const GridRows& rows, std::span<const Vec3> u, std::span<const Vec3> v, std::span<const Vec3> v0,
               double keep, Carried& points);

/// Velocities of the nodes of a new grid under the points: Σ m w v over `mass`, 0 where there is none or a component is
/// held. @param mass  of nodes, kg
std::vector<Vec3> velocitiesOf(const GridRows& rows, const GridOptions& grid, const Carried& points,
                               std::span<const double> mass);

/// Lumped, kg, of nodes.
std::vector<double> massesOf(const GridRows& rows, const Carried& points);

/// Of points with the moments about them, J.
double kineticEnergy(const GridOptions& grid, const Carried& points);

}  // namespace dovetail::mpm::detail
