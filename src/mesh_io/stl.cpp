#include <algorithm>
#include <cmath>
#include <limits>

#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"
#include "dovetail/geometry/triangle.hpp"
#include "dovetail/mesh_io/surface_files.hpp"
#include "little_endian.hpp"
#include "surface_parts.hpp"

namespace dovetail::mesh_io {

namespace {

constexpr std::size_t headerBytes = 84, facetBytes = 50;

/// Length of the binary file that the number at byte 80 announces; 0 if the file ends before it.
std::uint64_t announcedBytes(std::string_view bytes) {
  return bytes.size() < headerBytes ? 0 : headerBytes + facetBytes * littleEndian(bytes, 80, 4);
}

Vec3 vectorAt(std::string_view bytes, std::size_t at) {
  return {floatAt(bytes, at), floatAt(bytes, at + 4), floatAt(bytes, at + 8)};
}

/// A surface and the normals that its file has beside the order of the vertices.
struct WithNormals {
  TriangleMesh mesh;
  std::vector<Vec3> normal;  ///< per facet, of any length
};

WithNormals readBinary(std::string_view bytes, const std::filesystem::path& path) {
  WithNormals read;
  TriangleMesh& mesh = read.mesh;
  const std::size_t facets = (bytes.size() - headerBytes) / facetBytes;
  if (facets > static_cast<std::size_t>(std::numeric_limits<int>::max()) / 3)
    refuse(path, "byte 80", "the file holds too many facets", "cut the surface into several files");
  mesh.x.reserve(3 * facets);
  for (std::size_t f = 0; f < facets; ++f) {
    const int first = static_cast<int>(mesh.x.size());
    for (std::size_t v = 0; v < 3; ++v) {
      const std::size_t at = headerBytes + facetBytes * f + 12 * (v + 1);
      const Vec3 x = vectorAt(bytes, at);
      if (!isFinite(x))
        refuse(path, "facet " + std::to_string(f) + " at byte " + std::to_string(at), "a coordinate is NaN or infinite",
               "give finite numbers");
      mesh.x.push_back(x);
    }
    mesh.facets.push_back({first, first + 1, first + 2});
    read.normal.push_back(vectorAt(bytes, headerBytes + facetBytes * f));
  }
  return read;
}

void expect(TextSource& text, const char* wanted) {
  const std::string_view word = text.word();
  if (lower(word) != wanted)
    text.refuse("there is " + shown(word) + " where '" + wanted + "' should be",
                "give a complete STL file; a binary one has 84 + 50 bytes per facet");
}

/// From after the word "facet" to "endfacet".
void readFacet(TextSource& text, WithNormals& read, std::vector<int>& corners) {
  TriangleMesh& mesh = read.mesh;
  expect(text, "normal");
  Vec3 normal;
  for (int k = 0; k < 3; ++k)
    if (!io::isNumber(text.word(), normal[k])) normal[k] = 0.0;
  expect(text, "outer");
  expect(text, "loop");
  corners.clear();
  std::string word = lower(text.word());
  for (; word == "vertex"; word = lower(text.word())) {
    Vec3 x;
    for (int k = 0; k < 3; ++k) x[k] = text.real();
    corners.push_back(static_cast<int>(mesh.x.size()));
    mesh.x.push_back(x);
  }
  if (word != "endloop")
    text.refuse("there is " + shown(word) + " where 'vertex' or 'endloop' should be", "give a complete STL file");
  if (corners.size() < 3) text.refuse("a facet has " + std::to_string(corners.size()) + " vertices", "give 3 or more");
  addFan(corners, mesh);
  read.normal.resize(mesh.facets.size(), normal);
  expect(text, "endfacet");
}

/// Whether "facet normal" and three numbers come next on this line; the place stays.
bool facetFollows(TextSource& text) {
  const std::size_t place = text.offset();
  double ignored = 0.0;
  bool follows = lower(text.wordOnLine()) == "facet" && lower(text.wordOnLine()) == "normal";
  for (int k = 0; follows && k < 3; ++k) follows = io::isNumber(text.wordOnLine(), ignored);
  text.goTo(place);
  return follows;
}

/// Whether a solid with a facet begins further on in this line, behind the word "solid"; the place stays.
bool solidFollows(TextSource& text) {
  const std::size_t place = text.offset();
  bool follows = facetFollows(text);
  while (!follows && !text.wordOnLine().empty()) follows = facetFollows(text);
  text.goTo(place);
  return follows;
}

/// Passes over the name of a solid, which ends with the line, or where a facet or the end of the solid follows on it.
void skipName(TextSource& text) {
  const std::size_t begin = text.offset();
  text.endLine();
  const std::string below = lower(text.word());
  const bool goesOnBelow = below == "facet" || below == "endsolid";
  text.goTo(begin);
  while (!facetFollows(text)) {
    const std::size_t place = text.offset();
    const std::string word = lower(text.wordOnLine());
    if (word.empty() || (word == "endsolid" && !goesOnBelow)) return text.goTo(place);
  }
}

/// The same behind "endsolid", where the next solid may follow on the line.
void skipNameOfEnd(TextSource& text) {
  for (;;) {
    const std::size_t place = text.offset();
    const std::string word = lower(text.wordOnLine());
    if (word == "solid" && solidFollows(text)) return text.goTo(place);
    if (word.empty() || word == "solid") return text.endLine();  // no solid follows on this line
  }
}

/// Passes over lines before the first solid that say that they are comments.
void skipComments(TextSource& text) {
  for (;;) {
    const std::size_t place = text.offset();
    const std::string_view word = text.word();
    const bool comment = !word.empty() && (word.front() == '#' || word.front() == ';' || word.starts_with("//"));
    text.endLine();
    if (!comment || text.atEnd()) return text.goTo(place);
  }
}

WithNormals readAscii(std::string_view bytes, const std::filesystem::path& path) {
  TextSource text(bytes, path.string());
  WithNormals read;
  std::vector<int> corners;
  skipComments(text);
  for (std::string word = lower(text.word()); !word.empty(); word = lower(text.word())) {
    if (word != "solid")
      text.refuse(read.mesh.x.empty()
                      ? "the file is neither a text that starts with 'solid' nor a binary STL: there is " + shown(word)
                      : "there is " + shown(word) + " where 'solid' should be",
                  "give a complete STL file");
    skipName(text);
    for (word = lower(text.word()); word == "facet"; word = lower(text.word())) readFacet(text, read, corners);
    if (word != "endsolid")
      text.refuse("there is " + shown(word) + " where 'facet' or 'endsolid' should be", "give a complete STL file");
    skipNameOfEnd(text);
  }
  return read;
}

/// Whether a normal points out of the other side of its facet: normals of needles are rounded.
bool isOpposite(const WithNormals& read, std::size_t f) {
  const auto at = [&](std::size_t k) { return read.mesh.x[static_cast<std::size_t>(read.mesh.facets[f][k])]; };
  const Vec3 ofOrder = geometry::triangleNormal(at(0), at(1), at(2));
  return dot(ofOrder, read.normal[f]) < -0.5 * norm(read.normal[f]);
}

void noteOppositeNormals(const WithNormals& read, std::vector<std::string>& notes) {
  std::size_t opposite = 0;
  for (std::size_t f = 0; f < read.mesh.facets.size(); ++f) opposite += isOpposite(read, f);
  if (opposite == 0) return;
  notes.push_back("Normals of the file were ignored: " + std::to_string(opposite) + " of its " +
                  std::to_string(read.mesh.facets.size()) +
                  " facets have one that points against the order of their vertices, which counts.");
}

/// Whether what the file begins with could be read by people, or has the words of a solid at least.
bool isText(std::string_view bytes) {
  const std::string start = lower(bytes.substr(0, 1024));
  const std::size_t first = start.find_first_not_of(" \t\r\n");
  if (first != std::string::npos && first == start.find("solid") && start.find("facet") != std::string::npos)
    return true;
  return std::none_of(bytes.begin(),
                      bytes.begin() + static_cast<std::ptrdiff_t>(std::min<std::size_t>(bytes.size(), 512)),
                      [](char c) { return (c >= 0 && c < ' ' && (c < '\t' || c > '\r')) || c == '\x7F'; });
}

}  // namespace

TriangleMesh readStl(const std::filesystem::path& path, double tolerance, std::vector<std::string>* notes) {
  requireNonNegative(tolerance, "tolerance of the welding");
  const std::string bytes = readWhole(path);
  const std::uint64_t announced = announcedBytes(bytes);
  std::string room;
  WithNormals read;
  if (announced == bytes.size()) {
    read = readBinary(bytes, path);
  } else if (const std::string_view text = io::plainText(bytes, path.string(), room); isText(text)) {
    read = readAscii(text, path);
  } else {
    refuse(path, "byte " + std::to_string(std::min(bytes.size(), headerBytes - 4)),
           announced == 0
               ? "the file is neither a text that starts with 'solid' nor long enough for a binary STL"
               : "the file has " + std::to_string(bytes.size()) + " bytes, but " +
                     std::to_string(littleEndian(bytes, 80, 4)) + " facets need " + std::to_string(announced),
           "give a complete STL file");
  }
  requireFacets(read.mesh, path);
  if (notes != nullptr) noteOppositeNormals(read, *notes);
  geometry::weldVertices(read.mesh, tolerance);
  return std::move(read.mesh);
}

}  // namespace dovetail::mesh_io
