#include <iterator>
#include <map>

#include "dovetail/core/error.hpp"
#include "exodus_types.hpp"
#include "netcdf_file.hpp"

namespace dovetail::solid_io {

namespace {

constexpr const char* whole = "give a whole Exodus file";

class ExodusReader {
public:
  ExodusReader(std::string_view bytes, const std::string& name)
      : file_(bytes, name), source_("", name), builder_(source_) {
    source_.places = TextSource::Places::none;
  }
  SolidFile read();

private:
  [[noreturn]] void refuse(const std::string& what, const std::string& problem, const std::string& remedy) const {
    throw InputError(problem, file_.name() + ", " + what, remedy);
  }
  /// Names of blocks or sets, by their ids where they have none.
  std::vector<std::string> namesOf(const std::string& prefix, std::size_t count, const std::string& what) const;
  void readNodes();
  void readBlock(std::size_t k, const std::string& name);
  void addElement(const ExodusType& type, std::span<const Label> nodes);
  void readNodeSet(std::size_t k, const std::string& name);
  void readSideSet(std::size_t k, const std::string& name);

  NetcdfFile file_;
  TextSource source_;
  MeshBuilder builder_;
  Label elements_ = 0;
  bool plane_ = false;
  std::map<Label, bool> volumes_;  ///< whether a block has faces, by the number of its first element
};

std::vector<std::string> ExodusReader::namesOf(const std::string& prefix, std::size_t count,
                                               const std::string& what) const {
  std::vector<std::string> names = file_.texts(prefix + "_names");
  const std::string property = prefix + "_prop1";
  const std::vector<std::int64_t> ids = file_.has(property) ? file_.integers(property) : std::vector<std::int64_t>{};
  constexpr std::size_t most = 100000;
  if (count > most) refuse(what, "there are " + std::to_string(count), whole);
  names.resize(count);
  for (std::size_t k = 0; k < count; ++k)
    if (names[k].empty())
      names[k] = what + " " + std::to_string(k < ids.size() ? ids[k] : static_cast<std::int64_t>(k) + 1);
  return names;
}

void ExodusReader::readNodes() {
  const std::size_t count = file_.dimension("num_nodes"), axes = file_.dimension("num_dim");
  if (axes != 2 && axes != 3) refuse("num_dim", "the mesh has " + std::to_string(axes) + " dimensions", "give 2 or 3");
  std::vector<double> all;
  if (count > 0 && file_.has("coord")) {
    all = file_.reals("coord");
  } else if (count > 0) {
    for (const char* const name : {"coordx", "coordy", "coordz"}) {
      if (all.size() == axes * count) break;
      const std::vector<double> one = file_.reals(name);
      if (one.size() != count) refuse(name, "there are " + std::to_string(one.size()) + " coordinates", whole);
      all.insert(all.end(), one.begin(), one.end());
    }
  }
  if (all.size() != axes * count) refuse("coord", "there are " + std::to_string(all.size()) + " coordinates", whole);
  for (std::size_t i = 0; i < count; ++i)
    builder_.addNode(static_cast<Label>(i) + 1, {all[i], all[count + i], axes == 3 ? all[2 * count + i] : 0.0}, 0);
}

void ExodusReader::addElement(const ExodusType& type, std::span<const Label> nodes) {
  ++elements_;
  if (type.shape)
    builder_.addCell(elements_, *type.shape, nodes, 0);
  else if (type.dimension == 2)
    builder_.addFace(elements_, surfaceOf(static_cast<int>(nodes.size())), nodes, 0, false);
  else
    builder_.addLine(elements_, nodes, 0,
                     type.dimension == 1 ? MeshBuilder::LineUse::line : MeshBuilder::LineUse::names);
}

void ExodusReader::readBlock(std::size_t k, const std::string& name) {
  const std::string variable = "connect" + std::to_string(k + 1);
  if (!file_.has(variable)) return;  // an empty block
  const std::vector<std::size_t> shape = file_.shape(variable);
  if (shape.size() != 2) refuse(name, "its elements have different numbers of nodes", "give hexahedra or tetrahedra");
  const std::size_t count = shape[0], nodes = shape[1];
  const std::string word = file_.attribute(variable, "elem_type");
  const std::optional<ExodusType> type = exodusType(word, nodes);
  if (!type)
    refuse(name, "elements of the type " + shown(word) + " with " + std::to_string(nodes) + " nodes are not known here",
           "give HEX8, HEX20, HEX27, TET4 or TET10");
  const std::vector<std::int64_t> connectivity = file_.integers(variable);
  volumes_[elements_ + 1] = type->shape.has_value();
  const SetKey set{name, 0, "blocks"};
  std::vector<Label> own(nodes);
  for (std::size_t e = 0; e < count; ++e) {
    for (std::size_t n = 0; n < nodes; ++n)
      own[n] = connectivity[e * nodes + (type->order.empty() ? n : static_cast<std::size_t>(type->order[n]))];
    addElement(*type, own);
    builder_.addElementToSet(set, elements_, 0);
  }
}

void ExodusReader::readNodeSet(std::size_t k, const std::string& name) {
  const std::string variable = "node_ns" + std::to_string(k + 1);
  if (!file_.has(variable)) return;
  for (const std::int64_t node : file_.integers(variable)) builder_.addNodeToSet({name, 0, "node sets"}, node, 0);
}

void ExodusReader::readSideSet(std::size_t k, const std::string& name) {
  const std::string number = std::to_string(k + 1);
  if (!file_.has("elem_ss" + number)) return;
  const std::vector<std::int64_t> elements = file_.integers("elem_ss" + number),
                                  sides = file_.integers("side_ss" + number);
  if (elements.size() != sides.size()) refuse(name, "it has other numbers of elements and sides", whole);
  std::size_t passed = 0;
  for (std::size_t i = 0; i < elements.size(); ++i) {
    if (elements[i] < 1 || elements[i] > elements_)
      refuse(name, "there is no element " + std::to_string(elements[i]), whole);
    if (!plane_ && !std::prev(volumes_.upper_bound(elements[i]))->second) {
      ++passed;
      continue;
    }
    const int side = sideOfExodus(builder_.shapeOf(elements[i], 0), sides[i]);
    if (side < 0)
      refuse(name, "element " + std::to_string(elements[i]) + " has no side " + std::to_string(sides[i]), whole);
    builder_.addSideToSet({name, 0, "side sets"}, elements[i], side, 0);
  }
  if (passed > 0) builder_.note("Sides of shells in " + shown(name) + " are left out.");
}

SolidFile ExodusReader::read() {
  readNodes();
  const auto each = [&](const char* dimension, const char* prefix, const char* what, auto&& act) {
    const std::vector<std::string> names = namesOf(prefix, file_.dimension(dimension), what);
    for (std::size_t k = 0; k < names.size(); ++k) act(k, names[k]);
  };
  each("num_el_blk", "eb", "block", [&](std::size_t k, const std::string& name) { readBlock(k, name); });
  plane_ = builder_.takePlaneCells();
  each("num_node_sets", "ns", "node set", [&](std::size_t k, const std::string& name) { readNodeSet(k, name); });
  each("num_side_sets", "ss", "side set", [&](std::size_t k, const std::string& name) { readSideSet(k, name); });
  return builder_.finish();
}

}  // namespace

SolidFile exodusFromBytes(std::string_view bytes, const std::string& name) { return ExodusReader(bytes, name).read(); }

}  // namespace dovetail::solid_io
