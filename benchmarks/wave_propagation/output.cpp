#include "output.hpp"

#include "common/outputs.hpp"
#include "dovetail/io/output_folder.hpp"
#include "dovetail/io/provenance.hpp"
#include "dovetail/io/time_series.hpp"

namespace dovetail::wave {

std::unique_ptr<FrameWriter> prepareOutputs(const Settings& settings) {
  benchmark::requireOtherName(settings.summary, settings.out,
                              {"series.csv", "series.h5", "profile.csv", "solid.pvd", "particles.pvd"});
  std::unique_ptr<FrameWriter> frames;
  if (!settings.out.empty())
    frames = benchmark::underName("--out", [&] {
      io::prepareOutputFolder(settings.out, {"series.csv", "series.h5", "profile.csv"});
      return makeFrameWriter(settings.out, settings);
    });
  if (!settings.summary.empty()) benchmark::prepareSummary(settings.summary);
  return frames;
}

void writeTables(const RunResult& result, const io::TimeSeries& profile) {
  const std::filesystem::path folder(result.settings.out);
  const io::KeyValues provenance = io::provenance(describe(result.settings));
  io::writeCsv(folder / "series.csv", result.series, provenance);
  io::writeCsv(folder / "profile.csv", profile, provenance);
  writeSeriesHdf5(folder / "series.h5", result);
}

}  // namespace dovetail::wave
