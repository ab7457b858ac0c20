// What files hold.
#include <algorithm>
#include <fstream>
#include <ostream>

#include "comparing.hpp"
#include "dovetail/core/error.hpp"
#include "dovetail/io/output_folder.hpp"
#include "dovetail/io/time_series.hpp"
#include "dovetail/scene/convert.hpp"
#include "dovetail/scene/execute.hpp"
#include "dovetail/scene/read.hpp"
#include "inspecting.hpp"
#include "run/checkpoints.hpp"

namespace dovetail::scene {

namespace {

namespace fs = std::filesystem;

void inspectScene(const fs::path& file, std::ostream& out) {
  const Scene scene = readScene(file);
  out << "scene" << (scene.title.empty() ? "" : ": " + scene.title) << '\n'
      << scene.particles.size() << " groups of particles, " << scene.walls.size() << " walls, " << scene.clumps.size()
      << " clumps, " << scene.insertions.size() << " insertions, " << scene.solids.size() << " solids, "
      << scene.couplings.size() << " couplings, " << scene.stages.size() << " stages\n";
}

void inspectCsv(const fs::path& file, std::ostream& out) {
  std::ifstream stream = openFile(file);
  for (std::string line; std::getline(stream, line) && line.starts_with('#');) out << line.substr(1) << '\n';
  inspectTable(io::readCsv(file), out);
}

void inspectProvenance(const fs::path& file, std::ostream& out) {
  for (const auto& [key, value] : readProvenanceHdf5(file))
    out << ' ' << key << ": " << (key == "scene" ? std::to_string(value.size()) + " bytes of JSON" : value) << '\n';
}

void inspectHdf5(const fs::path& file, std::ostream& out) {
  const io::TimeSeries table = readSeriesHdf5(file);
  inspectProvenance(file, out);
  inspectTable(table, out);
}

/// Of files of ours that are told as they are.
void inspectText(const fs::path& file, std::ostream& out) {
  std::ifstream stream = openFile(file);
  out << stream.rdbuf();
}

void inspectState(const fs::path& file, std::ostream& out) {
  const Checkpoint checkpoint = loadCheckpoint(file);
  const Progress& progress = checkpoint.progress;
  out << "checkpoint of the scene " << hashOf(checkpoint.scene) << " at t = " << checkpoint.time << " s: stage "
      << progress.stage + 1 << ", macro step " << progress.macroStep << ", " << progress.rows << " rows and "
      << progress.frames.size() << " frames written, " << checkpoint.state.size() << " bytes\n";
}

}  // namespace

void inspectTable(const io::TimeSeries& table, std::ostream& out) {
  out << "table of " << table.rows() << " rows\n";
  for (std::size_t c = 0; c < table.names().size() && table.rows() > 0; ++c)
    out << "  " << table.names()[c] << ": " << table.column(c).front() << " … " << table.column(c).back() << '\n';
}

void tell(const fs::path& file, std::ostream& out) {
  std::error_code error;
  if (fs::is_directory(file, error)) {
    bool any = false;
    for (const char* const name : {"scene.json", "summary.json", "checkpoint.state", "series.csv"})
      if (fs::is_regular_file(file / name, error)) {
        out << "== " << name << '\n';
        tell(file / name, out);
        any = true;
      }
    if (!any) throw InputError("this is no folder of a run", file.string(), "give the one that a run wrote into");
    return;
  }
  if (!fs::is_regular_file(file, error)) throw InputError("there is no such file", file.string(), "correct its name");
  if (inspectSummary(file, out) || inspectFrames(file, out) || inspectShape(file, out)) return;
  const std::string ending = file.extension().string();
  if (ending == ".json") return inspectScene(file, out);
  if (ending == ".csv") return inspectCsv(file, out);
  if (ending == ".h5") return inspectHdf5(file, out);
  if (ending == ".vtkhdf") return inspectProvenance(file, out);
  if (ending == ".state") return inspectState(file, out);
  const bool isOurs = io::isOurs(file);
  if (isOurs && ending == ".txt") return inspectText(file, out);
  if (inspectGrains(file, out)) return;
  if (!isOurs)
    throw InputError("this is no file of Dovetail's", file.string(),
                     "give a scene, a file that a run wrote, or one of spheres of another code");
  out << "written by Dovetail\n";
}

}  // namespace dovetail::scene
