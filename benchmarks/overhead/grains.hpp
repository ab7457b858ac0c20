// Grains on a simple cubic lattice that fall into contact with what is below them.
#pragma once

#include <utility>

#include "dovetail/dem/laws/contact_laws.hpp"
#include "dovetail/dem/model/model.hpp"
#include "dovetail/dem/model/walls.hpp"
#include "dovetail/dem/setup/packing.hpp"
#include "scene.hpp"

namespace dovetail::overhead {

/// A cube of grains above z = 0 between four walls. @param floor  whether there is a fifth
inline void addGrains(dem::Model& grains, const Size& size, bool floor) {
  dem::ContactLaw<dem::LinearSpringDashpot, dem::TangentialSpring> law;
  law.normal = {.stiffness = stiffness, .restitution = 0.5};
  law.tangential = {.stiffness = 2.0 / 7.0 * stiffness, .friction = 0.4};
  grains.laws = dem::makeContactLaws(law);
  grains.gravity = gravity;
  const double width = widthOf(size);
  dem::addPacking(grains.particles,
                  dem::fillWithLattice(dem::Lattice::simpleCubic, {{}, {width, width, width}}, radius, 2.0 * radius),
                  {density});
  for (const auto& [point, inwards] : {std::pair{Vec3{}, Vec3{1, 0, 0}},
                                       {Vec3{}, Vec3{0, 1, 0}},
                                       {Vec3{width, 0, 0}, Vec3{-1, 0, 0}},
                                       {Vec3{0, width, 0}, Vec3{0, -1, 0}}})
    dem::addWall(grains, dem::makePlane(point, inwards));
  if (floor) dem::addWall(grains, dem::makePlane({}, {0, 0, 1}));
}

}  // namespace dovetail::overhead
