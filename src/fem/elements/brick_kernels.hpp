// The hand-written kernels of bricks (elements.hpp) as kernels of a solid's batches.
#pragma once

#include <algorithm>

#include "dovetail/fem/elements/elements.hpp"
#include "kernels.hpp"
#include "solid_base.hpp"

namespace dovetail::fem::detail {

class BrickKernels {
public:
  BrickKernels(const SolidCells& cells, ElementType type, const Material& law)
      : block_(makeElements(brickMesh(cells), type, law)) {}

  /// Forces and energy; batches are those of the solid.
  void forces(const BatchTask& task, BatchResult& result) const {
    constexpr std::array<std::size_t, 8> localNode = {0, 1, 3, 2, 4, 5, 7, 6};  // of a binary corner
    const ElementCache& cache = block_.cache();
    BatchForces forces;
    batchForces(cache, cache.batches[task.batch], task.u, task.wantEnergy, forces);
    for (std::size_t corner = 0; corner < 8; ++corner)
      for (std::size_t i = 0; i < 3; ++i) result.f[3 * localNode[corner] + i] = forces.f[i][corner];
    result.energy = task.wantEnergy ? forces.energy : Lane{};
    result.dissipated = Lane{};
  }

  const ElementBlock& block() const { return block_; }

private:
  static Mesh brickMesh(const SolidCells& cells) {
    Mesh mesh{cells.X, {}, {}, {}};
    mesh.elements.resize(cells.size());
    for (std::size_t e = 0; e < cells.size(); ++e)
      std::copy_n(cells.node.begin() + static_cast<std::ptrdiff_t>(8 * e), 8, mesh.elements[e].begin());
    return mesh;
  }

  ElementBlock block_;
};

}  // namespace dovetail::fem::detail
