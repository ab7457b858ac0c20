#include "dovetail/fem/laws/material_probe.hpp"

#include <array>
#include <vector>

namespace dovetail::fem {

ModuliAtRest moduliAtRest(const PointMaterial& material) {
  alignas(32) std::array<double, 9 * pointLanes> F{}, P{};
  alignas(32) std::array<double, 81 * pointLanes> A{};
  const std::size_t size = material.historySize();
  std::vector<double> history(size * pointLanes), changed(history.size());
  for (std::size_t lane = 0; lane < pointLanes; ++lane) {
    for (const std::size_t k : {0, 4, 8}) F[k * pointLanes + lane] = 1.0;
    material.startHistory(std::span(history).subspan(lane * size, size));
  }
  PointBatch batch{};
  batch.groups = 1;
  batch.F = F.data();
  batch.P = P.data();
  batch.tangent = A.data();
  batch.history = history.data();
  batch.newHistory = changed.data();
  material.evaluate(batch);
  return {A[0], A[10 * pointLanes]};
}

double youngsModulus(const PointMaterial& material) {
  if (const auto law = material.brickLaw()) return youngsModulus(*law);
  const auto [confined, shear] = moduliAtRest(material);
  return shear * (3.0 * confined - 4.0 * shear) / (confined - shear);
}

}  // namespace dovetail::fem
