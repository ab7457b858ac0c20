#include "dovetail/mesh_io/surface_files.hpp"

#include "surface_parts.hpp"

namespace dovetail::mesh_io {

TriangleMesh readSurface(const std::filesystem::path& path, std::vector<std::string>* notes) {
  const std::string ending = lower(path.extension().string());
  if (ending == ".stl") return readStl(path, 0.0, notes);
  if (ending == ".obj") return readObj(path);
  if (ending == ".ply") return readPly(path);
  refuse(path, "", "the ending " + shown(ending) + " is not known", "give a file ending in .stl, .obj or .ply");
}

}  // namespace dovetail::mesh_io
