#include "run_files.hpp"

#include "dovetail/core/error.hpp"
#include "dovetail/io/output_folder.hpp"

namespace dovetail::scene {

namespace {

namespace fs = std::filesystem;

void removeIfOurs(const fs::path& folder, const std::vector<const char*>& names) {
  for (const char* const name : names)
    if (io::isOurs(folder / name)) io::removeOurs(folder / name);
}

/// Whether frames of a run may have this name.
bool isNameOfFrames(const std::string& name) {
  return name == "grains" || name == "contacts" || name == "bonds" || name.starts_with("solid_") ||
         name.starts_with("points_") || name.starts_with("cell_") || name.starts_with("modes_") ||
         (name.starts_with("wall_") && name.find_first_not_of("0123456789", 5) == std::string::npos);
}

}  // namespace

std::vector<std::string> fileNames(const Scene& scene, bool goesOn) {
  std::vector<std::string> names{"scene.json", "series.csv", "summary.txt", "summary.json", "times.csv"};
  for (const Stage& stage : scene.stages)
    if (std::holds_alternative<FindModes>(stage.kind) && names.back() != modesFile) names.push_back(modesFile);
  if (!goesOn) names.insert(names.end(), {"checkpoint.state", "checkpoint.previous.state"});
  if (scene.output.hdf5) names.push_back("series.h5");
  return names;
}

void removeEnd(const fs::path& folder) {
  removeIfOurs(folder, {"summary.txt", "summary.json", "series.h5", "fields.vti", "profile_x.csv", "profile_y.csv",
                        "profile_z.csv", "picture.png", "film.gif"});
  io::removeReport(folder);
}

void removeEarlierRun(const fs::path& folder) {
  removeEnd(folder);
  removeIfOurs(folder, {"checkpoint.state", "checkpoint.previous.state", "checkpoint.damaged.state", "times.csv",
                        "series.csv", modesFile});
  std::vector<fs::path> listed;
  for (const auto& entry : fs::directory_iterator(folder))
    if (const fs::path& path = entry.path(); path.extension() == ".pvd" || path.extension() == ".vtkhdf")
      if (isNameOfFrames(path.stem().string()) && io::isOurs(path)) listed.push_back(path);
  for (const fs::path& old : listed) {
    io::removeOurs(old);
    if (old.extension() == ".pvd") io::removeFrames(folder / old.stem(), old.stem().string());
  }
}

void requireInputsElsewhere(const std::vector<std::string>& files, const fs::path& folder) {
  std::error_code error;
  for (const std::string& file : files) {
    const fs::path within = fs::path(file).parent_path();
    const bool isWithin =
        fs::equivalent(within.empty() ? "." : within, folder, error) || fs::equivalent(within / "..", folder, error);
    if (isWithin && io::isOurs(file))
      throw InputError("the run would overwrite this file, which the scene reads", file,
                       "give another folder by --out, or copy the file to another one");
  }
}

}  // namespace dovetail::scene
