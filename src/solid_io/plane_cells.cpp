// Surface elements and lines of files without volumes.
#include <utility>

#include "mesh_builder.hpp"

namespace dovetail::solid_io {

SurfaceKind surfaceOf(int nodes) {
  if (nodes == 3 || nodes == 6) return {3, {}, "a triangle"};
  if (nodes == 9) return {4, {}, "a quadrilateral of nine nodes"};
  return {4, nodes == 4 ? fem::ElementShape::quad4 : fem::ElementShape::quad8, ""};
}

bool MeshBuilder::takePlaneCells() {
  if (!cell_.empty() || face_.empty()) return plane_;
  plane_ = true;
  faces_.clear();
  for (const SurfaceElement& element : std::exchange(face_, {})) {
    if (!element.kind.plane)
      source_.refuseAt(element.place,
                       "there are no volume elements, and element " + std::to_string(element.label) + " is " +
                           element.kind.otherwise,
                       "give volumes, or quadrilaterals of plane strain of four or eight nodes");
    addCell(element.label, *element.kind.plane, element.nodes, element.place);
  }
  for (const auto& [label, line] : std::exchange(lines_, {}))
    if (line.use == LineUse::names)
      addLine(label, line.nodes, line.place);
    else
      addFace(label, {2, {}, ""}, line.nodes, line.place, line.use == LineUse::mustFit);
  note("There are no volume elements: the mesh is one of plane strain, 1 m thick (fem::SolidMesh::thickness).");
  return true;
}

}  // namespace dovetail::solid_io
