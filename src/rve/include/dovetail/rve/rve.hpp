// A cell of grains: what it is, what it is like now, and the verbs that change that.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "dovetail/core/vec3.hpp"
#include "dovetail/geometry/lattice.hpp"
#include "dovetail/rve/bonds.hpp"
#include "dovetail/rve/frame.hpp"
#include "dovetail/rve/springs.hpp"

namespace dovetail::rve {

/// Discs are cylinders that stay in the plane z = 0 and turn about z: in arrays by component x, y and, of spins and
/// torques, z are in use, the others empty. A disc cell answers for F in the plane, F₃₃ = 1.
enum class Shape { disc, sphere };

using Components = std::array<std::vector<double>, 3>;

/// Pairs of grains i < j that may touch before the list is made anew, in the order of i, j and image; those of grain i
/// are first[i] … first[i + 1] − 1. A contact's branch is b = x_j + H n − x_i.
struct Contacts {
  std::vector<int> first{0};
  std::vector<int> other;           ///< j
  std::vector<std::uint8_t> image;  ///< (n₀ + 1) + 3 (n₁ + 1) + 9 (n₂ + 1), n of −1, 0, 1
  std::vector<double> stiffness;  ///< k_n, N/m (elastic spheres: k_n/√δ); in a framed cell times the fraction of the
                                  ///< contact that lies here
  Components stretch;             ///< of the tangential spring, m; discs: the first alone, along e_z × n
  std::vector<double> roll;       ///< of the rolling spring, rad; empty where grains roll freely
  std::vector<double> tangent;    ///< k_t of elastic spheres that slide, N/m, as it was last; else empty
  std::vector<Bond> bond;         ///< empty if there are none; bonded contacts have `stiffness` 0

  std::size_t size() const { return other.size(); }
};

/// Energies (J) since the cell was made: what the boundary has put in, and where it has gone for good.
struct RveLedger {
  double work = 0.0;      ///< ∫ V σ : sym(L) dt, and what other springs store (setSprings)
  double friction = 0.0;  ///< slipping springs
  double damping = 0.0;   ///< of the fluctuations, and motion that relaxing has taken
  double bonds = 0.0;     ///< what was stored in bonds that broke and is not in the contacts that they are now
};

/// All that changes. Copies are snapshots: a cell that gets one back goes on with the same digits.
struct CellState {
  geometry::Lattice lattice;                        ///< H, m
  Eigen::Matrix3d F = Eigen::Matrix3d::Identity();  ///< since the cell was made
  Components x;                                     ///< centres, m
  Components v;                                     ///< m/s, fluctuations: ẋ = L x + v; turn with the cell
  Components spin;                                  ///< rad/s, fluctuations: on top of the cell's turn
  Components force, torque;                         ///< N, N m: by contacts, on each grain
  Contacts contacts;
  Springs springs;                                   ///< that the contacts were made with
  BondLaw bonds;                                     ///< the same
  Eigen::Matrix3d virial = Eigen::Matrix3d::Zero();  ///< Σ f ⊗ b, J; f acts on i
  double remainingSkin = 0.0;                        ///< m that pairs may still approach before the list is made anew
  double criticalStep = 0.0;                         ///< s, bound that holds until then; elastic spheres: now
  RveLedger ledger;
};

struct Rve {
  Shape shape = Shape::disc;
  Springs springs;
  BondLaw bonds;                ///< of contacts that are bonded (bond)
  std::vector<double> radius;   ///< m
  std::vector<double> mass;     ///< kg
  std::vector<double> inertia;  ///< kg m²
  double density = 0.0;         ///< of the grains, kg/m³
  double volume = 0.0;          ///< at F = 1, m³
  double skin = 0.0;            ///< m
  Frame frame;                  ///< empty: the cell repeats
  CellState state;

  std::size_t size() const { return radius.size(); }
  int dimension() const { return shape == Shape::disc ? 2 : 3; }
};

/// Grains to make a cell of.
struct Grains {
  Shape shape = Shape::disc;
  std::vector<Vec3> centre{};    ///< m; discs: z = 0
  std::vector<double> radius{};  ///< m
  double density = 2650.0;       ///< kg/m³; the length of discs is that of the third period
};

/// A cell that repeats, at rest, with contacts as the grains lie and no tangential springs stretched.
/// @param lattice  discs: the third period along z, which does not repeat
/// @throws InputError naming the grain whose centre or radius is not finite or > 0; if there are none, the springs or
///   the density are not valid, a period is not finite, or faces are closer than two of the largest diameters and
///   skins; NumericalError naming a grain whose force is not finite, as that of two at one place
Rve makeRve(const Grains& grains, const geometry::Lattice& lattice, const Springs& springs);

/// Current volume, m³.
double volume(const Rve& cell);
double meanDiameter(const Rve& cell);
/// Fraction of the volume that grains fill; overlaps count twice, copies of a frame's grains once.
double solidFraction(const Rve& cell);

/// Puts the state aside; the room that `kept` has is used again.
void save(const Rve& cell, CellState& kept);
/// Takes it back. @throws InputError if it is of other springs or bonds, of another number or volume of grains, or from
/// before F was made 1 anew (compress)
void restore(Rve& cell, const CellState& kept);

/// New springs of all contacts; stretches stay as far as friction holds them, and what it does not hold is booked as
/// friction. @throws InputError as validate, or if the springs do not go with the shape
void setSprings(Rve& cell, const Springs& springs);

/// A step of length dt: fluctuations are kicked by the forces, less damping (as Cundall's, along the motion in place of
/// the axes: the fraction `damping` of the size of a grain's force, and torque, against its fluctuation), then all
/// moves: x ← G (x + v dt), H ← G H, F ← G F. With G = R U, a turn after a stretch, all that has a direction turns by
/// R, any angle, and U strains. Symplectic Euler; m dv/dt = f along axes that turn with the cell, which leaves the
/// inertia of L x out (Desrues et al. 2019, eq. 15 at rest).
/// @throws InputError if dt is not above 0 or is above criticalStep, or damping is not in [0, 1); NumericalError if
///   det G ≤ 0, faces have come too close, or a velocity or force is not finite, naming the grain
void step(Rve& cell, double dt, const Eigen::Matrix3d& G = Eigen::Matrix3d::Identity(), double damping = 0.0);

/// Deforms the cell by G, grains and all; no time passes, velocities turn with it and stay otherwise. Every contact
/// feels it as one step of its own, so springs stretch and slip. @throws as step
void deform(Rve& cell, const Eigen::Matrix3d& G);

/// F times the inverse of the present one: what deforms the cell to F. Of discs, what is out of the plane is exactly 1
/// and 0.
/// @throws InputError if discs are to be deformed out of their plane
Eigen::Matrix3d relativeDeformation(const Rve& cell, const Eigen::Matrix3d& F);

/// Distance of the nearest faces of the shortest periods, over the two largest diameters and skins that step() needs.
double relativeWidth(const Rve& cell);

/// Lays the cell and a copy side by side, along the shortest periods and across the nearest faces: a cell of the same
/// packing, in which each copy moves as before until what is not stable parts them. Grains 2 i and 2 i + 1 are those of
/// i; volume, energies and the price of a step double, stresses and F stay.
/// @throws InputError for a cell with a frame
void repeat(Rve& cell);

/// The grains of a cell that is `are` copies, in `wanted` copies, with no state but the axes that repeat: for one to be
/// read. @throws InputError unless both are above 0, and `are` divides the grains
Rve inCopies(const Rve& cell, int are, int wanted);

/// Moves and turns grains by w (m) and θ (rad), components as in CellState; contacts feel it as with deform.
/// @throws InputError if they are not of the cell's size or not finite; NumericalError as step
void displace(Rve& cell, Components w, Components theta);

/// Stops all grains; what energy that takes is booked as damping.
void stop(Rve& cell);

struct Stress {
  Eigen::Matrix3d cauchy = Eigen::Matrix3d::Zero();  ///< Pa, tension positive, symmetric part of (1/V) Σ f ⊗ b
  double asymmetry = 0.0;                            ///< norm of the skew part over that of the symmetric one
  /// −trace/3, of discs −(σ₁₁ + σ₂₂)/2, Pa
  double pressure = 0.0;
};
/// Love and Weber's; at rest (Desrues et al. 2019, eq. 27).
Stress stress(const Rve& cell);
/// First Piola–Kirchhoff stress J σ F⁻ᵀ, Pa.
Eigen::Matrix3d nominalStress(const Rve& cell);

struct Balance {
  /// Largest force on a grain (torques as forces at its surface) over the mean contact force; what the frame's
  /// reactions hold does not count. Infinite if there are forces and no contacts.
  double unbalanced = 0.0;
  double meanForce = 0.0;     ///< of contacts, N
  double coordination = 0.0;  ///< 2 contacts over grains, in framed cells with their fractions
  int contacts = 0;           ///< that touch
  int rattlers = 0;           ///< grains that touch nobody
  int sliding = 0;            ///< contacts at the limit of friction
  int bonds = 0;              ///< contacts that are bonded
};
Balance balance(const Rve& cell);

/// Mean of n ⊗ n over the contacts and bonds, n their unit normals: trace 1, or 0 where nothing touches (Satake 1982).
Eigen::Matrix3d fabric(const Rve& cell);

/// Energy in the springs and bonds, J.
double storedEnergy(const Rve& cell);
/// Kinetic energy of the fluctuations, J.
double kineticEnergy(const Rve& cell);

}  // namespace dovetail::rve
