#include "reference_curves.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>

#include "dovetail/core/error.hpp"

namespace dovetail::wave {

namespace {

/// "1.5" of "wave_1P_c1.5dX.csv" for head "_c" and tail "dX.csv"; nothing if the name has another form.
std::optional<std::string> between(const std::string& text, const std::string& head, const std::string& tail) {
  if (text.size() < head.size() + tail.size() || !text.starts_with(head) || !text.ends_with(tail)) return std::nullopt;
  return text.substr(head.size(), text.size() - head.size() - tail.size());
}

double parseNumber(const std::string& text, const std::string& where) {
  double value = 0.0;
  const auto result = std::from_chars(text.data(), text.data() + text.size(), value);
  if (result.ec != std::errc{} || result.ptr != text.data() + text.size() || !(value >= 0.0) || !std::isfinite(value))
    throw InputError("'" + text + "' is no number", where, "name the file as in wave_1P_c1.5dX.csv");
  return value;
}

std::vector<EnergySample> readEnergy(const std::filesystem::path& file) {
  const io::TimeSeries table = io::readCsv(file);
  for (const char* name : {"t_s", "Etot_J"})
    if (std::find(table.names().begin(), table.names().end(), name) == table.names().end())
      throw InputError(std::string("column ") + name + " is missing", file.string(), "restore the file");
  const auto t = table.column("t_s"), energy = table.column("Etot_J");
  if (table.rows() == 0) throw InputError("there are no rows", file.string(), "restore the file");
  std::vector<EnergySample> samples;
  for (std::size_t row = 0; row < table.rows(); ++row) {
    if (!std::isfinite(t[row]) || !std::isfinite(energy[row]) || (row > 0 && t[row] <= t[row - 1]))
      throw InputError("row " + std::to_string(row + 1) + " is not finite or no later than the one before",
                       file.string(), "restore the file");
    samples.push_back({t[row], energy[row]});
  }
  if (energy[0] <= 0.0) throw InputError("the energy at the start is not positive", file.string(), "restore the file");
  return samples;
}

std::optional<ReferenceCurve> readCurve(const std::filesystem::path& file) {
  const std::string name = file.filename().string();
  const std::size_t mark = name.find("P_", 0);
  if (!name.starts_with("wave_") || mark == std::string::npos) return std::nullopt;
  const std::string rest = name.substr(mark);
  const auto width = between(rest, "P_c", "dX.csv");
  if (!width && rest != "P_fullDEM.csv") return std::nullopt;
  ReferenceCurve curve;
  const double perElement = parseNumber(name.substr(5, mark - 5), file.string());
  curve.particlesPerEdge = static_cast<int>(std::lround(std::cbrt(perElement)));
  if (width) curve.cgWidth = parseNumber(*width, file.string());
  curve.energy = readEnergy(file);
  return curve;
}

}  // namespace

std::vector<ReferenceCurve> readReferenceCurves(const std::string& folder) {
  std::vector<ReferenceCurve> curves;
  std::error_code ignored;
  for (const auto& entry : std::filesystem::directory_iterator(folder, ignored))
    if (auto curve = readCurve(entry.path())) curves.push_back(std::move(*curve));
  if (curves.empty())
    throw InputError("no wave_*P_c*dX.csv in " + folder, "--reference",
                     "name the folder that holds the published curves");
  const auto key = [](const ReferenceCurve& c) { return std::pair(c.particlesPerEdge, c.cgWidth.value_or(1e300)); };
  std::sort(curves.begin(), curves.end(), [&](const auto& a, const auto& b) { return key(a) < key(b); });
  return curves;
}

bool fits(const ReferenceCurve& curve, const Settings& s) {
  if (curve.particlesPerEdge != s.particlesPerEdge || s.signal != Signal::impulse) return false;
  return curve.cgWidth ? !s.fullDem && *curve.cgWidth == s.cgWidth : s.fullDem;
}

double largestDifference(const ReferenceCurve& curve, const std::vector<EnergySample>& energy) {
  double largest = 0.0;
  for (const EnergySample& theirs : curve.energy) {
    const double ours = energyAt(energy, theirs.t);
    if (std::isfinite(ours)) largest = std::max(largest, std::abs(ours - theirs.joules));
  }
  return largest / curve.energy.front().joules;
}

}  // namespace dovetail::wave
