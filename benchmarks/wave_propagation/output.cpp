#include "output.hpp"

#include "common/outputs.hpp"
#include "summary.hpp"
#include "velocity_profile.hpp"

namespace dovetail::wave {

Outputs::Outputs(const Settings& settings)
    : settings_(settings),
      folder_(settings.out),
      profile_(emptyProfile()),
      seriesFile_(folder_ / "series.csv", provenanceOf(settings)),
      profileFile_(folder_ / "profile.csv", provenanceOf(settings)) {
  const std::filesystem::path summary(settings.summary);
  benchmark::requireOtherName(summary, folder_,
                              {"series.csv", "series.h5", "profile.csv", "solid.pvd", "particles.pvd"});
  if (!folder_.empty())
    benchmark::underName("--out", [&] {
      io::prepareOutputFolder(folder_, {"series.csv", "series.h5", "profile.csv"});
      lock_.emplace(folder_);
      frames_ = makeFrameWriter(folder_, settings);
    });
  if (!summary.empty()) benchmark::prepareSummary(summary);
  if (!folder_.empty()) io::removeOurs(folder_ / "series.h5");
  if (!summary.empty()) io::removeOurs(summary);
}

Observer Outputs::observer() {
  if (folder_.empty()) return {};
  return [this](const Frame& frame) {
    appendProfile(profile_, settings_, frame);
    seriesFile_.write(frame.series);
    profileFile_.write(profile_);
    if (frames_) frames_->write(frame);
  };
}

void Outputs::finish(const RunResult& result) {
  if (!folder_.empty()) {
    appendParticlesAlone(profile_, result);
    seriesFile_.write(result.series);
    profileFile_.write(profile_);
    writeSeriesHdf5(folder_ / "series.h5", result);
  }
  if (!settings_.summary.empty()) writeSummary(settings_.summary, result);
}

}  // namespace dovetail::wave
