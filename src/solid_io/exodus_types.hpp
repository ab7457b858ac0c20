// The elements of Exodus files.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "mesh_builder.hpp"

namespace dovetail::solid_io {

/// What a block is made of; its nodes in our order are those of the file at `order`.
struct ExodusType {
  int dimension = 3;
  std::optional<fem::ElementShape> shape{};  ///< of volumes
  std::vector<int> order{};                  ///< empty: the same
};
/// @param name   such as "HEX8", "hex" @param nodes  of an element
/// @return nothing for other elements
std::optional<ExodusType> exodusType(const std::string& name, std::size_t nodes);

/// Our number of side `side`, from 1, of an element; −1 if there is no such side.
int sideOfExodus(fem::ElementShape shape, std::int64_t side);

}  // namespace dovetail::solid_io
