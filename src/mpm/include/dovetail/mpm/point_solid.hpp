// Solids made of material points on a grid that is renewed as they travel.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "dovetail/fem/laws/field_answers.hpp"
#include "dovetail/fem/model/model.hpp"
#include "dovetail/mpm/grid.hpp"
#include "dovetail/mpm/markers.hpp"

namespace dovetail::mpm {

/// How points take their velocity from the grid when it is renewed, and give it to the next one.
enum class Transfer {
  flip,  ///< a point adds the change of the velocities of nodes (Brackbill & Ruppel 1986, J. Comput. Phys. 65)
  /// A point takes the velocity of nodes and its gradient (Jiang, Schroeder, Selle, Teran & Stomakhin 2015, ACM Trans.
  /// Graph. 34); B-splines only. Keeps angular momentum.
  apic
};

/// Points as they start.
struct MaterialPoints {
  std::vector<Vec3> x;         ///< m
  std::vector<Vec3> v;         ///< m/s; empty: at rest
  std::vector<double> volume;  ///< m³, in plane strain thickness included
};

struct PointOptions {
  GridOptions grid{};
  Transfer transfer = Transfer::flip;
  double damping = 0.0;   ///< 1/s: what of the difference from the velocity of the nodes a point loses (PIC), of `flip`
  double renewal = 0.25;  ///< travel of a point over the spacing at which the grid is renewed, > 0 and at most 0.5
  std::string name = "points";
};

/// Points on a grid as a term of a model whose nodes are those of the grid. Between renewals the grid is a mesh: points
/// go x = x₀ + Σ w u, F = (1 + Σ u ⊗ ∂w/∂x) F₀, and forces are −∂/∂u of the stored energy. Where nodes have travelled
/// far enough the grid is laid out anew under the points, between steps (renewNodes): that leaves stored energy and
/// momentum as they are, and takes kinetic energy, which has a channel of its own. Of FLIP it is ½ Δvᵀ(M − Σ w m wᵀ)Δv
/// with the change Δv of the nodes' velocities since the last renewal, never negative.
///
/// What velocities of points hold beyond those of nodes is stored energy of this term.
class PointSolid : public fem::Term {
public:
  /// At the present state of the nodes.
  virtual std::vector<Vec3> places(const fem::Nodes& nodes) const = 0;
  virtual const GridRows& rows() const = 0;
  virtual const GridOptions& grid() const = 0;
  /// F of the points when the grid was laid out, [9 point + 3 i + J].
  virtual const std::vector<double>& laidDeformation() const = 0;
  virtual const std::vector<double>& masses() const = 0;  ///< of points, kg
  /// F, P, energies and dissipation of the points as they were asked last.
  virtual const fem::FieldAnswers& answers() const = 0;
  /// Kinetic energy that velocities of points have beyond those of nodes, J.
  virtual double beyondNodes() const = 0;
  virtual std::int64_t renewals() const = 0;
  /// Places that go with the body, on its faces at the start, m. @return number of the set
  /// @throws InputError naming one that is farther than the spacing from every point, or after a renewal
  virtual std::size_t addMarkers(std::span<const Vec3> x) = 0;
  /// On the present grid. @throws InputError for a set that does not exist
  virtual const Markers& markers(std::size_t set) const = 0;
  /// Bytes.
  virtual std::size_t memory() const = 0;
};

/// @throws InputError for no points, volumes that are not positive, numbers that differ, no field, options out of
/// range, `apic` with other shapes than B-splines, fewer points in a cell than leastPerCell(); NumericalError for
/// points beyond a border
std::shared_ptr<PointSolid> makePoints(const MaterialPoints& points, std::shared_ptr<fem::PointField> field,
                                       const PointOptions& options);

/// The points on nodes of their own, masses included. Loads of nodes of a mesh have no place here.
fem::Model makeModel(std::shared_ptr<PointSolid> points);

/// m g on every point: −∂/∂u of the energy −Σ m g · x. (fem::gravity acts on lumped nodes, which borders have moved.)
std::shared_ptr<fem::Term> gravity(std::shared_ptr<const PointSolid> points, const Vec3& g,
                                   std::string name = "gravity");
/// The same with a function of the time, s, which stores no energy: its work is booked as it is done.
std::shared_ptr<fem::Term> gravity(std::shared_ptr<const PointSolid> points, std::function<Vec3(double)> g,
                                   std::string name = "gravity");

}  // namespace dovetail::mpm
