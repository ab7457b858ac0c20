// Element types and faces of Abaqus.
#pragma once

#include <array>
#include <optional>
#include <string>

#include "dovetail/fem/mesh/solid_mesh.hpp"
#include "mesh_builder.hpp"

namespace dovetail::solid_io {

struct AbaqusType {
  int dimension;            ///< 3 volumes, 2 faces or plane cells, 1 lines
  fem::ElementShape shape;  ///< of volumes
  int nodes;
  SurfaceKind surface;  ///< of dimension 2
};
/// Empty for types that we do not take.
std::optional<AbaqusType> abaqusType(const std::string& type);
const char* abaqusName(fem::ElementShape shape);
/// Entry k: the place in an Abaqus element of our node k. Only C3D27 differs: its centre comes first, then faces S1 …
/// S6.
int abaqusPlace(fem::ElementShape shape, int k);
/// Our side of face S`face` (from 1); −1 if there is none.
int sideOfFace(fem::ElementShape shape, int face);

}  // namespace dovetail::solid_io
