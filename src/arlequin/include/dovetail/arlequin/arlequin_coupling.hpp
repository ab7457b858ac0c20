// Particles and a solid that share an overlap, as a connector of a run.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "dovetail/arlequin/coupling_options.hpp"
#include "dovetail/arlequin/overlap.hpp"
#include "dovetail/coupling/connector.hpp"

namespace dovetail::arlequin {

/// What an overlap looks like now.
struct OverlapState {
  std::size_t members = 0;       ///< particles that are tied
  std::size_t rows = 0;          ///< of the gap operator
  std::size_t voids = 0;         ///< elements within the overlap (w > 0 at all corners) that hold no particle
  std::int64_t relocations = 0;  ///< number of times that a particle was located anew
  std::int64_t admitted = 0;     ///< particles that came in
  std::int64_t removed = 0;      ///< particles that passed the border of the particles and left the scene
  /// Particles found within the solid so far that are not tied: members of clumps, or particles that entered where the
  /// particles' weight is zero. They keep their full weight and pass through.
  std::int64_t strangers = 0;
  std::int64_t firstStranger = -1;  ///< its id
  Vec3 strangerAt;                  ///< where that was first seen, m
};

/// Ties particles to the solid where both are: the gap g = Π(x − Φ x_FE) is held by a penalty, multipliers or a dashpot
/// (CouplingOptions). On implicit solids a penalty acts at every step of the particles, multipliers and dashpots at the
/// ends of macro steps. Particles::weight holds the particles' weight w, pairs the weight at their contact.
///
/// A particle is tied to the material point of the solid that it was located at. If it moves relative to that by more
/// than a tenth of its radius, it is located anew: λ is kept, and its part of the gap is kept in the rows, where it
/// rotates with the solid. A gap longer than a tenth of the mean radius (by mass) about a row slips, and the energy
/// that the penalty stored in the excess is lost. Very small particles among much larger ones are not tied. A change of
/// weight adds or removes mass at the solid's velocity, which is booked as entered or left (dem::Model); the momentum
/// relative to the solid goes to the nodes by Φᵀ. Particles that approach the mesh from outside get their weight when
/// they are found there, and are tied at once, without a gap of their own; those whose weight falls below
/// CouplingOptions::leastWeight are removed. Rows per element are not updated: their particles stay as located.
class ArlequinCoupling final : public coupling::Connector {
public:
  ArlequinCoupling(const ArlequinCoupling& other);
  ArlequinCoupling(ArlequinCoupling&&) noexcept;
  ~ArlequinCoupling() override;

  std::string name() const override { return "overlap"; }
  std::string code() const override { return "a mesh and a solid"; }
  std::unique_ptr<dem::Term> clone() const override { return std::make_unique<ArlequinCoupling>(*this); }
  Order order() const override;
  void check(const dem::Model& m) const override;
  double move(dem::Model& m, const dem::Step& step) override;
  void exchange(dem::Model& m, const dem::Step& step) override;
  void neighbourListUpdated(dem::Model& m) override;
  double renumber(std::span<const int> newNumber, const dem::Particles& before) override;
  void addForces(dem::Model& m, const dem::Step& step) override;
  void book(dem::Model& m, const dem::Step& step) override;
  /// A safe bound with the penalty on both sides; multipliers need none.
  void addDemand(const dem::Model& m, dem::ContactDemand& demand) const override;
  void save(ByteWriter& writer) const override;
  void load(ByteReader& reader) override;

  void constrainMacroStep(const dem::Model& m, std::span<const Vec3> ownForce, double half, std::span<Vec3> onParticles,
                          coupling::NodalLoad& load) const override;
  std::vector<double> solidWeight() const override;
  void markTied(std::span<std::uint8_t> tied) const override;
  double stored() const override;
  double lost() const override;
  double absorbed() const;  ///< the part of it that the absorber took, J

  /// force += what a penalty does against the motions, m, of all particles and nodes, N.
  void addStiffness(const dem::Model& m, std::span<const Vec3> particles, std::span<const Vec3> nodes,
                    std::span<Vec3> onParticles, std::span<Vec3> onNodes) const;

  const Overlap& overlap() const;
  const GapOperator& operators() const;
  std::span<const Vec3> gap() const;     ///< per row, m
  std::span<const Vec3> lambda() const;  ///< per row, N: pulls the particles back and the nodes along
  OverlapState state() const;

private:
  friend std::unique_ptr<ArlequinCoupling> makeArlequinCoupling(dem::Model& grains, const fem::SolidMesh& mesh,
                                                                std::vector<double> nodalWeight,
                                                                coupling::SolidSide& side,
                                                                const CouplingOptions& options);
  explicit ArlequinCoupling(coupling::SolidSide& side);
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Locates the overlap, sets Particles::weight, and makes the tie; the caller adds it to the run (or to grains.terms).
/// Particles of the model that are already weighed by another overlap keep their weight and are not tied.
/// @param nodalWeight  w per node of the mesh; the elements of the solid must have the weight 1 − w
/// @param side         its mass may be set later
/// @throws InputError as locateOverlap and requireWidth do; for a mesh that is not the solid's, a weight of the solid
/// that is not 1 − w, mid nodes that
///   are not levelled, a particle with less than leastWeight (beyond the border of the particles), members of clumps,
/// kernels in periodic space, particles that all belong to another overlap, an automatic penalty for a field of points
/// without a known modulus, kernels wider than 2.5 elements with more than 4000 rows
std::unique_ptr<ArlequinCoupling> makeArlequinCoupling(dem::Model& grains, const fem::SolidMesh& mesh,
                                                       std::vector<double> nodalWeight, coupling::SolidSide& side,
                                                       const CouplingOptions& options = {});

/// Numbers of the particles within the mesh whose weight is below leastWeight: remove them before the coupling is made.
std::vector<int> particlesBeyond(const dem::Model& grains, const fem::SolidMesh& mesh, const fem::Nodes& nodes,
                                 std::span<const double> nodalWeight,
                                 double leastWeight = CouplingOptions{}.leastWeight);

}  // namespace dovetail::arlequin
