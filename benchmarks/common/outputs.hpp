// Output places of the benchmark programs.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "dovetail/core/error.hpp"

namespace dovetail::benchmark {

/// Returns prepare(); what it refuses is told under the name of the option.
template <class Prepare>
auto underName(const std::string& option, Prepare prepare) {
  try {
    return prepare();
  } catch (const InputError& error) {
    throw InputError(option + ": " + error.what(), "", "");
  }
}

/// @throws InputError if --summary FILE is one of the names that the run writes in `outFolder` itself. Either may be
///         empty.
void requireOtherName(const std::filesystem::path& summary, const std::filesystem::path& outFolder,
                      const std::vector<std::string>& taken);

/// Checks that --summary FILE can be written, in a folder that is there. @throws InputError
void prepareSummary(const std::filesystem::path& summary);

}  // namespace dovetail::benchmark
