// Grains that share two layers of bricks with a solid.
#pragma once

#include <algorithm>
#include <vector>

#include "couplings.hpp"
#include "dovetail/arlequin/arlequin_coupling.hpp"
#include "dovetail/arlequin/weights.hpp"

namespace dovetail::overhead {

inline void shareLayers(coupling::CoupledRun& run, const Size& size) {
  constexpr int shared = 2;
  const fem::SolidMesh mesh = blockMesh(size, shared);
  std::vector<double> place;
  for (const Vec3& X : mesh.X)
    place.push_back(X.z < -1e-9 ? arlequin::beyondOverlap : std::clamp(1.0 - X.z / (shared * brick), 0.0, 1.0));
  const std::vector<double> weight = arlequin::nodalWeights(place, {});
  coupling::SolidSide& side = run.addSolid(makeBlock(mesh, arlequin::solidWeights(weight)), {.name = "block"});
  run.grains.terms.add(arlequin::makeArlequinCoupling(run.grains, mesh, weight, side, {}));
}

}  // namespace dovetail::overhead
