#include "dovetail/solid_io/solid_files.hpp"

#include <sstream>

#include "dovetail/core/error.hpp"
#include "dovetail/io/output_folder.hpp"
#include "dovetail/io/text_source.hpp"

namespace dovetail::solid_io {

using io::lower, io::shown, io::trimmed;

namespace {

[[noreturn]] void refuseEnding(const std::filesystem::path& path, const std::string& others = {}) {
  throw InputError("the ending of the name is " + shown(path.extension().string()), path.string(),
                   "use .msh (Gmsh) or .inp (Abaqus)" + others);
}

}  // namespace

SolidFile readSolid(const std::filesystem::path& path) {
  const std::string ending = lower(path.extension().string());
  const bool exodus = ending == ".e" || ending == ".exo" || ending == ".ex2" || ending == ".g";
  if (ending != ".msh" && ending != ".inp" && !exodus) refuseEnding(path, ", or .e, .exo, .ex2, .g (Exodus)");
  const std::string bytes = io::readWhole(path, "a mesh");
  if (exodus) return exodusFromBytes(bytes, path.string());
  // Decks are written under the ending .msh too: what the file begins with says what it is.
  const std::string_view start = trimmed(io::withoutByteOrderMark(bytes, path.string()).substr(0, 4096));
  const bool abaqus = start.starts_with('*') || (ending == ".inp" && !start.starts_with('$'));
  return abaqus ? abaqusFromText(bytes, path.string()) : gmshFromText(bytes, path.string());
}

void writeSolid(const fem::SolidMesh& mesh, const std::filesystem::path& path) {
  const std::string ending = lower(path.extension().string());
  if (ending != ".msh" && ending != ".inp") refuseEnding(path);
  std::ostringstream text;
  ending == ".msh" ? writeGmsh(mesh, text) : writeAbaqus(mesh, text);
  io::writeFileAtomically(path, text.str());
}

}  // namespace dovetail::solid_io
