#include "shape_sets.hpp"

#include <map>
#include <numeric>

namespace dovetail::solid_io {

namespace {

/// Splits a set of several shapes, under its name and theirs.
void addSetsByShape(fem::SolidMesh& mesh, const std::string& name, const std::vector<int>& elements) {
  std::map<std::string, std::vector<int>> parts;
  int first = 0;
  for (const fem::ElementGroup& group : mesh.groups) {
    const int last = first + static_cast<int>(group.size());
    for (const int e : elements)
      if (first <= e && e < last) parts[(name.empty() ? "" : name + " ") + fem::name(group.shape)].push_back(e);
    first = last;
  }
  if (parts.size() > 1) mesh.elementSets.merge(parts);
}

}  // namespace

void addSetsByShape(fem::SolidMesh& mesh) {
  if (mesh.groups.size() < 2) return;
  std::vector<int> all(mesh.elementCount());
  std::iota(all.begin(), all.end(), 0);
  const auto given = mesh.elementSets;
  addSetsByShape(mesh, "", all);
  for (const auto& [name, elements] : given) addSetsByShape(mesh, name, elements);
}

}  // namespace dovetail::solid_io
