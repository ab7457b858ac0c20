// Averages over a volume: solid fraction, coordination, fabric, and the stress after Love and Weber.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "dovetail/cg/fields.hpp"
#include "dovetail/core/vec3.hpp"

namespace dovetail::cg {

/// A box to average over, m.
struct AverageBox {
  Vec3 lower, upper;
  double volume() const { return (upper.x - lower.x) * (upper.y - lower.y) * (upper.z - lower.z); }
};

/// Volume of the part of a sphere that lies in a box, m³: exact areas of the slices, Gauss–Legendre across them between
/// the heights where the slices change in kind; accurate to 1e-11 of the sphere's volume.
/// @throws InputError unless lower < upper, all is finite, and the radius is > 0
double sphereInBox(const Vec3& centre, double radius, const AverageBox& box);

/// Fraction of the box that spheres fill; overlaps count twice. Porosity is 1 minus this.
/// @throws InputError as sphereInBox, or if the spans do not match
double solidFraction(std::span<const Vec3> x, std::span<const double> radius, const AverageBox& box);

/// How many contacts particles have.
struct Coordination {
  std::vector<int> contacts;     ///< per particle, walls included
  double mean = 0.0;             ///< of all particles
  int rattlers = 0;              ///< particles that are left with fewer than `least` contacts
  double withoutRattlers = 0.0;  ///< mean of the others, of the contacts among them and with walls
  std::vector<char> isRattler;   ///< per particle
};

/// @param first, second the particles of each contact; second < 0 for a wall
/// @param least contacts below which a particle does not take part in carrying load: 4 for frictionless spheres in
/// space,
///   2 with friction. Those that fall below it when others leave, leave too.
/// @throws InputError if the spans do not match, a number is out of range, or least < 0
Coordination coordination(std::span<const int> first, std::span<const int> second, int particles, int least = 4);

/// Fabric (1/N) Σ n ⊗ n of N contact normals: trace 1, one third of the identity where no direction is preferred
/// (Satake 1982; Oda 1982). Zero without contacts.
Eigen::Matrix3d fabric(std::span<const Vec3> normal);

/// The same at points, weighted with the kernel at the contact points: Σ n ⊗ n W / Σ W; zero where no contact is near.
/// @throws InputError for an invalid kernel or spans that do not match
std::vector<Eigen::Matrix3d> fabricField(const Kernel& kernel, std::span<const Vec3> points,
                                         std::span<const Vec3> contact, std::span<const Vec3> normal);

/// Stress averaged over a volume, Pa, positive in tension; (row, column) = (component of force, direction of the
/// normal).
struct AverageStress {
  Eigen::Matrix3d contact = Eigen::Matrix3d::Zero();
  Eigen::Matrix3d kinetic = Eigen::Matrix3d::Zero();
  Eigen::Matrix3d total() const { return contact + kinetic; }
  /// −⅓ trace of the total, Pa
  double pressure() const { return -total().trace() / 3.0; }
};

/// −(1/V) Σ f ⊗ (from − to) over all branches (Love 1927; Weber 1966), and −(1/V) Σ m v′ ⊗ v′ over all particles, v′
/// from their mean velocity. For a whole specimen, or a periodic cell with its contacts across the border once.
/// @throws InputError if the volume is not finite and > 0, or spans do not match
AverageStress loveWeberStress(const BranchView& branches, const ParticleView& particles, double volume);

/// The same for a box within the specimen: each branch counts with the fraction of its length that lies in the box,
/// each particle if its centre does. This is the exact average over the box of the stress of straight branches
/// (Fields::contactStress in the limit of no width), and boxes side by side add up to the whole.
/// @throws InputError as above, or unless lower < upper
AverageStress loveWeberStress(const BranchView& branches, const ParticleView& particles, const AverageBox& box);

}  // namespace dovetail::cg
