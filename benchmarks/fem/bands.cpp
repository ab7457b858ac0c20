// Bands of softening solids with the energy of the gradient of F beside solids without: waves, a shear layer against
// its closed form, a biaxial test on several meshes and with friction that scatters. Markdown tables.
#include <cmath>
#include <cstdio>
#include <memory>
#include <string>

#include "band_biaxial.hpp"
#include "band_layer.hpp"
#include "band_pressuremeter.hpp"
#include "band_scatter.hpp"
#include "band_waves.hpp"
#include "dovetail/core/error.hpp"
#include "program/options.hpp"
#include "program/run.hpp"
#include "soft_sand.hpp"

namespace {

using namespace dovetail;
using namespace dovetail::benchmark;

void showWaves() {
  std::printf("| waves of so many elements | average | half of it | gradient | multipliers |\n|---|---|---|---|---|\n");
  for (const int period : {2, 3, 4, 6, 8, 10, 12, 20, 40}) {
    const WaveStiffness of = stiffnessOfWave(period, 5.0, 10.0);
    std::printf("| %d | %+.4f | %+.4f | %+.4f | %+.4f |\n", period, of.average, of.halfAverage, of.gradient,
                of.multipliers);
  }
}

void showLayer() {
  std::printf(
      "\n| layer, elements a band | width | of the exact one | opening per drop of the stress |\n|---|---|---|---|\n");
  const SoftLayer layer;
  const Band exact = exactBand(layer);
  std::printf("| exact | %.3f | | %.2f |\n", exact.width, exact.opening);
  for (const fem::ElementShape shape : {fem::ElementShape::quad4, fem::ElementShape::quad8})
    for (const int elements : {5, 10, 20, 40}) {
      const Band found = bandOfElements(layer, shape, elements);
      std::printf("| %s %d | %.3f | %+.2f %% | %+.2f %% |\n", fem::name(shape), elements, found.width,
                  100.0 * (found.width / exact.width - 1.0), 100.0 * (found.opening / exact.opening - 1.0));
    }
}

/// 118 mm high, sheared, with a band of 13 to 16 mm in 12 elements.
void showLiu2015() {
  constexpr double height = 118.0, width = 14.5;
  const SoftLayer layer{.bandsAcross = height / width};
  const double millimetre = width / exactBand(layer).width;
  std::printf("\n| Liu et al. 2015, sec. 3.4: elements of 118 mm | a band of 13 to 16 mm | opening |\n|---|---|---|\n");
  for (const int rows : {12, 24, 41, 82}) {
    const Band found = bandOfElements(layer, fem::ElementShape::quad8, rows / layer.bandsAcross);
    std::printf("| %d | %.1f | %+.2f %% |\n", rows, millimetre * found.width,
                100.0 * (found.opening / exactBand(layer).opening - 1.0));
  }
}

void showCourse(const BandBiaxial& s, std::FILE* csv) {
  const BiaxialCourse course = pressTogether(s, {{softSand({})}});
  std::printf("| %s %d × %d%s | %g |", fem::name(s.shape), s.across, 2 * s.across, s.skew > 0.0 ? " skew" : "",
              s.modulus);
  for (std::size_t k = 0; k < static_cast<std::size_t>(std::lround(100.0 * s.end)); ++k) {
    if (k >= course.looks.size()) {
      std::printf(" |");
      continue;
    }
    const BandLook& look = course.looks[k];
    std::printf(" %.1f, %.3f |", look.axial / 1e3, look.fraction);
    if (csv != nullptr)
      std::fprintf(csv, "%s,%d,%g,%g,%.2f,%.6g,%.4f,%.4f\n", fem::name(s.shape), s.across, s.modulus, s.skew,
                   0.01 * static_cast<double>(k + 1), look.axial, look.fraction, look.largest);
  }
  if (course.broken > 0.0)
    std::printf(" broken at %.2f %% |", 100.0 * course.broken);
  else
    std::printf(" %.2f |", course.looks.back().largest);
  std::printf(" %.2e | %.0f | %.1e |\n", course.step, course.seconds, course.residual);
  std::fflush(stdout);
}

void showBiaxial(bool quick, double end, fem::ElementShape shape, std::FILE* csv) {
  const long percents = std::lround(100.0 * end);
  std::printf("\n| biaxial | D, N |");
  for (long k = 1; k <= percents; ++k) std::printf(" at %ld %%: kPa, half of the shear in |", k);
  std::printf(" largest shear | step, s | s | residual |\n|---|---|");
  for (long k = 1; k <= percents; ++k) std::printf("---|");
  std::printf("---|---|---|---|\n");
  if (csv != nullptr) std::fprintf(csv, "element,across,modulus,skew,strain,axial,fraction,largest\n");
  const auto show = [&](int across, double modulus, double skew) {
    showCourse({.across = across, .shape = shape, .modulus = modulus, .skew = skew, .end = end}, csv);
  };
  for (const int across : {8, 16, 32})
    for (const double modulus : {0.0, 90.0})
      if (!quick || across == 8) show(across, modulus, 0.0);
  if (quick) return;
  show(16, 90.0, 0.3);
  for (const double modulus : {360.0, 900.0}) show(16, modulus, 0.0);
}

void showScatter() {
  std::printf(
      "\n| friction scatters by | peak, kPa, seeds 1 to 3 | mean | kPa at 2 %% | half of the shear in |\n"
      "|---|---|---|---|---|\n");
  for (const double scatter : {0.0, 0.05, 0.1, 0.2, 0.4}) {
    std::printf("| %g |", scatter);
    double peak = 0.0, axial = 0.0, fraction = 0.0;
    constexpr int seeds = 3;
    for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
      const BiaxialCourse course = pressScattered(scatter, 90.0, seed);
      std::printf("%s %.1f", seed > 1 ? "," : "", course.peak / 1e3);
      peak += course.peak / (1e3 * seeds);
      axial += course.looks.at(1).axial / (1e3 * seeds);
      fraction += course.looks.at(1).fraction / seeds;
    }
    std::printf(" | %.1f | %.1f | %.3f |\n", peak, axial, fraction);
    std::fflush(stdout);
  }
}

/// A hole under pressure: its opening and its bands.
void showPressuremeter() {
  std::printf(
      "\n| hole under pressure, D, N | pressure | opening | bands | width, m | contrast | step, s | s | residual |\n"
      "|---|---|---|---|---|---|---|---|---|\n");
  for (const double modulus : {0.0, 40.0, 400.0}) {
    const PressuremeterCourse course = inflate({.modulus = modulus});
    for (const PressuremeterLook& look : course.looks)
      std::printf("| %g | %.2f | %.2f %% | %d | %.3f | %.2f | %.2e | %.0f | %.1e |\n", modulus, look.pressure,
                  100.0 * look.opening, look.bands, look.width, look.contrast, course.step, course.seconds,
                  course.residual);
    if (course.broken > 0.0) std::printf("| %g | %.2f | broken | | | | | | |\n", modulus, course.broken);
    std::fflush(stdout);
  }
}

}  // namespace

int main(int argc, char** argv) {
  return program::runProgram("fem_bands", [&] {
    bool quick = false;
    std::string only = "all", elements = "quad8", file;
    double end = 0.04;
    program::Options o("fem_bands", "Bands with a width of their own: waves, a shear layer and biaxial tests.");
    o.flag("--quick", quick, "the coarsest mesh alone");
    o.word("--only", only, "all|waves|layer|biaxial|scatter|pressuremeter", "one table");
    o.word("--elements", elements, "quad4|quad8", "of the biaxial test");
    o.number("--end STRAIN", end, program::between(0.01, 0.2), "of the biaxial test");
    o.text("--csv FILE", file, "the biaxial test for other programs");
    if (!o.parse(argc, argv)) return true;
    const auto shows = [&](const char* table) { return only == "all" || only == table; };
    const std::unique_ptr<std::FILE, int (*)(std::FILE*)> csv(file.empty() ? nullptr : std::fopen(file.c_str(), "w"),
                                                              std::fclose);
    if (!csv && !file.empty()) throw InputError("the file cannot be written", file, "give another name");
    if (shows("waves")) showWaves();
    if (shows("layer")) showLayer(), showLiu2015();
    if (shows("biaxial"))
      showBiaxial(quick, end, elements == "quad4" ? fem::ElementShape::quad4 : fem::ElementShape::quad8, csv.get());
    if (shows("scatter")) showScatter();
    if (shows("pressuremeter")) showPressuremeter();
    return true;
  });
}
