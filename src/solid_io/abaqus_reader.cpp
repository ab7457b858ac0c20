#include "abaqus_reader.hpp"

#include <algorithm>

#include "dovetail/core/error.hpp"
#include "inp_includes.hpp"

namespace dovetail::solid_io {

namespace {

using Fields = std::vector<std::string_view>;
using Words = std::set<std::string>;

std::string listed(const Words& words, const std::string& mark) {
  std::string all;
  for (const std::string& word : words) all += (all.empty() ? "" : ", ") + mark + word;
  return all;
}

/// Cards that make or move nodes and elements elsewhere.
const Words refused = {"ngen",
                       "nfill",
                       "ncopy",
                       "nmap",
                       "elgen",
                       "elcopy",
                       "system",
                       "import",
                       "submodel",
                       "elementdelete",
                       "symmetricmodelgeneration",
                       "parameter"};
/// Cards that hold or couple nodes.
const Words constraining = {"boundary",
                            "equation",
                            "mpc",
                            "tie",
                            "rigidbody",
                            "coupling",
                            "kinematic",
                            "distributing",
                            "contact",
                            "kinematiccoupling",
                            "distributingcoupling",
                            "embeddedelement",
                            "clearance",
                            "contactpair",
                            "shelltosolidcoupling",
                            "pre-tensionsection"};
/// Cards that this reader takes, for words that are nearly one of them.
const Words taken = {"node",    "element",  "nset",    "elset",    "surface",     "part",
                     "include", "instance", "endpart", "assembly", "endassembly", "endinstance"};

/// One letter more or less, or another.
bool isNearly(const std::string& word, const std::string& known) {
  if (word == known) return false;
  const std::string &longer = word.size() >= known.size() ? word : known,
                    &shorter = word.size() >= known.size() ? known : word;
  if (longer.size() - shorter.size() > 1) return false;
  const auto [a, b] = std::mismatch(shorter.begin(), shorter.end(), longer.begin());
  if (longer.size() > shorter.size()) return std::equal(a, shorter.end(), b + 1, longer.end());
  const bool swapped = a + 1 < shorter.end() && a[0] == b[1] && a[1] == b[0] && std::equal(a + 2, shorter.end(), b + 2);
  return swapped || std::equal(a + 1, shorter.end(), b + 1);
}

}  // namespace

SolidFile AbaqusReader::read() {
  if (const std::string text = cards_.textBeforeCards(); !text.empty())
    builder_.note("The text before the first card was ignored: " + text + ".");
  while (cards_.next()) readCard(cards_.keyword());
  giveSets();
  const bool plane = builder_.takePlaneCells();
  if (plane) variants_.merge(planeVariants_);
  readSurfaces();
  if (plane) faces_.clear();
  if (!plane) thicknesses_.clear();
  noteWhatWasDropped();
  SolidFile file = builder_.finish();
  nameAsInFile(nodeAliases_, file.nodeNumber);
  nameAsInFile(elementAliases_, file.elementNumber);
  return file;
}

void AbaqusReader::noteWhatWasDropped() {
  for (const auto& [types, what] : {std::pair{&lines_, "nodes"}, std::pair{&faces_, "faces"}})
    for (const auto& [type, count] : *types)
      builder_.note(counted(count, "element", "elements") + " of type " + type + (count == 1 ? " is" : " are") +
                    " no part of the solid: their sets name " + what + ".");
  if (!constraints_.empty())
    builder_.note("Supports, constraints and contacts of the file were ignored: " + listed(constraints_, "*") + ".");
  if (!passedOver_.empty())
    builder_.note("Cards that do not concern the mesh were ignored: " + listed(passedOver_, "*") + ".");
  if (!thicknesses_.empty())
    builder_.note("The thickness of *solid section was ignored: " + listed(thicknesses_, "") + ".");
  if (!ignored_.empty()) builder_.note("Parameters without effect were ignored: " + listed(ignored_, "") + ".");
  if (!variants_.empty())
    builder_.note("Of the element types " + listed(variants_, "") +
                  " only the shape was read: fem::Formulation sets the integration.");
}

void AbaqusReader::readCard(const std::string& keyword) {
  if (keyword == "node") return readNodes();
  if (keyword == "element") return readElements();
  if (keyword == "nset") return readSet(nodeSets_, "nset");
  if (keyword == "elset") return readSet(elementSets_, "elset");
  if (keyword == "surface") return keepSurface();
  if (keyword == "part") return enterPart();
  if (keyword == "instance") return enterInstance();
  if (keyword == "endpart" || keyword == "endinstance" || keyword == "endassembly") return leavePart();
  if (keyword == "assembly") {
    cards_.requireKnown({{"name"}});
    return leavePart();
  }
  readOther(keyword);
}

void AbaqusReader::readOther(const std::string& keyword) {
  if (refused.contains(keyword))
    cards_.refuse("*" + keyword + " is not known here", "write nodes, elements and sets out in this file");
  for (const std::string& known : taken)
    if (isNearly(keyword, known)) cards_.refuse("there is no card *" + keyword, "write *" + known);
  if (keyword.empty()) return cards_.requireNoData();
  if (keyword == "solidsection") readSection();
  if (keyword == "heading" || keyword == "preprint") return;
  (constraining.contains(keyword) ? constraints_ : passedOver_).insert(keyword);
}

void AbaqusReader::readSection() {
  Fields fields;
  if (cards_.data(fields) && !fields[0].empty()) thicknesses_.insert(std::string(fields[0].substr(0, 24)));
}

void AbaqusReader::readNodes() {
  cards_.requireKnown({{"nset"}, {"input"}, {"system"}});
  if (const std::string* system = cards_.parameter("system"); system && lower(*system) != "r")
    cards_.refuse("*node has the parameter system", "write Cartesian coordinates");
  LabelSet* set = cards_.has("nset") ? &setOf(nodeSets_, cards_.required("nset")) : nullptr;
  for (Fields fields; cards_.data(fields);) {
    if (fields.size() < 2 || fields.size() > 7)
      cards_.refuseData("a node has " + std::to_string(fields.size()) + " entries", "give number, x, y, z");
    Vec3 X;
    for (std::size_t i = 1; i < std::min<std::size_t>(fields.size(), 4); ++i)
      X[static_cast<int>(i) - 1] = fields[i].empty() ? 0.0 : source_.parseReal(fields[i]);
    const Label label = source_.parseInteger(fields[0]);
    builder_.addNode(newLabel(nodeAliases_, label, "node", cards_.dataPlace()), X, cards_.dataPlace());
    if (set != nullptr) set->members.push_back({label, space(), cards_.dataPlace()});
  }
}

void AbaqusReader::readElements() {
  cards_.requireKnown({{"type"}, {"elset"}, {"input"}});
  std::string name = cards_.required("type");
  std::transform(name.begin(), name.end(), name.begin(),
                 [](char c) { return c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c; });
  const auto type = abaqusType(name);
  if (!type)
    cards_.refuse("elements of type " + shown(name) + " are not known here",
                  "use C3D8, C3D20, C3D27, C3D4 or C3D10 (with surface elements that name faces), CPE4 or CPE8");
  LabelSet* set = cards_.has("elset") ? &setOf(elementSets_, cards_.required("elset")) : nullptr;
  const auto wanted = static_cast<std::size_t>(type->nodes) + 1;
  const auto refuseCount = [&](std::size_t place, std::size_t count) {
    source_.refuseAt(place, "an element has " + std::to_string(count) + " nodes",
                     "give " + std::to_string(type->nodes) + " after its number");
  };
  std::vector<Label> numbers;
  std::size_t place = 0;
  for (Fields fields; cards_.data(fields);) {
    if (numbers.empty()) place = cards_.dataPlace();
    if (fields.size() > 1 && fields.back().empty()) fields.pop_back();
    for (const std::string_view field : fields) {
      if (field.empty()) cards_.refuseData("an element names nothing between two commas", "give all of its nodes");
      numbers.push_back(source_.parseInteger(field));
    }
    if (numbers.size() > wanted) refuseCount(place, numbers.size() - 1);
    if (numbers.size() < wanted) continue;
    addElement(name, *type, numbers, place);
    if (set != nullptr) set->members.push_back({numbers[0], space(), place});
    numbers.clear();
  }
  if (!numbers.empty()) refuseCount(place, numbers.size() - 1);
}

void AbaqusReader::addElement(const std::string& name, const AbaqusType& type, std::span<const Label> numbers,
                              std::size_t place) {
  if (type.dimension == 3 && name != abaqusName(type.shape)) variants_.insert(name);
  if (type.dimension == 2 && type.surface.plane && name != abaqusName(*type.surface.plane)) planeVariants_.insert(name);
  const Label label = newLabel(elementAliases_, numbers[0], "element", place);
  std::vector<Label> nodes;
  for (int k = 0; k < type.nodes; ++k) {
    const int at = type.dimension == 3 ? abaqusPlace(type.shape, k) : k;
    nodes.push_back(labelOf(nodeAliases_, {numbers[static_cast<std::size_t>(at) + 1], space(), place}));
  }
  if (type.dimension == 1) {
    ++lines_[name];
    return builder_.addLine(label, nodes, place);
  }
  if (type.dimension == 2) {
    ++faces_[name];
    return builder_.addFace(label, type.surface, nodes, place);
  }
  builder_.addCell(label, type.shape, nodes, place);
}

SolidFile abaqusFromText(std::string_view bytes, const std::string& name) {
  const InpText whole = withIncludes(bytes, name);
  TextSource source(whole.text, name);
  source.setPieces(whole.pieces);
  return AbaqusReader(source).read();
}

SolidFile readAbaqus(const std::filesystem::path& path) {
  const std::string bytes = io::readWhole(path, "a mesh");
  return abaqusFromText(bytes, path.string());
}

}  // namespace dovetail::solid_io
