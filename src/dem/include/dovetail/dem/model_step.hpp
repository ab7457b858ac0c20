// The stable step of a whole scene.
#pragma once

#include "dovetail/dem/contact_step.hpp"
#include "dovetail/dem/model.hpp"

namespace dovetail::dem {

/// What all contacts of the scene ask of its particles: pairs as they lie, walls as at the last step.
/// @param leastOverlap m; see addDemand
template <class Law>
ContactDemand contactDemand(const Model<Law>& model, double leastOverlap = 0.0) {
  ContactDemand demand;
  addDemand(demand, model.particles, model.pairs, model.laws, leastOverlap);
  for (const PrimitiveWall& wall : model.walls)
    addWallDemand(demand, model.particles, wall.contacts, model.laws, wall.material);
  for (const MeshWall& mesh : model.meshes)
    addWallDemand(demand, model.particles, mesh.contacts, model.laws, mesh.wall.material);
  return demand;
}

/// A safe step for the scene as it is, and the contact that sets it. Look again when contacts have grown in number or,
/// under laws that stiffen, in depth.
template <class Law>
ContactStep criticalStep(const Model<Law>& model, double leastOverlap = 0.0) {
  return criticalStep(contactDemand(model, leastOverlap), model.particles);
}

}  // namespace dovetail::dem
