// Soft spheres that relax in a box: energy ½ Σ δ², steepest where they overlap most.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "dovetail/dem/laws/contact_laws.hpp"
#include "dovetail/dem/pairs/pairs.hpp"
#include "dovetail/dem/setup/packing.hpp"
#include "dovetail/dem/walls/primitive_wall.hpp"
#include "room_surface.hpp"

namespace dovetail::dem {

/// State of the contacts of a packing.
struct Overlaps {
  double largest = 0.0;  ///< over the smaller radius
  double sum = 0.0;      ///< Σ δ, m
  double virial = 0.0;   ///< Σ δ × distance of the centres (or the radius left at a wall), m²
  std::int64_t touching = 0;
  std::int64_t held = 0;  ///< contacts of each sphere, those of pairs twice, with the gap that was asked for
  Overlaps& operator+=(const Overlaps& b);
};

double meanRadius(const Packing& packing);

/// The spheres of a packing as particles under springs of 1 N/m: pairs and walls are swept as in any model.
class Relaxation {
public:
  explicit Relaxation(Packing& packing);

  /// The packing has been changed: radii, places or the box.
  void take();
  /// FIRE until the largest overlap is at most `overlap`, or the mean force on a sphere is below `balance` times the
  /// mean contact force, or the steps have run out. Returns the steps taken; the packing has the new places.
  std::int64_t run(double overlap, double balance, std::int64_t steps);
  /// As the spheres lie now; contacts are those with δ > −gap × smaller radius.
  Overlaps measure(double gap = 0.0) const;
  /// Mean force on a sphere over the mean contact force; 0 without contacts.
  double unbalanced(const Overlaps& now) const;

private:
  void makeWalls();
  void pushFromSurface();
  void findForces(double moved);

  Packing& packing_;
  Particles particles_;  // sorted in space: Particles::id is the sphere's number
  PairList list_;
  std::vector<PrimitiveWall> walls_;
  RoomSurface surface_;
  std::shared_ptr<const ContactLaws> laws_;
};

}  // namespace dovetail::dem
