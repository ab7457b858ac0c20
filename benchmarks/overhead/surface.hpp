// Contacts of grains with a solid.
#pragma once

#include "couplings.hpp"
#include "dovetail/surface/surface_contact.hpp"

namespace dovetail::overhead {

inline void touch(coupling::CoupledRun& run, coupling::SolidSide& side, const fem::SolidMesh& mesh, const char* set) {
  run.grains.terms.add(surface::SurfaceContact(
      side, surface::SurfaceCoupler(surface::makeSkin(mesh.X, mesh.faceSets.at(set))), run.grains.laws, "contacts"));
}

}  // namespace dovetail::overhead
