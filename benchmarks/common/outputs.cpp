#include "common/outputs.hpp"

#include "dovetail/core/error.hpp"
#include "dovetail/io/output_folder.hpp"

namespace dovetail::benchmark {

namespace fs = std::filesystem;

void prepareFolder(const std::string& option, const fs::path& folder, const std::vector<std::string>& names) {
  try {
    io::prepareOutputFolder(folder.empty() ? "." : folder, names);
  } catch (const InputError& error) {
    throw InputError(option + ": " + error.what(), "", "");
  }
}

void prepareSummary(const fs::path& file, const fs::path& outFolder, const std::vector<std::string>& taken) {
  const auto plain = [](const fs::path& path) { return fs::absolute(path).lexically_normal(); };
  for (const std::string& name : taken)
    if (!outFolder.empty() && plain(file) == plain(outFolder / name))
      throw InputError("the folder of --out gets a file of this name", "--summary " + file.string(),
                       "give another name, such as summary.json");
  prepareFolder("--summary", file.parent_path(), {file.filename().string()});
}

}  // namespace dovetail::benchmark
