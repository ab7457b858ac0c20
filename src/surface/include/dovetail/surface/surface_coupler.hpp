// Between particles and a solid: contacts on its surface, their loads on the nodes.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "dovetail/core/archive.hpp"
#include "dovetail/coupling/nodal_load.hpp"
#include "dovetail/dem/laws/contact_laws.hpp"
#include "dovetail/dem/particles/particles.hpp"
#include "dovetail/dem/walls/wall_seams.hpp"
#include "dovetail/surface/contact_fractions.hpp"
#include "dovetail/surface/skin.hpp"
#include "dovetail/surface/smooth_surface.hpp"
#include "dovetail/surface/spread_load.hpp"

namespace dovetail::surface {

class Carrier;

struct CouplingOptions {
  dem::EdgeRule edges = dem::EdgeRule::projected;  ///< on facets
  /// Facets within radius + margin of a particle are kept as candidates until the motion has used the margin up, m;
  /// 0 = half the smallest radius.
  double margin = 0.0;
};

/// Optional data of an exchange.
struct ExchangeOptions {
  dem::Booking booking = dem::Booking::on;
  /// How far particles have moved since the last exchange; not given: they are compared with where they were.
  std::optional<dem::Moves> moves{};
  geometry::Periodicity periodicity{};
  /// Of an overlap with the same solid: the solid's fraction 1 − w per node. Contacts act with the fraction at their
  /// point; the change of their stored energy with it is booked (madeByWeights). Empty: all act in full.
  std::span<const double> fraction{};
  /// Marks of particles that are tied to the solid and have no contact with its surface: one entry per particle, 0 =
  /// not tied.
  std::span<const std::uint8_t> tied{};
};

/// Couples particles to the nodes of any solid through its surface. It takes the nodes' u and v and returns nodal
/// forces; the owner of the solid integrates its motion.
///
/// Conservative pair (default): the contact's gap is that of the surface placed by its carrier, the load goes back by
/// the transpose. Particles + contacts + nodes then form one Hamiltonian system: the pair creates no energy for any
/// kernel width, and forces and moments of contact balance at any turn. Couples of rolling and twisting act on the
/// nodes as forces on the facet's vertices (dem::FacetSpin).
class SurfaceCoupler {
public:
  /// @param skin  see makeSkin and coarseGrain; skin.wall.material is its row in a table of laws
  /// @throws InputError if the margin is negative or not finite
  explicit SurfaceCoupler(Skin skin, const CouplingOptions& options = {});
  /// On smooth patches, see there for the potential. Patches that a particle touches at once, in the valleys of sharp
  /// edges, share the overlap as facets do (dem::projectWallContacts). For laws without memory.
  explicit SurfaceCoupler(SmoothSurface surface, const CouplingOptions& options = {});
  ~SurfaceCoupler();
  SurfaceCoupler(const SurfaceCoupler&);
  SurfaceCoupler(SurfaceCoupler&&) noexcept;
  SurfaceCoupler& operator=(const SurfaceCoupler&);
  SurfaceCoupler& operator=(SurfaceCoupler&&) noexcept;

  /// The paper's transfer (Eqs. 14 and 15) in place of the adjoint one: the gap stays that of the local skin, the load
  /// is spread by the kernel at the contact point. Forces still balance; power does not (see wallWork).
  void spreadLoad(SpreadLoad spread) { spread_ = std::make_shared<SpreadLoad>(std::move(spread)); }

  /// From here on other nodes carry the facets: vertices at X, m, while u = 0, vertices × nodes in `map`. Contacts
  /// stay. A state fits any nodes then: carry() those of the state after load().
  /// @throws InputError for a map of another size, on smooth patches or a skin with a kernel
  void carry(std::vector<Vec3> X, cg::Projection map);
  /// Candidates are found anew in the next exchange: u has another origin.
  void searchAnew() { nodesAtBuild_.clear(); }

  /// Places the surface, finds contacts, adds their forces to the particles, and sets load() to the reaction on the
  /// nodes.
  /// @param u, v  displacement, m, and velocity, m/s, of all nodes of the solid
  /// @param dt    DEM step, s (for laws with memory)
  /// @throws InputError as check does, or for fields that are shorter than the solid; NumericalError naming a particle
  ///         or node that is not finite, or a particle that has sunk deeper into a closed skin than its radius
  dem::ContactWork exchange(dem::Particles& particles, std::span<const Vec3> u, std::span<const Vec3> v,
                            const dem::ContactLaws& laws, double dt, const ExchangeOptions& options = {});

  /// The parts of an exchange: contacts, the solid's weight in them, their forces, and the energy of changed fractions.
  /// In between, contacts are joined with those of other walls, and those of a surface of several parts are distributed
  /// to the parts.
  void find(const dem::Particles& particles, std::span<const Vec3> u, std::span<const Vec3> v, double reach,
            const ExchangeOptions& options);
  void addSeam(const dem::WallAnswer& answer, const ExchangeOptions& options, std::vector<dem::WallAtSeam>& seams);
  void weigh(const dem::Particles& particles, const ExchangeOptions& options);
  void addAnswered(const dem::WallAnswer& answer, std::vector<dem::AnsweredContacts>& walls) {
    walls.push_back({&contacts_, answer});
  }
  dem::ContactWork answer(dem::Particles& particles, std::span<const Vec3> u, const dem::ContactLaws& laws, double dt,
                          const ExchangeOptions& options);
  void bookWeights(const ExchangeOptions& options);

  /// Contact forces on the nodes of the last exchange, N.
  const coupling::NodalLoad& load() const { return load_; }
  bool inContact() const { return contacts_.size() > 0; }

  /// Work the contacts did on the moving surface, J, from the first exchange after bookWallWork(true): trapezoidal
  /// between exchanges. With the adjoint pair it is the work of load() on the nodes.
  double wallWork() const { return wallWork_; }
  void bookWallWork(bool on) {
    booksWork_ = on;
    previous_.clear();
    uBefore_.clear();
  }
  /// Work of load() on the nodes less that of the contacts on the surface, J, if they are booked: what a transfer that
  /// is not adjoint has made.
  double madeByTransfer() const { return nodeWork_ - wallWork_; }
  /// What changes of the solid's weight (ExchangeOptions) have given to contacts so far, J.
  double madeByWeights() const { return fractions_.made; }

  /// @throws InputError naming the feature of the laws or of periodic space that this surface does not support
  void check(const dem::ContactLaws& laws, const geometry::Periodicity& periodicity = {}) const;
  /// @throws InputError for contacts of particles that do not exist, as in a damaged state
  void check(const dem::Particles& particles) const;
  /// Renumbers the particles, < 0: removed; the memory of their contacts follows. @return as dem::renumber, J
  double renumber(std::span<const int> newNumber);
  /// Adds the contacts of the last exchange to the demand on the step and the nodes: k |S_i| of node i (see
  /// ContactStep). Moments count as contacts of their own: k = k_r/R², S_i = R × the rate at which i turns the facet.
  /// @param side  of the demand, whose masses are the nodes
  void addDemand(dem::ContactDemand& demand, const dem::Particles& particles, const dem::ContactLaws& laws,
                 int side) const;
  /// The largest Σ_i S_i²/m_i of any point of the surface, 1/kg (an upper bound on a smooth one): a single particle on
  /// it has ω² = k (1/m + that).
  double largestMobility(std::span<const double> inverseMass) const;

  bool onFacets() const;
  /// Whether some node carries both.
  bool meets(const SurfaceCoupler& other) const;
  /// Where it is: one of the two; the other is an error. @throws InputError
  const Skin& skin() const;
  const SmoothSurface& smoothSurface() const;
  const dem::WallContacts& contacts() const { return contacts_; }
  /// See dem::forgetVelocities.
  void forgetVelocities(int springs) { dem::forgetVelocities(contacts_, springs); }
  /// The wall whose facets the contacts are with.
  const dem::TriangulatedWall& wall() const;
  /// The whole surface as facets (between the control points, of smooth patches), placed as told.
  const dem::TriangulatedWall& outline(std::span<const Vec3> u, std::span<const Vec3> v);
  int nodeCount() const;
  const CouplingOptions& options() const { return options_; }
  /// @throws InputError unless the nodes at X, m, have the surface where it is
  void requireFits(std::span<const Vec3> X) const;
  std::int64_t candidateBuilds() const { return builds_; }

  /// The state needed for an exact restart.
  void save(ByteWriter& writer) const;
  void load(ByteReader& reader);

private:
  void locate(const dem::Particles& particles, std::span<const Vec3> u, std::span<const Vec3> v, double reach,
              const ExchangeOptions& options);
  bool marginUsed(const dem::Particles& particles, std::span<const Vec3> u, double reach,
                  const ExchangeOptions& options);
  void take(const SurfaceCoupler& whole, int first, double reach, std::span<const Vec3> u, std::span<const Vec3> v);
  void placeSurface(std::span<const Vec3> u, std::span<const Vec3> v);
  double fractionAt(std::size_t contact, std::span<const double> fraction) const;
  void requireNoneThrough(const dem::Particles& particles, std::span<const std::uint8_t> tied);
  double workSinceLast() const;
  double nodeWorkSinceLast(std::span<const Vec3> u) const;
  void transfer();
  template <class Archive, class Self>
  static void archive(Archive& archive, Self& self);

  /// A copy has a copy of it.
  class OwnCarrier {
  public:
    explicit OwnCarrier(std::unique_ptr<Carrier> carrier);
    ~OwnCarrier();
    OwnCarrier(const OwnCarrier& other);
    OwnCarrier(OwnCarrier&&) noexcept;
    OwnCarrier& operator=(OwnCarrier other) noexcept;
    Carrier* operator->() const { return carrier_.get(); }
    Carrier& operator*() const { return *carrier_; }

  private:
    std::unique_ptr<Carrier> carrier_;
  };

  friend class SolidSurface;

  OwnCarrier carrier_;
  CouplingOptions options_;
  std::shared_ptr<SpreadLoad> spread_;  // keeps nothing from call to call, so copies may share it
  dem::WallContacts contacts_;
  coupling::NodalLoad onPoints_, load_;
  ContactFractions fractions_;
  std::vector<int> sunk_;          // particles whose centres were inside at the last evaluation, ascending
  std::vector<int> surfaceNodes_;  // that carry the surface
  bool changesNodes_ = false;      // carry() has been called
  double gain_;

  // What candidates were found for.
  std::int64_t builds_ = 0, revision_ = -1;
  double marginAtBuild_ = 0.0, reachAtBuild_ = 0.0;
  double travelled_ = 0.0;  // since the search, particles and points together, m
  Vec3 periodAtBuild_;
  std::vector<Vec3> particlesAtBuild_, nodesAtBuild_;  // nodes' u
  dem::ParticleTravel travel_;

  bool booksWork_ = false;
  double wallWork_ = 0.0, nodeWork_ = 0.0;
  std::vector<Vec3> previous_, uBefore_;  // points, and u, at the last exchange, only if work is booked
};

}  // namespace dovetail::surface
