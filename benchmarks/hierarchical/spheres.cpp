// Cells of Hertz's and Mindlin's spheres, pressed by 416 kPa: porosity, contacts and moduli.
#include "dovetail/core/parallel.hpp"
#include "dovetail/rve/equilibrium.hpp"
#include "dovetail/rve/moduli.hpp"
#include "dovetail/rve/operators.hpp"
#include "dovetail/rve/packing.hpp"
#include "elastic_spheres.hpp"
#include "figure.hpp"

namespace dovetail::benchmark {

rve::Rve elasticSpheres(int count, std::uint64_t seed) {
  constexpr double pressure = 416e3;  // Pa
  rve::Rve cell = rve::randomCell({.shape = rve::Shape::sphere,
                                   .count = count,
                                   .sizes = dem::UniformSizes{0.215e-3, 0.59e-3},
                                   .solidFraction = 0.6,
                                   .density = 2492.0,
                                   .seed = seed},
                                  rve::hertzMindlin(29e9, 0.15, 0.5));
  rve::compress(cell, {.pressure = {pressure, pressure, pressure}, .friction = 0.0, .rest = {.tolerance = 1e-4}});
  return cell;
}

FigureRows spheres(bool quick) {
  const std::size_t packings = 3;
  std::vector<double> porosity(packings), contacts(packings), bulk(packings), shear(packings), tangentBulk(packings),
      tangentShear(packings), boundBulk(packings), boundShear(packings);
  parallelTasks(packings, [&](std::size_t k) {
    const rve::Rve cell = elasticSpheres(quick ? 500 : 1000, k + 1);
    porosity[k] = 1.0 - rve::solidFraction(cell);
    contacts[k] = rve::balance(cell).coordination;
    const rve::SecantModuli secants = rve::secantModuli(cell, std::vector{2.4e-4, 6e-4});
    bulk[k] = 1e-6 * secants.bulk[0];
    shear[k] = 1e-6 * secants.shear[1];
    const rve::Moduli tangent = rve::moduliOf(cell, rve::elasticTangent(cell)),
                      bound = rve::moduliOf(cell, rve::voigtTangent(cell));
    tangentBulk[k] = 1e-6 * tangent.bulk;
    tangentShear[k] = 1e-6 * tangent.shear;
    boundBulk[k] = 1e-6 * bound.bulk;
    boundShear[k] = 1e-6 * bound.shear;
  });
  const double none = std::nan("");
  return {rowOf("porosity", porosity, 0.338, 0.005, "distribution of sizes not printed"),
          rowOf("contacts per sphere", contacts, 5.6, 0.1),
          rowOf("K to a compression of 2.4e-4, MPa", bulk, 335.0, 0.05 * 335.0, "strains of the tests not printed"),
          rowOf("G to a shear of 6e-4, MPa", shear, 241.0, 0.05 * 241.0, "strains of the tests not printed"),
          rowOf("K of the elastic tangent, MPa", tangentBulk, none, 0.0),
          rowOf("G of the elastic tangent, MPa", tangentShear, none, 0.0, "contacts slip on the way to larger shears"),
          rowOf("K of uniform strain, MPa", boundBulk, none, 0.0, "no packing with these contacts is stiffer"),
          rowOf("G of uniform strain, MPa", boundShear, none, 0.0)};
}

}  // namespace dovetail::benchmark
