// Contacts of grains with the surface of a solid, as a connector of a run.
#pragma once

#include <memory>
#include <string>

#include "dovetail/coupling/connector.hpp"
#include "dovetail/surface/coupling.hpp"

namespace dovetail::surface {

/// What a Coupling does, done between the particles of a model and the nodes of a solid. What contacts store and lose
/// is in the books of the particles' model (dem::Model::work), as with walls. Dashpots are booked with both the
/// velocity before and the one after the kick, of particle and surface, as the laws do for all contacts.
class SurfaceContact final : public coupling::Connector {
public:
  /// @param coupling  on the skin, or the smooth surface, of side's mesh
  /// @param laws      between particles and surface; skin.wall.material is the surface's row in their table
  /// @param name      in ledgers, errors and profiles
  /// @throws InputError if the surface belongs to a mesh with another number of nodes, there are no laws, or they
  ///         cannot be had on this surface
  SurfaceContact(coupling::SolidSide& side, Coupling coupling, std::shared_ptr<const dem::ContactLaws> laws,
                 std::string name = "surface contacts");

  const Coupling& coupling() const { return coupling_; }
  const dem::ContactLaws& laws() const { return *laws_; }

  std::string name() const override { return name_; }
  std::unique_ptr<dem::Term> clone() const override { return std::make_unique<SurfaceContact>(*this); }
  /// What a transfer that is not adjoint has taken, if its work is booked (Coupling::bookWallWork).
  double lost() const override { return -coupling_.madeByTransfer(); }
  void check(const dem::Model& m) const override;
  void surround(dem::Surroundings& around) override;
  double renumber(std::span<const int> newNumber, const dem::Particles& before) override;
  void addForces(dem::Model& m, const dem::Step& step) override;
  void addDemand(const dem::Model& m, dem::ContactDemand& demand) const override;
  void addContacts(const dem::Model& m, dem::ContactSample& sample) const override;
  void save(ByteWriter& writer) const override;
  void load(ByteReader& reader) override;

private:
  Coupling coupling_;
  std::shared_ptr<const dem::ContactLaws> laws_;
  std::string name_;
};

}  // namespace dovetail::surface
