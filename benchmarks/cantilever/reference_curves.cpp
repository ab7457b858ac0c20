#include "reference_curves.hpp"

#include <algorithm>
#include <cmath>

#include "common/curves.hpp"
#include "dovetail/core/error.hpp"
#include "settings.hpp"

namespace dovetail::cantilever {

std::vector<ReferenceCurve> readReferenceCurves(const std::string& folder) {
  std::vector<ReferenceCurve> curves;
  for (const auto& [path, width] : benchmark::filesNamed(folder, "cantilever_c", "d.csv")) {
    const auto c =
        benchmark::readColumns(path, {"t_s", "x1_m", "y1_m", "z1_m", "x2_m", "y2_m", "z2_m", "Etot_J", "Eel_DE_J"});
    curves.push_back({benchmark::numberInName(width, path, "cantilever_c2.5d.csv"), c[0], c[1], c[2], c[3], c[4], c[5],
                      c[6], c[7], c[8]});
    const double midSpan = 0.5 * Case{}.length;
    for (double& y : curves.back().y1) y += midSpan;
    for (double& y : curves.back().y2) y += midSpan;
  }
  if (curves.empty())
    throw InputError("no cantilever_c*d.csv in " + folder, "--reference",
                     "name the folder that holds the published curves");
  std::sort(curves.begin(), curves.end(), [](const auto& a, const auto& b) { return a.cgWidth < b.cgWidth; });
  return curves;
}

CurveFigures figuresOf(const ReferenceCurve& curve) {
  const Case beam;
  const double force = 2.0 * particleMass() * beam.gravity;
  const double bending = beam.youngsModulus * std::pow(beam.side, 4) / 12.0;
  CurveFigures figures{};
  const double z0 = curve.z1.front();
  double sumTrue = 0.0, sumAuthors = 0.0;
  std::size_t rows = 0, without = 0;
  figures.leaveTime = curve.t.back();
  for (; rows < curve.t.size(); ++rows) {
    if (rows > 0 && curve.y1[rows] > beam.length) {
      const double fraction = (beam.length - curve.y1[rows - 1]) / (curve.y1[rows] - curve.y1[rows - 1]);
      figures.leaveTime = curve.t[rows - 1] + fraction * (curve.t[rows] - curve.t[rows - 1]);
      break;
    }
    const auto error = [&](double offset) {
      const auto off = [&](double x, double y, double z, double x0) {
        const double dz = z - (z0 - force * std::pow(y - offset, 3) / (3.0 * bending)), dx = x - x0;
        return dx * dx + dz * dz;
      };
      return std::sqrt(off(curve.x1[rows], curve.y1[rows], curve.z1[rows], beam.startX) +
                       off(curve.x2[rows], curve.y2[rows], curve.z2[rows], -beam.startX));
    };
    sumTrue += error(0.0);
    sumAuthors += error(beam.startY);
    figures.largestEnergy = std::max(figures.largestEnergy, curve.energy[rows]);
    if (rows > 0 && curve.contactEnergy[rows] == 0.0) ++without;
  }
  const auto count = static_cast<double>(std::max<std::size_t>(rows, 1));
  figures.errorTrueArm = sumTrue / count;
  figures.errorAuthorsArm = sumAuthors / count;
  figures.noContactFraction = static_cast<double>(without) / count;
  figures.finalEnergy = curve.energy.back();
  return figures;
}

}  // namespace dovetail::cantilever
