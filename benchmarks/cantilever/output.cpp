#include "output.hpp"

#include "common/outputs.hpp"
#include "summary.hpp"

namespace dovetail::cantilever {

Outputs::Outputs(const Settings& settings)
    : folder_(settings.out), summary_(settings.summary), series_(folder_ / "series.csv", provenanceOf(settings)) {
  benchmark::requireOtherName(summary_, folder_, {"series.csv", "series.h5", "beam.pvd", "particles.pvd"});
  if (!folder_.empty())
    benchmark::underName("--out", [&] {
      io::prepareOutputFolder(folder_, {"series.csv", "series.h5"});
      lock_.emplace(folder_);
      frames_ = makeFrameWriter(folder_, settings);
    });
  if (!summary_.empty()) benchmark::prepareSummary(summary_);
  if (!folder_.empty()) io::removeOurs(folder_ / "series.h5");
  if (!summary_.empty()) io::removeOurs(summary_);
}

Observer Outputs::observer() {
  if (folder_.empty()) return {};
  return [this](const Frame& frame) {
    series_.write(frame.series);
    if (frames_) frames_->write(frame);
  };
}

void Outputs::finish(const RunResult& result) {
  if (!folder_.empty()) {
    series_.write(result.series);
    writeSeriesHdf5(folder_ / "series.h5", result);
  }
  if (!summary_.empty()) writeSummary(summary_, result);
}

}  // namespace dovetail::cantilever
