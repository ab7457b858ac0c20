// Contacts that touch, in blocks whose numbers lie side by side for vector registers.
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>

#include "dovetail/core/vector_code.hpp"
#include "sweep.hpp"

namespace dovetail::rve {

inline constexpr int rowLength = 64, lanes = 8;
using Row = double[rowLength];

/// Who touches, and branches. Behind the last contact it is repeated until all lanes are full.
template <int dimension>
struct TouchingRows {
  int count = 0, padded = 0;
  int contact[rowLength], i[rowLength], j[rowLength];
  Row branch[dimension], squared;
};

/// Pairs as they are listed.
template <int dimension>
struct ListedRows {
  int first = 0, count = 0;
  int i[rowLength];
  Row branch[dimension], reach, squared, apart;  // apart: not below 0 if nothing touches
};

/// Distances; pairs that do not touch forget what their springs remember.
template <int dimension>
void screen(std::span<double* const> memory, ListedRows<dimension>& __restrict r) {
  const int count = r.count;
  for (int m = 0; m < count; ++m) {
    double squared = 0.0;
    for (int k = 0; k < dimension; ++k) squared += r.branch[k][m] * r.branch[k][m];
    r.squared[m] = squared;
    r.apart[m] = squared - r.reach[m] * r.reach[m];
  }
  for (double* const whole : memory) {
    double* const __restrict held = whole + r.first;
    for (int m = 0; m < count; ++m) held[m] = r.apart[m] < 0.0 ? held[m] : 0.0;
  }
}

template <int dimension>
void takeTouching(const int* other, const ListedRows<dimension>& r, TouchingRows<dimension>& rows) {
  // No branch depends on who touches: that would be guessed wrong too often.
  int at[rowLength + 1], count = 0;
  for (int m = 0; m < r.count; ++m) {
    at[count] = m;
    count += r.apart[m] < 0.0 ? 1 : 0;
  }
  rows.count = count;
  rows.padded = (count + lanes - 1) / lanes * lanes;
  for (int m = 0; m < rows.padded; ++m) {
    const int from = at[std::min(m, count - 1)];
    rows.contact[m] = r.first + from;
    rows.i[m] = r.i[from];
    rows.j[m] = other[r.first + from];
    for (int k = 0; k < dimension; ++k) rows.branch[k][m] = r.branch[k][from];
    rows.squared[m] = r.squared[from];
  }
}

/// Calls flush(rows) for all contacts that touch, in the order of the list, in blocks.
/// @param memory  what springs remember by contact: 0 where nothing touches
template <int dimension, class Flush>
void forTouchingBlocks(const Rve& cell, std::span<double* const> memory, const Flush& flush) {
  const CellState& s = cell.state;
  const std::array<Vec3, 27> shift = imageShifts(s.lattice);
  const double* x[dimension];
  for (int k = 0; k < dimension; ++k) x[k] = s.x[static_cast<std::size_t>(k)].data();
  const double* const radius = cell.radius.data();
  const int* const first = s.contacts.first.data();
  const int* const other = s.contacts.other.data();
  const std::uint8_t* const image = s.contacts.image.data();
  ListedRows<dimension> listed;
  TouchingRows<dimension> rows;
  const int size = static_cast<int>(s.contacts.size());
  int i = 0;
  for (listed.first = 0; listed.first < size; listed.first += rowLength) {
    listed.count = std::min(rowLength, size - listed.first);
    for (int m = 0; m < listed.count; ++m) {
      const int c = listed.first + m, j = other[c];
      while (first[i + 1] <= c) ++i;
      const double* const away = &shift[image[c]].x;
      for (int k = 0; k < dimension; ++k) listed.branch[k][m] = x[k][j] + away[k] - x[k][i];
      listed.reach[m] = radius[i] + radius[j];
      listed.i[m] = i;
    }
    withVectors([&] { screen<dimension>(memory, listed); });
    takeTouching(other, listed, rows);
    if (rows.count > 0) flush(rows);
  }
}

/// Sums of rows in eight lanes: their order is not that of the registers.
struct LaneSum {
  double lane[lanes] = {};

  void add(const Row& a, int padded) {
    for (int m = 0; m < padded; m += lanes)
      for (int l = 0; l < lanes; ++l) lane[l] += a[m + l];
  }
  void addProducts(const Row& a, const Row& b, int padded) {
    for (int m = 0; m < padded; m += lanes)
      for (int l = 0; l < lanes; ++l) lane[l] += a[m + l] * b[m + l];
  }
  double total() const {
    return ((lane[0] + lane[1]) + (lane[2] + lane[3])) + ((lane[4] + lane[5]) + (lane[6] + lane[7]));
  }
};

/// Σ f ⊗ b and what slips.
template <int dimension>
struct ContactSums {
  LaneSum virial[dimension][dimension], slipped;

  void add(const Row (&force)[dimension], const TouchingRows<dimension>& at) {
    for (int k = 0; k < dimension; ++k)
      for (int l = 0; l < dimension; ++l) virial[k][l].addProducts(force[k], at.branch[l], at.padded);
  }
  void ledger(CellState& s) const {
    s.virial.setZero();
    for (int k = 0; k < dimension; ++k)
      for (int l = 0; l < dimension; ++l) s.virial(k, l) = virial[k][l].total();
    s.ledger.friction += slipped.total();
  }
};

/// Where springs slip, in fractions of overlaps; no friction is infinite here, so that 0 and quotients stay numbers.
inline double slipFractionOf(const Springs& springs) {
  const double fraction = springs.friction / springs.tangential;
  return fraction < 1e100 ? fraction : 1e100;
}

}  // namespace dovetail::rve
