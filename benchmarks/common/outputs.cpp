#include "common/outputs.hpp"

namespace dovetail::benchmark {

namespace fs = std::filesystem;

namespace {

void requireOtherName(const fs::path& summary, const fs::path& outFolder, const std::vector<std::string>& taken) {
  const auto plain = [](const fs::path& path) { return fs::absolute(path).lexically_normal(); };
  for (const std::string& name : taken)
    if (plain(summary) == plain(outFolder / name))
      throw InputError("the folder of --out gets a file of this name", "--summary " + summary.string(),
                       "give another name, such as summary.json");
}

}  // namespace

void prepareSummary(const fs::path& summary) {
  const fs::path folder = summary.parent_path();
  if (std::error_code error; !folder.empty() && !fs::exists(folder, error))
    throw InputError("there is no folder " + folder.string(), "--summary " + summary.string(),
                     "make it, or give a folder that exists");
  underName("--summary",
            [&] { return io::prepareOutputFolder(folder.empty() ? "." : folder, {summary.filename().string()}); });
}

Outputs::Outputs(const RunOptions& settings, const std::string& solid, bool withProfile, io::KeyValues provenance)
    : folder_(settings.out),
      provenance_(std::move(provenance)),
      series_(folder_ / "series.csv", provenance_),
      profile_(folder_ / "profile.csv", provenance_) {
  std::vector<std::string> tables{"series.csv", "series.h5"}, names{solid + ".pvd", "particles.pvd"};
  if (withProfile) tables.emplace_back("profile.csv");
  names.insert(names.end(), tables.begin(), tables.end());
  const fs::path summary(settings.summary);
  if (!summary.empty() && !folder_.empty()) requireOtherName(summary, folder_, names);
  if (!folder_.empty())
    underName("--out", [&] {
      io::prepareOutputFolder(folder_, tables);
      lock_.emplace(folder_);
      frames_ = makeFrameWriter(folder_, solid, provenance_);
    });
  if (!summary.empty()) prepareSummary(summary);
  if (!folder_.empty()) io::removeOurs(folder_ / "series.h5");
  if (!summary.empty()) io::removeOurs(summary);
}

Observer Outputs::observer() {
  if (folder_.empty()) return {};
  return [this](const Frame& frame) {
    series_.write(frame.series);
    if (frame.profile) profile_.write(*frame.profile);
    if (frames_) frames_->write(frame);
  };
}

void Outputs::finish(const RunData& result) {
  if (folder_.empty()) return;
  series_.write(result.series);
  if (result.velocityProfile) profile_.write(*result.velocityProfile);
  writeSeriesHdf5(folder_ / "series.h5", result.series, provenance_);
}

}  // namespace dovetail::benchmark
