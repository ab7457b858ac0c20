#include "grains.hpp"

#include <algorithm>
#include <cmath>
#include <type_traits>

#include "dovetail/core/lane_sum.hpp"
#include "dovetail/core/vector_code.hpp"

namespace dovetail::rve {

namespace {

using Lanes = double[lanes];

/// Calls body(first, count) for eight items at a time and then for the rest: loops over count become vectors, and sums
/// in lanes have an order of their own.
template <class Body>
void inLanes(std::size_t n, const Body& body) {
  std::size_t i = 0;
  for (; i + lanes <= n; i += lanes) body(i, std::integral_constant<std::size_t, lanes>{});
  if (i < n) body(i, n - i);
}

/// Components that are in use, one after the other.
template <class Field>
auto inUse(Field& field) {
  using Number = std::conditional_t<std::is_const_v<Field>, const double, double>;
  std::array<Number*, 3> used{};
  std::size_t count = 0;
  for (auto& component : field)
    if (!component.empty()) used[count++] = component.data();
  return used;
}

std::size_t dimensionOf(const Components& field) {
  return static_cast<std::size_t>(std::ranges::count_if(field, [](const auto& c) { return !c.empty(); }));
}

std::size_t sizeOf(const Components& field) { return std::max({field[0].size(), field[1].size(), field[2].size()}); }

/// Calls body(dimension), known where it is compiled.
template <class Body>
auto inDimension(std::size_t dimension, const Body& body) {
  if (dimension == 3) return body(std::integral_constant<std::size_t, 3>{});
  if (dimension == 2) return body(std::integral_constant<std::size_t, 2>{});
  return body(std::integral_constant<std::size_t, 1>{});
}

template <std::size_t dimension>
double kickIn(const std::array<double*, 3>& v, const std::array<const double*, 3>& force, const double* mass,
              std::size_t n, double dt, double damping) {
  LaneSum taken;
  inLanes(n, [&](std::size_t i, auto count) {
    for (std::size_t l = 0; l < count; ++l) {
      double push2 = 0.0, speed2 = 0.0;
      for (std::size_t k = 0; k < dimension; ++k) {
        push2 += force[k][i + l] * force[k][i + l];
        speed2 += v[k][i + l] * v[k][i + l];
      }
      // What is slower has no direction that digits could tell.
      const double drag = speed2 > 1e-200 ? damping * std::sqrt(push2 / speed2) : 0.0;
      const double perMass = dt / mass[i + l];
      double way = 0.0;
      for (std::size_t k = 0; k < dimension; ++k) {
        const double before = v[k][i + l], after = before + perMass * (force[k][i + l] - drag * before);
        way += before * (before + after);
        v[k][i + l] = after;
      }
      taken.lane[l] += 0.5 * dt * drag * way;
    }
  });
  return taken.total();
}

template <std::size_t dimension>
double advanceIn(CellState& s, double dt, const Eigen::Matrix3d& G) {
  double* x[dimension];
  const double* v[dimension];
  double g[dimension][dimension];
  for (std::size_t k = 0; k < dimension; ++k) {
    x[k] = s.x[k].data();
    v[k] = s.v[k].data();
    for (std::size_t l = 0; l < dimension; ++l) g[k][l] = G(static_cast<int>(k), static_cast<int>(l));
  }
  Lanes most = {};
  LaneSum sum2;
  inLanes(s.x[0].size(), [&](std::size_t i, auto count) {
    double moved[dimension][lanes];
    Lanes speed2 = {};
    for (std::size_t k = 0; k < dimension; ++k)
      for (std::size_t l = 0; l < count; ++l) {
        const double speed = v[k][i + l];
        moved[k][l] = x[k][i + l] + dt * speed;
        speed2[l] += speed * speed;
      }
    for (std::size_t k = 0; k < dimension; ++k)
      for (std::size_t l = 0; l < count; ++l) {
        double sum = g[k][0] * moved[0][l];
        for (std::size_t j = 1; j < dimension; ++j) sum += g[k][j] * moved[j][l];
        x[k][i + l] = sum;
      }
    for (std::size_t l = 0; l < count; ++l) {
      most[l] = most[l] < speed2[l] ? speed2[l] : most[l];
      sum2.lane[l] += speed2[l];
    }
  });
  const double fastest2 = *std::max_element(most, most + lanes);
  return std::isfinite(sum2.total()) ? fastest2 : std::nan("");
}

template <std::size_t dimension>
void turnIn(const std::array<double*, 3>& field, std::size_t n, const Eigen::Matrix3d& by) {
  inLanes(n, [&](std::size_t i, auto count) {
    for (std::size_t l = 0; l < count; ++l) {
      double old[dimension];
      for (std::size_t k = 0; k < dimension; ++k) old[k] = field[k][i + l];
      for (std::size_t k = 0; k < dimension; ++k) {
        double sum = by(static_cast<int>(k), 0) * old[0];
        for (std::size_t j = 1; j < dimension; ++j) sum += by(static_cast<int>(k), static_cast<int>(j)) * old[j];
        field[k][i + l] = sum;
      }
    }
  });
}

}  // namespace

double kick(Components& v, const Components& force, const std::vector<double>& mass, double dt, double damping) {
  double taken = 0.0;
  withVectors([&] {
    taken = inDimension(dimensionOf(v), [&](auto dimension) {
      return kickIn<dimension>(inUse(v), inUse(force), mass.data(), sizeOf(v), dt, damping);
    });
  });
  return taken;
}

double advance(CellState& s, double dt, const Eigen::Matrix3d& G) {
  double fastest2 = 0.0;
  withVectors([&] {
    fastest2 = inDimension(dimensionOf(s.x), [&](auto dimension) { return advanceIn<dimension>(s, dt, G); });
  });
  return fastest2;
}

void turn(Components& field, const Eigen::Matrix3d& by) {
  const std::size_t dimension = dimensionOf(field);
  if (dimension == 1) return;
  withVectors([&] { inDimension(dimension, [&](auto d) { turnIn<d>(inUse(field), sizeOf(field), by); }); });
}

}  // namespace dovetail::rve
