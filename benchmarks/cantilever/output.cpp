#include "output.hpp"

#include "dovetail/core/error.hpp"
#include "dovetail/io/output_folder.hpp"
#include "dovetail/io/provenance.hpp"
#include "dovetail/io/time_series.hpp"

namespace dovetail::cantilever {

namespace {

/// What is wrong with a place is told under the name of the option.
template <class Prepare>
auto underName(const std::string& option, Prepare prepare) {
  try {
    return prepare();
  } catch (const InputError& error) {
    throw InputError(option + ": " + error.what(), "", "");
  }
}

void requireDistinctSummary(const Settings& settings) {
  if (settings.out.empty() || settings.summary.empty()) return;
  const std::filesystem::path folder(settings.out), file(settings.summary);
  const auto plain = [](const std::filesystem::path& path) {
    return std::filesystem::absolute(path).lexically_normal();
  };
  for (const char* name : {"series.csv", "series.h5", "beam.pvd", "particles.pvd"})
    if (plain(file) == plain(folder / name))
      throw InputError("the folder of --out gets a file of this name", "--summary " + file.string(),
                       "give another name, such as summary.json");
}

}  // namespace

std::unique_ptr<FrameWriter> prepareOutputs(const Settings& settings) {
  requireDistinctSummary(settings);
  std::unique_ptr<FrameWriter> frames;
  if (!settings.out.empty())
    frames = underName("--out", [&] {
      io::prepareOutputFolder(settings.out, {"series.csv", "series.h5"});
      return makeFrameWriter(settings.out, settings);
    });
  if (settings.summary.empty()) return frames;
  const std::filesystem::path file(settings.summary), parent = file.parent_path();
  underName("--summary",
            [&] { return io::prepareOutputFolder(parent.empty() ? "." : parent, {file.filename().string()}); });
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
