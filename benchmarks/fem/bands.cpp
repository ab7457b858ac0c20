// Bands of softening solids with the energy of the gradient of F beside solids without: a shear layer against its
// closed form, and a biaxial test on several meshes. Two Markdown tables.
#include <cmath>
#include <cstdio>
#include <string>

#include "band_biaxial.hpp"
#include "band_layer.hpp"
#include "program/options.hpp"
#include "program/run.hpp"
#include "soft_sand.hpp"

namespace {

using namespace dovetail;
using namespace dovetail::benchmark;

void showLayer() {
  std::printf(
      "| layer, elements a band | width | of the exact one | opening per drop of the stress |\n|---|---|---|---|\n");
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

void showCourse(const BandBiaxial& s) {
  const BiaxialCourse course = pressTogether(s, {{softSand({})}});
  std::printf("| %s %d × %d%s | %g |", fem::name(s.shape), s.across, 2 * s.across, s.skew > 0.0 ? " skew" : "",
              s.modulus);
  for (std::size_t k = 0; k < static_cast<std::size_t>(std::lround(100.0 * s.end)); ++k)
    k < course.looks.size() ? std::printf(" %.1f |", course.looks[k].axial / 1e3) : std::printf(" |");
  if (course.turned > 0.0)
    std::printf(" inverts at %.2f %% | |", 100.0 * course.turned);
  else
    std::printf(" %.3f | %.2f |", course.looks.back().fraction, course.looks.back().largest);
  std::printf(" %.2e | %.0f | %.1e |\n", course.step, course.seconds, course.residual);
  std::fflush(stdout);
}

void showBiaxial(bool quick, double end, fem::ElementShape shape) {
  std::printf("\n| biaxial, %% strain | D, N |");
  for (int k = 1; k <= std::lround(100.0 * end); ++k) std::printf(" kPa at %d %% |", k);
  std::printf(" half of the shear in | largest shear | step, s | s | residual |\n|---|---|");
  for (int k = 1; k <= std::lround(100.0 * end); ++k) std::printf("---|");
  std::printf("---|---|---|---|---|\n");
  for (const double modulus : {0.0, 90.0})
    for (const int across : {8, 16, 32}) {
      if (quick && across > 8) continue;
      showCourse({.across = across, .shape = shape, .modulus = modulus, .end = end});
    }
  if (quick) return;
  showCourse({.across = 16, .shape = shape, .modulus = 90.0, .skew = 0.3, .end = end});
  showCourse({.across = 16, .shape = shape, .modulus = 360.0, .end = end});
}

}  // namespace

int main(int argc, char** argv) {
  return program::runProgram("fem_bands", [&] {
    bool quick = false;
    std::string only = "all", elements = "quad8";
    double end = 0.04;
    program::Options o("fem_bands", "Bands with a width of their own: a shear layer and a biaxial test.");
    o.flag("--quick", quick, "the coarsest mesh alone");
    o.word("--only", only, "all|layer|biaxial", "one table");
    o.word("--elements", elements, "quad4|quad8", "of the biaxial test");
    o.number("--end STRAIN", end, program::between(0.01, 0.2), "of the biaxial test");
    if (!o.parse(argc, argv)) return true;
    if (only != "biaxial") showLayer();
    if (only != "layer")
      showBiaxial(quick, end, elements == "quad4" ? fem::ElementShape::quad4 : fem::ElementShape::quad8);
    return true;
  });
}
