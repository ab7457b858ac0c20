// Walls of a model.
#pragma once

#include "dovetail/dem/model/model.hpp"
#include "dovetail/dem/walls/mesh_wall.hpp"
#include "dovetail/dem/walls/primitive_wall.hpp"

namespace dovetail::dem {

/// How far the particles of a model have moved, for lists of what is near a wall.
Moves movesOf(const Model& m, const Step& step);

/// A plane, cylinder or sphere that particles can touch.
class PrimitiveWallTerm final : public Term {
public:
  explicit PrimitiveWallTerm(PrimitiveWall w) : wall(std::move(w)) {}
  PrimitiveWall wall;
  bool present = true;  ///< else it touches nothing, and a servo rests; setPresent changes it between steps
  double stored = 0.0;  ///< in its contacts now, J

  std::string name() const override { return "walls"; }
  std::unique_ptr<Term> clone() const override { return std::make_unique<PrimitiveWallTerm>(*this); }
  std::string code() const override;
  void check(const Model& m) const override;
  double move(Model& m, const Step& step) override;
  void surround(Surroundings& around) override;
  double renumber(std::span<const int> newNumber, const Particles& before) override;
  void addForces(Model& m, const Step& step) override;
  void close(Model& m, double dt) override;
  void forgetVelocities(int springs) override {
    detail::forgetVelocities(wall.contacts.memory, wall.contacts.size(), springs);
  }
  void addDemand(const Model& m, ContactDemand& demand) const override;
  void addPartners(const Model& m, std::vector<ImpactPartner>& partners) const override;
  void addEnergies(const Model& m, Energies& e) const override;
  void addOutside(const Model& m, Momenta& force, Momenta& impulse) const override;
  void addContacts(const Model& m, ContactSample& sample) const override;
  void save(ByteWriter& writer) const override;
  void load(ByteReader& reader) override;
};

/// A triangulated wall that particles can touch.
class MeshWallTerm final : public Term {
public:
  explicit MeshWallTerm(MeshWall m) : mesh(std::move(m)) {}
  MeshWall mesh;
  bool present = true;  ///< as that of a PrimitiveWallTerm
  double stored = 0.0;  ///< in its contacts now, J

  std::string name() const override { return "mesh walls"; }
  std::unique_ptr<Term> clone() const override { return std::make_unique<MeshWallTerm>(*this); }
  std::string code() const override;
  void check(const Model& m) const override;
  double move(Model& m, const Step& step) override;
  void surround(Surroundings& around) override;
  double renumber(std::span<const int> newNumber, const Particles& before) override;
  void findFacetContacts(Model& m, const Step& step, std::vector<WallAtSeam>& seams) override;
  void takeFacetContacts(Model& m, const Step& step, std::vector<AnsweredContacts>& walls) override;
  void addForces(Model& m, const Step& step) override;
  void close(Model& m, double dt) override;
  void forgetVelocities(int springs) override { dem::forgetVelocities(mesh.contacts, springs); }
  void addDemand(const Model& m, ContactDemand& demand) const override;
  void addPartners(const Model& m, std::vector<ImpactPartner>& partners) const override;
  void addEnergies(const Model& m, Energies& e) const override;
  void addOutside(const Model& m, Momenta& force, Momenta& impulse) const override;
  void addContacts(const Model& m, ContactSample& sample) const override;
  void save(ByteWriter& writer) const override;
  void load(ByteReader& reader) override;
};

/// The wall in the model.
inline PrimitiveWall& addWall(Model& m, PrimitiveWall wall) {
  return m.terms.add(PrimitiveWallTerm(std::move(wall))).wall;
}
inline MeshWall& addWall(Model& m, MeshWall wall) { return m.terms.add(MeshWallTerm(std::move(wall))).mesh; }

/// A rigid solid that moves freely under gravity and its contacts: a wall on a body of its own (bodies(m)), with the
/// mass properties of what it encloses or of the caller's own, described in the frame in which the wall lies now. Such
/// walls have contact with particles only.
/// @param v m/s @param omega rad/s, in space
/// @throws InputError as solidInside and addBody
MeshWall& addFreeWall(Model& m, TriangulatedWall wall, Density density, const Vec3& v = {}, const Vec3& omega = {});
MeshWall& addFreeWall(Model& m, TriangulatedWall wall, const MassProperties& properties, const Vec3& v = {},
                      const Vec3& omega = {});

/// Removes a wall; the energy of its contacts is booked as left. The body of a free wall stays, without contacts.
/// @throws InputError if it is not the model's
void removeWall(Model& m, const PrimitiveWall& wall);
void removeWall(Model& m, const MeshWall& mesh);

/// Takes a wall away or puts it back, where its motion has it. Find forces anew before the next step: the energy of its
/// contacts is then booked as entered. It keeps its number.
void setPresent(PrimitiveWallTerm& term, bool present);
void setPresent(MeshWallTerm& term, bool present);

/// Wall number i of its kind, in the order in which they were added. @throws InputError if there is none
PrimitiveWall& primitiveWall(Model& m, std::size_t i);
const PrimitiveWall& primitiveWall(const Model& m, std::size_t i);
MeshWall& meshWall(Model& m, std::size_t i);
const MeshWall& meshWall(const Model& m, std::size_t i);

}  // namespace dovetail::dem
