// Quadrature and shape functions of one coordinate.
#pragma once

#include <array>
#include <cmath>

namespace dovetail::fem::detail {

struct Point1 {
  double at, weight;
};
inline const std::array<Point1, 2> gauss2 = {{{-1.0 / std::sqrt(3.0), 1.0}, {1.0 / std::sqrt(3.0), 1.0}}};
inline const std::array<Point1, 3> gauss3 = {
    {{-std::sqrt(0.6), 5.0 / 9.0}, {0.0, 8.0 / 9.0}, {std::sqrt(0.6), 5.0 / 9.0}}};

/// Lagrange's polynomial on the nodes −1, 1 (first order) or −1, 0, 1 (second order), and its slope.
inline std::array<double, 2> lagrange(double node, double x, bool second) {
  if (!second) return {0.5 * (1.0 + node * x), 0.5 * node};
  if (node == 0.0) return {1.0 - x * x, -2.0 * x};
  return {0.5 * x * (x + node), x + 0.5 * node};
}

}  // namespace dovetail::fem::detail
