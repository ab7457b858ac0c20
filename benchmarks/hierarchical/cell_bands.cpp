// Bands in solids of cells between rough plates, with the energy of the gradient of F and without, on two meshes.
#include <cmath>
#include <string>
#include <vector>

#include "band_biaxial.hpp"
#include "biaxial_solid.hpp"
#include "figure.hpp"

namespace dovetail::benchmark {

namespace {

constexpr double modulus = 1000.0, end = 0.03, damping = 5.0;  // N; mean axial; 1/s
constexpr std::array meshes{8, 12};

BiaxialCourse pressed(const rve::Rve& cell, int across, double D) {
  return pressTogether(
      {.across = across, .modulus = D, .end = end, .damping = damping, .rough = true, .following = true},
      {{hierarchical::cellField({cell}, hierarchical::DynamicCells{})}});
}

/// The same packings on both meshes.
struct Courses {
  std::vector<BiaxialCourse> coarse, fine;
};

Courses coursesOf(const std::vector<rve::Rve>& cells, double D) {
  Courses all;
  for (const rve::Rve& cell : cells) {
    all.coarse.push_back(pressed(cell, meshes[0], D));
    all.fine.push_back(pressed(cell, meshes[1], D));
  }
  return all;
}

/// NaN where the solid broke before.
double at(const BiaxialCourse& course, int percent, double BandLook::*value) {
  const auto k = static_cast<std::size_t>(percent - 1);
  return k < course.looks.size() ? course.looks[k].*value : std::nan("");
}

/// Values of those that are numbers.
template <class Value>
std::vector<double> over(const std::vector<BiaxialCourse>& courses, const Value& value) {
  std::vector<double> all;
  for (const BiaxialCourse& course : courses)
    if (const double one = value(course); !std::isnan(one)) all.push_back(one);
  return all;
}

void addCourses(FigureRows& rows, const std::vector<BiaxialCourse>& courses, const std::string& name) {
  const double none = std::nan("");
  const auto add = [&](const std::string& what, const auto& value) {
    rows.push_back(rowOf(what + ", " + name, over(courses, value), none, 0.0));
  };
  add("half of the shear at 3 % in", [](const BiaxialCourse& c) { return at(c, 3, &BandLook::fraction); });
  add("largest shear at 3 %", [](const BiaxialCourse& c) { return at(c, 3, &BandLook::largest); });
  for (const int percent : {1, 2, 3})
    add("kPa at " + std::to_string(percent) + " %",
        [percent](const BiaxialCourse& c) { return 1e-3 * at(c, percent, &BandLook::axial); });
  add("residual of the ledger over work", [](const BiaxialCourse& c) { return c.residual; });
  add("seconds of the processor", [](const BiaxialCourse& c) { return c.seconds; });
}

double meanAt(const std::vector<BiaxialCourse>& courses, int percent, double BandLook::*value) {
  return rowOf("", over(courses, [&](const BiaxialCourse& c) { return at(c, percent, value); }), 0.0, 0.0).here;
}

/// Value of the fine mesh over that of the coarse one.
double fineOverCoarse(const Courses& of) {
  return meanAt(of.fine, 3, &BandLook::fraction) / meanAt(of.coarse, 3, &BandLook::fraction);
}

double apartAt2(const Courses& of) {
  return std::abs(meanAt(of.fine, 2, &BandLook::axial) - meanAt(of.coarse, 2, &BandLook::axial));
}

}  // namespace

FigureRows bandsOfCells(bool quick) {
  std::vector<rve::Rve> cells;
  for (std::uint64_t seed = 1; seed <= (quick ? 1U : 3U); ++seed) cells.push_back(sand(seed));
  const Courses local = coursesOf(cells, 0.0), with = coursesOf(cells, modulus);
  FigureRows rows;
  addCourses(rows, local.coarse, "8 × 16");
  addCourses(rows, local.fine, "12 × 24");
  addCourses(rows, with.coarse, "8 × 16 with the gradient");
  addCourses(rows, with.fine, "12 × 24 with the gradient");
  rows.push_back({"half of the shear, 12 × 24 over 8 × 16", fineOverCoarse(local), 0.0, 0.35, 0.35,
                  "at most 0.7: as wide as elements"});
  rows.push_back({"half of the shear, 12 × 24 over 8 × 16 with the gradient", fineOverCoarse(with), 0.0, 1.0, 0.1});
  rows.push_back(
      {"kPa apart at 2 %, times more without the gradient", apartAt2(local) / apartAt2(with), 0.0, 2.0, 0.0, {}, true});
  return rows;
}

}  // namespace dovetail::benchmark
