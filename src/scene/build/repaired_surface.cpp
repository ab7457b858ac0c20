// Surfaces of files, made fit for walls and meshers.
#include <filesystem>

#include "dovetail/geometry/triangle_mesh.hpp"
#include "parts.hpp"

namespace dovetail::scene {

namespace {

std::vector<std::string> notesOn(const geometry::SurfaceRepair& repair, geometry::ClosedPatches closed) {
  std::vector<std::string> notes;
  const auto note = [&](int count, const std::string& one, const std::string& many) {
    if (count > 0) notes.push_back(std::to_string(count) + " " + (count == 1 ? one : many));
  };
  const std::string why = closed == geometry::ClosedPatches::turn
                              ? " reversed: neighbours must be oriented alike, and closed parts outwards."
                              : " reversed: neighbours must be oriented alike.";
  note(repair.degenerateFacets, "facet without area was removed.", "facets without area were removed.");
  note(repair.duplicateFacets, "duplicate facet was removed.", "duplicate facets were removed.");
  note(repair.turnedFacets, "facet was" + why, "facets were" + why);
  note(repair.unusedVertices, "unused vertex was removed.", "unused vertices were removed.");
  return notes;
}

}  // namespace

geometry::TriangleMesh repairedSurface(const std::string& file, geometry::ClosedPatches closed,
                                       std::vector<std::string>& notes) {
  SurfaceOfFile read = readTriangles(file);
  const geometry::SurfaceRepair repair = geometry::repairSurface(read.mesh, 0.0, closed);
  const std::string name = std::filesystem::path(file).filename().string();
  for (const std::vector<std::string>& told : {read.notes, notesOn(repair, closed)})
    for (const std::string& note : told) notes.push_back(name + ": " + note);
  if (read.mesh.facets.empty())
    throw InputError("no facet of " + name + " has an area", "", "give a file with a surface");
  return std::move(read.mesh);
}

}  // namespace dovetail::scene
