// What frames show of a run, as plain arrays.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "dovetail/dem/model/model.hpp"
#include "dovetail/dem/walls/mesh_wall.hpp"
#include "dovetail/rve/rve.hpp"
#include "dovetail/scene/build.hpp"
#include "point_fields.hpp"

namespace dovetail::scene {

/// Fraction of the solid per node, 1 − w in an overlap, interpolated in the elements; empty if all is the solid's.
std::vector<double> fractionOf(const fem::Model& model);

/// What frames of a solid show, by the words of `output.contents`: displacement (m), velocity (m/s), weights, and of
/// stress, strain, cells and history means over the points of each element. Of material points, all at the points, with
/// "radius" (m).
std::vector<MeshField> solidFields(const fem::Model& model, std::size_t elements, const Solid& solid,
                                   const std::vector<std::string>& contents);

/// At the points of a solid themselves: the deformation gradient, and what these words give.
std::vector<MeshField> pointFields(const Points& points, const Solid& solid, const std::vector<std::string>& contents);

/// Of a started run whose frames show solids: what says that a set has another name in them, as a field has its own.
std::vector<std::string> notesOnSetNames(const Built& built, const Scene& scene);

/// Grains among the particles of a started run, as frames show them: without spheres at material points.
dem::Particles grainsAlone(const dem::Particles& particles);

/// Contacts or bonds, as lines from the centre of the first grain to that of the second, or to the contact point on a
/// wall.
struct ForceLines {
  std::vector<Vec3> ends;                   ///< two per line, m
  std::vector<std::array<int, 2>> line;     ///< numbers of ends
  std::vector<std::int64_t> first, second;  ///< ids of grains, −1: a wall or a solid
  std::vector<Vec3> force;                  ///< on the first, N
  std::vector<double> normal, tangential;   ///< N: > 0 pushes apart; magnitude across the line's direction
  std::vector<double> utilised;             ///< of bonds: largest stress over strength
  std::vector<double> sliding;              ///< of contacts in cells of grains: 1 at the limit of friction, else 0
};
/// The normal is that of the contact.
ForceLines contactLines(const dem::Model& grains);
/// Of all bonds; the normal is along the line.
ForceLines bondLines(const dem::Model& grains);

/// Grains of a cell, in the period that begins at the origin, and their contacts, which end in other periods where they
/// cross a border. Grains are numbered from 0.
struct CellGrains {
  std::vector<Vec3> x, v, spin;  ///< m; m/s, rad/s, fluctuations
  ForceLines contacts;
};
CellGrains grainsOf(const rve::Rve& cell);

/// A triangulated wall with what grains do to its facets.
struct WallFacets {
  std::vector<Vec3> traction;    ///< per facet, Pa: force of the grains over the facet's area
  std::vector<double> pressure;  ///< per facet, Pa: its part into the wall's outer side, −normal · traction
};
WallFacets wallFacets(const dem::MeshWall& mesh);

}  // namespace dovetail::scene
