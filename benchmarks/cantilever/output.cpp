#include "output.hpp"

#include "dovetail/io/output_folder.hpp"
#include "dovetail/io/provenance.hpp"
#include "dovetail/io/time_series.hpp"

namespace dovetail::cantilever {

void prepareOutputs(const Settings& settings) {
  if (!settings.out.empty()) io::prepareOutputFolder(settings.out, {"series.csv", "series.h5"});
  if (settings.summary.empty()) return;
  const std::filesystem::path file(settings.summary);
  io::prepareOutputFolder(file.has_parent_path() ? file.parent_path() : std::filesystem::path("."),
                          {file.filename().string()});
}

std::vector<std::string> writeSeries(const RunResult& result) {
  const std::filesystem::path folder(result.settings.out);
  std::vector<std::string> written{"series.csv"};
  io::writeCsv(folder / "series.csv", result.series, io::provenance(describe(result.settings)));
  if (writeSeriesHdf5(folder / "series.h5", result)) written.emplace_back("series.h5");
  return written;
}

}  // namespace dovetail::cantilever
