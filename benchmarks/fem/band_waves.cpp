#include "band_waves.hpp"

#include <cmath>
#include <numbers>

#include "dovetail/fem/mesh/solid_mesh.hpp"
#include "dovetail/fem/model/model.hpp"
#include "dovetail/fem/terms/gradient_energy.hpp"

namespace dovetail::benchmark {

namespace {

constexpr double phase = 0.4;

/// What the weights (1 − r²/R²)² leave of a wave.
double leftOf(double kh, double radius) {
  double sum = 0.0, all = 0.0;
  for (int r = -static_cast<int>(radius); r <= static_cast<int>(radius); ++r) {
    const double weight = std::pow(1.0 - r * r / (radius * radius), 2);
    sum += weight * std::cos(kh * r);
    all += weight;
  }
  return sum / all;
}

/// Of a layer of cubes of edge 1, sheared by F = cos(k (e + ½) + φ) in element e, J.
double energyOfLayer(int elements, double kh, double modulus) {
  const fem::SolidMesh mesh = fem::boxOf(fem::ElementShape::quad4, {1, elements, 1}, {}, {1.0, 1.0 * elements, 1.0});
  fem::Model model = fem::makeModel(mesh);
  for (std::size_t n = 0; n < mesh.X.size(); ++n)
    model.nodes.u[n].x = std::sin(kh * mesh.X[n].y + phase) / (2.0 * std::sin(0.5 * kh));
  return fem::gradientEnergy(mesh, {.modulus = modulus})->energy(model.nodes, {});
}

}  // namespace

WaveStiffness stiffnessOfWave(int period, double radius, double band) {
  const double kh = 2.0 * std::numbers::pi / period, D = std::pow(0.5 * band / std::numbers::pi, 2);  // H = h = 1
  double squares = 0.0;                                                                               // ½ F²
  for (int e = 0; e < period; ++e) squares += 0.5 * std::pow(std::cos(kh * (e + 0.5) + phase), 2);
  const double left = leftOf(kh, radius);
  WaveStiffness found;
  found.average = -left * left;
  found.halfAverage = -0.25 * (1.0 + left) * (1.0 + left);
  // borders drop out of lengths that differ by a period
  found.gradient = (energyOfLayer(4 * period, kh, D) - energyOfLayer(3 * period, kh, D)) / squares - 1.0;
  // v = F/cos(½ kh) at the nodes has the mean F in every element
  found.multipliers = period > 2 ? 4.0 * D * std::pow(std::tan(0.5 * kh), 2) - 1.0 : HUGE_VAL;
  return found;
}

}  // namespace dovetail::benchmark
