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

Solid::Solid(const fem::SolidMesh& fullMesh, std::unique_ptr<fem::Model> model, double massShare)
    : mesh(fullMesh),
      model_(checked(std::move(model))),
      motion_(*model_, massShare),
      material_(*fem::requireBrickSolid(*model_, "volume coupling").material()->brickLaw()) {}

}  // namespace dovetail::arlequin
