// What a coupling asks of the surface that it is on: facets of a skin, or smooth patches.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "dovetail/core/archive.hpp"
#include "dovetail/dem/laws/contact_laws.hpp"
#include "dovetail/dem/walls/wall_seams.hpp"
#include "dovetail/surface/skin.hpp"
#include "dovetail/surface/smooth_surface.hpp"

namespace dovetail::surface {

/// A surface whose points (vertices, control points) nodes carry, and on which particles make contacts.
class Carrier {
public:
  virtual ~Carrier() = default;
  virtual std::unique_ptr<Carrier> clone() const = 0;

  virtual const cg::Projection& map() const = 0;     ///< points × nodes
  virtual const PatchOffsets& offsets() const = 0;   ///< of the points
  virtual std::span<const Vec3> points() const = 0;  ///< where they are, m
  /// Null if it is the other one.
  virtual const Skin* skin() const { return nullptr; }
  virtual const SmoothSurface* smooth() const { return nullptr; }

  /// @throws InputError naming what of the laws, or of a space that repeats, cannot be had on this surface
  virtual void check(const dem::ContactLaws& laws, const geometry::Periodicity& periodicity) const = 0;
  virtual void placeAll(std::span<const Vec3> u, std::span<const Vec3> v) = 0;
  /// Those points that candidates may touch.
  virtual void place(std::span<const Vec3> u, std::span<const Vec3> v) = 0;
  /// From here on `place` places the points of these contacts, which somebody else has found.
  virtual void activate(const dem::WallContacts&) {}
  /// Who may touch what before margin (m) is used up; all points are placed.
  virtual void search(const dem::Particles& particles, double margin, double reach,
                      const geometry::Periodicity& periodicity) = 0;
  /// @param travelled  bound on how far any particle and any point together have come since the search, m
  virtual void findContacts(const dem::Particles& particles, double travelled, dem::WallContacts& contacts) = 0;

  /// Where contacts, which were found last, may go on as those of other walls with this answer.
  virtual void addSeam(dem::WallContacts&, const dem::WallAnswer&, std::span<const std::uint8_t> /*absent*/,
                       std::vector<dem::WallAtSeam>&) const {}

  /// The wall that contacts are with: their facets, with positions and velocities there.
  virtual const dem::TriangulatedWall& wall() const = 0;
  /// Facets along the whole surface, where its points are now.
  virtual const dem::TriangulatedWall& outline() = 0;
  /// Adds the reaction to the contacts' forces and couples on the points, N.
  virtual void addReaction(const dem::WallContacts& contacts, coupling::NodalLoad& onPoints) const = 0;
  /// Points that a contact is with, and its weights: how fast it is shifted with them.
  virtual void follow(const dem::WallContacts& contacts, std::size_t contact,
                      std::vector<std::pair<int, double>>& points) const = 0;
  /// The same points and how fast the facet is turned with them, 1/m. Nothing where contacts exert no couples.
  virtual void turnWith(const dem::WallContacts& contacts, std::size_t contact,
                        std::vector<std::pair<int, double>>& points) const = 0;

  /// From here on these nodes carry it: points at X, m, where they are at rest. @throws InputError on smooth patches
  virtual void carry(std::vector<Vec3> X, cg::Projection map);

  virtual void save(ByteWriter& writer) const = 0;
  virtual void load(ByteReader& reader) = 0;
};

std::unique_ptr<Carrier> makeCarrier(Skin skin, dem::EdgeRule rule);
std::unique_ptr<Carrier> makeCarrier(SmoothSurface surface);

std::vector<int> sortedUnique(std::vector<int> values);

}  // namespace dovetail::surface
