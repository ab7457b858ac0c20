#include <algorithm>

#include "dovetail/surface/smooth_surface.hpp"

namespace dovetail::surface {

namespace {

/// Bézier points of the spline's two pieces over a face, as weights of its four control points in a row: every point of
/// the piece lies among its Bézier points.
constexpr std::array<std::array<double, 4>, 5> bezier{{{0.125, 0.75, 0.125, 0.0},
                                                       {0.0, 0.75, 0.25, 0.0},
                                                       {0.0, 0.5, 0.5, 0.0},
                                                       {0.0, 0.25, 0.75, 0.0},
                                                       {0.0, 0.125, 0.75, 0.125}}};

}  // namespace

double largestMobility(const SmoothSurface& surface, std::span<const double> inverseMass) {
  double largest = 0.0;
  std::vector<double> weight(inverseMass.size(), 0.0);
  std::vector<int> touched;
  for (const auto& control : surface.control)
    for (const auto& along : bezier)
      for (const auto& across : bezier) {
        for (std::size_t k = 0; k < 16; ++k) {
          const double share = along[k % 4] * across[k / 4];
          if (share == 0.0) continue;
          for (std::size_t i = 0; i < surface.carrier.rowColumns(control[k]).size(); ++i) {
            const int node = surface.carrier.rowColumns(control[k])[i];
            touched.push_back(node);
            weight[node] += share * surface.carrier.rowWeights(control[k])[i];
          }
        }
        double mobility = 0.0;
        for (int node : touched) {  // the second time round a node has weight zero
          mobility += weight[node] * weight[node] * inverseMass[node];
          weight[node] = 0.0;
        }
        touched.clear();
        largest = std::max(largest, mobility);
      }
  return largest;
}

}  // namespace dovetail::surface
