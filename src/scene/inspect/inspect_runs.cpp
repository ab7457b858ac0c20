// What summaries, surfaces and meshes hold.
#include <fstream>
#include <iterator>
#include <ostream>

#include "build/parts.hpp"
#include "dovetail/core/atomic_file.hpp"
#include "dovetail/geometry/triangle_mesh.hpp"
#include "inspecting.hpp"
#include "read/json_tree.hpp"

namespace dovetail::scene {

namespace {

namespace fs = std::filesystem;

void inspectNumber(const Node& root, const char* part, const char* key, const char* unit, std::ostream& out) {
  const Node* const inner = root.find(part);
  const Node* const value = inner ? inner->find(key) : nullptr;
  if (value && value->kind == Node::Kind::number)
    out << "  " << part << ", " << key << ": " << value->number << unit << '\n';
}

void inspectTexts(const Node& root, const char* key, std::ostream& out) {
  const Node* const list = root.find(key);
  if (!list) return;
  for (const Node& item : list->items) out << "  " << key << ": " << item.text << '\n';
}

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
  std::ifstream stream = openFile(file);
  const Node root = parseJson({std::istreambuf_iterator<char>(stream), {}}, file.string());
  if (root.kind != Node::Kind::object || !root.find("provenance") || !root.find("times")) return false;
  out << "summary" << (root.find("title") ? ": " + root.find("title")->text : "") << '\n';
  for (const Node::Member& entry : root.find("provenance")->members)
    out << "  " << entry.key << ": " << entry.value[0].text << '\n';
  for (const char* const key : {"time_s", "particles"})
    if (const Node* const value = root.find(key)) out << "  " << key << ": " << value->number << '\n';
  inspectNumber(root, "step", "dt_s", "", out);
  inspectNumber(root, "step", "limit_s", "", out);
  inspectNumber(root, "energy", "residual_J", "", out);
  inspectNumber(root, "energy", "largest_residual_J", "", out);
  for (const char* const key : {"notes", "warnings"}) inspectTexts(root, key, out);
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
