#include "output.hpp"

#include "dovetail/core/error.hpp"
#include "dovetail/io/output_folder.hpp"
#include "dovetail/io/provenance.hpp"
#include "dovetail/io/time_series.hpp"

namespace dovetail::cantilever {

namespace {

/// Prepares a folder; what is wrong with it is told under the name of the option.
void prepareFor(const std::string& option, const std::filesystem::path& folder, const std::vector<std::string>& names) {
  try {
    io::prepareOutputFolder(folder.empty() ? "." : folder, names);
  } catch (const InputError& error) {
    throw InputError(option + ": " + error.what(), "", "");
  }
}

}  // namespace

void prepareOutputs(const Settings& settings) {
  const std::filesystem::path folder(settings.out), file(settings.summary);
  if (!settings.out.empty()) prepareFor("--out", folder, {"series.csv", "series.h5"});
  if (settings.summary.empty()) return;
  const auto plain = [](const std::filesystem::path& path) {
    return std::filesystem::absolute(path).lexically_normal();
  };
  for (const char* name : {"series.csv", "series.h5", "beam.pvd", "particles.pvd"})
    if (!settings.out.empty() && plain(file) == plain(folder / name))
      throw InputError("the folder of --out gets a file of this name", "--summary " + file.string(),
                       "give another name, such as summary.json");
  prepareFor("--summary", file.parent_path(), {file.filename().string()});
}

std::vector<std::string> writeSeries(const RunResult& result) {
  const std::filesystem::path folder(result.settings.out);
  std::vector<std::string> written{"series.csv"};
  io::writeCsv(folder / "series.csv", result.series, io::provenance(describe(result.settings)));
  if (writeSeriesHdf5(folder / "series.h5", result)) written.emplace_back("series.h5");
  return written;
}

}  // namespace dovetail::cantilever
