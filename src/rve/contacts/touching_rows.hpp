// Contacts that touch, in blocks whose numbers lie side by side for vector registers.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "dovetail/core/lane_sum.hpp"
#include "dovetail/core/vector_code.hpp"
#include "dovetail/dem/laws/contact_block.hpp"
#include "sweep.hpp"

namespace dovetail::rve {

inline constexpr int rowLength = dem::detail::blockSize;
using Row = double[rowLength];

[[gnu::always_inline]] inline Vec3 vectorAt(const Row (&rows)[3], int m) {
  return {rows[0][m], rows[1][m], rows[2][m]};
}
[[gnu::always_inline]] inline void setVector(Row (&rows)[3], int m, const Vec3& a) {
  rows[0][m] = a.x;
  rows[1][m] = a.y;
  rows[2][m] = a.z;
}

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

/// Distances. Returns whether pairs that do not touch remember something.
template <int dimension>
bool screen(std::span<double* const> memory, ListedRows<dimension>& __restrict r) {
  const int count = r.count;
  for (int m = 0; m < count; ++m) {
    double squared = 0.0;
    for (int k = 0; k < dimension; ++k) squared += r.branch[k][m] * r.branch[k][m];
    r.squared[m] = squared;
    r.apart[m] = squared - r.reach[m] * r.reach[m];
  }
  std::int64_t ended = 0;
  for (const double* const whole : memory) {
    const double* const __restrict held = whole + r.first;
    for (int m = 0; m < count; ++m)
      ended |= static_cast<std::int64_t>(!(r.apart[m] < 0.0)) & static_cast<std::int64_t>(held[m] != 0.0);
  }
  return ended != 0;
}

/// Pairs that do not touch forget what their springs remember. Returns what these held, J.
template <int dimension>
double forget(const Rve& cell, std::span<double* const> memory, const ListedRows<dimension>& r) {
  const Contacts& contacts = cell.state.contacts;
  double sum = 0.0;
  for (int m = 0; m < r.count; ++m) {
    if (r.apart[m] < 0.0) continue;
    const auto c = static_cast<std::size_t>(r.first + m), i = static_cast<std::size_t>(r.i[m]),
               j = static_cast<std::size_t>(contacts.other[c]);
    const double kt = contacts.tangent.empty() ? cell.springs.tangential * contacts.stiffness[c] : contacts.tangent[c];
    for (const std::vector<double>& stretch : contacts.stretch)
      if (!stretch.empty()) sum += 0.5 * kt * stretch[c] * stretch[c];
    if (!contacts.roll.empty())
      sum += 0.5 * cell.springs.rolling * kt * cell.radius[i] * cell.radius[j] * contacts.roll[c] * contacts.roll[c];
    for (double* const held : memory) held[c] = 0.0;
  }
  return sum;
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
  constexpr int full = static_cast<int>(lanes);
  rows.padded = (count + full - 1) / full * full;
  const auto take = [&](int m, int from) {
    rows.contact[m] = r.first + from;
    rows.i[m] = r.i[from];
    rows.j[m] = other[r.first + from];
    for (int k = 0; k < dimension; ++k) rows.branch[k][m] = r.branch[k][from];
    rows.squared[m] = r.squared[from];
  };
  for (int m = 0; m < count; ++m) take(m, at[m]);
  for (int m = count; m < rows.padded; ++m) take(m, at[count - 1]);
}

/// Calls flush(rows) for all contacts that touch, in the order of the list, in blocks.
/// @param memory  what springs remember by contact: 0 where nothing touches
/// @return what springs held whose contacts have ended, J
template <int dimension, class Flush>
double forTouchingBlocks(const Rve& cell, std::span<double* const> memory, const Flush& flush) {
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
  double ended = 0.0;
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
    bool some = false;
    withVectors([&] { some = screen<dimension>(memory, listed); });
    if (some) ended += forget<dimension>(cell, memory, listed);
    takeTouching(other, listed, rows);
    if (rows.count > 0) flush(rows);
  }
  return ended;
}

/// Σ f ⊗ b and what slips.
template <int dimension>
struct ContactSums {
  LaneSum virial[dimension][dimension], slipped;

  void add(const Row (&force)[dimension], const TouchingRows<dimension>& at) {
    for (int k = 0; k < dimension; ++k)
      for (int l = 0; l < dimension; ++l)
        virial[k][l].addProducts(force[k], at.branch[l], static_cast<std::size_t>(at.padded));
  }
  void ledger(CellState& s, double ended) const {
    s.virial.setZero();
    for (int k = 0; k < dimension; ++k)
      for (int l = 0; l < dimension; ++l) s.virial(k, l) = virial[k][l].total();
    s.ledger.friction += slipped.total() + ended;
  }
};

}  // namespace dovetail::rve
