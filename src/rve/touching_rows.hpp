// Contacts that touch, in blocks whose numbers lie side by side for vector registers.
#pragma once

#include <cstddef>

#include "sweep.hpp"

namespace dovetail::rve {

inline constexpr int rowLength = 64;
using Row = double[rowLength];

/// Who touches, and branches.
template <int dimension>
struct TouchingRows {
  int count = 0;
  int contact[rowLength], i[rowLength], j[rowLength];
  Row branch[dimension], squared;
};

/// Calls flush(rows) for all contacts that touch, in the order of the list, in blocks; release(c, touches) for every
/// pair listed. No branch depends on who touches: that would be guessed wrong too often.
template <int dimension, class Release, class Flush>
void forTouchingBlocks(const Cell& cell, const Release& release, const Flush& flush) {
  const CellState& s = cell.state;
  const std::array<Vec3, 27> shift = imageShifts(s.lattice);
  const double* x[dimension];
  for (int k = 0; k < dimension; ++k) x[k] = s.x[static_cast<std::size_t>(k)].data();
  const double* const radius = cell.radius.data();
  const int* const first = s.contacts.first.data();
  const int* const other = s.contacts.other.data();
  const std::uint8_t* const image = s.contacts.image.data();
  TouchingRows<dimension> rows;
  const int n = static_cast<int>(cell.size());
  for (int i = 0; i < n; ++i) {
    double xi[dimension];
    for (int k = 0; k < dimension; ++k) xi[k] = x[k][i];
    const double ri = radius[i];
    for (int c = first[i]; c < first[i + 1]; ++c) {
      const int j = other[c], at = rows.count;
      const double* const away = &shift[image[c]].x;
      const double reach = ri + radius[j];
      double squared = 0.0;
      for (int k = 0; k < dimension; ++k) {
        const double b = x[k][j] + away[k] - xi[k];
        rows.branch[k][at] = b;
        squared += b * b;
      }
      rows.squared[at] = squared;
      rows.contact[at] = c;
      rows.i[at] = i;
      rows.j[at] = j;
      const bool touches = squared < reach * reach;
      release(c, touches);
      rows.count += touches ? 1 : 0;
      if (rows.count == rowLength) {
        flush(rows);
        rows.count = 0;
      }
    }
  }
  flush(rows);
}

/// Where springs slip, in shares of overlaps; no friction is infinite here, so that 0 and quotients stay numbers.
inline double slipShareOf(const Springs& springs) {
  const double share = springs.friction / springs.tangential;
  return share < 1e100 ? share : 1e100;
}

}  // namespace dovetail::rve
