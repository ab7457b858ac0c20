#include <algorithm>
#include <limits>
#include <set>

#include "abaqus_types.hpp"
#include "dovetail/core/error.hpp"
#include "inp_cards.hpp"
#include "mesh_builder.hpp"

namespace dovetail::solid_io {

namespace {

using Fields = std::vector<std::string_view>;

/// first, first + step, … up to last, as GENERATE has it.
struct LabelRange {
  Label first, last, step;
  std::size_t place;
  auto operator<=>(const LabelRange&) const = default;
};

/// A set of labels, and the spelling its name was first given in. Ranges are counted out when all that they may name
/// has been read: until then a line of a file could stand for any number of labels.
struct LabelSet {
  std::string name;
  std::vector<Label> labels;
  std::vector<LabelRange> ranges;
  std::size_t place;
};
using LabelSets = std::map<std::string, LabelSet>;

bool isNumber(std::string_view field) {
  return !field.empty() && field.find_first_not_of("+-0123456789") == std::string_view::npos;
}

template <class Item>
void sortUnique(std::vector<Item>& items) {
  std::sort(items.begin(), items.end());
  items.erase(std::unique(items.begin(), items.end()), items.end());
}

std::string unquoted(std::string_view field) {
  if (field.size() >= 2 && field.front() == '"' && field.back() == '"') field = field.substr(1, field.size() - 2);
  return std::string(field);
}

std::string listed(const std::set<std::string>& words, const std::string& mark) {
  std::string all;
  for (const std::string& word : words) all += (all.empty() ? "" : ", ") + mark + word;
  return all;
}

class AbaqusReader {
public:
  explicit AbaqusReader(Source& source) : source_(source), cards_(source), builder_(source) {}

  SolidFile read() {
    while (cards_.next()) readCard(cards_.keyword());
    countOut(nodeSets_, builder_.nodeCount(), "nodes");
    countOut(elementSets_, builder_.elementCount(), "elements");
    for (const auto& [key, set] : nodeSets_)
      for (const Label label : set.labels) builder_.addNodeToSet(set.name, label, set.place);
    for (const auto& [key, set] : elementSets_)
      for (const Label label : set.labels) builder_.addElementToSet(set.name, label, set.place);
    if (builder_.takePlaneCells()) variants_.merge(planeVariants_);
    readSurfaces();
    if (!passedOver_.empty())
      builder_.note("Cards that say nothing about the mesh were passed over: " + listed(passedOver_, "*") + ".");
    if (!variants_.empty())
      builder_.note("Of the element types " + listed(variants_, "") +
                    " the shape alone was read: fem::Formulation says how it is integrated.");
    return builder_.finish(false);
  }

private:
  void readCard(const std::string& keyword) {
    static const std::set<std::string> refused = {"include", "ngen",   "nfill",  "ncopy",    "nmap",          "elgen",
                                                  "elcopy",  "system", "import", "submodel", "element delete"};
    if (keyword == "node") return readNodes();
    if (keyword == "element") return readElements();
    if (keyword == "nset") return readSet(nodeSets_, "nset", nullptr);
    if (keyword == "elset") return readSet(elementSets_, "elset", nullptr);
    if (keyword == "surface") return keepSurface();
    if (keyword == "part" && ++parts_ > 1)
      cards_.refuse("there is a second *part", "write one part, or a flat file (no parts, no assembly)");
    if (keyword == "instance") return readInstance();
    if (refused.contains(keyword))
      cards_.refuse("*" + keyword + " is not known here", "write nodes, elements and sets out in this file");
    static const std::set<std::string> silent = {"heading",  "preprint",    "part",       "endpart",
                                                 "assembly", "endassembly", "endinstance"};
    if (!silent.contains(keyword)) passedOver_.insert(keyword);
  }

  void readInstance() {
    Fields fields;
    if (++instances_ > 1)
      cards_.refuse("there is a second *instance", "write one, or a flat file (no parts, no assembly)");
    if (cards_.data(fields))
      cards_.refuseData("the instance is moved", "write it where it belongs, without a translation or rotation");
  }

  void requireHere() {
    for (const char* elsewhere : {"input", "system"})
      if (cards_.has(elsewhere))
        cards_.refuse("*" + cards_.keyword() + " has the parameter " + elsewhere, "write Cartesian data in this file");
  }

  void readNodes() {
    requireHere();
    LabelSet* set = cards_.has("nset") ? &setOf(nodeSets_, cards_.required("nset")) : nullptr;
    for (Fields fields; cards_.data(fields);) {
      if (fields.size() < 2 || fields.size() > 7)
        cards_.refuseData("a node has " + std::to_string(fields.size()) + " entries", "give number, x, y, z");
      Vec3 X;
      for (std::size_t i = 1; i < std::min<std::size_t>(fields.size(), 4); ++i)
        X[static_cast<int>(i) - 1] = fields[i].empty() ? 0.0 : source_.parseReal(fields[i]);
      const Label label = source_.parseInteger(fields[0]);
      builder_.addNode(label, X, cards_.dataPlace());
      if (set != nullptr) set->labels.push_back(label);
    }
  }

  void readElements() {
    requireHere();
    std::string name = cards_.required("type");
    std::transform(name.begin(), name.end(), name.begin(),
                   [](char c) { return c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c; });
    const auto type = abaqusType(name);
    if (!type)
      cards_.refuse("elements of type " + shown(name) + " are not known here",
                    "use C3D8, C3D20, C3D27, C3D4 or C3D10 (with surface elements that name faces), CPE4 or CPE8");
    if (type->dimension == 3 && name != abaqusName(type->shape)) variants_.insert(name);
    if (type->dimension == 2 && type->surface.plane && name != abaqusName(*type->surface.plane))
      planeVariants_.insert(name);
    LabelSet* set = cards_.has("elset") ? &setOf(elementSets_, cards_.required("elset")) : nullptr;
    std::vector<Label> numbers;
    std::size_t place = 0;
    for (Fields fields; cards_.data(fields);) {
      if (numbers.empty()) place = cards_.dataPlace();
      for (const std::string_view field : fields)
        if (!field.empty()) numbers.push_back(source_.parseInteger(field));
      const auto wanted = static_cast<std::size_t>(type->nodes) + 1;
      if (numbers.size() > wanted)
        source_.refuseAt(place, "an element has " + std::to_string(numbers.size() - 1) + " nodes",
                         "give " + std::to_string(type->nodes) + " after its number");
      if (numbers.size() < wanted) continue;
      addElement(*type, numbers, place);
      if (set != nullptr) set->labels.push_back(numbers[0]);
      numbers.clear();
    }
    if (!numbers.empty())
      source_.refuseAt(place, "an element has " + std::to_string(numbers.size() - 1) + " nodes",
                       "give " + std::to_string(type->nodes) + " after its number");
  }

  void addElement(const AbaqusType& type, std::span<const Label> numbers, std::size_t place) {
    const auto nodes = numbers.subspan(1);
    if (type.dimension == 1) return builder_.addLine(numbers[0], nodes, place);
    if (type.dimension == 2) return builder_.addFace(numbers[0], type.surface, nodes, place);
    std::vector<Label> ours;
    for (int k = 0; k < type.nodes; ++k) ours.push_back(nodes[static_cast<std::size_t>(abaqusPlace(type.shape, k))]);
    builder_.addCell(numbers[0], type.shape, ours, place);
  }

  LabelSet& setOf(LabelSets& sets, const std::string& name) {
    return sets.try_emplace(lower(name), LabelSet{name, {}, {}, cards_.place()}).first->second;
  }

  void readSet(LabelSets& sets, const std::string& parameter, LabelSet* into) {
    LabelSet& set = into != nullptr ? *into : setOf(sets, cards_.required(parameter));
    if (parameter == "nset" && cards_.has("elset"))
      cards_.refuse("*nset takes the nodes of an elset", "list the nodes");
    const bool generate = cards_.has("generate");
    for (Fields fields; cards_.data(fields);) {
      if (generate) {
        addRange(set, fields);
        continue;
      }
      for (const std::string_view field : fields) {
        if (isNumber(field)) set.labels.push_back(source_.parseInteger(field));
        if (!field.empty() && !isNumber(field)) addOther(sets, set, unquoted(field));
      }
    }
  }

  void addRange(LabelSet& set, const Fields& fields) {
    if (fields.size() < 2)
      cards_.refuseData("a line of GENERATE has " + std::to_string(fields.size()) + " entries",
                        "give first, last and step");
    const Label first = source_.parseInteger(fields[0]), last = source_.parseInteger(fields[1]);
    const Label step = fields.size() > 2 && !fields[2].empty() ? source_.parseInteger(fields[2]) : 1;
    if (step < 1 || first < 0 || last < first || last > std::numeric_limits<int>::max())
      cards_.refuseData("GENERATE from " + std::to_string(first) + " to " + std::to_string(last) + " in steps of " +
                            std::to_string(step) + " makes no sense",
                        "give first <= last and a step >= 1");
    set.ranges.push_back({first, last, step, cards_.dataPlace()});
  }

  /// Turns ranges into labels; one that names more than `existing` of them names some that do not exist.
  void countOut(LabelSets& sets, std::size_t existing, const std::string& what) {
    for (auto& [key, set] : sets) {
      for (const LabelRange& range : set.ranges) {
        const auto count = static_cast<std::size_t>((range.last - range.first) / range.step) + 1;
        if (count > existing)
          source_.refuseAt(range.place,
                           "GENERATE names " + std::to_string(count) + " " + what + ", of which the file has " +
                               std::to_string(existing),
                           "name " + what + " that the file defines");
        for (std::size_t k = 0; k < count; ++k) set.labels.push_back(range.first + static_cast<Label>(k) * range.step);
        if (set.labels.size() > 4 * existing) sortUnique(set.labels);
      }
      set.ranges.clear();
    }
  }

  void addOther(const LabelSets& sets, LabelSet& set, const std::string& name) {
    const auto other = sets.find(lower(name));
    if (other == sets.end()) cards_.refuseData("there is no set " + shown(name) + " yet", "define it further up");
    const LabelSet copy = other->second;  // a set may name itself
    set.labels.insert(set.labels.end(), copy.labels.begin(), copy.labels.end());
    set.ranges.insert(set.ranges.end(), copy.ranges.begin(), copy.ranges.end());
    sortUnique(set.labels);
    sortUnique(set.ranges);
  }

  struct SurfaceLine {
    std::string surface, item, face;
    bool ofNodes;
    std::size_t place;
  };

  void keepSurface() {
    const std::string& name = cards_.required("name");
    const std::string* given = cards_.parameter("type");
    const std::string type = given == nullptr ? "element" : lower(*given);
    if (type != "element" && type != "node")
      cards_.refuse("a surface of type " + shown(type) + " is not known here", "use TYPE=ELEMENT or TYPE=NODE");
    const auto known = surfaceNames_.emplace(lower(name), name);
    for (Fields fields; cards_.data(fields);)
      surfaces_.push_back({known.first->second, unquoted(fields[0]), fields.size() > 1 ? lower(fields[1]) : "",
                           type == "node", cards_.dataPlace()});
  }

  /// Labels that a number or the name of a set stands for.
  std::vector<Label> labelsOf(const LabelSets& sets, const SurfaceLine& line) {
    if (isNumber(line.item)) return {source_.parseInteger(line.item)};
    const auto set = sets.find(lower(line.item));
    if (set == sets.end())
      source_.refuseAt(line.place, "there is no set " + shown(line.item), "name a set or an element of this file");
    return set->second.labels;
  }

  void readSurfaces() {
    for (const SurfaceLine& line : surfaces_) {
      if (line.ofNodes) {
        for (const Label label : labelsOf(nodeSets_, line)) builder_.addNodeToSet(line.surface, label, line.place);
        continue;
      }
      const bool isFace = line.face.size() == 2 && line.face[0] == 's' && line.face[1] >= '1' && line.face[1] <= '6';
      if (!isFace) source_.refuseAt(line.place, "the face of a surface is " + shown(line.face), "name it S1 to S6");
      for (const Label label : labelsOf(elementSets_, line)) {
        const int side = sideOfFace(builder_.shapeOf(label, line.place), line.face[1] - '0');
        if (side < 0) source_.refuseAt(line.place, "the element has no face " + shown(line.face), "name it S1 to S4");
        builder_.addSideToSet(line.surface, label, side, line.place);
      }
    }
  }

  Source& source_;
  InpCards cards_;
  MeshBuilder builder_;
  int parts_ = 0, instances_ = 0;
  LabelSets nodeSets_, elementSets_;
  std::map<std::string, std::string> surfaceNames_;
  std::vector<SurfaceLine> surfaces_;
  std::set<std::string> passedOver_, variants_, planeVariants_;
};

}  // namespace

SolidFile abaqusFromText(std::string_view bytes, const std::string& name) {
  Source source(bytes, name);
  return AbaqusReader(source).read();
}

SolidFile readAbaqus(const std::filesystem::path& path) {
  const std::string bytes = readWhole(path);
  return abaqusFromText(bytes, path.string());
}

}  // namespace dovetail::solid_io
