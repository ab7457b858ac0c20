// Numbers by which VTK's formats call the shapes of cells.
#pragma once

#include <array>
#include <cstdint>

#include "dovetail/fem/mesh/solid_mesh.hpp"

namespace dovetail::solid_io {

/// By fem::ElementShape; VTK numbers the nodes of these cells as ElementShape does.
inline constexpr std::array<std::uint8_t, 7> vtkCellTypes{12, 25, 29, 10, 24, 9, 23};
constexpr std::uint8_t vtkCellType(fem::ElementShape shape) { return vtkCellTypes[static_cast<std::size_t>(shape)]; }

}  // namespace dovetail::solid_io
