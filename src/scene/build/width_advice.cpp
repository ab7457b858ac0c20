#include "width_advice.hpp"

#include <algorithm>
#include <cstdio>
#include <ostream>

#include "dovetail/cg/width_study.hpp"
#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"

namespace dovetail::scene {

namespace {

/// Where fields are compared, and up to which width.
struct Place {
  geometry::Box box;
  double most;
};

Place placeFor(const geometry::Periodicity& space, const geometry::Box& around, double diameter,
               const GridOptions& settings) {
  constexpr double widest = 8.0;  // mean diameters
  if (settings.box) return {*settings.box, widest * diameter};
  Place place{around, widest * diameter};
  for (int c = 0; c < 3; ++c)
    if (!space.axes[static_cast<std::size_t>(c)])
      place.most = std::min(place.most, 0.25 * (around.upper[c] - around.lower[c]));
  for (int c = 0; c < 3; ++c)
    if (!space.axes[static_cast<std::size_t>(c)]) {
      place.box.lower[c] += place.most;
      place.box.upper[c] -= place.most;
    }
  return place;
}

/// Points that fill a box evenly and are in step with no lattice (Halton, Numer. Math. 2, 1960).
std::vector<Vec3> spread(const geometry::Box& box, int count) {
  const auto place = [](int number, int base) {
    double sum = 0.0, digit = 1.0;
    for (; number > 0; number /= base) sum += (digit /= base) * (number % base);
    return sum;
  };
  constexpr int bases[] = {2, 3, 5};
  std::vector<Vec3> points(static_cast<std::size_t>(count), box.lower);
  for (int p = 0; p < count; ++p)
    for (int c = 0; c < 3; ++c)
      points[static_cast<std::size_t>(p)][c] += (box.upper[c] - box.lower[c]) * place(p + 1, bases[c]);
  return points;
}

}  // namespace

double advisedWidth(const cg::SnapshotView& grains, const geometry::Box& around, double meanDiameter,
                    const GridOptions& settings, std::ostream& log) {
  const double least = 0.75 * meanDiameter;
  const Place place = placeFor(grains.space, around, meanDiameter, settings);
  if (!(place.most >= 2.0 * least))
    throw InputError("the layer of grains is too thin: only widths of up to " + formatNumber(place.most) +
                         " m stay clear of its faces",
                     "--advise-width", "give a --box of points where fields are wanted, or the --width itself");
  const cg::WidthStudy study =
      cg::studyWidths(settings.shape, 3, spread(place.box, 1000), grains, {.least = least, .most = place.most});
  char row[120];
  std::snprintf(row, sizeof row, "%-14s %12s %12s %12s\n", "width, m", "measure", "of density", "of velocity");
  log << "change of density and velocity per e-fold of the width, 1000 points\n" << row;
  for (std::size_t k = 0; k < study.density.size(); ++k) {
    std::snprintf(row, sizeof row, "%-14.6g %12.4g %12.4g %12.4g\n", study.curve.at[k], study.curve.measure[k],
                  study.density[k], study.velocity[k]);
    log << row;
  }
  const std::string name = "width, m";
  log << '\n' << optimaText({&name, 1}, {&study.curve, 1}) << '\n';
  return study.curve.best;
}

}  // namespace dovetail::scene
