#include "dovetail/arlequin/coupling.hpp"
#include "dovetail/core/error.hpp"

namespace dovetail::arlequin {

namespace {

std::unique_ptr<fem::Model> checked(std::unique_ptr<fem::Model> model) {
  fem::requireBrickSolid(*model, "volume coupling");
  addMass(*model);
  return model;
}

}  // namespace

Bricks bricksOf(const fem::SolidMesh& mesh) {
  Bricks bricks{mesh.X, {}};
  for (const fem::CellGroup& group : mesh.groups) {
    if (group.shape != fem::CellShape::hex8)
      throw InputError(std::string("the mesh has ") + fem::name(group.shape) + " elements", "volume coupling",
                       "give a mesh of hex8 elements alone");
    for (std::size_t e = 0; e < group.size(); ++e) {
      std::array<int, 8>& element = bricks.elements.emplace_back();
      for (std::size_t a = 0; a < 8; ++a) element[a] = group.node[8 * e + a];
    }
  }
  return bricks;
}

fem::CellLocator locatorOf(std::span<const std::array<int, 8>> elements, std::span<const Vec3> position) {
  fem::CellGroup group{fem::CellShape::hex8, {}};
  for (const std::array<int, 8>& element : elements)
    group.node.insert(group.node.end(), element.begin(), element.end());
  return {std::span(&group, 1), position};
}

Solid::Solid(const fem::SolidMesh& fullMesh, std::unique_ptr<fem::Model> model, double massShare)
    : mesh(bricksOf(fullMesh)),
      model_(checked(std::move(model))),
      motion_(*model_, massShare),
      material_(*fem::requireBrickSolid(*model_, "volume coupling").material()->brickLaw()) {}

}  // namespace dovetail::arlequin
