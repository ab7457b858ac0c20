// Tables that others deposited.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace dovetail::benchmark {

/// A file of a folder, and what stands between the head and the tail of its name.
struct NamedFile {
  std::filesystem::path path;
  std::string middle;
};
/// Files "<head>…<tail>" of the folder, by name; none if there is no such folder.
std::vector<NamedFile> filesNamed(const std::string& folder, const std::string& head, const std::string& tail);

/// The number in a file's name. @throws InputError naming the file, unless it is finite and not negative
double numberInName(const std::string& text, const std::filesystem::path& file, const std::string& example);

/// The columns of a CSV file, in that order.
/// @throws InputError naming the file, if one is missing, there are no rows, or a value in them is not finite
std::vector<std::vector<double>> readColumns(const std::filesystem::path& file, const std::vector<std::string>& names);

}  // namespace dovetail::benchmark
