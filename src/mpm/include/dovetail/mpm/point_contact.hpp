// Contact of material points with grains, walls and other bodies of points: a sphere at every point.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "dovetail/coupling/connector.hpp"
#include "dovetail/mpm/point_solid.hpp"

namespace dovetail::mpm {

struct SphereOptions {
  double radius = 0.0;  ///< m; half the distance of points at the start is usual
  int material = 0;     ///< row of the contact laws
};

/// Particles of the run that stand for the points of a solid: they go where the nodes bring them, with the velocity of
/// the grid there and half of its curl for spin, and the forces on them go to the nodes by the same weights, torques as
/// couples by the gradients. So both powers are equal, and sums of forces and moments are kept. They meet grains, walls
/// and points of other solids by the contact laws of the run, and never each other.
///
/// Their mass, motion and weight are those of the solid.
class PointContact final : public coupling::Connector {
public:
  /// For particles that have been added: see addSpheres.
  PointContact(coupling::SolidSide& side, std::shared_ptr<const PointSolid> points, std::vector<std::int64_t> ids)
      : Connector(side), points_(std::move(points)), ids_(std::move(ids)) {}

  std::string name() const override { return "contact of " + points_->name(); }
  std::unique_ptr<dem::Term> clone() const override { return std::make_unique<PointContact>(*this); }
  Order order() const override { return Order::bodies; }
  bool followsNodes() const override { return true; }
  std::span<const std::int64_t> placed() const override { return ids_; }

  void check(const dem::Model& m) const override;
  void own(dem::Particles& particles) const override;
  double placeParticles(dem::Model& m, std::span<const Vec3> v) override;
  void close(dem::Model& m, double dt) override;
  void neighbourListUpdated(dem::Model& m) override;
  void leaving(dem::Model& m, std::vector<char>& leaves) override;
  void addForces(dem::Model& m, const dem::Step& step) override;
  void addOwnForces(dem::ContactDemand& demand, double rate) const override;
  void addEnergies(const dem::Model& m, dem::Energies& e) const override;
  void addMomenta(const dem::Model& m, Momenta& sums) const override;
  /// What borders of the grid take of contact forces near them, and add to them.
  void addOutside(const dem::Model& m, Momenta& force, Momenta& impulse) const override;

  /// Numbers of the particles, in the order of points.
  const std::vector<int>& numbers(const dem::Particles& particles) const;

private:
  std::shared_ptr<const PointSolid> points_;
  std::vector<std::int64_t> ids_;
  Momenta ofBorders_;
  mutable std::vector<int> number_;
  mutable std::int64_t located_ = -1;
};

/// Adds a sphere for every point, and the term. Stiff laws of these spheres set the step: k = M d in space, with the
/// confined modulus M and the distance d of points (k = M thickness in the plane), is as stiff as the solid.
/// @throws InputError for no points, or a radius that is not positive; the run must not have started
PointContact& addSpheres(dem::Model& grains, coupling::SolidSide& side, std::shared_ptr<const PointSolid> points,
                         const SphereOptions& options);

}  // namespace dovetail::mpm
