#include <algorithm>

#include "dovetail/mesh_io/surface_files.hpp"
#include "surface_parts.hpp"

namespace dovetail::mesh_io {

namespace {

/// Lines that say nothing about the surface's shape.
constexpr std::string_view passedOver[] = {"vt",     "vn",         "g",         "o",     "s",        "mg",
                                           "usemtl", "mtllib",     "l",         "p",     "lod",      "usemap",
                                           "maplib", "shadow_obj", "trace_obj", "bevel", "c_interp", "d_interp"};

/// Number of the vertex in "i", "i/t", "i//n" or "i/t/n".
int corner(const TextSource& text, std::string_view word, std::size_t vertices) {
  const std::int64_t index = text.parseInteger(word.substr(0, word.find('/')));
  const auto count = static_cast<std::int64_t>(vertices);
  const std::int64_t number = index < 0 ? count + index : index - 1;
  if (index == 0 || number < 0 || number >= count)
    text.refuse("vertex " + std::to_string(index) + " is used after only " + std::to_string(count) + " vertices",
                "use 1 to " + std::to_string(count) + ", or -1 to -" + std::to_string(count));
  return static_cast<int>(number);
}

/// OBJ files have no end mark: one that was cut off within a line must not be taken with half a number.
void requireLastLineWhole(std::string_view bytes, const std::filesystem::path& path) {
  if (bytes.empty() || bytes.back() == '\n') return;
  const std::string_view last = bytes.substr(bytes.rfind('\n') + 1);  // all, if there is one line
  if (last.find_first_not_of(" \t\r") == std::string_view::npos || last.front() == '#') return;
  refuse(path, "line " + std::to_string(1 + std::count(bytes.begin(), bytes.end(), '\n')),
         "the file breaks off in this line", "give the whole file, or end its last line if it is whole");
}

void readFace(TextSource& text, TriangleMesh& mesh, std::vector<int>& corners) {
  corners.clear();
  for (std::string_view word = text.wordOnLine(); !word.empty(); word = text.wordOnLine()) {
    if (word.front() == '#') break;
    if (word == "\\") {
      text.endLine();
      continue;
    }
    corners.push_back(corner(text, word, mesh.x.size()));
  }
  if (corners.size() < 3) text.refuse("a face has " + std::to_string(corners.size()) + " vertices", "give 3 or more");
  addFan(corners, mesh);
}

}  // namespace

TriangleMesh readObj(const std::filesystem::path& path) {
  const std::string bytes = readWhole(path);
  std::string room;
  const std::string_view lines = io::plainText(bytes, path.string(), room);
  requireLastLineWhole(lines, path);
  TextSource text(lines, path.string());
  TriangleMesh mesh;
  std::vector<int> corners;
  for (; !text.atEnd(); text.endLine()) {
    const std::string_view word = text.wordOnLine();
    if (word.empty() || word.front() == '#') continue;
    if (word == "v") {
      Vec3 x;
      for (int k = 0; k < 3; ++k) x[k] = text.parseReal(text.wordOnLine());
      mesh.x.push_back(x);
    } else if (word == "f") {
      readFace(text, mesh, corners);
    } else if (std::find(std::begin(passedOver), std::end(passedOver), word) == std::end(passedOver)) {
      text.refuse("a line starts with " + shown(word), "give an OBJ file of vertices (v) and faces (f)");
    }
  }
  requireFacets(mesh, path);
  return mesh;
}

}  // namespace dovetail::mesh_io
