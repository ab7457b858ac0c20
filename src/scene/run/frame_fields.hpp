// What frames show of a run, as plain arrays.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "dovetail/dem/model/model.hpp"
#include "dovetail/dem/walls/mesh_wall.hpp"
#include "dovetail/fem/model/model.hpp"
#include "dovetail/scene/build.hpp"

namespace dovetail::scene {

/// Means of the points of each element of the mesh, by their volumes as they are now; zero for elements that are not
/// modelled.
struct CellStress {
  std::vector<double> cauchy;              ///< nine per element, row-major, Pa, > 0 in tension
  std::vector<double> vonMises, pressure;  ///< Pa; pressure −tr σ/3, > 0 in compression
};
CellStress cellStress(const fem::Model& model, std::size_t elements);

/// Values side by side, per point or cell.
struct MeshField {
  std::string name;
  std::vector<double> values;
  int components = 1;
  bool perCell = true;
};

/// What the material of a solid remembers, element by element: means of its points by their reference volumes.
/// "plastic_strain" (accumulated, √⅔ times its rate's norm) and "plastic_volume" (det Fₚ) of laws that flow; "history",
/// all numbers, of others that remember something.
std::vector<MeshField> cellHistory(const fem::Model& model, std::size_t elements, const Solid& solid);

/// Fraction of the solid per node, 1 − w in an overlap, interpolated in the elements; empty if all is the solid's.
std::vector<double> fractionOf(const fem::Model& model);

/// What frames of a solid show, by the words of `output.contents`: displacement (m), velocity (m/s), stress, strain,
/// cells, history, weights.
std::vector<MeshField> solidFields(const fem::Model& model, std::size_t elements, const Solid& solid,
                                   const std::vector<std::string>& contents);

/// Of a started run whose frames show solids: what says that a set has another name in them, as a field has its own.
std::vector<std::string> notesOnSetNames(const Built& built, const Scene& scene);

/// Contacts or bonds, as lines from the centre of the first grain to that of the second, or to the contact point on a
/// wall.
struct ForceLines {
  std::vector<Vec3> ends;                   ///< two per line, m
  std::vector<std::array<int, 2>> line;     ///< numbers of ends
  std::vector<std::int64_t> first, second;  ///< ids of grains, −1: a wall or a solid
  std::vector<Vec3> force;                  ///< on the first, N
  std::vector<double> normal, tangential;   ///< N: > 0 pushes apart; magnitude across the line's direction
  std::vector<double> utilised;             ///< of bonds: largest stress over strength
};
/// The normal is that of the contact.
ForceLines contactLines(const dem::Model& grains);
/// Of all bonds; the normal is along the line.
ForceLines bondLines(const dem::Model& grains);

/// A triangulated wall with what grains do to its facets.
struct WallFacets {
  std::vector<Vec3> traction;    ///< per facet, Pa: force of the grains over the facet's area
  std::vector<double> pressure;  ///< per facet, Pa: its part into the wall's outer side, −normal · traction
};
WallFacets wallFacets(const dem::MeshWall& mesh);

}  // namespace dovetail::scene
