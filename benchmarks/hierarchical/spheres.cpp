// A cell of Hertz's and Mindlin's spheres, pressed by 416 kPa: porosity, contacts and moduli.
#include <algorithm>
#include <cmath>
#include <limits>

#include "dovetail/rve/equilibrium.hpp"
#include "dovetail/rve/operators.hpp"
#include "dovetail/rve/packing.hpp"
#include "elastic_spheres.hpp"
#include "figure.hpp"

namespace dovetail::benchmark {

namespace {

constexpr double pressure = 416e3;  // Pa

/// Isotropic part of ∂P/∂F, less what turns.
Moduli isotropicPart(const rve::Tangent& A) {
  Moduli m;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) {
      m.bulk += A(4 * i, 4 * j) / 9.0;
      if (i == j) continue;
      m.shear += (A(4 * i, 4 * i) - A(4 * i, 4 * j)) / 30.0;
      m.shear += (A(3 * i + j, 3 * i + j) + A(3 * i + j, 3 * j + i)) / 20.0;
    }
  return m;
}

/// Shear modulus from rest to a shear strain, grains slipping as they do, Pa.
double secantShear(rve::Rve cell, double gamma) {
  const double before = rve::stress(cell).cauchy(0, 1);
  constexpr int parts = 10;
  for (int k = 1; k <= parts; ++k) {
    Eigen::Matrix3d F = Eigen::Matrix3d::Identity();
    F(0, 1) = F(1, 0) = 0.5 * gamma * k / parts;
    rve::deform(cell, rve::relativeDeformation(cell, F));
    rve::relax(cell, {.tolerance = 1e-4});
  }
  return (rve::stress(cell).cauchy(0, 1) - before) / gamma;
}

}  // namespace

rve::Rve elasticSpheres(int count, std::uint64_t seed) {
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

Moduli probed(rve::Rve cell) {
  rve::Springs sticking = cell.springs;
  sticking.friction = std::numeric_limits<double>::infinity();
  rve::setSprings(cell, sticking);
  constexpr double strain = 5e-6;
  const RestCriterion rest{.tolerance = 1e-5};
  rve::relax(cell, rest);
  const auto stressAt = [&](const Eigen::Matrix3d& E) -> Eigen::Matrix3d {
    rve::Rve strained = cell;
    rve::deform(strained, Eigen::Matrix3d::Identity() + strain * E);
    rve::relax(strained, rest);
    return rve::stress(strained).cauchy;
  };
  const auto slopeOf = [&](const Eigen::Matrix3d& E) -> Eigen::Matrix3d {
    return (stressAt(E) - stressAt(-E)) / (2.0 * strain);
  };
  Moduli m;
  m.bulk = slopeOf(Eigen::Matrix3d::Identity()).trace() / 9.0;
  for (int axis = 0; axis < 3; ++axis) {
    const int i = axis, j = (axis + 1) % 3;
    Eigen::Matrix3d shear = Eigen::Matrix3d::Zero(), stretch = Eigen::Matrix3d::Zero();
    shear(i, j) = shear(j, i) = 0.5;
    stretch(i, i) = 0.5;
    stretch(j, j) = -0.5;
    const Eigen::Matrix3d stretched = slopeOf(stretch);
    m.shear += (slopeOf(shear)(i, j) + 0.5 * (stretched(i, i) - stretched(j, j))) / 6.0;
  }
  return m;
}

FigureRows spheres(bool quick) {
  std::vector<double> porosity, contacts, bulk, shear, young, poisson, secant, bulkBound, shearBound;
  for (std::uint64_t seed = 1; seed <= (quick ? 1u : 3u); ++seed) {
    const rve::Rve cell = elasticSpheres(quick ? 1000 : 4096, seed);
    porosity.push_back(1.0 - rve::solidFraction(cell));
    contacts.push_back(rve::balance(cell).coordination);
    const Moduli m = probed(cell), bound = isotropicPart(rve::voigtTangent(cell));
    bulk.push_back(1e-6 * m.bulk);
    shear.push_back(1e-6 * m.shear);
    young.push_back(9e-6 * m.bulk * m.shear / (3.0 * m.bulk + m.shear));
    poisson.push_back((3.0 * m.bulk - 2.0 * m.shear) / (6.0 * m.bulk + 2.0 * m.shear));
    secant.push_back(1e-6 * secantShear(cell, 5e-4));
    bulkBound.push_back(1e-6 * bound.bulk);
    shearBound.push_back(1e-6 * bound.shear);
  }
  const double none = std::nan("");
  return {rowOf("porosity", porosity, 0.338, 0.005, "distribution of sizes not printed"),
          rowOf("contacts per sphere", contacts, 5.6, 0.1),
          rowOf("K, MPa", bulk, 335.0, 0.05 * 335.0),
          rowOf("G, MPa", shear, 241.0, 0.1 * 241.0, "of contacts that stick; they slip on the way to larger shears"),
          rowOf("G to a shear of 5e-4, MPa", secant, none, 0.0, "how far the printed one went is not printed"),
          rowOf("E, MPa", young, 584.0, 0.1 * 584.0),
          rowOf("Poisson's ratio", poisson, 0.2, 0.05),
          rowOf("K of uniform strain, MPa", bulkBound, none, 0.0, "no packing with these contacts is stiffer"),
          rowOf("G of uniform strain, MPa", shearBound, none, 0.0)};
}

}  // namespace dovetail::benchmark
