// A block of bricks of two grains' edge, held from below, and a plate.
#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "dovetail/fem/elements/solid.hpp"
#include "dovetail/fem/laws/point_laws.hpp"
#include "dovetail/fem/terms/loads.hpp"
#include "scene.hpp"

namespace dovetail::overhead {

inline constexpr double brick = 4.0 * radius;  // m
inline constexpr int layers = 5;               // below z = 0

/// @param above  layers above z = 0
inline fem::SolidMesh blockMesh(const Size& size, int above) {
  const double width = widthOf(size);
  return fem::boxOf(fem::ElementShape::hex8, {size.edge / 2, size.edge / 2, layers + above}, {0, 0, -layers * brick},
                    {width, width, above * brick});
}
/// @param fraction  of the elements, that is theirs where grains lie over them
inline std::unique_ptr<fem::Model> makeBlock(const fem::SolidMesh& mesh, std::vector<double> fraction = {}) {
  auto model = std::make_unique<fem::Model>(fem::makeModel(mesh));
  model->add(fem::makeSolid(mesh, fem::pointMaterial(fem::neoHookean(1e6, 0.2, 1309.0)),
                            {.name = "elements", .fraction = std::move(fraction)}));
  model->add(fem::gravity(gravity));
  fem::fix(model->nodes, mesh.nodeSets.at("z-"));
  return model;
}

/// On top of the grains, sinking.
inline fem::SolidMesh plateMesh(const Size& size) {
  const double width = widthOf(size), top = 2.0 * radius * size.edge;
  return fem::boxOf(fem::ElementShape::hex8, {size.edge / 4, size.edge / 4, 1}, {0.25 * width, 0.25 * width, top},
                    {0.75 * width, 0.75 * width, top + brick});
}
inline std::unique_ptr<fem::Model> makePlate(const fem::SolidMesh& mesh) {
  auto model = std::make_unique<fem::Model>(fem::makeModel(mesh));
  model->add(fem::makeSolid(mesh, fem::pointMaterial(fem::neoHookean(1e6, 0.2, 1309.0)), {.name = "elements"}));
  model->add(fem::gravity(gravity));
  return model;
}

}  // namespace dovetail::overhead
