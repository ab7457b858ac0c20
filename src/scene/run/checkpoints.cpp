#include "checkpoints.hpp"

#include <algorithm>
#include <bit>
#include <cstdio>
#include <ostream>

#include "dovetail/core/archive.hpp"
#include "dovetail/core/atomic_file.hpp"
#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"
#include "dovetail/core/team.hpp"
#include "dovetail/io/output_folder.hpp"
#include "dovetail/io/time_series.hpp"
#include "dovetail/scene/read.hpp"

namespace dovetail::scene {

namespace {

namespace fs = std::filesystem;

constexpr const char* timesFile = "times.csv";

fs::path lastState(const fs::path& folder) { return folder / "checkpoint.state"; }
fs::path stateBefore(const fs::path& folder) { return folder / "checkpoint.previous.state"; }

template <class Archive, class P>
void archiveProgress(Archive& archive, P& p) {
  archive(p.stage, p.macroStep, p.rows, p.frames, p.rest.report.atRest, p.rest.report.residual, p.rest.report.steps,
          p.rest.stops, p.rest.before, p.rest.quiet, p.remarks, p.toldOfStep, p.deep.ids, p.deep.overlap, p.deep.worst,
          p.deep.time, p.begun);
}

}  // namespace

Checkpoint loadCheckpoint(const fs::path& file) {
  ByteReader archive(readChecked(file, checkpointKind));
  Checkpoint checkpoint;
  archive(checkpoint.scene, checkpoint.meshes, checkpoint.time);
  archiveProgress(archive, checkpoint.progress);
  archive(checkpoint.state);
  return checkpoint;
}

Checkpoint lastCheckpoint(const fs::path& folder, std::ostream& log, Damaged damaged) {
  const fs::path last = lastState(folder), before = stateBefore(folder);
  std::error_code error;
  if (!fs::exists(last, error) && !fs::exists(before, error))
    throw InputError("there is no checkpoint", folder.string(),
                     "give the folder of a run with output.checkpoints, or of a run that a signal has ended");
  if (!fs::exists(last, error)) return loadCheckpoint(before);
  try {
    return loadCheckpoint(last);
  } catch (const InputError& damage) {
    if (!fs::exists(before, error)) throw;
    Checkpoint checkpoint = [&] {
      try {
        return loadCheckpoint(before);
      } catch (const InputError&) {
        throw damage;
      }
    }();
    log << "WARNING: " << damage.what() << "\nThe previous state is used instead: " << before.filename().string()
        << ", t = " << formatNumber(checkpoint.time) << " s" << std::endl;
    if (damaged == Damaged::isSetAside && writesFiles()) fs::rename(last, folder / "checkpoint.damaged.state", error);
    return checkpoint;
  }
}

namespace {

std::vector<std::uint64_t> fingerprintsOf(const coupling::CoupledRun& run) {
  std::vector<std::uint64_t> meshes;
  for (std::size_t s = 0; s < run.solids(); ++s) meshes.push_back(fingerprintOf(run.solid(s).nodes().X));
  return meshes;
}

}  // namespace

void requireSameOnRanks(const std::string& identity, coupling::CoupledRun& run) {
  if (team().size() == 1) return;
  ByteWriter archive;
  archive(identity, fingerprintsOf(run), run.save());
  const std::string digest = hashOf({archive.bytes().begin(), archive.bytes().end()});
  const std::vector<std::vector<char>> all = team().gather({digest.begin(), digest.end()});
  for (std::size_t rank = 1; rank < all.size(); ++rank)
    if (all[rank] != all[0])
      throw InputError("rank " + std::to_string(rank) + " begins with another scene or state than rank 0", "ranks",
                       "leave all files of the scene as they are while it starts, and give all ranks the same ones");
}

void writeCheckpoint(const fs::path& folder, const std::string& identity, const Progress& progress,
                     coupling::CoupledRun& run) {
  ByteWriter archive;
  archive(identity, fingerprintsOf(run), run.time());
  archiveProgress(archive, progress);
  archive(run.save());
  if (!writesFiles()) return;
  std::error_code none;  // the first one has none before it
  const bool isFree = !fs::exists(fs::symlink_status(stateBefore(folder), none)) || io::isOurs(stateBefore(folder));
  if (isFree && io::isOurs(lastState(folder))) fs::rename(lastState(folder), stateBefore(folder), none);
  writeChecked(lastState(folder), checkpointKind, archive.bytes());
}

void adopt(const Checkpoint& checkpoint, const std::string& identity, Built& built, const Scene& scene) {
  if (checkpoint.scene != identity)
    throw InputError("the checkpoint is of another scene", "checkpoint.state",
                     "restore its scene.json, or start a new run");
  const std::vector<StageStart>& begun = checkpoint.progress.begun;
  for (std::size_t k = 0; k < begun.size() && k < scene.stages.size(); ++k)
    beginStage(built, scene, k, begun[k], Grains::follow);
  built.run->load(checkpoint.state);
}

std::string identityOf(const Scene& scene) {
  Scene same = scene;
  same.steps.threads = 0;
  if (!same.stages.empty())
    if (auto* const last = std::get_if<RunFor>(&same.stages.back().kind)) last->time = 1.0;
  return sceneText(same);
}

std::uint64_t fingerprintOf(std::span<const Vec3> places) {
  std::uint64_t hash = 14695981039346656037ULL;
  for (const Vec3& place : places)
    for (int c = 0; c < 3; ++c) hash = (hash ^ std::bit_cast<std::uint64_t>(place[c] + 0.0)) * 1099511628211ULL;
  return hash;
}

void writeTimes(const fs::path& folder, const io::KeyValues& provenance, const std::vector<TimeTaken>& taken) {
  io::TimeSeries table({"stage", "wall_s", "processor_s"});
  for (std::size_t k = 0; k < taken.size(); ++k)
    table.append({static_cast<double>(k + 1), taken[k].wall, taken[k].processor});
  io::writeCsv(folder / timesFile, table, provenance);
}

std::vector<TimeTaken> readTimes(const fs::path& folder, std::size_t stages) {
  std::vector<TimeTaken> taken(stages);
  std::error_code error;
  if (!fs::exists(folder / timesFile, error)) return taken;
  try {
    const io::TimeSeries table = io::readCsv(folder / timesFile);
    // States of before have no time of the processors.
    const bool both = std::ranges::find(table.names(), "processor_s") != table.names().end();
    const auto wall = table.column("wall_s"), processor = table.column(both ? "processor_s" : "wall_s");
    for (std::size_t k = 0; k < std::min(stages, wall.size()); ++k)
      if (wall[k] >= 0.0 && processor[k] >= 0.0) taken[k] = {wall[k], processor[k]};
  } catch (const InputError&) {  // a run goes on without what only tells times
  }
  return taken;
}

std::string hashOf(const std::string& text) {
  std::uint64_t hash = 14695981039346656037ULL;
  for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 1099511628211ULL;
  char digits[17];
  std::snprintf(digits, sizeof digits, "%016llx", static_cast<unsigned long long>(hash));
  return digits;
}

}  // namespace dovetail::scene
