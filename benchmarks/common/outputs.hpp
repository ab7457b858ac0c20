// Output folders of the benchmark programs.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace dovetail::benchmark {

/// io::prepareOutputFolder; what is wrong with the folder (empty: the current one) is told under the option's name.
/// @throws InputError
void prepareFolder(const std::string& option, const std::filesystem::path& folder,
                   const std::vector<std::string>& names);

/// Prepares --summary FILE. @param taken  names that the run writes in `outFolder` itself
/// @throws InputError if the file cannot be written, or would be one of those
void prepareSummary(const std::filesystem::path& file, const std::filesystem::path& outFolder,
                    const std::vector<std::string>& taken);

}  // namespace dovetail::benchmark
