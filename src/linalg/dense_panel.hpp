// Products of a dense block, by columns, with a few vectors at once: the block is read once for all of them.
#pragma once

#include <array>
#include <cstddef>

#include "dovetail/core/vector_code.hpp"

namespace dovetail::linalg::detail {

/// Some vectors, `stride` apart.
template <int count>
struct Vectors {
  double* first;
  std::size_t stride;
  double* operator[](int c) const { return first + static_cast<std::size_t>(c) * stride; }
  Vectors from(std::size_t row) const { return {first + row, stride}; }
};

/// Of L: rows × columns entries, each column `stride` after the one before.
struct Panel {
  const double* first;
  std::size_t stride, rows, columns;
  const double* column(std::size_t j) const { return first + j * stride; }
  Panel part(std::size_t row, std::size_t column, std::size_t ofRows, std::size_t ofColumns) const {
    return {first + column * stride + row, stride, ofRows, ofColumns};
  }
};

namespace panel {

/// y −= Σ_k L_(j+k) x_(j+k), k < wide.
template <int wide, int count>
[[gnu::always_inline]] inline void subtractColumns(const Panel& L, std::size_t j, Vectors<count> x, Vectors<count> y) {
  const double* __restrict l[wide];
  double factor[count][wide];
  for (int k = 0; k < wide; ++k) {
    l[k] = L.column(j + static_cast<std::size_t>(k));
    for (int c = 0; c < count; ++c) factor[c][k] = x[c][j + static_cast<std::size_t>(k)];
  }
  for (int c = 0; c < count; ++c) {
    double* __restrict out = y[c];
    for (std::size_t r = 0; r < L.rows; ++r) {
      double sum = l[0][r] * factor[c][0];
      for (int k = 1; k < wide; ++k) sum += l[k][r] * factor[c][k];
      out[r] -= sum;
    }
  }
}

/// y −= L x
template <int count>
[[gnu::always_inline]] inline void subtractProduct(const Panel& L, Vectors<count> x, Vectors<count> y) {
  std::size_t j = 0;
  for (; j + 4 <= L.columns; j += 4) subtractColumns<4>(L, j, x, y);
  for (; j < L.columns; ++j) subtractColumns<1>(L, j, x, y);
}

using Four [[gnu::vector_size(32), gnu::aligned(8), gnu::may_alias]] = double;

/// x_(j+k) −= L_(j+k)ᵀ y, k < wide.
template <int wide, int count>
[[gnu::always_inline]] inline void subtractDots(const Panel& L, std::size_t j, Vectors<count> y, Vectors<count> x) {
  Four sum[wide][count] = {};
  std::size_t r = 0;
  for (; r + 4 <= L.rows; r += 4)
    for (int k = 0; k < wide; ++k) {
      const Four l = *reinterpret_cast<const Four*>(L.column(j + static_cast<std::size_t>(k)) + r);
      for (int c = 0; c < count; ++c) sum[k][c] += l * *reinterpret_cast<const Four*>(y[c] + r);
    }
  for (int k = 0; k < wide; ++k)
    for (int c = 0; c < count; ++c) {
      double rest = 0.0;
      for (std::size_t q = r; q < L.rows; ++q) rest += L.column(j + static_cast<std::size_t>(k))[q] * y[c][q];
      const Four& s = sum[k][c];
      x[c][j + static_cast<std::size_t>(k)] -= ((s[0] + s[2]) + (s[1] + s[3])) + rest;
    }
}

/// x −= Lᵀ y
template <int count>
[[gnu::always_inline]] inline void subtractTransposed(const Panel& L, Vectors<count> y, Vectors<count> x) {
  std::size_t j = 0;
  for (; j + 4 <= L.columns; j += 4) subtractDots<4>(L, j, y, x);
  for (; j < L.columns; ++j) subtractDots<1>(L, j, y, x);
}

/// x ← L⁻¹ x for the lower triangle of a square block.
template <int count>
[[gnu::always_inline]] inline void solveLower(const Panel& L, Vectors<count> x) {
  for (std::size_t j = 0; j < L.columns; ++j) {
    for (int c = 0; c < count; ++c) x[c][j] /= L.column(j)[j];
    subtractColumns<1>(L.part(j + 1, j, L.rows - j - 1, 1), 0, x.from(j), x.from(j + 1));
  }
}

/// x ← L⁻ᵀ x
template <int count>
[[gnu::always_inline]] inline void solveTransposed(const Panel& L, Vectors<count> x) {
  for (std::size_t j = L.columns; j-- > 0;) {
    subtractDots<1>(L.part(j + 1, j, L.rows - j - 1, 1), 0, x.from(j + 1), x.from(j));
    for (int c = 0; c < count; ++c) x[c][j] /= L.column(j)[j];
  }
}

}  // namespace panel

}  // namespace dovetail::linalg::detail
