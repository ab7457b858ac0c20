// What summaries, surfaces and meshes hold.
#include <ostream>

#include "build/parts.hpp"
#include "dovetail/geometry/triangle_mesh.hpp"
#include "dovetail/report/summary.hpp"
#include "inspecting.hpp"

namespace dovetail::scene {

namespace {

namespace fs = std::filesystem;

void inspectBox(const std::vector<Vec3>& places, std::ostream& out) {
  if (places.empty()) return;
  Vec3 least = places[0], most = least;
  for (const Vec3& x : places)
    for (int c = 0; c < 3; ++c) least[c] = std::min(least[c], x[c]), most[c] = std::max(most[c], x[c]);
  for (int c = 0; c < 3; ++c)
    out << "  "
        << "xyz"[c] << ": " << least[c] << " … " << most[c] << '\n';
}

}  // namespace

bool inspectSummary(const fs::path& file, std::ostream& out) {
  if (file.filename() != "summary.json") return false;
  const report::Json summary = report::readSummary(file);
  const auto print = [&](const std::string& name, const report::Json& value) {
    if (const std::string text = report::textOf(value); !text.empty()) out << "  " << name << ": " << text << '\n';
  };
  out << "summary: " << summary.value("title", "") << '\n';
  for (const auto& [key, value] : summary.at("provenance").items()) print(key, value);
  for (const char* const key : {"time_s", "particles"}) print(key, summary.value(key, report::Json()));
  for (const auto& [part, key] :
       {std::pair{"step", "dt_s"}, {"step", "limit_s"}, {"energy", "residual_J"}, {"energy", "largest_residual_J"}})
    if (summary.contains(part)) print(std::string(part) + ", " + key, summary[part].value(key, report::Json()));
  for (const char* const part : {"notes", "warnings"})
    for (const report::Json& line : summary.value(part, report::Json::array())) print(part, line);
  const report::Json results = summary.value("results", report::Json::object());
  for (const auto& [key, value] : results.items()) print(key, value);
  return true;
}

bool inspectShape(const fs::path& file, std::ostream& out) {
  const std::string ending = file.extension().string();
  if (ending == ".stl" || ending == ".obj" || ending == ".ply") {
    const auto [mesh, notes] = readTriangles(file.string());
    out << "surface of " << mesh.x.size() << " vertices and " << mesh.facets.size() << " facets\n";
    inspectBox(mesh.x, out);
    for (const std::string& note : notes) out << note << '\n';
    return true;
  }
  if (ending != ".msh" && ending != ".inp") return false;
  const auto [mesh, notes] = readMesh(file.string());
  out << "mesh of " << mesh.X.size() << " nodes\n";
  for (const fem::ElementGroup& group : mesh.groups)
    out << "  " << group.size() << " elements " << fem::name(group.shape) << '\n';
  for (const auto& [name, elements] : mesh.elementSets)
    out << "  element set \"" << name << "\": " << elements.size() << '\n';
  for (const auto& [name, nodes] : mesh.nodeSets) out << "  node set \"" << name << "\": " << nodes.size() << '\n';
  for (const auto& [name, faces] : mesh.faceSets) out << "  face set \"" << name << "\": " << faces.size() << '\n';
  inspectBox(mesh.X, out);
  for (const std::string& note : notes) out << note << '\n';
  return true;
}

}  // namespace dovetail::scene
