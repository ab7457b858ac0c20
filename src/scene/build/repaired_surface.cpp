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

geometry::TriangleMesh repairedSurface(const std::vector<std::string>& files, double tolerance,
                                       geometry::ClosedPatches closed, std::vector<std::string>& notes) {
  geometry::TriangleMesh all;
  std::string names;
  for (const std::string& file : files) {
    SurfaceOfFile read = readTriangles(file);
    const std::string name = std::filesystem::path(file).filename().string();
    names += (names.empty() ? "" : ", ") + name;
    for (const std::string& note : read.notes) notes.push_back(name + ": " + note);
    const auto first = static_cast<int>(all.x.size());
    all.x.insert(all.x.end(), read.mesh.x.begin(), read.mesh.x.end());
    for (geometry::Facet facet : read.mesh.facets) {
      for (int& vertex : facet) vertex += first;
      all.facets.push_back(facet);
    }
  }
  for (const std::string& note : notesOn(geometry::repairSurface(all, tolerance, closed), closed))
    notes.push_back(names + ": " + note);
  if (all.facets.empty()) throw InputError("no facet of " + names + " has an area", "", "give a file with a surface");
  return all;
}

geometry::TriangleMesh surfaceOf(const TriangleFiles& from, geometry::ClosedPatches closed,
                                 std::vector<std::string>& notes) {
  std::vector<std::string> files{from.file};
  files.insert(files.end(), from.more.begin(), from.more.end());
  geometry::TriangleMesh mesh = repairedSurface(files, from.tolerance / from.scale, closed, notes);
  for (Vec3& x : mesh.x) x = from.scale * x + from.shift;
  return mesh;
}

}  // namespace dovetail::scene
