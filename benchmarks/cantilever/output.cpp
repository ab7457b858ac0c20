#include "output.hpp"

#include "common/outputs.hpp"
#include "dovetail/io/output_folder.hpp"
#include "dovetail/io/provenance.hpp"
#include "dovetail/io/time_series.hpp"

namespace dovetail::cantilever {

std::unique_ptr<FrameWriter> prepareOutputs(const Settings& settings) {
  benchmark::requireOtherName(settings.summary, settings.out, {"series.csv", "series.h5", "beam.pvd", "particles.pvd"});
  std::unique_ptr<FrameWriter> frames;
  if (!settings.out.empty())
    frames = benchmark::underName("--out", [&] {
      io::prepareOutputFolder(settings.out, {"series.csv", "series.h5"});
      return makeFrameWriter(settings.out, settings);
    });
  if (!settings.summary.empty()) benchmark::prepareSummary(settings.summary);
  return frames;
}

std::vector<std::string> writeSeries(const RunResult& result) {
  const std::filesystem::path folder(result.settings.out);
  std::vector<std::string> written{"series.csv"};
  io::writeCsv(folder / "series.csv", result.series, io::provenance(describe(result.settings)));
  if (writeSeriesHdf5(folder / "series.h5", result)) written.emplace_back("series.h5");
  return written;
}

}  // namespace dovetail::cantilever
