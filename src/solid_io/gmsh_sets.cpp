// Elements of MSH files, and the sets that groups or entities make of them.
#include <algorithm>
#include <limits>

#include "gmsh_reader.hpp"

namespace dovetail::solid_io {

namespace {

constexpr std::array<const char*, 4> kinds = {"points", "curves", "surfaces", "volumes"};
const char* kindOf(int dimension) { return kinds[static_cast<std::size_t>(dimension)]; }

}  // namespace

std::span<const Label> GmshReader::nodesOf(const Element& element) const {
  return std::span(elementNodes_).subspan(element.firstNode, static_cast<std::size_t>(element.type->nodes));
}

/// Numbers of groups, whose sign says which way an entity runs.
std::vector<std::int64_t> GmshReader::groupsOf(const Element& element) const {
  std::vector<std::int64_t> groups = {element.group};
  if (version4_) {
    const auto found = groupsOfEntity_.find({element.type->dimension, element.entity});
    groups = found == groupsOfEntity_.end() ? std::vector<std::int64_t>() : found->second;
  }
  std::erase(groups, 0);
  for (std::int64_t& group : groups) {
    if (group == std::numeric_limits<std::int64_t>::min())
      source_.refuseAt(element.place, "the physical group is " + std::to_string(group),
                       "give numbers that have a positive one");
    group = std::abs(group);
  }
  return groups;
}

void GmshReader::giveElements() {
  std::set<Group> used;
  for (const Element& element : elements_) {
    const std::vector<std::int64_t> groups = groupsOf(element);
    giveElement(element, !groups.empty());
    for (const std::int64_t group : groups) {
      used.insert({element.type->dimension, group});
      addToSet(element, keyOf({element.type->dimension, group}));
    }
  }
  if (used.empty())
    for (const Element& element : elements_) addToSet(element, keyOfEntity(element));
  noteSharedNames(used);
}

void GmshReader::giveElement(const Element& element, bool grouped) {
  const auto& [type, label, firstNode, place, group, entity] = element;
  const std::span<const Label> nodes = nodesOf(element);
  if (type->dimension == 3) {
    std::array<Label, 27> ours{};
    const auto order = gmshOrder(type->shape);
    for (std::size_t k = 0; k < order.size(); ++k) ours[k] = nodes[static_cast<std::size_t>(order[k])];
    builder_.addCell(label, type->shape, std::span(ours).first(order.size()), place);
  }
  if (type->dimension == 2) builder_.addFace(label, surfaceOf(type->nodes), nodes, place, grouped);
  if (type->dimension == 1)
    builder_.addLine(label, nodes, place, grouped ? MeshBuilder::LineUse::mustFit : MeshBuilder::LineUse::line);
}

void GmshReader::addToSet(const Element& element, const SetKey& set) {
  if (element.type->dimension > 0) return builder_.addElementToSet(set, element.label, element.place);
  for (const Label node : nodesOf(element)) builder_.addNodeToSet(set, node, element.place);
}

SetKey GmshReader::keyOf(const Group& group) const {
  const auto& [dimension, number] = group;
  const std::string kind = kindOf(dimension);
  const auto found = names_.find(group);
  if (found == names_.end()) return {std::to_string(number), 3 - dimension, kind + " without a name"};
  return {found->second, 3 - dimension, kind};
}

SetKey GmshReader::keyOfEntity(const Element& element) {
  constexpr std::array<const char*, 4> words = {"point ", "curve ", "surface ", "volume "};
  const int dimension = element.type->dimension;
  const std::string word = words[static_cast<std::size_t>(dimension)];
  return {word + std::to_string(element.entity), 3 - dimension, word};
}

/// Gmsh itself takes groups of one dimension and one name for one.
void GmshReader::noteSharedNames(const std::set<Group>& used) {
  std::map<std::pair<int, std::string>, std::vector<std::int64_t>> named;
  for (const Group& group : used)
    if (const auto found = names_.find(group); found != names_.end())
      named[{group.first, found->second}].push_back(group.second);
  for (const auto& [name, numbers] : named) {
    if (numbers.size() < 2) continue;
    std::string all;
    for (const std::int64_t number : numbers) all += (all.empty() ? "" : ", ") + std::to_string(number);
    builder_.note("The groups " + all + " of " + kindOf(name.first) + " have one name, \"" + name.second +
                  "\", and are one set.");
  }
}

}  // namespace dovetail::solid_io
