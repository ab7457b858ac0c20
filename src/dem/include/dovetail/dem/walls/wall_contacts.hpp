// Contacts between particles and a triangulated wall.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "dovetail/dem/laws/contact.hpp"
#include "dovetail/dem/particles/particles.hpp"
#include "dovetail/dem/walls/ended_memories.hpp"
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

/// Memory of the contacts of the last step. Empty unless the law has memory.
struct WallSprings {
  std::vector<int> particle;
  std::vector<Vec3> normal;
  std::vector<double> memory;    ///< of the law, contact by contact; a tangential spring takes three, its stretch, m
  WallMemoryKind memoryKind;     ///< PreparedLaws::wallMemoryKind
  std::vector<double> fraction;  ///< engagement

  std::vector<double> next;    // those of this step, while they are being worked out
  std::vector<int> successor;  // of each of the last step in this one, −1: it has ended
};

/// Contacts of one wall, by particle, then facet. Arrays keep their memory between steps.
struct WallContacts {
  std::vector<int> particle, facet;
  std::vector<std::array<double, 3>> weight;  ///< fraction of the facet's vertices in the contact point; sums to 1
  std::vector<Vec3> normal;                   ///< unit, from the wall to the particle
  /// λ, the part of the overlap that this contact carries, m, > 0; where the law reaches farther than touch also the
  /// whole gap, < 0, down to −reach.
  std::vector<double> overlap;
  std::vector<double>
      engagement;  ///< fraction of what the law says to overlap/engagement: force, couple and their losses
  std::vector<double> energyFraction;  ///< fraction of what it stores at that overlap
  std::vector<Vec3> force;             ///< on the particle, N; set by ContactLaws::wall
  std::vector<Vec3> couple;            ///< on the particle beyond arm × force, N m; if the law exerts torques
  std::vector<double> energy;          ///< of the normal springs, J; if booked
  std::vector<double> sideEnergy;      ///< of those that the law remembers
  /// Only where space repeats: which image of the particle touches; and the periods, m.
  std::vector<Image> image;
  Vec3 period;
  WallSprings springs;

  std::size_t size() const { return particle.size(); }
  /// What is to be added to the particle's position to have it next to the wall, m.
  Vec3 shift(std::size_t c) const { return image.empty() ? Vec3{} : shiftOf(image[c], period); }
};

/// No contacts; the memory of those of the last step stays.
void clear(WallContacts& contacts);
/// The first so many of those that have just been found.
void resize(WallContacts& contacts, std::size_t count);

/// Calls (array, other's array) for all arrays that a search has filled.
template <class Call>
void forArrays(WallContacts& contacts, const WallContacts& other, Call&& call) {
  call(contacts.particle, other.particle);
  call(contacts.facet, other.facet);
  call(contacts.weight, other.weight);
  call(contacts.normal, other.normal);
  call(contacts.overlap, other.overlap);
  call(contacts.engagement, other.engagement);
  call(contacts.energyFraction, other.energyFraction);
  call(contacts.image, other.image);
}

/// One contact as another list has it.
inline void appendContact(WallContacts& contacts, const WallContacts& from, std::size_t c) {
  forArrays(contacts, from, [c](auto& to, const auto& of) {
    if (!of.empty()) to.push_back(of[c]);
  });
}

/// Contact point on the wall, m.
inline Vec3 contactPoint(const WallContacts& contacts, const TriangulatedWall& wall, std::size_t c) {
  const auto& vertex = wall.facets[static_cast<std::size_t>(contacts.facet[c])];
  const auto& w = contacts.weight[c];
  return w[0] * wall.x[static_cast<std::size_t>(vertex[0])] + w[1] * wall.x[static_cast<std::size_t>(vertex[1])] +
         w[2] * wall.x[static_cast<std::size_t>(vertex[2])];
}

/// From the particle's centre to the contact point on the wall, m.
inline Vec3 contactArm(const Particles& particles, const WallContacts& contacts, const TriangulatedWall& wall,
                       std::size_t c) {
  const Vec3 arm = contactPoint(contacts, wall, c) - particles.x[static_cast<std::size_t>(contacts.particle[c])];
  return contacts.image.empty() ? arm : arm - contacts.shift(c);
}

/// Velocity of the wall at the contact point, with the weights that carry the force (its adjoint), m/s.
inline Vec3 wallVelocity(const WallContacts& contacts, const TriangulatedWall& wall, std::size_t c) {
  const auto& vertex = wall.facets[static_cast<std::size_t>(contacts.facet[c])];
  const auto& w = contacts.weight[c];
  return w[0] * wall.v[static_cast<std::size_t>(vertex[0])] + w[1] * wall.v[static_cast<std::size_t>(vertex[1])] +
         w[2] * wall.v[static_cast<std::size_t>(vertex[2])];
}

/// Contacts as they are now; `force` is set to zero, `springs` stay. The same for any number of threads. With
/// candidates.reach also contacts beyond touch: each with the nearest facet of those that do not face away from one
/// another (normals less than about 80° apart), unless one of these is touched.
void findWallContacts(const Particles& particles, const TriangulatedWall& wall, const WallCandidates& candidates,
                      EdgeRule rule, WallContacts& contacts);

/// EdgeRule::projected. Each particle has the potential
///   V = k min_n max_{λ ≥ 0} Σ λᵢ δᵢ − ½ Σ λᵢ λⱼ s(nᵢ·nⱼ),   δᵢ = R − nᵢ·(x − cᵢ),
/// where nᵢ, cᵢ are normal and foot of a face, edge or vertex seen from yᵢ = x + Σ s′(nᵢ·nⱼ) λⱼ nⱼ. With s(g) = g this
/// is the dual of V = ½k min |y − x|² under |y − facet i| ≥ R, and yᵢ = y. Facets that face each other (g ≤ 0) are
/// uncoupled, s = 0: their forces add, where the projection would diverge; s joins the two with a continuous slope over
/// 0 < g < 0.2, that is in valleys of 90° to 101.5°. Contact i carries λᵢ at cᵢ: by the envelope theorem
/// k λᵢ nᵢ = −∂V/∂x and −k λᵢ weight nᵢ = −∂V/∂(vertex), so force, moment and energy balance.
/// Feet are those of the surface: one on an edge or vertex counts only where no facet that hangs together with it, over
/// gaps up to 0.002 R, is nearer to yᵢ. So the cut into triangles does not show.
/// One-sided walls: for a centre outside, which the nearest feature decides, faces turned away do not count; one inside
/// is pushed out through the face of the least V, down to one radius. A facet is clear if one of the active normals
/// clears it, whichever facet that belongs to. The minimum is a local one, of two where a facet has two places to be
/// seen from, and where more than three normals are partly coupled the fractions may have two maxima. So V may jump
/// among spikes and folds: at 8 of 200 000 random places with overlaps up to 0.5 R it jumped by more than 4e-10 k R²
/// (at most 1.5 % of V), or the force was off by more than 1e-6; never around plates, thinner than the overlap or not.
/// V = Σ ½k λ²/engagement (LinearSpringDashpot::Prepared::energy).
void projectWallContacts(const Particles& particles, const TriangulatedWall& wall, const WallCandidates& candidates,
                         WallContacts& contacts);

/// EdgeRule::paper: one contact per facet at its closest point; the one with the largest overlap is kept, and if it
/// lies inside a face, then all others that do so too; what remains is weighted by its fraction of the sum of overlaps.
/// There is no angle test. (Text and Algorithm 1 of the paper contradict each other here; this is what its authors'
/// code does, but for the order of facets, which decides nothing here.) The force is no gradient: energy is not
/// conserved at edges.
void paperWallContacts(const Particles& particles, const TriangulatedWall& wall, const WallCandidates& candidates,
                       WallContacts& contacts);

/// Gives the memory of contacts the new numbers of their particles (< 0: removed). Returns the energy of the springs of
/// removed particles, J, for the caller to book.
double renumber(WallContacts& contacts, std::span<const int> newNumber);

namespace detail {
/// Energies of the contacts of removed particles; the contacts' own are cleared, as their numbers are no longer true.
template <class Contacts>
double energyOfLeavers(Contacts& contacts, std::span<const int> newNumber) {
  double sum = 0.0;
  for (std::vector<double>* const energy : {&contacts.energy, &contacts.sideEnergy}) {
    for (std::size_t c = 0; c < energy->size() && c < contacts.particle.size(); ++c)
      if (newNumber[static_cast<std::size_t>(contacts.particle[c])] < 0) sum += (*energy)[c];
    energy->clear();
  }
  return sum;
}
/// What contacts remember becomes of the kind of the present law: springs stay if they mean the same, else they start
/// anew, and velocities that were not remembered are unknown, which is zero.
/// @param memory  numbers per contact
/// @param of      the kind that it was
void readAs(const WallMemoryKind& kind, int memory, std::size_t contacts, WallMemoryKind& of,
            std::vector<double>& remembered);
/// Sets what contacts remember behind their springs to zero.
void forgetVelocities(std::vector<double>& memory, std::size_t contacts, int springs);
/// Stores the memory of a contact that has ended. @param fraction  of the contact, or what it has less of it now
void addEnded(EndedMemories& ended, const Particles& particles, int particle, const std::vector<double>& memory,
              std::size_t contact, std::size_t components, double fraction);
}  // namespace detail

/// The contacts forget how they moved in the last step. @param springs  numbers of their memory that stay
inline void forgetVelocities(WallContacts& contacts, int springs) {
  detail::forgetVelocities(contacts.springs.memory, contacts.springs.particle.size(), springs);
}

/// The reaction on the wall, N: f[vertex] −= weight × force for all contacts, and couples as forces on the vertices of
/// their facet (see FacetSpin), so that force, moment and power balance.
/// @param x positions of the vertices, m
void addWallForces(const WallContacts& contacts, std::span<const Vec3> x, std::span<const geometry::Facet> facets,
                   std::span<Vec3> f);
inline void addWallForces(const WallContacts& contacts, TriangulatedWall& wall) {
  addWallForces(contacts, wall.x, wall.facets, wall.f);
}

}  // namespace dovetail::dem
