#include "gmsh_reader.hpp"

#include "dovetail/core/error.hpp"
#include "dovetail/io/plain_text.hpp"

namespace dovetail::solid_io {

namespace {
constexpr const char* saveAgain = "save the mesh in Gmsh as version 4.1 or 2.2";
}  // namespace

SolidFile GmshReader::read() {
  for (std::string_view word = source_.word(); !word.empty(); word = source_.word()) {
    if (word.size() < 2 || word.front() != '$')
      source_.refuse("there is " + shown(word) + " where a section such as $Nodes should begin",
                     "give a complete MSH file");
    const std::string section(word.substr(1));
    if (seen_.empty() != (section == "MeshFormat"))
      source_.refuse(seen_.empty() ? "the file does not begin with $MeshFormat" : "there is a second $MeshFormat",
                     saveAgain);
    source_.endLine();
    readSection(section);
  }
  if (!seen_.contains("Elements"))
    throw InputError("there is no section $Elements", source_.name(), "give a complete MSH file");
  giveElements();
  return builder_.finish();
}

void GmshReader::readSection(const std::string& section) {
  const bool ours = section == "MeshFormat" || section == "PhysicalNames" || section == "Entities" ||
                    section == "Nodes" || section == "Elements";
  if (section == "PartitionedEntities" || section == "Partitions")
    source_.refuse("the mesh is partitioned", "save it whole");
  if (!ours) return source_.skipBehindLine("$End" + section);
  if (!seen_.insert(section).second) source_.refuse("there is a second $" + section, "give each section once");
  if (section == "MeshFormat") readFormat();
  if (section == "PhysicalNames") readPhysicalNames();
  source_.binary = binary_;
  if (section == "Entities") version4_ ? readEntities4() : source_.skipBehindLine("$EndEntities");
  if (section == "Nodes") version4_ ? readNodes4() : readNodes2();
  if (section == "Elements") version4_ ? readElements4() : readElements2();
  source_.binary = false;
  if (section == "Entities" && !version4_) return;
  const std::string_view end = source_.word();
  if (end != "$End" + section)
    source_.refuse("there is " + shown(end) + " where $End" + section + " should be",
                   "give a complete file whose counts are right");
}

void GmshReader::readFormat() {
  const std::string version(source_.word());
  if (version != "4.1" && version != "2.2") source_.refuse("the version is " + shown(version), saveAgain);
  version4_ = version == "4.1";
  const std::int64_t mode = source_.parseInteger(source_.word());
  if (mode != 0 && mode != 1)
    source_.refuse("the file type is " + std::to_string(mode), "give 0 (ASCII) or 1 (binary)");
  if (const std::int64_t size = source_.parseInteger(source_.word()); size != 8)
    source_.refuse("the data size is " + std::to_string(size), "save the mesh with 8 bytes per number");
  source_.endLine();
  binary_ = mode == 1;
  if (!binary_) return;
  source_.binary = true;
  source_.places = io::TextSource::Places::bytes;
  if (source_.integer(4) != 1) source_.refuse("the byte order is not this machine's", "save the mesh as ASCII");
  source_.binary = false;
}

void GmshReader::readPhysicalNames() {
  const std::size_t count = source_.count(0, 4);
  source_.endLine();
  for (std::size_t k = 0; k < count; ++k) {
    const std::int64_t dimension = source_.parseInteger(source_.word()), group = source_.parseInteger(source_.word());
    const std::string_view text = trimmed(source_.line());
    if (dimension < 0 || dimension > 3)
      source_.refuse("the dimension of a group is " + std::to_string(dimension), "give 0 to 3");
    if (text.size() < 3 || text.front() != '"' || text.back() != '"')
      source_.refuse("the name of a group is " + shown(text), "put a name of one or more letters in quotes");
    names_[{static_cast<int>(dimension), group}] = std::string(text.substr(1, text.size() - 2));
  }
}

const GmshType& GmshReader::requireType(std::int64_t code) {
  const GmshType* type = gmshType(code);
  if (type == nullptr)
    source_.refuse("elements of " + gmshTypeName(code) + " are not known here",
                   "mesh with hexahedra, tetrahedra or, in a plane, quadrilaterals of first or second order");
  return *type;
}

SolidFile gmshFromText(std::string_view bytes, const std::string& name) {
  std::string room;
  io::TextSource source(io::plainText(bytes, name, room), name);
  return GmshReader(source).read();
}

SolidFile readGmsh(const std::filesystem::path& path) {
  const std::string bytes = io::readWhole(path, "a mesh");
  return gmshFromText(bytes, path.string());
}

}  // namespace dovetail::solid_io
