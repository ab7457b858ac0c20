// Contacts side by side, which a loop that vectorises works on.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "dovetail/dem/laws/contact.hpp"

// The passes of the loop that follows do not touch each other's data. (Clang warns where it cannot use that.)
#ifdef __clang__
#define DOVETAIL_INDEPENDENT
#else
#define DOVETAIL_INDEPENDENT _Pragma("GCC ivdep")
#endif

namespace dovetail::dem::detail {

inline constexpr std::size_t blockSize = 64;
inline constexpr std::size_t channels = 8;  // of ContactWork
inline constexpr double timeless = 1e-90;   // s; in shorter steps nothing moves on and no velocity is remembered

/// Up to blockSize contacts: rows that are filled before `answer`, and rows that it fills. Rows that a law does not
/// need are never touched.
struct ContactBlock {
  using Row = std::array<double, blockSize>;
  struct Rows3 {
    alignas(64) Row x, y, z;
    Vec3 at(std::size_t l) const { return {x[l], y[l], z[l]}; }
    void set(std::size_t l, const Vec3& v) {
      x[l] = v.x;
      y[l] = v.y;
      z[l] = v.z;
    }
  };
  // Given: pairs
  alignas(64) Row radiusI, radiusJ;  ///< m
  // Given: walls; made by `meet` for pairs
  Rows3 normal;             ///< unit, from the partner to the particle; of pairs first x_particle − x_partner, m
  alignas(64) Row overlap;  ///< m
  alignas(64) Row energyFraction;  ///< factor on what normal springs store and plastic flow takes
  // Given: both
  Rows3 velocity;                   ///< v_particle − v_partner, m/s: of the centres (pairs), at the contact (walls)
  Rows3 spinSum, spinDifference;    ///< ω_particle ± ω_partner, rad/s
  alignas(64) Row rootMass;         ///< √ of the effective mass, kg^½
  alignas(64) Row inverseMass;      ///< 1/effective mass, 1/kg; 0 where there is none
  alignas(64) Row effectiveRadius;  ///< m
  alignas(64) Row scale;            ///< factor on forces and energies
  alignas(64) std::array<int, blockSize> kind;  ///< row of the law table
  std::array<double*, 12> memory;               ///< of the law, by component; advanced
  std::array<double*, 6> motion{};  ///< velocities of the last step, by component (ContactLaw::recalled); advanced
  bool recalls = false;             ///< there are such

  // Between the passes
  alignas(64) Row drift;                                 ///< see Meeting
  Rows3 slip, spin;                                      ///< at the instant of the force, m/s, rad/s
  alignas(64) Row separating;                            ///< n·v at the instant of the force, m/s
  alignas(64) std::array<std::int64_t, blockSize> kink;  ///< 1 it begins in this step, 2 it ends in the next, 3 both
  alignas(64) Row share;                                 ///< of the step, in which they touched
  alignas(64) Row engagement, engagementUntilEnd;        ///< see Contact

  // Answered
  Rows3 force;                                 ///< on the particle, N
  Rows3 couple;                                ///< on the particle beyond arm × force, N m (walls)
  Rows3 torqueI, torqueJ;                      ///< on the particle and its partner about their centres, N m (pairs)
  alignas(64) std::array<Row, channels> work;  ///< channels of ContactWork
};

/// Which rows are in use.
struct BlockOptions {
  bool spins = false;   ///< the law exerts torques
  bool wall = false;    ///< normal, overlap and velocity at the contact are given, not those of the centres
  bool varied = false;  ///< contacts have a scale and a row of the law table
  bool booked = true;   ///< energies are wanted
  Recall recall = Recall::nothing;
};

/// Sum of the work of the first n contacts, in an order of their own: eight interleaved sums, then those.
ContactWork sumWork(const ContactBlock& block, std::size_t n);

}  // namespace dovetail::dem::detail
