// The command line that the examples share.
#pragma once

#include <filesystem>
#include <functional>
#include <string>

namespace dovetail::example {

struct Options {
  bool quick = false;         ///< the shortened form that the tests run
  bool help = false;          ///< told, and nothing more to do
  std::filesystem::path out;  ///< folder for CSV and VTU files; empty: none are written
};

/// Whether an example writes files: one that writes none has no --out.
enum class Files { none, some };

/// @param about one line for --help
/// @throws InputError on an option that is unknown or lacks its value
Options readOptions(int argc, char** argv, const std::string& program, const std::string& about, Files files);

/// Runs the example. Returns its exit code: 0 if the result is within the tolerance, 1 if not or if the run broke
/// down, 2 if the request was refused.
int runExample(int argc, char** argv, const std::string& program, const std::string& about,
               const std::function<bool(const Options&)>& example, Files files = Files::some);

}  // namespace dovetail::example
