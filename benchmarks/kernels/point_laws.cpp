// Nanoseconds per point of the laws: stress alone, and stress with tangent.
#include "dovetail/fem/laws/point_laws.hpp"

#include <chrono>
#include <cstdio>
#include <random>
#include <string>
#include <vector>

#include "dovetail/core/parallel.hpp"
#include "dovetail/fem/laws/plasticity.hpp"
#include "dovetail/fem/laws/point_law.hpp"
#include "dovetail/fem/laws/viscosity.hpp"
#include "program/run.hpp"

namespace {

using namespace dovetail::fem;

constexpr std::size_t groups = 64;

/// The same energy as NeoHookean, differentiated.
struct Differentiated {
  double kappa, mu;
  template <class T>
  T energy(const Tensor<T>& F) const {
    using std::exp, std::log;
    const T J = determinant(F), logJ = log(J);
    return 0.5 * mu * (exp(-2.0 / 3.0 * logJ) * contraction(F, F) - 3.0) + 0.25 * kappa * (J * J - 1.0 - 2.0 * logJ);
  }
};

struct Arrays {
  std::vector<double> F, P, tangent, energy, dissipated, history, newHistory;

  Arrays(const PointMaterial& material, double amplitude)
      : F(36 * groups), P(36 * groups), tangent(324 * groups), energy(4 * groups), dissipated(4 * groups) {
    std::mt19937 random(1);
    std::uniform_real_distribution<double> value(-amplitude, amplitude);
    for (std::size_t k = 0; k < F.size(); ++k) F[k] = value(random) + (k / 4 % 9 % 4 == 0 ? 1.0 : 0.0);
    const std::size_t size = material.historySize();
    history.resize(4 * groups * size);
    for (std::size_t p = 0; p < 4 * groups; ++p) material.startHistory(std::span(history).subspan(p * size, size));
    newHistory = history;
  }
  PointBatch batch(bool withTangent) {
    return {groups,        F.data(),          P.data(),       withTangent ? tangent.data() : nullptr,
            energy.data(), dissipated.data(), history.data(), newHistory.data(),
            1e-3};
  }
};

double nanoseconds(const PointMaterial& material, const PointBatch& batch) {
  double best = 1e99;
  for (int round = 0; round < 7; ++round) {
    const int repeats = 200;
    const auto start = std::chrono::steady_clock::now();
    for (int i = 0; i < repeats; ++i) material.evaluate(batch);
    const std::chrono::duration<double, std::nano> time = std::chrono::steady_clock::now() - start;
    best = std::min(best, time.count() / (repeats * 4.0 * groups));
  }
  return best;
}

void report(const std::string& name, const std::shared_ptr<const PointMaterial>& material, double amplitude) {
  Arrays arrays(*material, amplitude);
  const double stress = nanoseconds(*material, arrays.batch(false));
  const double tangent = nanoseconds(*material, arrays.batch(true));
  std::printf("%-34s %8.1f %8.1f\n", name.c_str(), stress, tangent);
}

}  // namespace

int main(int argc, char** argv) {
  dovetail::program::Options options("bench_point_laws",
                                     "Times stress and tangent of material laws at points, on one thread.");
  return dovetail::program::runProgram(options, argc, argv, [&] {
    dovetail::setThreads(1);
    const NeoHookean rubber = neoHookean(3e6, 0.3, 1000.0);
    const J2Plasticity steel{200e9, 0.3, 7800.0, saturatingYield(0.4e9, 0.1e9, 0.7e9, 17.0)};
    J2Plasticity kinematic = steel;
    kinematic.kinematicModulus = 1e9;
    std::printf("%-34s %8s %8s   ns per point, one thread\n", "law", "stress", "tangent");
    report("neo-Hookean", pointMaterial(rubber), 0.1);
    report("neo-Hookean, differentiated",
           elasticMaterial("", 1.0, Differentiated{rubber.bulkModulus, rubber.shearModulus}), 0.1);
    report("St Venant-Kirchhoff", pointMaterial(StVenantKirchhoff{3e6, 0.3, 1000.0}), 0.1);
    report("axial springs, differentiated", pointMaterial(AxialSprings{3e6, 1000.0}), 0.1);
    report("Hencky", pointMaterial(Hencky{3e6, 0.3, 1000.0}), 0.1);
    report("J2, elastic", pointMaterial(steel), 1e-4);
    report("J2, flowing", pointMaterial(steel), 0.1);
    report("J2 with back stress, flowing", pointMaterial(kinematic), 0.1);
    report("Drucker-Prager", pointMaterial(DruckerPrager{50e6, 0.25, 2000.0, 1e4, 0.5, 0.1}), 0.05);
    report("viscous neo-Hookean", pointMaterial(kelvinVoigt(pointMaterial(rubber), 1e-3, 3e6, 0.3)), 0.1);
    return true;
  });
}
