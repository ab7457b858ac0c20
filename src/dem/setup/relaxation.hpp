// Soft spheres that relax in a box: energy ½ Σ δ², steepest where they overlap most.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "dovetail/dem/setup/packing.hpp"
#include "dovetail/geometry/hierarchical_grid.hpp"

namespace dovetail::dem {

/// State of the contacts of a packing.
struct Overlaps {
  double largest = 0.0;  ///< over the smaller radius
  double squares = 0.0;  ///< Σ δ², m²
  double virial = 0.0;   ///< Σ δ × distance of the centres (or the radius left at a wall), m²
  std::int64_t contacts = 0;
};

double meanRadius(const Packing& packing);

class Relaxation {
public:
  explicit Relaxation(Packing& packing) : packing_(packing) {}

  /// FIRE until the largest overlap is at most `overlap`, or the mean force on a sphere is below `balance` times the
  /// mean contact force, or the steps have run out. Returns the steps taken.
  std::int64_t run(double overlap, double balance, std::int64_t steps);
  /// As the spheres lie now; contacts are those with δ > −gap × smaller radius.
  Overlaps measure(double gap = 0.0);
  /// Mean force on a sphere over the mean contact force when last measured; 0 without contacts.
  double unbalanced() const { return contactForce_ > 0.0 ? residual_ / contactForce_ : 0.0; }

private:
  void forces();
  void keepPairs();

  Packing& packing_;
  std::vector<Vec3> force_, velocity_, positionAtBuild_;
  std::vector<double> radiusAtBuild_;
  double skin_ = 0.0;
  geometry::Periodicity spaceAtBuild_;
  geometry::SpherePairs pairs_;
  geometry::HierarchicalGrid grid_;
  Overlaps now_;
  double residual_ = 0.0, contactForce_ = 0.0;
};

}  // namespace dovetail::dem
