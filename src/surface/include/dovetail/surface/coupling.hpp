// The seam between particles and a solid: contacts on the skin, their loads on the nodes.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "dovetail/cg/surface_kernel.hpp"
#include "dovetail/dem/particles/particles.hpp"
#include "dovetail/dem/walls/wall_candidates.hpp"
#include "dovetail/dem/walls/wall_collide.hpp"
#include "dovetail/dem/walls/wall_contacts.hpp"
#include "dovetail/coupling/nodal_load.hpp"
#include "dovetail/surface/skin.hpp"
#include "dovetail/surface/spread_load.hpp"

namespace dovetail::surface {

struct CouplingOptions {
  dem::EdgeRule edges = dem::EdgeRule::projected;
  /// Facets within radius + margin of a particle are kept as candidates until the motion has used the margin up, m;
  /// 0 = half the smallest radius.
  double margin = 0.0;
};

/// Couples particles to the nodes of any solid through its skin. It needs the nodes' u and v and gives nodal forces;
/// whoever owns the solid makes its own time step.
///
/// Conservative pair (default): the contact's gap is that of the skin placed by the carrier S, the load goes back by
/// Sᵀ. Particles + contacts + nodes then form one Hamiltonian system: the pair creates no energy for any kernel width.
class Coupling {
public:
  /// @param skin  see makeSkin and coarseGrain
  /// @throws InputError if the margin is negative or not finite
  explicit Coupling(Skin skin, const CouplingOptions& options = {});

  /// The paper's transfer (Eqs. 14 and 15) in place of the adjoint one: the gap stays that of the local skin, the load
  /// is spread by the kernel at the contact point. Forces still balance; power does not (see wallWork).
  void spreadLoad(SpreadLoad spread) { spread_ = std::move(spread); }

  /// Place the skin, find contacts, add their forces to the particles, and set load() to the reaction on the nodes.
  /// @param u, v  displacement, m, and velocity, m/s, of all nodes of the solid
  /// @param dt    DEM step, s (for laws with history)
  template <class Law>
  dem::ContactWork exchange(dem::Particles& particles, std::span<const Vec3> u, std::span<const Vec3> v, const Law& law,
                            double dt) {
    locate(particles, u, v);
    placeSkin(u, v);
    dem::findWallContacts(particles, skin_.wall, candidates_, options_.edges, contacts_);
    const dem::ContactWork work =
        dem::detail::collide(particles, skin_.wall, contacts_, dem::prepare(law), dt, dem::Booking::on);
    bookNewContacts();
    transfer();
    return work;
  }

  /// Contact forces on the nodes of the last exchange, N.
  const coupling::NodalLoad& load() const { return load_; }
  bool inContact() const { return contacts_.size() > 0; }

  /// Work the contacts did on the moving skin, J, from the first exchange after bookWallWork(true): trapezoidal between
  /// exchanges. With the adjoint pair it equals the work of load() on the nodes.
  double wallWork() const { return wallWork_; }
  void bookWallWork(bool on) {
    booksWork_ = on;
    previous_.clear();
  }

  const Skin& skin() const { return skin_; }
  const dem::WallContacts& contacts() const { return contacts_; }
  std::int64_t candidateBuilds() const { return candidates_.builds; }

private:
  void locate(const dem::Particles& particles, std::span<const Vec3> u, std::span<const Vec3> v);
  bool marginUsed(const dem::Particles& particles, std::span<const Vec3> u) const;
  void placeSkin(std::span<const Vec3> u, std::span<const Vec3> v);
  void bookNewContacts();
  double contactWorkSinceLast() const;
  void transfer();

  Skin skin_;
  CouplingOptions options_;
  std::optional<SpreadLoad> spread_;
  dem::WallCandidates candidates_;
  dem::WallContacts contacts_;
  coupling::NodalLoad load_;
  std::vector<int> active_;                            // vertices of candidate facets
  std::vector<int> surfaceNodes_;                      // nodes that carry the skin
  std::vector<Vec3> particlesAtBuild_, nodesAtBuild_;  // positions, and those nodes' u, when the candidates were found
  double gain_;
  bool booksWork_ = false;
  double wallWork_ = 0.0;
  std::vector<Vec3> previous_;  // skin at the last exchange, only if work is booked
};

}  // namespace dovetail::surface
