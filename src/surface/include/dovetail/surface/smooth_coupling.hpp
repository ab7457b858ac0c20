// The coupling on the smooth surface: same verbs as Coupling, contact with B-spline patches.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "dovetail/core/error.hpp"
#include "dovetail/dem/laws/contact_work.hpp"
#include "dovetail/dem/particles/particles.hpp"
#include "dovetail/dem/walls/share_solver.hpp"
#include "dovetail/coupling/nodal_load.hpp"
#include "dovetail/surface/smooth_surface.hpp"

namespace dovetail::surface {

/// Contacts of particles with smooth patches.
struct SmoothContacts {
  std::vector<int> particle, face;
  std::vector<std::array<double, 16>> weight;  ///< of the face's control points; sums to one
  std::vector<Vec3> normal;                    ///< unit, from the surface to the particle
  std::vector<double> overlap, engagement;     ///< as in dem::WallContacts
  std::vector<Vec3> force;                     ///< on the particle, N

  std::size_t size() const { return particle.size(); }
  void clear();
};

/// Conservative coupling on a SmoothSurface (see there for the potential). Patches that a particle touches at once, in
/// the valleys of sharp edges, share the overlap as facets do (dem::projectWallContacts).
class SmoothCoupling {
public:
  /// @param margin  as CouplingOptions::margin
  explicit SmoothCoupling(SmoothSurface surface, double margin = 0.0);

  /// As Coupling::exchange; laws without history only.
  template <class Law>
  dem::ContactWork exchange(dem::Particles& particles, std::span<const Vec3> u, std::span<const Vec3> v, const Law& law,
                            double /*dt*/) {
    static_assert(!Law::rotates && Law::memory == 0, "tangential springs are not carried on the smooth surface");
    locate(particles, u, v);
    placeSurface(u, v);
    findContacts(particles);
    const dem::ContactWork work = collide(particles, law.normal);
    bookNewContacts();
    transfer();
    return work;
  }

  const coupling::NodalLoad& load() const { return load_; }
  bool inContact() const { return contacts_.size() > 0; }

  /// As Coupling::wallWork.
  double wallWork() const { return wallWork_; }
  void bookWallWork(bool on) {
    booksWork_ = on;
    previous_.clear();
  }

  const SmoothSurface& surface() const { return surface_; }
  const SmoothContacts& contacts() const { return contacts_; }

private:
  struct Hit {
    int face;
    PatchPoint at;
    Vec3 normal;
    double overlap;  ///< m; < 0 where the patch is farther than the radius
    double share;    ///< m
    Vec3 position;   ///< y − x, the place from which the patch is seen
  };
  void locate(const dem::Particles& particles, std::span<const Vec3> u, std::span<const Vec3> v);
  void placeSurface(std::span<const Vec3> u, std::span<const Vec3> v);
  void findContacts(const dem::Particles& particles);
  void findHits(const Vec3& x, double radius, double reach, std::span<const int> faces);
  void shareOverlap(const Vec3& x, double radius);
  void lookFrom(const Vec3& x, double radius, Hit& hit) const;
  double moveHits();
  template <class Normal>
  dem::ContactWork collide(dem::Particles& particles, const Normal& normal);
  void bookNewContacts();
  double contactWorkSinceLast() const;
  void transfer();

  SmoothSurface surface_;
  double margin_;
  SmoothContacts contacts_;
  coupling::NodalLoad load_;
  std::vector<int> active_, offsets_, candidate_;  // control points in use; candidate faces per particle (CSR)
  std::vector<int> surfaceNodes_;
  std::vector<Vec3> particlesAtBuild_, nodesAtBuild_;
  std::vector<std::array<double, 2>> start_;  // per candidate: where the last search ended
  std::vector<Hit> hits_;
  std::vector<dem::Share> shares_;
  dem::ShareSolver solver_;
  double gain_, margin0_ = 0.0;
  bool booksWork_ = false;
  double wallWork_ = 0.0;
  std::vector<Vec3> previous_;  // control points at the last exchange, only if work is booked
};

template <class Normal>
dem::ContactWork SmoothCoupling::collide(dem::Particles& particles, const Normal& normal) {
  dem::ContactWork work;
  const auto law = normal.prepare();
  for (std::size_t c = 0; c < contacts_.size(); ++c) {
    const int p = contacts_.particle[c];
    Vec3 wallVelocity;
    for (std::size_t k = 0; k < 16; ++k)
      wallVelocity += contacts_.weight[c][k] * surface_.v[surface_.control[contacts_.face[c]][k]];
    const Vec3& n = contacts_.normal[c];
    const double separating = dot(n, particles.v[p] - wallVelocity);
    const double lambda = contacts_.overlap[c];
    const double force = law.force(lambda, separating, contacts_.engagement[c], std::sqrt(particles.mass[p]));
    contacts_.force[c] = force * n;
    particles.f[p] += contacts_.force[c];
    work.elasticEnergy += law.energy(lambda, contacts_.engagement[c]);
    work.dissipatedPower += (law.elasticForce(lambda) - force) * separating;
  }
  return work;
}

}  // namespace dovetail::surface
