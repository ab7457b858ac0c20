#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "dovetail/mesh_io/surface_files.hpp"
#include "little_endian.hpp"
#include "surface_parts.hpp"

namespace dovetail::mesh_io {

namespace {

struct NumberType {
  std::string_view name, otherName;
  std::size_t bytes;
  enum { signedWhole, unsignedWhole, floating } kind;
};
constexpr NumberType numberTypes[] = {
    {"char", "int8", 1, NumberType::signedWhole},   {"uchar", "uint8", 1, NumberType::unsignedWhole},
    {"short", "int16", 2, NumberType::signedWhole}, {"ushort", "uint16", 2, NumberType::unsignedWhole},
    {"int", "int32", 4, NumberType::signedWhole},   {"uint", "uint32", 4, NumberType::unsignedWhole},
    {"float", "float32", 4, NumberType::floating},  {"double", "float64", 8, NumberType::floating}};

struct Property {
  std::string name;
  const NumberType* type = nullptr;
  const NumberType* count = nullptr;  ///< of a list
};
struct Element {
  std::string name;
  std::int64_t items = 0;
  std::vector<Property> properties;
};
using Header = std::vector<Element>;

const NumberType* numberType(const TextSource& text, std::string_view name) {
  for (const NumberType& type : numberTypes)
    if (name == type.name || name == type.otherName) return &type;
  text.refuse("the number type " + shown(name) + " is not known",
              "use char, uchar, short, ushort, int, uint, float or double");
}

Property readProperty(TextSource& text) {
  Property property;
  std::string_view word = text.wordOnLine();
  if (word == "list") {
    property.count = numberType(text, text.wordOnLine());
    if (property.count->kind == NumberType::floating)
      text.refuse("a list is counted with floating numbers", "use uchar, or another whole type");
    word = text.wordOnLine();
  }
  property.type = numberType(text, word);
  property.name = text.wordOnLine();
  if (property.name.empty()) text.refuse("a property has no name", "write: property <type> <name>");
  return property;
}

bool readFormat(TextSource& text) {
  const std::string_view format = text.wordOnLine(), version = text.wordOnLine();
  if ((format != "ascii" && format != "binary_little_endian") || version != "1.0")
    text.refuse("the format is " + shown(format) + " " + shown(version),
                "give 'ascii 1.0' or 'binary_little_endian 1.0'");
  return format != "ascii";
}

Header readHeader(TextSource& text) {
  Header header;
  std::optional<bool> binary;
  if (text.wordOnLine() != "ply") text.refuse("the file does not start with 'ply'", "give a PLY file");
  for (text.endLine(); !text.atEnd(); text.endLine()) {
    const std::string_view word = text.wordOnLine();
    if (word == "end_header") {
      if (!binary) text.refuse("the header names no format", "write: format ascii 1.0");
      text.endLine();
      text.binary = *binary;
      return header;
    }
    if (word == "format") {
      binary = readFormat(text);
    } else if (word == "element") {
      Element& element = header.emplace_back();
      element.name = text.wordOnLine();
      element.items = text.parseInteger(text.wordOnLine());
      if (element.items < 0) text.refuse("the count of an element is negative", "give 0 or more");
    } else if (word == "property" && !header.empty()) {
      header.back().properties.push_back(readProperty(text));
    } else if (word != "comment" && word != "obj_info") {
      text.refuse("a line of the header starts with " + shown(word), "give a PLY file");
    }
  }
  text.refuse("the header does not end", "give a complete PLY file with the line end_header");
}

double binaryNumber(std::string_view bytes, const NumberType& type) {
  if (type.kind == NumberType::floating) return type.bytes == 4 ? floatAt(bytes, 0) : doubleAt(bytes, 0);
  const std::uint64_t raw = littleEndian(bytes, 0, type.bytes), half = std::uint64_t{1} << (8 * type.bytes - 1);
  const double value = static_cast<double>(raw);
  return type.kind == NumberType::signedWhole && raw >= half ? value - 2.0 * static_cast<double>(half) : value;
}

double next(TextSource& text, const NumberType& type) {
  if (!text.binary) return text.real();
  const double value = binaryNumber(text.take(type.bytes), type);
  if (!std::isfinite(value)) text.refuse("a number is NaN or infinite", "give finite numbers");
  return value;
}

int whole(TextSource& text, const NumberType& type) {
  const double value = next(text, type);
  if (value != std::floor(value) || std::abs(value) > static_cast<double>(std::numeric_limits<int>::max()))
    text.refuse("an index or count is no whole number or too large", "give whole numbers");
  return static_cast<int>(value);
}

/// Before space is set aside for so many items: each takes a byte or more.
void requireRoomFor(const TextSource& text, std::int64_t items) {
  if (items > static_cast<std::int64_t>(text.remaining()))
    text.refuse("the file is too short for " + std::to_string(items) + " items", "give a complete PLY file");
}

const Element* find(const Header& header, const char* name) {
  for (const Element& element : header)
    if (element.name == name) return &element;
  return nullptr;
}

bool has(const Element* element, std::string_view property, bool list) {
  return element != nullptr &&
         std::any_of(element->properties.begin(), element->properties.end(),
                     [&](const Property& p) { return p.name == property && (p.count != nullptr) == list; });
}

void readCorners(TextSource& text, const Property& property, std::int64_t vertices, TriangleMesh& mesh) {
  const int count = whole(text, *property.count);
  if (count < 3) text.refuse("a face has " + std::to_string(count) + " vertices", "give 3 or more");
  requireRoomFor(text, count);
  std::vector<int> corners(static_cast<std::size_t>(count));
  for (int& v : corners) {
    v = whole(text, *property.type);
    if (v < 0 || v >= vertices)
      text.refuse("a face names vertex " + std::to_string(v), "use 0 to " + std::to_string(vertices - 1));
  }
  addFan(corners, mesh);
}

void readItem(TextSource& text, const Element& element, std::int64_t vertices, TriangleMesh& mesh) {
  const bool isVertex = element.name == "vertex", isFace = element.name == "face";
  Vec3 x;
  for (const Property& p : element.properties) {
    if (p.count == nullptr) {
      const double value = next(text, *p.type);
      for (int k = 0; k < 3; ++k)
        if (p.name.size() == 1 && p.name[0] == "xyz"[k]) x[k] = value;
    } else if (isFace && (p.name == "vertex_indices" || p.name == "vertex_index")) {
      readCorners(text, p, vertices, mesh);
    } else {
      for (int left = whole(text, *p.count); left > 0; --left) next(text, *p.type);
    }
  }
  if (isVertex) mesh.x.push_back(x);
}

}  // namespace

TriangleMesh readPly(const std::filesystem::path& path) {
  const std::string bytes = readWhole(path);
  std::string room;
  const bool isText = bytes.starts_with("\xEF\xBB\xBF") || bytes.find("format ascii") < 200;
  TextSource text(isText ? io::plainText(bytes, path.string(), room) : bytes, path.string());
  const Header header = readHeader(text);
  const Element *vertex = find(header, "vertex"), *face = find(header, "face");
  if (!has(vertex, "x", false) || !has(vertex, "y", false) || !has(vertex, "z", false))
    refuse(path, "header", "the vertices have no x, y and z", "give a PLY file with an element vertex");
  if (!has(face, "vertex_indices", true) && !has(face, "vertex_index", true))
    refuse(path, "header", "there are no faces with vertex_indices", "give a PLY file with an element face");
  TriangleMesh mesh;
  for (const Element& element : header) {
    if (element.properties.empty()) continue;
    requireRoomFor(text, element.items);
    for (std::int64_t i = 0; i < element.items; ++i) readItem(text, element, vertex->items, mesh);
  }
  if (text.binary ? !text.atEnd() : !text.word().empty())
    text.refuseAt(text.offset(), "the file continues after its last element",
                  "give a PLY file whose header counts all that follows");
  requireFacets(mesh, path);
  return mesh;
}

}  // namespace dovetail::mesh_io
