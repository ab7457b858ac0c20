#include "run_files.hpp"

#include "dovetail/io/output_folder.hpp"

namespace dovetail::scene {

namespace {

namespace fs = std::filesystem;

void removeIfOurs(const fs::path& folder, const std::vector<const char*>& names) {
  for (const char* const name : names)
    if (io::isOurs(folder / name)) io::removeOurs(folder / name);
}

}  // namespace

std::vector<std::string> fileNames(const Scene& scene, bool goesOn) {
  std::vector<std::string> names{"scene.json", "series.csv", "summary.txt", "summary.json", "times.csv"};
  if (!goesOn) names.insert(names.end(), {"checkpoint.state", "checkpoint.previous.state"});
  if (scene.output.hdf5) names.push_back("series.h5");
  return names;
}

void removeEnd(const fs::path& folder) {
  removeIfOurs(folder, {"summary.txt", "summary.json", "series.h5", "fields.vti", "report.html", "report.md"});
}

void removeEarlierRun(const fs::path& folder) {
  removeEnd(folder);
  removeIfOurs(
      folder, {"checkpoint.state", "checkpoint.previous.state", "checkpoint.damaged.state", "times.csv", "series.csv"});
  std::vector<fs::path> listed;
  for (const auto& entry : fs::directory_iterator(folder)) {
    const fs::path& path = entry.path();
    const bool figure = path.extension() == ".svg" && path.filename().string().starts_with("report_");
    if ((figure || path.extension() == ".pvd" || path.extension() == ".vtkhdf") && io::isOurs(path))
      listed.push_back(path);
  }
  for (const fs::path& old : listed) {
    io::removeOurs(old);
    if (old.extension() == ".pvd") io::removeFrames(folder / old.stem(), old.stem().string());
  }
}

}  // namespace dovetail::scene
