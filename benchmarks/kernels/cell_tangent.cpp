// What tangents of cells of spheres cost, in answers: paths of 1e-4 of strain from rest to rest.
#include <cstdio>
#include <cstdlib>
#include <ctime>

#include "dovetail/rve/equilibrium.hpp"
#include "dovetail/rve/operators.hpp"
#include "dovetail/rve/packing.hpp"

using namespace dovetail;

namespace {

/// Of the processor: others use the machine.
template <class Body>
double seconds(const Body& body) {
  const std::clock_t begin = std::clock();
  body();
  return static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
}

void report(rve::Rve cell, const char* state) {
  Eigen::Matrix3d F = cell.state.F;
  F(2, 2) *= 1.0 - 1e-4;
  const double answer = seconds([&] { rve::followPath(cell, F, {.rest = {.tolerance = 1e-5}}); });
  rve::Tangent tangent;
  const double elastic = seconds([&] { tangent = rve::elasticTangent(cell); });
  const double voigt = seconds([&] { tangent -= rve::voigtTangent(cell); });
  std::printf("%6zu spheres, %s: answer %.4f s, elasticTangent %.4f s = %.1f answers, voigtTangent %.4f s = %.2f\n",
              cell.size(), state, answer, elastic, elastic / answer, voigt, voigt / answer);
  std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
  const int most = argc > 1 ? std::atoi(argv[1]) : 4000;
  for (const int count : {500, 1000, 2000, 4000}) {
    if (count > most) break;
    rve::Rve cell = rve::randomCell({.shape = rve::Shape::sphere,
                                     .count = count,
                                     .sizes = dem::UniformSizes{1e-3, 2e-3},
                                     .solidFraction = 0.6,
                                     .seed = 1},
                                    {.modulus = 1e8, .tangential = 0.8, .friction = 0.5});
    rve::compress(cell, {.pressure = {1e5, 1e5, 1e5}, .friction = 0.1, .rest = {.tolerance = 1e-4}});
    report(cell, "pressed");
    Eigen::Matrix3d F = Eigen::Matrix3d::Identity();
    for (int k = 1; k <= 5; ++k) {
      F(2, 2) = 1.0 - 2e-3 * k;
      F(0, 0) = F(1, 1) = 1.0 + 1e-3 * k;
      rve::followPath(cell, F, {.inertialNumber = 5e-3, .rest = {.tolerance = 1e-4}});
    }
    report(cell, "sheared");
  }
}
