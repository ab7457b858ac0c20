#include "dovetail/scene/convert.hpp"

#include <algorithm>
#include <ostream>

#include "build/grains_of_codes.hpp"
#include "build/parts.hpp"
#include "dovetail/core/finite.hpp"
#include "dovetail/io/output_folder.hpp"
#include "dovetail/io/plain_text.hpp"
#include "dovetail/io/time_series.hpp"
#include "dovetail/solid_io/solid_files.hpp"
#include "grain_sources.hpp"

namespace dovetail::scene {

namespace {

namespace fs = std::filesystem;
using grain_io::GrainFile;

bool isOneOf(const std::string& ending, std::initializer_list<const char*> endings) {
  return std::find(endings.begin(), endings.end(), ending) != endings.end();
}
bool isMeshFile(const std::string& ending) { return isOneOf(ending, {".msh", ".inp", ".e", ".exo", ".ex2", ".g"}); }

void writeTable(const fs::path& to, const GrainFile& grains) {
  const bool spins = std::any_of(grains.spin.begin(), grains.spin.end(), [](const Vec3& w) { return norm(w) > 0.0; });
  std::vector<std::string> names = {"x_m", "y_m", "z_m", "radius_m", "vx_m_per_s", "vy_m_per_s", "vz_m_per_s"};
  if (spins) names.insert(names.end(), {"wx_rad_per_s", "wy_rad_per_s", "wz_rad_per_s"});
  io::TimeSeries table(names);
  for (std::size_t i = 0; i < grains.size(); ++i) {
    const Vec3& x = grains.position[i];
    const Vec3 v = grains.velocity.empty() ? Vec3{} : grains.velocity[i];
    std::vector<double> row{x.x, x.y, x.z, grains.radius[i], v.x, v.y, v.z};
    if (spins) row.insert(row.end(), {grains.spin[i].x, grains.spin[i].y, grains.spin[i].z});
    table.append(row);
  }
  io::writeCsv(to, table, io::provenance());
}

/// What a table or a frame has no place for.
void tellLosses(const GrainFile& grains, const std::string& ending, std::ostream& log) {
  std::vector<std::string> lost;
  if (ending == ".csv" || ending == ".vtu") {
    if (!grains.density.empty()) {
      const auto [least, most] = std::minmax_element(grains.density.begin(), grains.density.end());
      lost.push_back("densities (" + formatNumber(*least) + " to " + formatNumber(*most) + " kg/m³)");
    }
    const bool types = std::any_of(grains.type.begin(), grains.type.end(),
                                   [&](std::int64_t type) { return type != grains.type.front(); });
    if (types) lost.emplace_back("types");
  }
  std::string text;
  for (const std::string& one : lost) text += text.empty() ? one : ", " + one;
  if (!text.empty()) log << "Not in a " << ending << " file: " << text << ".\n";
  const bool periodic = grains.periodic && ((*grains.periodic)[0] || (*grains.periodic)[1] || (*grains.periodic)[2]);
  if (periodic) log << "The space is periodic; in a scene: " << periodicKey(*grains.box, *grains.periodic) << ".\n";
}

void writeGrains(const GrainFile& grains, const fs::path& from, const fs::path& to, std::ostream& log) {
  const std::string ending = io::lower(to.extension().string());
  if (isOneOf(ending, {".data", ".lmp"})) {
    if (grains.density.empty())
      throw InputError("the file has no densities, which data files of LAMMPS need", from.string(), "give --density");
    io::writeFileAtomically(to, grain_io::lammpsText(grains));
  } else if (ending == ".csv") {
    writeTable(to, grains);
  } else if (ending == ".vtu") {
    writeGrainFrame(to, grains);
  } else {
    throw InputError("grains are not written into files that end in " + io::shown(ending), to.string(),
                     "use .data or .lmp (LAMMPS), .csv, .vtu or .vtkhdf");
  }
  for (const std::string& note : grains.notes) log << note << '\n';
  tellLosses(grains, ending, log);
  log << grains.size() << " grains: " << to.string() << '\n';
}

void convertSeries(const fs::path& from, const fs::path& to, const ConvertOptions& settings, std::ostream& log) {
  std::error_code error;
  const bool isRun = fs::is_directory(from, error);
  std::vector<GrainFile> frames;
  if (!settings.frame && (isRun || io::lower(from.extension().string()) == ".pvd")) {
    for (const auto& [time, file] : framesOf(isRun ? from / "grains.pvd" : from)) {
      frames.push_back(grainsOfFrame(file));
      frames.back().time = time;
    }
  } else {
    frames.push_back(grainsFrom(from, settings));
  }
  writeGrainSeries(to, frames);
  log << frames.size() << " frames: " << to.string() << '\n';
}

void convertMesh(const fs::path& from, const fs::path& to, const ConvertOptions& settings, std::ostream& log) {
  if (settings.density || settings.frame)
    throw InputError("meshes have no densities and frames", from.string(), "leave out --density and --frame");
  const MeshOfFile read = readMesh(from.string());
  for (const std::string& note : read.notes) log << note << '\n';
  if (io::lower(to.extension().string()) == ".vtu")
    writeMeshFrame(to, read.mesh);
  else
    solid_io::writeSolid(read.mesh, to);
  log << read.mesh.X.size() << " nodes, " << read.mesh.elementCount() << " elements: " << to.string() << '\n';
}

}  // namespace

void convert(const fs::path& from, const fs::path& to, const ConvertOptions& settings, std::ostream& log) {
  io::requireFreeOrOurs(to);
  std::error_code error;
  if (fs::equivalent(from, to, error)) throw InputError("the file would replace itself", to.string(), "give another");
  const std::string ending = io::lower(to.extension().string());
  if (isMeshFile(io::lower(from.extension().string())) || isMeshFile(ending))
    return convertMesh(from, to, settings, log);
  if (ending == ".vtkhdf") return convertSeries(from, to, settings, log);
  writeGrains(grainsFrom(from, settings), from, to, log);
}

bool inspectGrains(const fs::path& file, std::ostream& out) {
  GrainFile grains;
  try {
    grain_io::codeOf(io::readWhole(file, "a file"), file.string());
  } catch (const InputError&) {
    return false;
  }
  grains = grainsFrom(file, {.density = {}, .units = grain_io::Units::ofFile, .frame = {}});
  const auto [least, most] = std::minmax_element(grains.radius.begin(), grains.radius.end());
  out << grains.size() << " spheres, radii " << *least << " … " << *most << " m\n";
  if (grains.density.empty()) out << "no densities\n";
  std::vector<std::int64_t> types = grains.type;
  std::sort(types.begin(), types.end());
  types.erase(std::unique(types.begin(), types.end()), types.end());
  for (const std::int64_t type : types)
    out << "type " << type << ": " << std::count(grains.type.begin(), grains.type.end(), type) << " spheres\n";
  if (grains.box)
    out << "box, in a scene: " << periodicKey(*grains.box, grains.periodic.value_or(std::array{false, false, false}))
        << '\n';
  for (const std::string& note : grains.notes) out << note << '\n';
  return true;
}

}  // namespace dovetail::scene
