#include "run_frames.hpp"

#include <set>

#include "dovetail/core/error.hpp"

namespace dovetail::scene {

namespace fs = std::filesystem;

const io::FrameContent* Instant::find(const std::string& name) const {
  const auto found = parts.find(name);
  return found == parts.end() ? nullptr : &found->second;
}

namespace {

struct SeriesFile {
  std::string series, file;  ///< without .pvd
};

std::vector<SeriesFile> filesOf(const Scene& scene, bool modes, const std::string& cell) {
  if (!cell.empty()) return {{"grains", "cell_" + cell}, {"contacts", "cell_" + cell + "_contacts"}};
  std::vector<SeriesFile> files;
  for (const Solid& solid : scene.solids)
    files.push_back({"solid_" + solid.name, (modes ? "modes_" : "solid_") + solid.name});
  if (modes) return files;
  for (const char* const name : {"grains", "contacts", "bonds"}) files.push_back({name, name});
  for (std::size_t w = 0; w < scene.walls.size(); ++w)
    files.push_back({"wall_" + std::to_string(w), "wall_" + std::to_string(w)});
  return files;
}

[[noreturn]] void refuse(const fs::path& folder, const Scene& scene, bool modes, const std::string& cell) {
  if (modes)
    throw InputError("the run has no frames of modes", folder.string(),
                     "give its scene a stage \"do\": \"modes\" and \"frames\" in \"output\", and run again");
  if (!cell.empty()) {
    std::string names;
    for (const ShownCell& one : scene.output.cells) names += (names.empty() ? "" : ", ") + one.name;
    throw InputError(
        "the run has no frames of a cell \"" + cell + "\"", folder.string(),
        names.empty() ? "name it in \"cells\" in \"output\" of the scene, and run again" : "give one of " + names);
  }
  throw InputError("the run has no frames", folder.string(),
                   "write \"frames\": \"10 ms\", or another interval, into \"output\" of its scene, and run again");
}

}  // namespace

RunFrames::RunFrames(const fs::path& folder, const Scene& scene, bool modes, const std::string& cell) {
  std::set<double> times;
  std::error_code error;
  for (const SeriesFile& one : filesOf(scene, modes, cell)) {
    const fs::path file = folder / (one.file + ".pvd");
    if (!fs::is_regular_file(file, error)) continue;
    for (const auto& [time, frame] : io::readPvd(file)) {
      files_[one.series][time] = frame;
      times.insert(time);
    }
  }
  times_.assign(times.begin(), times.end());
  if (times_.empty()) refuse(folder, scene, modes, cell);
}

std::size_t RunFrames::numberOf(int frame) const {
  const auto all = static_cast<long>(times_.size());
  const long number = frame < 0 ? all + frame : frame;
  if (number < 0 || number >= all)
    throw InputError(
        "there is no frame " + std::to_string(frame), "--frame",
        "give a number from 0 to " + std::to_string(all - 1) + ", or from -1, the last, to " + std::to_string(-all));
  return static_cast<std::size_t>(number);
}

Instant RunFrames::read(std::size_t frame) const {
  Instant instant{times_[frame], {}};
  for (const auto& [name, files] : files_)
    if (const auto found = files.find(instant.time); found != files.end())
      instant.parts[name] = io::readFrame(found->second);
  return instant;
}

}  // namespace dovetail::scene
