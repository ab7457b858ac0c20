#include "reference_curves.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "common/curves.hpp"
#include "dovetail/core/error.hpp"

namespace dovetail::wave {

namespace {

std::vector<EnergySample> readEnergy(const std::filesystem::path& file) {
  const auto columns = benchmark::readColumns(file, {"t_s", "Etot_J"});
  std::vector<EnergySample> samples;
  for (std::size_t row = 0; row < columns[0].size(); ++row) {
    if (row > 0 && columns[0][row] <= columns[0][row - 1])
      throw InputError("row " + std::to_string(row + 1) + " is not later than the row before", file.string(),
                       "restore the file");
    samples.push_back({columns[0][row], columns[1][row]});
  }
  if (samples.front().joules <= 0.0)
    throw InputError("the energy at the start is not positive", file.string(), "restore the file");
  return samples;
}

}  // namespace

std::vector<ReferenceCurve> readReferenceCurves(const std::string& folder) {
  const std::string example = "wave_1P_c1.5dX.csv";
  std::vector<ReferenceCurve> curves;
  for (const auto& [path, middle] : benchmark::filesNamed(folder, "wave_", ".csv")) {
    const std::size_t mark = middle.find("P_");
    const std::string rest = mark == std::string::npos ? "" : middle.substr(mark + 2);
    const bool alone = rest == "fullDEM";
    if (!alone && !(rest.starts_with("c") && rest.ends_with("dX"))) continue;
    ReferenceCurve curve;
    curve.particlesPerEdge =
        static_cast<int>(std::lround(std::cbrt(benchmark::numberInName(middle.substr(0, mark), path, example))));
    if (!alone) curve.cgWidth = benchmark::numberInName(rest.substr(1, rest.size() - 3), path, example);
    curve.energy = readEnergy(path);
    curves.push_back(std::move(curve));
  }
  if (curves.empty())
    throw InputError("no wave_*P_c*dX.csv in " + folder, "--reference",
                     "name the folder that holds the published curves");
  const auto key = [](const ReferenceCurve& c) { return std::pair(c.particlesPerEdge, c.cgWidth.value_or(1e300)); };
  std::sort(curves.begin(), curves.end(), [&](const auto& a, const auto& b) { return key(a) < key(b); });
  return curves;
}

double energyAt(const std::vector<EnergySample>& energy, double t) {
  const auto after =
      std::lower_bound(energy.begin(), energy.end(), t, [](const EnergySample& s, double time) { return s.t < time; });
  if (after == energy.end() || after == energy.begin()) return std::numeric_limits<double>::quiet_NaN();
  const EnergySample &a = *(after - 1), &b = *after;
  return a.joules + (b.joules - a.joules) * (t - a.t) / (b.t - a.t);
}

double dissipatedFraction(const std::vector<EnergySample>& energy, int particlesPerEdge) {
  const bool one = particlesPerEdge == 1;
  return 1.0 - energyAt(energy, one ? 60.8e-3 : 81.7e-3) / energyAt(energy, one ? 19.3e-3 : 19.9e-3);
}

bool fits(const ReferenceCurve& curve, const Settings& s) {
  if (curve.particlesPerEdge != s.particlesPerEdge || !s.impulse()) return false;
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
