#include "reference_curves.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>

#include "dovetail/core/error.hpp"
#include "settings.hpp"

namespace dovetail::cantilever {

namespace {

using Columns = std::map<std::string, std::vector<double>>;

double parseNumber(const std::string& text, const std::string& where) {
  double value = 0.0;
  const auto result = std::from_chars(text.data(), text.data() + text.size(), value);
  if (result.ec != std::errc{} || result.ptr != text.data() + text.size() || !std::isfinite(value))
    throw InputError("'" + text + "' is no number", where, "give comma-separated numbers below one header line");
  return value;
}

std::vector<std::string> split(const std::string& line) {
  std::vector<std::string> fields;
  std::istringstream stream(line);
  for (std::string field; std::getline(stream, field, ',');) {
    field.erase(std::remove(field.begin(), field.end(), '\r'), field.end());
    fields.push_back(field);
  }
  return fields;
}

Columns readColumns(const std::string& file) {
  std::ifstream stream(file);
  std::string line;
  if (!std::getline(stream, line)) throw InputError("the file cannot be read", file, "give a readable CSV file");
  const std::vector<std::string> names = split(line);
  Columns columns;
  for (std::size_t row = 2; std::getline(stream, line); ++row) {
    const auto fields = split(line);
    const std::string where = file + ", line " + std::to_string(row);
    if (fields.size() != names.size())
      throw InputError(
          "the line has " + std::to_string(fields.size()) + " fields instead of " + std::to_string(names.size()), where,
          "restore the file");
    for (std::size_t k = 0; k < names.size(); ++k) columns[names[k]].push_back(parseNumber(fields[k], where));
  }
  if (columns.empty()) throw InputError("there are no rows", file, "restore the file");
  return columns;
}

ReferenceCurve readCurve(const std::string& file, double width) {
  Columns columns = readColumns(file);
  const auto take = [&](const std::string& name) {
    if (!columns.contains(name)) throw InputError("column " + name + " is missing", file, "restore the file");
    return columns[name];
  };
  ReferenceCurve curve{width,        take("t_s"),  take("x1_m"), take("y1_m"),   take("z1_m"),
                       take("x2_m"), take("y2_m"), take("z2_m"), take("Etot_J"), take("Eel_DE_J")};
  const double midSpan = 0.5 * Case{}.length;
  for (double& y : curve.y1) y += midSpan;
  for (double& y : curve.y2) y += midSpan;
  return curve;
}

}  // namespace

std::vector<ReferenceCurve> readReferenceCurves(const std::string& folder) {
  std::vector<ReferenceCurve> curves;
  std::error_code ignored;
  for (const auto& entry : std::filesystem::directory_iterator(folder, ignored)) {
    const std::string name = entry.path().filename().string(), head = "cantilever_c", tail = "d.csv";
    if (!name.starts_with(head) || !name.ends_with(tail)) continue;
    const std::string number = name.substr(head.size(), name.size() - head.size() - tail.size());
    curves.push_back(readCurve(entry.path().string(), parseNumber(number, entry.path().string())));
  }
  if (curves.empty())
    throw InputError("no cantilever_c*d.csv in " + folder, "--reference",
                     "name the folder that holds the published curves");
  std::sort(curves.begin(), curves.end(), [](const auto& a, const auto& b) { return a.cgWidth < b.cgWidth; });
  return curves;
}

CurveFigures figuresOf(const ReferenceCurve& curve) {
  const Case beam;
  const double force = 2.0 * particleMass(beam) * beam.gravity;
  const double bending = beam.youngsModulus * std::pow(beam.side, 4) / 12.0;
  CurveFigures figures{};
  const double z0 = curve.z1.front();
  double sumTrue = 0.0, sumAuthors = 0.0;
  std::size_t rows = 0, without = 0;
  figures.leaveTime = curve.t.back();
  for (; rows < curve.t.size(); ++rows) {
    if (rows > 0 && curve.y1[rows] > beam.length) {
      const double share = (beam.length - curve.y1[rows - 1]) / (curve.y1[rows] - curve.y1[rows - 1]);
      figures.leaveTime = curve.t[rows - 1] + share * (curve.t[rows] - curve.t[rows - 1]);
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
  figures.noContactShare = static_cast<double>(without) / count;
  figures.finalEnergy = curve.energy.back();
  return figures;
}

}  // namespace dovetail::cantilever
