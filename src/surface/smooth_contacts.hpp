// Contacts of one particle with smooth patches.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "dovetail/dem/walls/edge_contact_solver.hpp"
#include "dovetail/surface/smooth_surface.hpp"

namespace dovetail::surface {

/// Overlap, engagement and energyFraction as in dem::WallContacts.
struct SmoothContact {
  int particle, face;
  std::array<double, 16> weight;
  Vec3 normal, foot;
  double overlap, engagement, energyFraction;
};

/// A patch in reach of a particle.
struct PatchHit {
  int face;
  PatchPoint at;
  Vec3 normal;
  double overlap;   // m; < 0 where the patch is farther than the radius
  double fraction;  // m
  Vec3 position;    // y − x, the place from which the patch is seen
};

/// Memory that is kept between particles and steps.
struct SmoothScratch {
  std::vector<PatchHit> hits;
  std::vector<dem::Fraction> fractions;
  dem::EdgeContactSolver solver;
};

/// Appends the contacts of a particle with the faces near it. Patches that it touches at once share its overlap in the
/// potential of dem::projectWallContacts, with patches in place of facets.
/// @param start  per face: where the search for its closest point ended last
/// @throws NumericalError naming the particle whose closest point or fractions were not found
void appendSmoothContacts(const SmoothSurface& surface, int particle, const Vec3& x, double radius,
                          std::span<const int> faces, std::span<std::array<double, 2>> start, SmoothScratch& scratch,
                          std::vector<SmoothContact>& contacts);

}  // namespace dovetail::surface
