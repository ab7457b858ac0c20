// Time per element of the internal forces and per step of the Newmark solver. Prints medians and
// the best sample.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <functional>
#include <vector>

#include "dovetail/core/parallel.hpp"
#include "dovetail/fem/elements/elements.hpp"
#include "dovetail/fem/motion/newmark.hpp"

namespace {

using namespace dovetail;
using namespace dovetail::fem;

struct Times {
  double median, best;  // s
};

/// Seconds of a call over `samples` samples of `repeats` calls.
Times measure(int samples, int repeats, const std::function<void()>& call) {
  std::vector<double> seconds;
  for (int s = 0; s < samples; ++s) {
    const auto start = std::chrono::steady_clock::now();
    for (int r = 0; r < repeats; ++r) call();
    seconds.push_back(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count() / repeats);
  }
  std::sort(seconds.begin(), seconds.end());
  return {seconds[static_cast<std::size_t>(samples / 2)], seconds.front()};
}

Mesh beam(std::array<int, 3> counts, bool distorted) {
  Mesh mesh = boxMesh(counts, {0.0, 0.0, 0.0}, {0.4 * counts[0], 0.4 * counts[1], 0.4 * counts[2]});
  if (distorted)
    for (Vec3& X : mesh.X) X += 0.03 * Vec3{std::sin(7.0 * X.y), std::sin(5.0 * X.z), std::sin(6.0 * X.x)};
  return mesh;
}

Nodes bent(const Mesh& mesh) {
  Nodes nodes = makeNodes(mesh);
  for (std::size_t n = 0; n < nodes.X.size(); ++n)
    nodes.u[n] = 0.01 * Vec3{std::sin(nodes.X[n].y), std::cos(nodes.X[n].z), std::sin(nodes.X[n].x)};
  return nodes;
}

void timeResidual(const char* label, std::array<int, 3> counts, bool distorted, ElementType type,
                  const Material& material) {
  const Mesh mesh = beam(counts, distorted);
  const ElementBlock block = makeElements(mesh, type, material);
  Nodes nodes = bent(mesh);
  const int repeats = std::max(1, static_cast<int>(400000 / block.size()));
  const auto n = static_cast<double>(block.size());
  const Times plain = measure(15, repeats, [&] { addInternalForces(block, nodes); });
  const Times energy = measure(15, repeats, [&] { addInternalForces(block, nodes, true); });
  std::printf("%-34s %3dx%3dx%3d  %6.1f ns/element (best %6.1f), with energy %6.1f (best %6.1f)\n", label, counts[0],
              counts[1], counts[2], 1e9 * plain.median / n, 1e9 * plain.best / n, 1e9 * energy.median / n,
              1e9 * energy.best / n);
}

void timeNewmark(std::array<int, 3> counts, double share, double dt) {
  const Mesh mesh = beam(counts, false);
  const ElementBlock block = makeElements(mesh, ElementType::hex8, StVenantKirchhoff{1e8, 0.0, 1309.0});
  Nodes nodes = makeNodes(mesh);
  addLumpedMass(block, nodes);
  fix(nodes, nodeSet(mesh, "z-"));
  NewmarkSolver solver(block, nodes, dt, {.consistentShare = share});
  std::vector<Vec3> load(nodes.X.size());
  for (const int node : nodeSet(mesh, "z+")) load[static_cast<std::size_t>(node)].x = 20.0;
  int iterations = 0, steps = 0, factorisations = 0;
  const Times seconds = measure(15, 20, [&] {
    const NewmarkReport report = solver.step(nodes, load);
    iterations += report.iterations;
    factorisations += report.factorisations;
    ++steps;
  });
  std::printf(
      "Newmark (%s), %3dx%3dx%3d, share %.1f, dt %.1e s: %8.3f ms/step (best %.3f), %.2f iterations, %d "
      "factorisations\n",
      SparseCholesky::name(), counts[0], counts[1], counts[2], share, dt, 1e3 * seconds.median, 1e3 * seconds.best,
      static_cast<double>(iterations) / steps, factorisations);
}

}  // namespace

int main(int argc, char** argv) {
  setThreads(argc > 1 ? std::atoi(argv[1]) : 1);
  std::printf("%d thread(s)\n", threads());
  const StVenantKirchhoff kirchhoff{1e8, 0.3, 1309.0};
  for (const std::array<int, 3> counts : {std::array{2, 2, 30}, std::array{10, 10, 150}}) {
    timeResidual("hex8 boxes", counts, false, ElementType::hex8, kirchhoff);
    timeResidual("hex8 boxes, deformed metric", counts, false, ElementType::hex8,
                 DeformedMetricHooke{1e8, 0.3, 1309.0});
    timeResidual("hybrid8 boxes", counts, false, ElementType::hybrid8, kirchhoff);
    timeResidual("hex8 distorted", counts, true, ElementType::hex8, kirchhoff);
    timeResidual("hybrid8 distorted", counts, true, ElementType::hybrid8, kirchhoff);
  }
  timeNewmark({2, 2, 30}, 0.0, 9e-5);
  timeNewmark({2, 2, 30}, 0.0, 4.5e-3);
  timeNewmark({2, 2, 30}, 1.0, 4.5e-3);
}
