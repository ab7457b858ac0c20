// Vectors of three in registers of four numbers: how arrays of vectors become rows, and rows sums of vectors.
#pragma once

#ifdef __AVX__
#include <immintrin.h>
#endif

#include <cstddef>
#include <cstring>

#include "dovetail/core/vec3.hpp"

namespace dovetail::dem::detail {

using Four = double __attribute__((vector_size(32)));

/// (x, y, z, ·).
/// @tparam within  something follows that may be read; else nothing beyond z is read
template <bool within>
[[gnu::always_inline]] inline Four load(const Vec3& a) {
  if constexpr (within) {
    Four values;
    std::memcpy(&values, &a.x, sizeof values);
    return values;
  }
#ifdef __AVX__
  return _mm256_maskload_pd(&a.x, _mm256_setr_epi64x(-1, -1, -1, 0));
#else
  return Four{a.x, a.y, a.z, 0.0};
#endif
}

[[gnu::always_inline]] inline void store(double* row, const Four& values) { std::memcpy(row, &values, sizeof values); }
[[gnu::always_inline]] inline Four loadRow(const double* row) {
  Four values;
  std::memcpy(&values, row, sizeof values);
  return values;
}

/// Four vectors (x, y, z, ·) into places l … l + 3 of rows.
template <class Rows3>
[[gnu::always_inline]] inline void setRows(Rows3& rows, std::size_t l, const Four& a, const Four& b, const Four& c,
                                           const Four& d) {
  const Four abXZ = __builtin_shufflevector(a, b, 0, 4, 2, 6), cdXZ = __builtin_shufflevector(c, d, 0, 4, 2, 6);
  const Four abY = __builtin_shufflevector(a, b, 1, 5, 3, 7), cdY = __builtin_shufflevector(c, d, 1, 5, 3, 7);
  store(rows.x.data() + l, __builtin_shufflevector(abXZ, cdXZ, 0, 1, 4, 5));
  store(rows.y.data() + l, __builtin_shufflevector(abY, cdY, 0, 1, 4, 5));
  store(rows.z.data() + l, __builtin_shufflevector(abXZ, cdXZ, 2, 3, 6, 7));
}

struct FourVectors {
  Four a, b, c, d;  ///< each (x, y, z, ·)
};

/// Places l … l + 3 of rows as vectors; what stands at · is finite if y is, and of no meaning.
template <class Rows3>
[[gnu::always_inline]] inline FourVectors vectorsOf(const Rows3& rows, std::size_t l) {
  const Four x = loadRow(rows.x.data() + l), y = loadRow(rows.y.data() + l), z = loadRow(rows.z.data() + l);
  const Four abXZ = __builtin_shufflevector(x, z, 0, 1, 4, 5), cdXZ = __builtin_shufflevector(x, z, 2, 3, 6, 7);
  const Four abY = __builtin_shufflevector(y, y, 0, 1, 0, 1), cdY = __builtin_shufflevector(y, y, 2, 3, 2, 3);
  return {__builtin_shufflevector(abXZ, abY, 0, 4, 2, 6), __builtin_shufflevector(abXZ, abY, 1, 5, 3, 7),
          __builtin_shufflevector(cdXZ, cdY, 0, 4, 2, 6), __builtin_shufflevector(cdXZ, cdY, 1, 5, 3, 7)};
}

inline Vec3 vectorOf(const Four& a) { return {a[0], a[1], a[2]}; }

}  // namespace dovetail::dem::detail
