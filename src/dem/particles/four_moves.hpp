// Four particles side by side: half kicks and drift, moments of mass.
#pragma once

#include <limits>

#include "../pairs/vectors.hpp"
#include "dovetail/dem/particles/particles.hpp"

namespace dovetail::dem::detail {

/// What one sweep does to a particle.
struct Sweep {
  double dt;
  int halfKicks;      // before the drift
  bool startsForces;  // after it
  Vec3 g;
};

/// The numbers of four particles, each for the three places of its vector.
struct ByPlaces {
  Four a, b, c;
};
[[gnu::always_inline]] inline ByPlaces byPlaces(const Four& of) {
  return {__builtin_shufflevector(of, of, 0, 0, 0, 1), __builtin_shufflevector(of, of, 1, 1, 2, 2),
          __builtin_shufflevector(of, of, 2, 3, 3, 3)};
}

/// Squared norms of four vectors that lie one behind the other, added up as squaredNorm does.
[[gnu::always_inline]] inline Four squaredNorms(const Four& a, const Four& b, const Four& c) {
  const Four aa = a * a, bb = b * b, cc = c * c;
  const Four x = __builtin_shufflevector(__builtin_shufflevector(aa, bb, 0, 3, 6, 6), cc, 0, 1, 2, 5);
  const Four ab = __builtin_shufflevector(aa, bb, 1, 4, 7, 2), bc = __builtin_shufflevector(bb, cc, 1, 4, 7, 0);
  const Four y = __builtin_shufflevector(ab, cc, 0, 1, 2, 6), z = __builtin_shufflevector(ab, bc, 3, 4, 5, 6);
  return x + y + z;
}

/// Twelve numbers: four vectors that lie one behind the other.
struct FourInARow {
  Four a, b, c;
  [[gnu::always_inline]] static FourInARow of(const Vec3* vectors) {
    const double* const row = &vectors->x;
    return {loadRow(row), loadRow(row + 4), loadRow(row + 8)};
  }
  [[gnu::always_inline]] void put(Vec3* vectors) const {
    double* const row = &vectors->x;
    store(row, a);
    store(row + 4, b);
    store(row + 8, c);
  }
  /// += n times (factors of each × vectors).
  [[gnu::always_inline]] void kick(int n, const ByPlaces& factors, const FourInARow& of) {
    const Four ka = factors.a * of.a, kb = factors.b * of.b, kc = factors.c * of.c;
    for (int k = 0; k < n; ++k) {
      a += ka;
      b += kb;
      c += kc;
    }
  }
};

/// Particles i … i + 3, with the digits of one after the other.
/// @param largest  of squared displacements so far, m², by place
/// @return false, and nothing is changed, if a number is not finite
template <bool spins, bool weighted>
[[gnu::always_inline]] inline bool advanceFour(Particles& particles, std::size_t i, const Sweep& sweep, Four& largest) {
  const Four own = loadRow(particles.mass.data() + i);
  Four mass = own, inertia = own;
  if constexpr (weighted) mass = loadRow(particles.weight.data() + i) * own;
  FourInARow v = FourInARow::of(&particles.v[i]), x = FourInARow::of(&particles.x[i]), omega;
  v.kick(sweep.halfKicks, byPlaces((0.5 * sweep.dt) / mass), FourInARow::of(&particles.f[i]));
  Four moved = squaredNorms(v.a, v.b, v.c) * (sweep.dt * sweep.dt) + 0.0 * (x.a + x.b + x.c);
  if constexpr (spins) {
    const Four radius = loadRow(particles.radius.data() + i);
    inertia = 0.4 * own * radius * radius;
    if constexpr (weighted) inertia = loadRow(particles.weight.data() + i) * inertia;
    omega = FourInARow::of(&particles.omega[i]);
    omega.kick(sweep.halfKicks, byPlaces((0.5 * sweep.dt) / inertia), FourInARow::of(&particles.torque[i]));
    moved += 0.0 * (omega.a + omega.b + omega.c);
  }
  const auto finite = moved < std::numeric_limits<double>::infinity();
  const auto both = finite & __builtin_shufflevector(finite, finite, 2, 3, 0, 1);
  if ((both[0] & both[1]) == 0) [[unlikely]]
    return false;
  largest = moved > largest ? moved : largest;
  v.put(&particles.v[i]);
  FourInARow{x.a + sweep.dt * v.a, x.b + sweep.dt * v.b, x.c + sweep.dt * v.c}.put(&particles.x[i]);
  if constexpr (spins) omega.put(&particles.omega[i]);
  if (!sweep.startsForces) return true;
  const ByPlaces weight = byPlaces(mass);
  const Vec3& g = sweep.g;
  FourInARow{weight.a * Four{g.x, g.y, g.z, g.x}, weight.b * Four{g.y, g.z, g.x, g.y},
             weight.c * Four{g.z, g.x, g.y, g.z}}
      .put(&particles.f[i]);
  if constexpr (spins) FourInARow{Four{}, Four{}, Four{}}.put(&particles.torque[i]);
  return true;
}

/// Σ m, kg, and Σ m x, kg m.
struct MassMoments {
  Four masses{}, first{}, second{}, third{};  // of every fourth particle; of x y z x, y z x y, z x y z

  /// Particles i … i + 3.
  [[gnu::always_inline]] void addFour(const Particles& particles, std::size_t i) {
    const double* const x = &particles.x[i].x;
    Four mass = loadRow(particles.mass.data() + i);
    if (!particles.weight.empty()) mass *= loadRow(particles.weight.data() + i);
    const ByPlaces each = byPlaces(mass);
    masses += mass;
    first += each.a * loadRow(x);
    second += each.b * loadRow(x + 4);
    third += each.c * loadRow(x + 8);
  }
  void add(double mass, const Vec3& x) {
    masses[0] += mass;
    for (int k = 0; k < 3; ++k) first[k] += mass * x[k];
  }
  double mass() const { return (masses[0] + masses[1]) + (masses[2] + masses[3]); }
  Vec3 moment() const {
    return {(first[0] + first[3]) + (second[2] + third[1]), (first[1] + second[0]) + (second[3] + third[2]),
            (first[2] + second[1]) + (third[0] + third[3])};
  }
};

}  // namespace dovetail::dem::detail
