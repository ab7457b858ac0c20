// States of runs, to go on from.
#pragma once

#include <cstdint>
#include <filesystem>
#include <iosfwd>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

#include "build/changes.hpp"
#include "dovetail/core/stopwatch.hpp"
#include "dovetail/coupling/rest.hpp"
#include "dovetail/coupling/run.hpp"
#include "dovetail/io/provenance.hpp"
#include "dovetail/scene/files.hpp"
#include "dovetail/scene/scene.hpp"
#include "warnings/impacts.hpp"

namespace dovetail::scene {

/// A sentence on what has happened, without what depends on the machine.
struct Remark {
  std::string text;
  bool warns = false;
};
template <class Archive, class R>
void archiveFields(Archive& archive, R& remark) requires std::is_same_v<std::remove_const_t<R>, Remark> {
  archive(remark.text, remark.warns);
}

/// Where a run stands in its stages, and what it has written.
struct Progress {
  std::uint64_t stage = 0;
  std::int64_t macroStep = 0;   ///< in this stage
  std::uint64_t rows = 0;       ///< of the series
  std::vector<double> frames;   ///< their times, s
  coupling::RestProgress rest;  ///< of a stage that brings to rest
  std::vector<Remark> remarks;
  bool toldOfStep = false;        ///< that it has become too large
  std::vector<StageStart> begun;  ///< of all stages so far
  DeepGrains deep;
};

/// What states of scenes are; with the mark of our files (output_folder.hpp).
inline constexpr const char* checkpointKind = "dovetail 10 scene";

/// A state as it lies in a file.
struct Checkpoint {
  std::string scene;                  ///< its identity
  std::vector<std::uint64_t> meshes;  ///< fingerprints, by solid
  double time = 0.0;                  ///< s
  Progress progress;
  std::vector<char> state;  ///< of the run
};

/// @throws InputError if the file is none, or damaged
Checkpoint loadCheckpoint(const std::filesystem::path& file);

/// What becomes of a damaged state: it is checkpoint.damaged.state then, and no longer in the way of new ones.
enum class Damaged { isLeft, isSetAside };
/// The last state in a folder that is whole: the one before if the last is damaged, which is told, or was never put in
/// its place.
/// @throws InputError if there is none
Checkpoint lastCheckpoint(const std::filesystem::path& folder, std::ostream& log, Damaged damaged);

/// Ranks that share a solid compute all else on their own, from files that each has read.
/// @throws InputError on all of them if they do not begin with the same bytes
void requireSameOnRanks(const std::string& identity, coupling::CoupledRun& run);

/// Keeps the last checkpoint, and the one before.
void writeCheckpoint(const std::filesystem::path& folder, const std::string& identity, const Progress& progress,
                     coupling::CoupledRun& run);
/// Puts the state in force, with what the stages so far have changed. @param identity  of the scene. @throws InputError
/// if the state is of another scene
void adopt(const Checkpoint& checkpoint, const std::string& identity, Built& built, const Scene& scene);

/// All of a scene that its states depend on, as a scene in full: without the number of threads, and with 1 s for its
/// last stage if that runs for a time.
std::string identityOf(const Scene& scene);
/// Of the places of nodes.
std::uint64_t fingerprintOf(std::span<const Vec3> places);

/// The time that each stage has taken in all programs that worked on it, beside the state: it has the
/// same bytes on every machine, times.csv has not.
void writeTimes(const std::filesystem::path& folder, const io::KeyValues& provenance,
                const std::vector<TimeTaken>& taken);
/// @return a number per stage, 0 for what no file tells
std::vector<TimeTaken> readTimes(const std::filesystem::path& folder, std::size_t stages);

}  // namespace dovetail::scene
