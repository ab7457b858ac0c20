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

/// Particles i … i + 3, which neither spin nor are weighted, with the digits of one after the other.
/// @param largest  of squared displacements so far, m², by place
/// @return false, and nothing is changed, if a number is not finite
[[gnu::always_inline]] inline bool advanceFour(Particles& particles, std::size_t i, const Sweep& sweep, Four& largest) {
  const Four mass = loadRow(particles.mass.data() + i);
  const ByPlaces half = byPlaces((0.5 * sweep.dt) / mass);
  double *const v = &particles.v[i].x, *const x = &particles.x[i].x, *const f = &particles.f[i].x;
  Four v0 = loadRow(v), v1 = loadRow(v + 4), v2 = loadRow(v + 8);
  const Four k0 = half.a * loadRow(f), k1 = half.b * loadRow(f + 4), k2 = half.c * loadRow(f + 8);
  for (int k = 0; k < sweep.halfKicks; ++k) {
    v0 += k0;
    v1 += k1;
    v2 += k2;
  }
  const Four x0 = loadRow(x), x1 = loadRow(x + 4), x2 = loadRow(x + 8);
  const Four moved = squaredNorms(v0, v1, v2) * (sweep.dt * sweep.dt);
  const auto finite = moved + 0.0 * (x0 + x1 + x2) < std::numeric_limits<double>::infinity();
  const auto both = finite & __builtin_shufflevector(finite, finite, 2, 3, 0, 1);
  if ((both[0] & both[1]) == 0) [[unlikely]]
    return false;
  largest = moved > largest ? moved : largest;
  store(v, v0);
  store(v + 4, v1);
  store(v + 8, v2);
  store(x, x0 + sweep.dt * v0);
  store(x + 4, x1 + sweep.dt * v1);
  store(x + 8, x2 + sweep.dt * v2);
  if (!sweep.startsForces) return true;
  const ByPlaces weight = byPlaces(mass);
  const Vec3& g = sweep.g;
  store(f, weight.a * Four{g.x, g.y, g.z, g.x});
  store(f + 4, weight.b * Four{g.y, g.z, g.x, g.y});
  store(f + 8, weight.c * Four{g.z, g.x, g.y, g.z});
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
