// Places on a body of material points that have no mass: corners of its faces.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "dovetail/cg/projection.hpp"
#include "dovetail/fem/model/term.hpp"
#include "dovetail/mpm/grid.hpp"

namespace dovetail::mpm {

class PointSolid;

/// A node as a border mirrors it: the bits of `flip` are components with the other sign.
struct NodeImage {
  int node;
  std::uint8_t flip;
};

/// Markers go with the nodes that the points next to them reach: x = X + S u, a mean over these points of the functions
/// that the nodes have at the point, as polynomials up to the marker (weightsBeside), or where a node has little mass
/// there, as tangents. Rows sum to one and reproduce linear fields, so that forces at markers, which go to the nodes by
/// the transpose, keep their sum and their moment.
struct Markers {
  std::vector<Vec3> X;  ///< m, as the grid was laid out
  cg::Projection map;   ///< S: markers × nodes, behind which there are `images`
  std::vector<NodeImage> images;

  std::size_t nodes() const { return static_cast<std::size_t>(map.columns) - images.size(); }
};

/// Values of the nodes, and of the images behind them.
std::vector<Vec3> withImages(const Markers& markers, std::span<const Vec3> nodal);
/// Values at the markers. @param nodal  of the nodes
std::vector<Vec3> valuesAt(const Markers& markers, std::span<const Vec3> nodal);
/// Adds Sᵀ values to those of the nodes.
void addTransposed(const Markers& markers, std::span<const Vec3> values, std::span<Vec3> nodal);

/// A term that acts on faces (pressure, traction, a contact plane) as one that acts on a body of points: it sees the
/// markers of a set as its nodes, with their first places for X. Adjoint, and tangents Sᵀ K S; its energy, history and
/// name are its own.
class MarkerTerm : public fem::Term {
public:
  virtual const fem::Term& term() const = 0;
  /// The markers, as the term sees them while the nodes are so.
  virtual fem::Nodes seen(const fem::Nodes& nodes) const = 0;
};
/// @param set  of PointSolid::addMarkers
/// @throws InputError for no points, or no term
std::shared_ptr<MarkerTerm> onMarkers(std::shared_ptr<const PointSolid> points, std::size_t set,
                                      std::shared_ptr<fem::Term> term);

}  // namespace dovetail::mpm
