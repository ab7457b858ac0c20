// Sets and surfaces of INP files.
#include <algorithm>
#include <limits>

#include "abaqus_reader.hpp"

namespace dovetail::solid_io {

namespace {

template <class Item>
void sortUnique(std::vector<Item>& items) {
  std::stable_sort(items.begin(), items.end());
  items.erase(std::unique(items.begin(), items.end()), items.end());
}

template <class Item>
void append(std::vector<Item>& to, const std::vector<Item>& items) {
  to.insert(to.end(), items.begin(), items.end());
  sortUnique(to);
}

}  // namespace

bool isNumber(std::string_view field) {
  return !field.empty() && field.find_first_not_of("+-0123456789") == std::string_view::npos;
}

std::string unquoted(std::string_view field) {
  if (field.size() >= 2 && field.front() == '"' && field.back() == '"') field = field.substr(1, field.size() - 2);
  return std::string(field);
}

LabelSet& AbaqusReader::setOf(LabelSets& sets, const std::string& name) {
  return sets.try_emplace({space(), lower(name)}, LabelSet{name, {}, {}, {}}).first->second;
}

void AbaqusReader::readSet(LabelSets& sets, const std::string& parameter) {
  std::vector<Parameter> known = {{parameter},
                                  {"generate", Parameter::flag},
                                  {"internal", Parameter::flag},
                                  {"unsorted", Parameter::flag},
                                  {"instance"},
                                  {"frequency"}};
  const bool ofNodes = parameter == "nset";
  if (ofNodes) known.push_back({"elset"});
  cards_.requireKnown(known);
  if (cards_.has("frequency")) ignored_.insert("frequency of *" + parameter);
  if (cards_.has("unsorted")) ignored_.insert("UNSORTED (sets are sorted)");
  LabelSet& set = setOf(sets, cards_.required(parameter));
  const Space in = spaceOfCard();
  if (ofNodes && cards_.has("elset")) {
    const LabelSet* const elements = find(elementSets_, in, cards_.required("elset"));
    if (elements == nullptr)
      cards_.refuse("there is no element set " + shown(cards_.required("elset")) + " yet", "define it further up");
    for (const auto& [key, one] : elementSets_)
      if (&one == elements) append(set.elementSets, {key});
    return cards_.requireNoData();
  }
  const bool generate = cards_.has("generate");
  for (std::vector<std::string_view> fields; cards_.data(fields);) {
    if (generate) {
      addRange(set, fields, in);
      continue;
    }
    for (const std::string_view field : fields)
      if (!field.empty()) readMember(sets, set, unquoted(field), in);
  }
}

void AbaqusReader::readMember(const LabelSets& sets, LabelSet& set, std::string field, Space space) {
  if (const LabelSet* const other = find(sets, space, field); other != nullptr && !isNumber(field))
    return addOther(set, *other);
  if (takeInstance(field)) space = Space::part;
  if (!isNumber(field)) cards_.refuseData("there is no set " + shown(field) + " yet", "define it further up");
  set.members.push_back({source_.parseInteger(field), space, cards_.dataPlace()});
}

void AbaqusReader::addRange(LabelSet& set, const std::vector<std::string_view>& given, Space space) {
  std::vector<std::string_view> fields = given;
  while (!fields.empty() && fields.back().empty()) fields.pop_back();
  if (fields.size() < 2 || fields.size() > 3)
    cards_.refuseData("a line of GENERATE has " + std::to_string(fields.size()) + " entries",
                      "give first, last and step");
  Label first = source_.parseInteger(fields[0]), last = source_.parseInteger(fields[1]);
  Label step = fields.size() > 2 && !fields[2].empty() ? source_.parseInteger(fields[2]) : 1;
  constexpr Label most = std::numeric_limits<int>::max();
  const bool backwards = step < 0 && last < first;
  const bool makesSense = step != 0 && std::min(first, last) >= 0 && std::max(first, last) <= most && step >= -most &&
                          (backwards || (step > 0 && first <= last));
  if (!makesSense)
    cards_.refuseData("GENERATE from " + std::to_string(first) + " to " + std::to_string(last) + " in steps of " +
                          std::to_string(step) + " makes no sense",
                      "give first <= last and a step >= 1");
  if (backwards) {
    last = first - (first - last) / -step * -step;
    std::swap(first, last);
    step = -step;
  }
  set.ranges.push_back({first, last, step, space, cards_.dataPlace()});
}

void AbaqusReader::addOther(LabelSet& set, const LabelSet& other) {
  const LabelSet copy = other;  // a set may name itself
  append(set.members, copy.members);
  append(set.ranges, copy.ranges);
  append(set.elementSets, copy.elementSets);
}

/// In the assembly a name of the assembly's comes first; then one of its only part.
const LabelSet* AbaqusReader::find(const LabelSets& sets, Space space, std::string name) const {
  auto found = sets.find({space, lower(name)});
  if (found != sets.end()) return &found->second;
  takeInstance(name);
  found = sets.find({Space::part, lower(name)});
  return found == sets.end() ? nullptr : &found->second;
}

/// Turns ranges into labels; one that names more than `existing` of them names some that do not exist.
void AbaqusReader::countOut(LabelSets& sets, std::size_t existing, const std::string& what) {
  for (auto& [key, set] : sets) {
    for (const LabelRange& range : set.ranges) {
      const auto count = static_cast<std::size_t>((range.last - range.first) / range.step) + 1;
      if (count > existing)
        source_.refuseAt(range.place,
                         "GENERATE names " + std::to_string(count) + " " + what + ", of which the file has " +
                             std::to_string(existing),
                         "name " + what + " that the file defines");
      for (std::size_t k = 0; k < count; ++k)
        set.members.push_back({range.first + static_cast<Label>(k) * range.step, range.space, range.place});
      if (set.members.size() > 4 * existing) sortUnique(set.members);
    }
    set.ranges.clear();
  }
}

/// The name that a set has in the mesh.
template <class Entry>
std::string AbaqusReader::nameOf(const SetName& key, const std::string& name, const std::map<SetName, Entry>& others,
                                 const std::string& what) {
  if (key.first == Space::model || !others.contains({Space::model, key.second})) return name;
  const std::string own = (instance_.empty() ? part_ : instance_) + "." + name;
  builder_.note("The assembly and the part have a" + what + " \"" + name +
                "\" each: the name is the assembly's, the part's is \"" + own + "\".");
  return own;
}

void AbaqusReader::addNodesOfElements(LabelSet& set) {
  for (const SetName& key : set.elementSets)
    for (const Member& element : elementSets_.at(key).members) {
      const auto [nodes, place] = builder_.nodesOf(labelOf(elementAliases_, element));
      for (const Label node : nodes) set.members.push_back({node, Space::part, place});
    }
  if (!set.elementSets.empty()) sortUnique(set.members);
}

void AbaqusReader::giveSets() {
  countOut(nodeSets_, builder_.nodeCount(), "nodes");
  countOut(elementSets_, builder_.elementCount(), "elements");
  const auto noteEmpty = [&](const LabelSet& set, const std::string& what) {
    if (set.members.empty()) builder_.note("The " + what + " \"" + set.name + "\" has no members and is left out.");
  };
  for (auto& [key, set] : nodeSets_) {
    addNodesOfElements(set);
    noteEmpty(set, "node set");
    const SetKey given{nameOf(key, set.name, nodeSets_, " node set"), 0, "nodes"};
    for (const Member& member : set.members) builder_.addNodeToSet(given, labelOf(nodeAliases_, member), member.place);
  }
  for (const auto& [key, set] : elementSets_) {
    noteEmpty(set, "element set");
    const SetKey given{nameOf(key, set.name, elementSets_, "n element set"), 2, "elements"};
    for (const Member& member : set.members)
      builder_.addElementToSet(given, labelOf(elementAliases_, member), member.place);
  }
}

void AbaqusReader::keepSurface() {
  cards_.requireKnown(
      {{"name"}, {"type"}, {"internal", Parameter::flag}, {"regiontype"}, {"trim"}, {"maxratio"}, {"fillet"}});
  for (const char* harmless : {"regiontype", "trim", "maxratio", "fillet"})
    if (cards_.has(harmless)) ignored_.insert(std::string(harmless) + " of *surface");
  const std::string& name = cards_.required("name");
  const std::string* given = cards_.parameter("type");
  const std::string type = given == nullptr ? "element" : lower(*given);
  if (type != "element" && type != "node")
    cards_.refuse("a surface of type " + shown(type) + " is not known here", "use TYPE=ELEMENT or TYPE=NODE");
  const SetName key{space(), lower(name)};
  surfaces_.emplace(key, name);
  bool any = false;
  for (std::vector<std::string_view> fields; cards_.data(fields); any = true) {
    while (fields.size() > 2 && fields.back().empty()) fields.pop_back();
    if (fields[0].empty()) cards_.refuseData("a line of a surface names no set", "give a set or number, and a face");
    if (fields.size() > 2)
      cards_.refuseData("a line of a surface has " + std::to_string(fields.size()) + " entries",
                        "give a set or number and a face, one pair a line");
    surfaceLines_.push_back({key, surfaces_.at(key), unquoted(fields[0]), fields.size() > 1 ? lower(fields[1]) : "",
                             type == "node", cards_.dataPlace()});
  }
  if (!any) builder_.note("The surface \"" + name + "\" has no lines and is left out.");
}

/// Labels that a number or the name of a set stands for.
std::vector<Label> AbaqusReader::labelsOf(const LabelSets& sets, const std::map<Label, Label>& aliases,
                                          const SurfaceLine& line) {
  Space in = line.surface.first;
  std::vector<Label> labels;
  if (const LabelSet* const set = isNumber(line.item) ? nullptr : find(sets, in, line.item)) {
    for (const Member& member : set->members) labels.push_back(labelOf(aliases, member));
    return labels;
  }
  std::string item = line.item;
  if (takeInstance(item)) in = Space::part;
  if (!isNumber(item))
    source_.refuseAt(line.place, "there is no set " + shown(line.item), "name a set or an element of this file");
  return {labelOf(aliases, {source_.parseInteger(item), in, line.place})};
}

void AbaqusReader::readSurfaces() {
  std::map<SetName, SetKey> keys;
  for (const auto& [key, name] : surfaces_) keys[key] = {nameOf(key, name, surfaces_, " surface"), 1, "surface"};
  for (const SurfaceLine& line : surfaceLines_) readSurface(line, keys.at(line.surface));
}

void AbaqusReader::readSurface(const SurfaceLine& line, const SetKey& key) {
  if (line.ofNodes) {
    for (const Label label : labelsOf(nodeSets_, nodeAliases_, line)) builder_.addNodeToSet(key, label, line.place);
    return;
  }
  const bool isFace = line.face.size() == 2 && line.face[0] == 's' && line.face[1] >= '1' && line.face[1] <= '6';
  if (!isFace) source_.refuseAt(line.place, "the face of a surface is " + shown(line.face), "name it S1 to S6");
  for (const Label label : labelsOf(elementSets_, elementAliases_, line)) {
    const int side = sideOfFace(builder_.shapeOf(label, line.place), line.face[1] - '0');
    if (side < 0) source_.refuseAt(line.place, "the element has no face " + shown(line.face), "name it S1 to S4");
    builder_.addSideToSet(key, label, side, line.place);
  }
}

}  // namespace dovetail::solid_io
