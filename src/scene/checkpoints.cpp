#include "checkpoints.hpp"

#include <algorithm>
#include <cstdio>

#include "dovetail/core/archive.hpp"
#include "dovetail/core/error.hpp"
#include "dovetail/io/time_series.hpp"

namespace dovetail::scene {

namespace {

namespace fs = std::filesystem;

constexpr const char* timesFile = "times.csv";

fs::path lastState(const fs::path& folder) { return folder / "checkpoint.state"; }
fs::path stateBefore(const fs::path& folder) { return folder / "checkpoint.previous.state"; }

template <class Archive, class P>
void archiveProgress(Archive& archive, P& p) {
  archive(p.stage, p.window, p.rows, p.frames, p.rest.report.atRest, p.rest.report.kinetic, p.rest.report.windows,
          p.rest.report.stops, p.rest.before, p.rest.quiet, p.remarks, p.toldOfStep, p.deep.ids, p.deep.overlap,
          p.deep.worst, p.deep.time);
}

}  // namespace

fs::path lastCheckpoint(const fs::path& folder) {
  std::error_code error;
  for (const fs::path& file : {lastState(folder), stateBefore(folder)})
    if (fs::exists(file, error)) return file;
  throw InputError("there is no checkpoint", folder.string(),
                   "give the folder of a run with output.checkpoints, or one that a signal has ended");
}

Checkpoint loadCheckpoint(const fs::path& file) {
  ByteReader archive(readChecked(file, checkpointKind));
  Checkpoint checkpoint;
  std::vector<char> hash;
  archive(hash, checkpoint.time);
  archiveProgress(archive, checkpoint.progress);
  archive(checkpoint.state);
  checkpoint.scene.assign(hash.begin(), hash.end());
  return checkpoint;
}

void writeCheckpoint(const fs::path& folder, const std::string& hash, const Progress& progress,
                     coupling::CoupledRun& run) {
  ByteWriter archive;
  archive(std::vector<char>(hash.begin(), hash.end()), run.time());
  archiveProgress(archive, progress);
  archive(run.save());
  std::error_code none;
  fs::rename(lastState(folder), stateBefore(folder), none);  // the first one has none before it
  writeChecked(lastState(folder), checkpointKind, archive.bytes());
}

Progress readCheckpoint(const fs::path& folder, const std::string& hash, coupling::CoupledRun& run) {
  const fs::path file = lastCheckpoint(folder);
  const Checkpoint checkpoint = loadCheckpoint(file);
  if (checkpoint.scene != hash)
    throw InputError("the checkpoint is of another scene", file.string(), "put its scene.json back, or begin anew");
  run.load(checkpoint.state);
  return checkpoint.progress;
}

void writeTimes(const fs::path& folder, const io::KeyValues& provenance, const std::vector<double>& seconds) {
  io::TimeSeries table({"stage", "wall_s"});
  for (std::size_t k = 0; k < seconds.size(); ++k) table.append({static_cast<double>(k + 1), seconds[k]});
  io::writeCsv(folder / timesFile, table, provenance);
}

std::vector<double> readTimes(const fs::path& folder, std::size_t stages) {
  std::vector<double> seconds(stages, 0.0);
  std::error_code error;
  if (!fs::exists(folder / timesFile, error)) return seconds;
  try {
    const io::TimeSeries table = io::readCsv(folder / timesFile);
    const auto column = table.column("wall_s");
    for (std::size_t k = 0; k < std::min(stages, column.size()); ++k)
      if (column[k] >= 0.0) seconds[k] = column[k];
  } catch (const InputError&) {  // a run goes on without what only tells times
  }
  return seconds;
}

std::string hashOf(const std::string& text) {
  std::uint64_t hash = 14695981039346656037ULL;
  for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 1099511628211ULL;
  char digits[17];
  std::snprintf(digits, sizeof digits, "%016llx", static_cast<unsigned long long>(hash));
  return digits;
}

}  // namespace dovetail::scene
