// Sets of a mesh from those of its file.
#include <algorithm>
#include <set>

#include "dovetail/fem/mesh/cell_topology.hpp"
#include "face_finder.hpp"
#include "mesh_builder.hpp"
#include "shape_sets.hpp"

namespace dovetail::solid_io {

namespace {

void sortUnique(std::vector<int>& numbers) {
  std::sort(numbers.begin(), numbers.end());
  numbers.erase(std::unique(numbers.begin(), numbers.end()), numbers.end());
}

bool sameMembers(const std::vector<int>& a, const std::vector<int>& b) { return a == b; }
bool sameMembers(const std::vector<fem::Face>& a, const std::vector<fem::Face>& b) {
  const auto nodesOf = [](const std::vector<fem::Face>& faces) {
    std::set<std::array<int, 9>> nodes;
    for (const fem::Face& face : faces) nodes.insert(face.node);
    return nodes;
  };
  return nodesOf(a) == nodesOf(b);
}

/// A face that is named twice would carry its load twice.
void dropRepeated(std::vector<fem::Face>& faces) {
  std::set<std::array<int, 9>> seen;
  std::erase_if(faces, [&](const fem::Face& face) { return !seen.insert(face.node).second; });
}

}  // namespace

std::map<SetKey, std::vector<int>> MeshBuilder::nodesNamed() {
  std::map<SetKey, std::vector<int>> named;
  for (const auto& [set, references] : nodeSets_) {
    std::vector<int> numbers;
    for (const Reference& reference : references) {
      const int number = newNumber_[static_cast<std::size_t>(nodeIndex(reference.label, reference.place))];
      if (number >= 0) numbers.push_back(number);
    }
    sortUnique(numbers);
    if (numbers.empty())
      note("The node set \"" + set.name + "\" is left out: no volume element uses its nodes.");
    else
      named[set] = numbers;
  }
  return named;
}

void MeshBuilder::fillElementSets(SolidFile& file) {
  std::map<SetKey, std::vector<int>> named;
  for (const auto& [set, references] : elementSets_) {
    std::vector<int> numbers;
    for (const Reference& reference : references)
      if (const auto cell = cells_.find(reference.label); cell != cells_.end())
        numbers.push_back(cell_[cell->second].number);
    sortUnique(numbers);
    if (!numbers.empty()) named[set] = numbers;
  }
  settle(named, "element", file.mesh.elementSets);
  addSetsByShape(file.mesh);
}

template <class Members>
void MeshBuilder::settle(const std::map<SetKey, Members>& named, const std::string& kind,
                         std::map<std::string, Members>& sets) {
  for (const auto& [set, members] : named) {
    const auto [first, isNew] = sets.try_emplace(set.name, members);
    if (isNew || sameMembers(first->second, members)) continue;
    std::string own = set.name + " (" + set.origin + ")";
    while (!sets.try_emplace(own, members).second) own += "'";
    note("There are different " + kind + " sets \"" + set.name + "\"; that of the " + set.origin + " is \"" + own +
         "\".");
  }
}

bool MeshBuilder::placeFace(const FaceFinder& finder, const SurfaceElement& element, fem::Face& face) const {
  std::vector<int> corners;
  for (const Label label : std::span(element.nodes).first(static_cast<std::size_t>(element.kind.corners)))
    corners.push_back(newNumber_[static_cast<std::size_t>(nodeIndex(label, element.place))]);
  const bool all = std::find(corners.begin(), corners.end(), -1) == corners.end();
  const Side side = all ? finder.find(corners) : Side{-1, -1};
  if (side.element < 0 && element.mustFit)
    source_.refuseAt(element.place,
                     plane_ ? "line " + std::to_string(element.label) + " is no side of an element"
                            : "surface element " + std::to_string(element.label) + " is no face of a volume element",
                     plane_ ? "mesh the surface beside it, or take it out of its set"
                            : "mesh the volume behind it, or take it out of its set");
  if (side.element >= 0) face = finder.face(side);
  return side.element >= 0;
}

std::vector<fem::Face> MeshBuilder::placedFaces(const FaceFinder& finder, std::vector<char>& fits) {
  std::vector<fem::Face> placed(face_.size());
  fits.resize(face_.size());
  for (std::size_t f = 0; f < face_.size(); ++f) fits[f] = placeFace(finder, face_[f], placed[f]);
  const auto loose = static_cast<std::size_t>(std::count(fits.begin(), fits.end(), 0));
  if (loose > 0)
    note((plane_ ? counted(loose, "line that is no side of an element was", "lines that are no sides of elements were")
                 : counted(loose, "surface element that is no face of a volume element was",
                           "surface elements that are no faces of volume elements were")) +
         " ignored.");
  return placed;
}

void MeshBuilder::fillFaceSets(SolidFile& file, std::map<SetKey, std::vector<int>>& nodes) {
  if (face_.empty() && sideSets_.empty()) return;
  const FaceFinder finder(file.mesh);
  std::vector<char> fits;
  const std::vector<fem::Face> placed = placedFaces(finder, fits);
  std::map<SetKey, std::vector<fem::Face>> named;
  for (const auto& [set, references] : elementSets_)
    for (const Reference& reference : references)
      if (const auto face = faces_.find(reference.label); face != faces_.end() && fits[face->second])
        named[set].push_back(placed[face->second]);
  for (const auto& [set, references] : sideSets_)
    for (const Reference& reference : references) {
      shapeOf(reference.label, reference.place);
      named[set].push_back(finder.face({cell_[cells_.at(reference.label)].number, reference.side}));
    }
  for (auto& [set, faces] : named) {
    dropRepeated(faces);
    std::vector<int>& ofFaces = nodes[set];
    for (const fem::Face& face : faces)
      ofFaces.insert(ofFaces.end(), face.node.begin(), face.node.begin() + fem::nodesOf(face.shape));
    sortUnique(ofFaces);
  }
  settle(named, "face", file.mesh.faceSets);
}

}  // namespace dovetail::solid_io
