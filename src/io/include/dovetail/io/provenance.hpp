// Where a result came from: the build, the machine and the run's settings, written into every file.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace dovetail::io {

/// Ordered pairs of key and value.
using KeyValues = std::vector<std::pair<std::string, std::string>>;

/// What is fixed when the library is built. No entry is empty.
struct BuildInfo {
  std::string version;    // of this library, e.g. "0.1.0"
  std::string commit;     // git commit, "-dirty" appended if tracked files were changed; "unknown" outside git
  std::string compiler;   // name and version
  std::string flags;      // of the build type and the options of the project ("none" if there are none)
  std::string buildType;  // e.g. "Release"
};
const BuildInfo& buildInfo();

/// Model name of the processor this runs on; the architecture where the system does not give it.
std::string processorName();

/// Entries "version" ("dovetail 0.1.0"), "commit", "compiler", "flags", "build type", "processor", "threads" (those
/// of parallel.hpp, now), then one "setting.<key>" per setting, in the order given. No time stamp: equal runs give
/// equal files.
/// @throws InputError if a setting's key is empty or given twice
KeyValues provenance(const KeyValues& settings = {});

/// The same entries, with "version" put first if it is missing: the mark by which a later run knows its own files.
KeyValues withMark(KeyValues provenance);

/// One line per entry, `<prefix>key: value\n`; line breaks and backslashes of a value become `\n`, `\r` and `\\`.
std::string provenanceLines(const KeyValues& provenance, const std::string& prefix = "");

}  // namespace dovetail::io
