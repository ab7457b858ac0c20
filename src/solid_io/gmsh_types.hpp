// Element types of the MSH formats and their node orders.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>

#include "dovetail/fem/mesh/solid_mesh.hpp"

namespace dovetail::solid_io {

struct GmshType {
  int code, nodes, dimension;
  fem::ElementShape shape;  ///< of volume elements
};

/// Null for types that we do not take.
const GmshType* gmshType(std::int64_t code);
/// "prism of 6 nodes" and so on, for types that we do not take.
std::string gmshTypeName(std::int64_t code);
int gmshCode(fem::ElementShape shape);
int gmshCode(fem::FaceShape shape);
/// Entry k: the place in a Gmsh element of our node k.
std::span<const int> gmshOrder(fem::ElementShape shape);

}  // namespace dovetail::solid_io
