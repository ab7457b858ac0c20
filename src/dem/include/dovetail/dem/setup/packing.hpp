// Packings to start from: lattices, and random ones of a given solid fraction or pressure.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "dovetail/dem/particles/particles.hpp"
#include "dovetail/dem/setup/sizes.hpp"
#include "dovetail/dem/walls/primitive_wall.hpp"
#include "dovetail/geometry/box.hpp"
#include "dovetail/geometry/hierarchical_grid.hpp"
#include "dovetail/geometry/triangle_mesh.hpp"

namespace dovetail::dem {

/// A part of a box to which spheres keep, in place of the whole of it: on the particles' side of walls, and inside a
/// closed surface with outward normals.
struct PackingRoom {
  geometry::Box box;  ///< around it, m
  std::vector<PrimitiveWall> walls{};
  geometry::TriangleMesh surface{};
  double volume = 0.0;  ///< m³; 0: the whole box
};

/// The cylinder between two planes. @param axis from one end, at `point`, towards the other, of any length
/// @throws InputError if the axis has no length, or radius or length are not finite and > 0
PackingRoom cylinderRoom(const Vec3& point, const Vec3& axis, double radius, double length);
/// @throws InputError as solidInside, if the surface is not closed
PackingRoom roomInside(geometry::TriangleMesh surface);
/// Spheres in a box.
struct Packing {
  std::vector<Vec3> centre;    ///< m
  std::vector<double> radius;  ///< m
  /// The box, and the axes along which it repeats; along the others it has walls, which no sphere crosses.
  geometry::Periodicity space;
  PackingRoom room{};  ///< if it is less than the box
  double volume() const {
    return room.volume > 0.0 ? room.volume : space.length(0) * space.length(1) * space.length(2);
  }
};

/// Σ 4/3 π R³, m³; overlaps count twice.
double volumeOf(std::span<const double> radius);
/// The same over the volume of the box or room.
double solidFraction(const Packing& packing);

/// Appends the spheres as particles. Returns the number of the first.
/// @throws InputError as addParticle
int addPacking(Particles& particles, const Packing& packing, Density density, const Vec3& velocity = {});

enum class Lattice { simpleCubic, bodyCentred, faceCentred, hexagonal };

/// A periodic block of conventional cells (1, 2, 4 spheres each; hexagonal: 4 in a right-angled cell of a, √3 a, √(8/3)
/// a).
/// @param distance between nearest centres, m
/// @throws InputError if radius or distance is not finite and > 0, or a number of cells below 1
Packing latticeBlock(Lattice lattice, const std::array<int, 3>& cells, double radius, double distance);

/// As much of a lattice as fits with whole spheres between the walls of a box, beginning in its lower corner. Along
/// periodic axes it repeats, with cells stretched by what the box differs from whole ones.
/// @throws InputError if the box is not finite, radius or distance not finite and > 0, not even one sphere fits, or a
///   period is no multiple of the cell (to 1e-6 of it), saying the nearest that is
Packing fillWithLattice(Lattice lattice, const geometry::Box& box, double radius, double distance,
                        const std::array<bool, 3>& periodic = {});

/// Report on a random packing.
struct PackingReport {
  bool reached = false;         ///< the solid fraction, or the pressure, that was asked for
  double solidFraction = 0.0;   ///< that is there
  double scale = 1.0;           ///< of the radii, < 1 where growth jammed before the sizes asked for
  double largestOverlap = 0.0;  ///< over the smaller radius of the two (or the sphere's, at a wall)
  double coordination = 0.0;  ///< mean number of contacts per sphere, walls included; touching counts up to 1e-6 radii
  double unbalanced = 0.0;    ///< mean force on a sphere over the mean contact force; 0 without contacts
  double pressure = 0.0;      ///< Pa, by compressToPressure only
  std::int64_t iterations = 0;  ///< steps of the relaxation
};

struct GrowthOptions {
  double solidFraction = 0.55;       ///< of the box or room, in (0, 0.74)
  std::int64_t number = 0;           ///< of spheres, in place of a solid fraction; 0: not given
  PackingRoom room{};                ///< in the box, which does not repeat then
  double overlap = 1e-3;             ///< largest one that is left, over the smaller radius
  std::uint64_t seed = 1;            ///< same seed, same packing
  std::int64_t iterations = 200000;  ///< given up after so many
};

/// Draws so many radii, or until the solid fraction is reached (the last one is left out if that comes closer), places
/// the spheres at random, small, and lets all of them grow in proportion (after Lubachevsky & Stillinger, J. Stat.
/// Phys. 60, 1990; here without events: soft spheres relax by FIRE, Bitzek et al., Phys. Rev. Lett. 97, 2006, after
/// each bit of growth) until they have the sizes drawn, or no bit of growth can be relaxed any more. No friction, no
/// gravity.
/// @throws InputError if the sizes or the space are not valid, the solid fraction is not in (0, 0.74), the overlap not
/// in
///   (0, 0.1], the box holds fewer than one sphere, or a sphere is wider than the box
Packing growPacking(const Sizes& sizes, const geometry::Periodicity& space, const GrowthOptions& settings,
                    PackingReport& report);

struct CompressionOptions {
  double stiffness = 1e5;   ///< of every contact, N/m
  double pressure = 1e3;    ///< wanted, Pa: a third of the trace of the stress, compression > 0
  double tolerance = 1e-3;  ///< of the pressure, relative
  std::int64_t iterations = 200000;
};

/// Changes the size of the box, isotropically and the spheres' places with it, until frictionless spheres at rest press
/// with the pressure wanted: a servo, which takes the bulk stiffness it divides by from the last two states. Just above
/// jamming, where the pressure is below about 1e-4 stiffness/diameter, spheres come to rest slowly: see
/// PackingReport::unbalanced. Gives up where a periodic box would become narrower than two diameters.
/// @throws InputError if a setting or the packing is not valid
PackingReport compressToPressure(Packing& packing, const CompressionOptions& settings);

}  // namespace dovetail::dem
