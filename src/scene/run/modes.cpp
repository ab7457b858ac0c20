#include "modes.hpp"

#include <algorithm>

#include "build/parts.hpp"
#include "dovetail/core/finite.hpp"
#include "dovetail/fem/solve/modes.hpp"
#include "dovetail/io/time_series.hpp"
#include "frames.hpp"

namespace dovetail::scene {

namespace {

constexpr double stageNumber(std::size_t stage) { return static_cast<double>(stage + 1); }

/// Those of earlier stages, of this run: a new one removes the file.
io::TimeSeries rowsBefore(const std::filesystem::path& file, std::size_t stage) {
  io::TimeSeries table({"stage", "solid", "mode", "frequency_Hz"});
  if (!std::filesystem::exists(file)) return table;
  const io::TimeSeries found = io::readCsv(file);
  if (found.names() != table.names()) return table;
  for (std::size_t row = 0; row < found.rows(); ++row) {
    std::vector<double> values;
    for (const std::string& name : found.names()) values.push_back(found.column(name)[row]);
    if (values[0] < stageNumber(stage)) table.append(values);
  }
  return table;
}

std::string lineOf(const std::string& solid, const std::vector<double>& frequencies) {
  constexpr std::size_t most = 6;
  std::string line;
  for (std::size_t m = 0; m < std::min(most, frequencies.size()); ++m)
    line += (m > 0 ? ", " : "") + formatNumber(frequencies[m]);
  return "frequencies of \"" + solid + "\": " + line + (frequencies.size() > most ? ", … Hz" : " Hz");
}

}  // namespace

Lines findModes(const Built& built, const Scene& scene, std::size_t stage, const std::filesystem::path& file,
                const io::KeyValues& provenance) {
  const auto& wanted = std::get<FindModes>(scene.stages[stage].kind);
  io::TimeSeries table = rowsBefore(file, stage);
  Lines lines;
  for (std::size_t s = 0; s < built.run->solids(); ++s) {
    const coupling::SolidSide& side = built.run->solid(s);
    fem::ModesOptions options{.count = wanted.count, .massFraction = side.mass->fraction()};
    options.linear.method = static_cast<linalg::LinearMethod>(scene.solids[s].linearSolver);
    const fem::Modes modes = atPlace(scene.stages[stage].where, [&] { return fem::modesOf(*side.model, options); });
    const std::vector<double>& frequencies = modes.frequency;
    for (std::size_t m = 0; m < frequencies.size(); ++m)
      table.append({stageNumber(stage), static_cast<double>(s), static_cast<double>(m + 1), frequencies[m]});
    if (scene.output.frames && std::ranges::count(scene.output.contents, "solids") > 0)
      writeModes(file.parent_path(), built, s, modes, provenance);
    lines.push_back(lineOf(side.name, frequencies));
  }
  io::writeCsv(file, table, provenance);
  return lines;
}

}  // namespace dovetail::scene
