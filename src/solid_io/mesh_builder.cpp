#include "mesh_builder.hpp"

#include <algorithm>
#include <limits>
#include <set>

#include "dovetail/core/error.hpp"
#include "dovetail/core/farthest.hpp"
#include "dovetail/fem/mesh/cell_topology.hpp"
#include "dovetail/fem/mesh/mesh_quality.hpp"
#include "face_finder.hpp"

namespace dovetail::solid_io {

void MeshBuilder::addNode(Label label, const Vec3& X, std::size_t place) {
  if (!nodes_.emplace(label, X_.size()).second)
    source_.refuseAt(place, "node " + std::to_string(label) + " occurs twice", "give each node a number of its own");
  if (X_.size() >= static_cast<std::size_t>(std::numeric_limits<int>::max()))
    source_.refuseAt(place, "the file holds too many nodes", "cut the mesh into several files");
  if (isTooFar(X))
    source_.refuseAt(place, "node " + std::to_string(label) + " lies farther than 1e15 m from the origin",
                     "give coordinates in metres");
  X_.push_back(X);
  nodeLabel_.push_back(label);
}

void MeshBuilder::requireNew(Label label, std::size_t place) const {
  if (hasElement(label))
    source_.refuseAt(place, "element " + std::to_string(label) + " occurs twice",
                     "give each element a number of its own");
}

void MeshBuilder::addLine(Label label, std::span<const Label> nodes, std::size_t place, LineUse use) {
  requireNew(label, place);
  lines_[label] = {{nodes.begin(), nodes.end()}, place, use};
}

void MeshBuilder::nameNodesOfLines() {
  for (const auto& [set, references] : elementSets_)
    for (const Reference& reference : references)
      if (const auto line = lines_.find(reference.label); line != lines_.end())
        for (const Label node : line->second.nodes) addNodeToSet(set, node, reference.place);
}

void MeshBuilder::addCell(Label label, fem::ElementShape shape, std::span<const Label> nodes, std::size_t place) {
  requireNew(label, place);
  cells_.emplace(label, cell_.size());
  cell_.push_back({label, shape, cellNode_.size(), place});
  cellNode_.insert(cellNode_.end(), nodes.begin(), nodes.end());
}

void MeshBuilder::addFace(Label label, const SurfaceKind& kind, std::span<const Label> nodes, std::size_t place,
                          bool mustFit) {
  requireNew(label, place);
  faces_.emplace(label, face_.size());
  face_.push_back({label, kind, {nodes.begin(), nodes.end()}, place, mustFit});
}

void MeshBuilder::addNodeToSet(const SetKey& set, Label node, std::size_t place) {
  nodeIndex(node, place);
  nodeSets_[set].push_back({node, 0, place});
}
void MeshBuilder::addElementToSet(const SetKey& set, Label element, std::size_t place) {
  if (!hasElement(element))
    source_.refuseAt(place, "element " + std::to_string(element) + " does not exist",
                     "name elements that the file defines");
  elementSets_[set].push_back({element, 0, place});
}
void MeshBuilder::addSideToSet(const SetKey& set, Label element, int side, std::size_t place) {
  sideSets_[set].push_back({element, side, place});
}

fem::ElementShape MeshBuilder::shapeOf(Label label, std::size_t place) const {
  const auto found = cells_.find(label);
  if (found == cells_.end())
    source_.refuseAt(place, "there is no volume element " + std::to_string(label), "name one that the file defines");
  return cell_[found->second].shape;
}

MeshBuilder::ElementNodes MeshBuilder::nodesOf(Label element) const {
  if (const auto line = lines_.find(element); line != lines_.end()) return {line->second.nodes, line->second.place};
  if (const auto face = faces_.find(element); face != faces_.end())
    return {face_[face->second].nodes, face_[face->second].place};
  const auto found = cells_.find(element);
  if (found == cells_.end()) return {};
  const Cell& cell = cell_[found->second];
  const auto begin = cellNode_.begin() + static_cast<std::ptrdiff_t>(cell.firstNode);
  return {{begin, begin + fem::nodesOf(cell.shape)}, cell.place};
}

int MeshBuilder::nodeIndex(Label label, std::size_t place) const {
  const auto found = nodes_.find(label);
  if (found == nodes_.end())
    source_.refuseAt(place, "node " + std::to_string(label) + " does not exist", "name nodes that the file defines");
  return static_cast<int>(found->second);
}

std::vector<char> MeshBuilder::usedNodes() {
  std::vector<char> used(X_.size(), 0);
  for (const Cell& cell : cell_)
    for (std::size_t a = 0; a < static_cast<std::size_t>(fem::nodesOf(cell.shape)); ++a)
      used[static_cast<std::size_t>(nodeIndex(cellNode_[cell.firstNode + a], cell.place))] = 1;
  return used;
}

void MeshBuilder::numberNodes(SolidFile& file) {
  const std::vector<char> used = usedNodes();
  newNumber_.assign(X_.size(), -1);
  std::size_t dropped = 0;
  std::set<std::array<double, 3>> places;
  for (std::size_t n = 0; n < X_.size(); ++n) {
    if (!used[n]) {
      ++dropped;
      continue;
    }
    newNumber_[n] = static_cast<int>(file.mesh.X.size());
    file.mesh.X.push_back(X_[n]);
    file.nodeNumber.push_back(nodeLabel_[n]);
    places.insert({X_[n].x, X_[n].y, X_[n].z});
  }
  if (dropped > 0)
    note(counted(dropped, "node that no volume element uses was", "nodes that no volume element uses were") +
         " dropped.");
  if (const std::size_t twice = file.mesh.X.size() - places.size(); twice > 0)
    note(counted(twice, "node lies", "nodes lie") + " exactly where an earlier one does; they stay separate.");
}

void MeshBuilder::dropDuplicates() {
  std::map<std::vector<Label>, std::size_t> seen;
  std::vector<Cell> kept;
  std::size_t dropped = 0;
  for (const Cell& cell : cell_) {
    const auto begin = cellNode_.begin() + static_cast<std::ptrdiff_t>(cell.firstNode);
    std::vector<Label> nodes(begin, begin + fem::nodesOf(cell.shape));
    std::sort(nodes.begin(), nodes.end());
    if (const auto twice = std::adjacent_find(nodes.begin(), nodes.end()); twice != nodes.end())
      source_.refuseAt(cell.place,
                       "element " + std::to_string(cell.label) + " names node " + std::to_string(*twice) + " twice",
                       "give elements whose nodes all differ (collapsed bricks are not taken)");
    const auto [entry, isNew] = seen.emplace(std::move(nodes), kept.size());
    cells_[cell.label] = entry->second;
    if (isNew) kept.push_back(cell);
    dropped += !isNew;
  }
  cell_ = std::move(kept);
  if (dropped > 0)
    note(counted(dropped, "element with the nodes of an earlier one was",
                 "elements with the nodes of earlier ones were") +
         " dropped; their sets have the earlier ones instead.");
}

void MeshBuilder::fillGroups(SolidFile& file) {
  for (const Cell& cell : cell_)
    if (std::none_of(file.mesh.groups.begin(), file.mesh.groups.end(),
                     [&](const fem::ElementGroup& group) { return group.shape == cell.shape; }))
      file.mesh.groups.push_back({cell.shape, {}});
  for (fem::ElementGroup& group : file.mesh.groups)
    for (Cell& cell : cell_) {
      if (cell.shape != group.shape) continue;
      cell.number = static_cast<int>(file.elementNumber.size());
      file.elementNumber.push_back(cell.label);
      for (std::size_t a = 0; a < static_cast<std::size_t>(fem::nodesOf(cell.shape)); ++a)
        group.node.push_back(
            newNumber_[static_cast<std::size_t>(nodeIndex(cellNode_[cell.firstNode + a], cell.place))]);
    }
}

void MeshBuilder::requireSound(const SolidFile& file) const {
  const fem::MeshQuality quality = fem::measureQuality(file.mesh);
  std::vector<std::size_t> bad;
  for (std::size_t e = 0; e < quality.element.size(); ++e)
    if (!(quality.element[e].scaledJacobian > 0.0)) bad.push_back(e);
  if (bad.empty()) return fem::validate(file.mesh);
  std::string named = bad.size() == 1 ? "element" : "elements";
  for (std::size_t k = 0; k < std::min<std::size_t>(10, bad.size()); ++k)
    named += (k == 0 ? " " : ", ") + std::to_string(file.elementNumber[bad[k]]);
  if (bad.size() > 10) named += " and " + std::to_string(bad.size() - 10) + " more";
  const auto first = std::find_if(cell_.begin(), cell_.end(),
                                  [&](const Cell& cell) { return cell.number == static_cast<int>(bad[0]); });
  source_.refuseAt(
      first->place, "flat, inside out or too distorted: " + named,
      "repair the mesh in the program that made it; if all are named, the order of their nodes is reversed");
}

SolidFile MeshBuilder::finish() {
  SolidFile file;
  takePlaneCells();
  if (cell_.empty())
    throw InputError("the file holds no volume elements", source_.name(),
                     "give hexahedra or tetrahedra of first or second order, or quadrilaterals of plane strain");
  nameNodesOfLines();
  numberNodes(file);
  if (const int off = plane_ ? fem::nodeOffPlane(file.mesh.X) : -1; off >= 0)
    throw InputError("the file holds no volume elements, and node " +
                         std::to_string(file.nodeNumber[static_cast<std::size_t>(off)]) +
                         " of its quadrilaterals is not in one plane z = const with the first",
                     source_.name(), "give volumes, or turn the mesh into the plane");
  dropDuplicates();
  fillGroups(file);
  std::map<SetKey, std::vector<int>> nodes = nodesNamed();
  fillElementSets(file);
  fillFaceSets(file, nodes);
  settle(nodes, "node", file.mesh.nodeSets);
  requireSound(file);
  file.notes = notes_;
  return file;
}

}  // namespace dovetail::solid_io
