// Contacts between particles and a triangulated wall.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "dovetail/dem/particles/particles.hpp"
#include "dovetail/dem/walls/wall.hpp"
#include "dovetail/dem/walls/wall_candidates.hpp"

namespace dovetail::dem {

/// How contacts of one particle with several facets of a wall are combined.
enum class EdgeRule {
  /// The force is the gradient of ½k|y − x|², y being the nearest position at which the particle (centre x, radius R)
  /// is clear of all facets. One contact over faces and convex edges, a continuous sum at concave ones, the plain sum
  /// where two walls face each other or meet at 90°. Conserves energy. See projectWallContacts.
  projected,
  /// Cheng et al. 2022, sec. 5.1.1, as their code has it: see paperWallContacts.
  paper,
};

/// What the contacts of the last step remember. Empty unless the law remembers something.
struct WallSprings {
  std::vector<int> particle, facet;
  std::vector<Vec3> normal;
  std::vector<double> memory;  ///< of the law, contact by contact; a tangential spring takes three, its stretch, m

  std::vector<double> next;  // those of this step, while they are being worked out
  std::vector<char> taken;
};

/// Contacts of one wall, by particle, then facet. Arrays keep their memory between steps.
struct WallContacts {
  std::vector<int> particle, facet;
  std::vector<std::array<double, 3>> weight;  ///< share of the facet's vertices in the contact point; sums to 1
  std::vector<Vec3> normal;                   ///< unit, from the wall to the particle
  std::vector<double> overlap;                ///< λ, the part of the overlap that this contact carries, m, > 0
  std::vector<double> engagement;             ///< λ / overlap of the two alone, 0 … 1
  std::vector<Vec3> force;                    ///< on the particle, N; set by collideWithWall
  std::vector<Vec3> couple;                   ///< on the particle beyond arm × force, N m; if the law exerts torques
  WallSprings springs;

  std::size_t size() const { return particle.size(); }
};

/// Contact point on the wall, m.
inline Vec3 contactPoint(const WallContacts& contacts, const TriangulatedWall& wall, std::size_t c) {
  const auto& vertex = wall.facets[static_cast<std::size_t>(contacts.facet[c])];
  const auto& w = contacts.weight[c];
  return w[0] * wall.x[static_cast<std::size_t>(vertex[0])] + w[1] * wall.x[static_cast<std::size_t>(vertex[1])] +
         w[2] * wall.x[static_cast<std::size_t>(vertex[2])];
}

/// Velocity of the wall at the contact point, with the weights that carry the force (its adjoint), m/s.
inline Vec3 wallVelocity(const WallContacts& contacts, const TriangulatedWall& wall, std::size_t c) {
  const auto& vertex = wall.facets[static_cast<std::size_t>(contacts.facet[c])];
  const auto& w = contacts.weight[c];
  return w[0] * wall.v[static_cast<std::size_t>(vertex[0])] + w[1] * wall.v[static_cast<std::size_t>(vertex[1])] +
         w[2] * wall.v[static_cast<std::size_t>(vertex[2])];
}

/// Contacts as they are now; `force` is set to zero, `springs` stay. The same for any number of threads.
void findWallContacts(const Particles& particles, const TriangulatedWall& wall, const WallCandidates& candidates,
                      EdgeRule rule, WallContacts& contacts);

/// EdgeRule::projected. Each particle has the potential
///   V = k max_{λ ≥ 0} Σ λᵢ δᵢ − ½ Σ λᵢ λⱼ s(nᵢ·nⱼ),   δᵢ = R − nᵢ·(x − cᵢ),
/// where nᵢ, cᵢ are normal and foot of facet i seen from yᵢ = x + Σ s′(nᵢ·nⱼ) λⱼ nⱼ. With s(g) = g this is the dual of
/// V = ½k min |y − x|² under |y − facet i| ≥ R, and yᵢ = y. Facets that face each other (g ≤ 0) are uncoupled, s = 0:
/// their forces add, where the projection would diverge; s joins the two with a continuous slope over 0 < g < 0.2, that
/// is in valleys of 90° to 101.5°. Contact i carries λᵢ at cᵢ: by the envelope theorem k λᵢ nᵢ = −∂V/∂x and
/// −k λᵢ weight nᵢ = −∂V/∂(vertex), so force, moment and energy balance.
/// Where several minima compete V may jump: not on ground as rough as 0.2 R up to overlaps of 0.4 R, but from 0.15 R on
/// among spikes, and from 0.025 R on between two separate edges that are seen under a right angle.
/// V = Σ ½k λ²/engagement (LinearSpringDashpot::Prepared::energy).
void projectWallContacts(const Particles& particles, const TriangulatedWall& wall, const WallCandidates& candidates,
                         WallContacts& contacts);

/// EdgeRule::paper: one contact per facet at its closest point; the one with the largest overlap is kept, and if it
/// lies inside a face, then all others that do so too; what remains is weighted by its share of the sum of overlaps.
/// There is no angle test. (Text and Algorithm 1 of the paper contradict each other here; this is what its authors'
/// code does, but for the order of facets, which decides nothing here.) The force is no gradient: energy is not
/// conserved at edges.
void paperWallContacts(const Particles& particles, const TriangulatedWall& wall, const WallCandidates& candidates,
                       WallContacts& contacts);

/// Gives what contacts remember the new numbers of their particles (< 0: gone).
void renumber(WallContacts& contacts, std::span<const int> newNumber);

/// f[vertex] −= weight × force for all contacts: the reaction on the wall, N.
void addWallForces(const WallContacts& contacts, std::span<const geometry::Facet> facets, std::span<Vec3> f);
inline void addWallForces(const WallContacts& contacts, TriangulatedWall& wall) {
  addWallForces(contacts, wall.facets, wall.f);
}

}  // namespace dovetail::dem
