// Contacts of grains with the surface of a solid, as a connector of a run.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "dovetail/coupling/connector.hpp"
#include "dovetail/surface/solid_surface.hpp"
#include "dovetail/surface/surface_coupler.hpp"

namespace dovetail::surface {

/// A SurfaceCoupler between the particles of a model and the nodes of a solid. Energy that contacts store and lose is
/// in the ledger of the particles' model (dem::Model::work), as with walls. Dashpots are booked with both the velocity
/// before and the one after the kick, of particle and surface, as the laws do for all contacts.
///
/// A solid has one surface: those on one solid are parts of it, each with its faces, law, material and kernel. The
/// first of them in the model finds the contacts of all, one per place also where parts meet, and owns the data common
/// to all. In an overlap of the same solid contacts act with the solid's weight, and tied particles have no contact
/// with the surface. A smooth surface cannot be a part, and must not touch another.
class SurfaceContact : public coupling::Connector {
public:
  /// @param coupling  on the skin, or the smooth surface, of side's mesh
  /// @param laws      between particles and surface; skin.wall.material is the surface's row in their table
  /// @param name      in ledgers, errors and profiles
  /// @throws InputError if the surface is not at the nodes of the solid, there are no laws, or the surface does not
  /// support them
  SurfaceContact(coupling::SolidSide& side, SurfaceCoupler coupling, std::shared_ptr<const dem::ContactLaws> laws,
                 std::string name = "surface contacts");

  const SurfaceCoupler& coupling() const { return coupling_; }
  const dem::ContactLaws& laws() const { return *laws_; }

  /// Of the contacts on the solid in the last evaluation, N, and their moment, N m, about a point, m.
  virtual Momenta onSolid(const Vec3& about) const;

  std::string name() const override { return name_; }
  std::unique_ptr<dem::Term> clone() const override { return std::make_unique<SurfaceContact>(*this); }
  /// Energy taken by a transfer that is not adjoint, if its work is booked (SurfaceCoupler::bookWallWork), and changes
  /// of the solid's weight.
  double lost() const override;
  void check(const dem::Model& m) const override;
  void surround(dem::Surroundings& around) override;
  double renumber(std::span<const int> newNumber, const dem::Particles& before) override;
  void findFacetContacts(dem::Model& m, const dem::Step& step, std::vector<dem::WallAtSeam>& seams) override;
  void takeFacetContacts(dem::Model& m, const dem::Step& step, std::vector<dem::AnsweredContacts>& walls) override;
  void addForces(dem::Model& m, const dem::Step& step) override;
  void forgetVelocities(int springs) override { coupling_.forgetVelocities(springs); }
  void addDemand(const dem::Model& m, dem::ContactDemand& demand) const override;
  void addPartners(const dem::Model& m, std::vector<dem::ImpactPartner>& partners) const override;
  void addContacts(const dem::Model& m, dem::ContactSample& sample) const override;
  void save(ByteWriter& writer) const override;
  void load(ByteReader& reader) override;

protected:
  /// On a surface whose nodes are not simply those of the solid: see the virtual calls below.
  SurfaceContact(coupling::SolidSide& side, std::shared_ptr<const dem::ContactLaws> laws, std::string name,
                 SurfaceCoupler coupling);

  /// Of what carries the surface.
  struct Motion {
    std::span<const Vec3> u, v;  ///< m, m/s
  };
  /// Now; of the solid's nodes unless told otherwise.
  virtual Motion carrying() { return {side().nodes().u, side().nodes().v}; }
  /// Adds what the exchange has put on the nodes that carry the surface to the side.
  virtual void loadSide();
  /// Values of the solid's nodes at those that carry the surface.
  virtual std::vector<double> ofCarrying(std::vector<double> ofNodes) const { return ofNodes; }
  SurfaceCoupler& coupler() { return coupling_; }

private:
  /// The terms of a model that have a part of the solid's surface or share its volume. Copies and moved objects find
  /// them anew.
  struct Company {
    Company() = default;
    Company(const Company&) {}
    Company& operator=(const Company& other) = default;

    const dem::Terms* terms = nullptr;
    std::int64_t revision = 0;
    std::vector<SurfaceContact*> parts;  ///< all of them if this is the first, else none
    std::vector<const coupling::Connector*> overlaps;
    std::vector<double> fraction;  ///< 1 − w per node; empty without overlaps
  };

  std::vector<const SurfaceContact*> partsIn(const dem::Model& m) const;
  void join(dem::Model& m);
  void rejoin(std::vector<std::int64_t> ids);
  void requireJoinable(std::span<const SurfaceContact* const> parts) const;
  std::vector<SurfacePart> surfaceParts() const;
  dem::WallAnswer answered() const { return {laws_.get(), coupling_.wall().material}; }
  ExchangeOptions exchangeOptions(const dem::Model& m, const dem::Step& step) const;
  template <class Call>
  void naming(const dem::Step& step, Call&& call) const;

  SurfaceCoupler coupling_;
  std::shared_ptr<const dem::ContactLaws> laws_;
  std::string name_;
  std::int64_t id_;  // of it and its copies
  Company company_;
  std::optional<SolidSurface> surface_;  // of several parts
  std::vector<std::int64_t> surfaceOf_;  // their numbers
  double booked_ = 0.0;                  // J, made by fractions on surfaces of other parts
  std::vector<char> state_;              // of a surface that is yet to be made
  std::vector<std::uint8_t> tied_;
};

}  // namespace dovetail::surface
