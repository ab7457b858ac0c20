// What the arrays of a VTU file say of its points and cells.
#pragma once

#include <vector>

#include "mesh_builder.hpp"

class vtkUnstructuredGrid;

namespace dovetail::solid_io {

/// Which cells are copies of another piece's, refined or hidden, by VTK's array vtkGhostType; they are noted.
std::vector<char> ghostCells(vtkUnstructuredGrid* grid, MeshBuilder& builder);

/// Gives the sets of whole-number arrays to the builder, which has the points and the cells that are not left out.
/// Arrays that look like sets and give none are noted.
void readVtuSets(vtkUnstructuredGrid* grid, const std::vector<char>& leftOut, MeshBuilder& builder);

}  // namespace dovetail::solid_io
