#include "output.hpp"

#include "common/outputs.hpp"
#include "dovetail/io/provenance.hpp"
#include "dovetail/io/time_series.hpp"

namespace dovetail::wave {

void prepareOutputs(const Settings& settings) {
  const std::filesystem::path folder(settings.out), file(settings.summary);
  if (!settings.out.empty()) benchmark::prepareFolder("--out", folder, {"series.csv", "series.h5", "profile.csv"});
  if (!settings.summary.empty())
    benchmark::prepareSummary(file, folder, {"series.csv", "series.h5", "profile.csv", "solid.pvd", "particles.pvd"});
}

void writeTables(const RunResult& result, const io::TimeSeries& profile) {
  const std::filesystem::path folder(result.settings.out);
  const io::KeyValues provenance = io::provenance(describe(result.settings));
  io::writeCsv(folder / "series.csv", result.series, provenance);
  io::writeCsv(folder / "profile.csv", profile, provenance);
  writeSeriesHdf5(folder / "series.h5", result);
}

}  // namespace dovetail::wave
