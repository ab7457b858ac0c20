#include "run_frames.hpp"

#include <set>

#include "dovetail/core/error.hpp"

namespace dovetail::scene {

namespace fs = std::filesystem;

const io::FrameContent* Instant::find(const std::string& name) const {
  const auto found = parts.find(name);
  return found == parts.end() ? nullptr : &found->second;
}

RunFrames::RunFrames(const fs::path& folder, const Scene& scene, bool modes) {
  std::vector<std::string> names{"grains", "contacts", "bonds"};
  for (const Solid& solid : scene.solids) names.push_back("solid_" + solid.name);
  for (std::size_t w = 0; w < scene.walls.size(); ++w) names.push_back("wall_" + std::to_string(w));
  std::set<double> times;
  std::error_code error;
  for (const std::string& name : names) {
    if (modes && !name.starts_with("solid_")) continue;
    const fs::path file = folder / ((modes ? "modes_" + name.substr(6) : name) + ".pvd");
    if (!fs::is_regular_file(file, error)) continue;
    for (const auto& [time, frame] : io::readPvd(file)) {
      files_[name][time] = frame;
      times.insert(time);
    }
  }
  times_.assign(times.begin(), times.end());
  if (times_.empty() && modes)
    throw InputError("the run has no frames of modes", folder.string(),
                     "give its scene a stage \"do\": \"modes\" and \"frames\" in \"output\", and run again");
  if (times_.empty())
    throw InputError("the run has no frames", folder.string(),
                     "write \"frames\": \"10 ms\", or another interval, into \"output\" of its scene, and run again");
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
