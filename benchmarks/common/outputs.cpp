#include "common/outputs.hpp"

#include "dovetail/io/output_folder.hpp"

namespace dovetail::benchmark {

namespace fs = std::filesystem;

void requireOtherName(const fs::path& summary, const fs::path& outFolder, const std::vector<std::string>& taken) {
  if (summary.empty() || outFolder.empty()) return;
  const auto plain = [](const fs::path& path) { return fs::absolute(path).lexically_normal(); };
  for (const std::string& name : taken)
    if (plain(summary) == plain(outFolder / name))
      throw InputError("the folder of --out gets a file of this name", "--summary " + summary.string(),
                       "give another name, such as summary.json");
}

void prepareSummary(const fs::path& summary) {
  const fs::path folder = summary.parent_path();
  if (std::error_code error; !folder.empty() && !fs::exists(folder, error))
    throw InputError("there is no folder " + folder.string(), "--summary " + summary.string(),
                     "make it, or give a folder that exists");
  underName("--summary",
            [&] { return io::prepareOutputFolder(folder.empty() ? "." : folder, {summary.filename().string()}); });
}

}  // namespace dovetail::benchmark
