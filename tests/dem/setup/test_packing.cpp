// Sizes, lattices and random packings.
#include <gtest/gtest.h>

#include <numbers>

#include "dovetail/core/error.hpp"
#include "dovetail/core/parallel.hpp"
#include "dovetail/dem/setup/packing.hpp"

namespace dovetail::dem {
namespace {

geometry::Periodicity box(double length, bool periodic) {
  return {{{0, 0, 0}, {length, length, length}}, {periodic, periodic, periodic}};
}

/// By a double loop: Σ δ × distance over the pairs, the largest overlap over the smaller radius, and contacts.
struct Contacts {
  double virial = 0.0, largest = 0.0;
  int count = 0;
};
Contacts contactsOf(const Packing& packing, double slack = 0.0) {
  Contacts found;
  for (std::size_t i = 0; i < packing.centre.size(); ++i)
    for (std::size_t j = i + 1; j < packing.centre.size(); ++j) {
      const double distance = norm(packing.space.minimumImage(packing.centre[i] - packing.centre[j]));
      const double overlap = packing.radius[i] + packing.radius[j] - distance;
      if (overlap > -slack) ++found.count;
      if (overlap <= 0.0) continue;
      found.virial += overlap * distance;
      found.largest = std::max(found.largest, overlap / std::min(packing.radius[i], packing.radius[j]));
    }
  return found;
}

TEST(Sizes, HaveTheirMomentsAndBounds) {
  RandomStream random(1);
  const int n = 200000;
  const auto mean = [&](const Sizes& sizes, auto&& f) {
    double sum = 0.0;
    for (int i = 0; i < n; ++i) sum += f(drawRadius(sizes, random)) / n;
    return sum;
  };
  const auto same = [](double r) { return r; };
  EXPECT_NEAR(mean(UniformSizes{1.0, 3.0}, same), 2.0, 5.0 / std::sqrt(3.0 * n));
  EXPECT_EQ(drawRadius(UniformSizes{0.7, 0.7}, random), 0.7);
  EXPECT_NEAR(mean(NormalSizes{1.0, 0.1, 0.2, 1.8}, same), 1.0, 5.0 * 0.1 / std::sqrt(n));
  EXPECT_NEAR(mean(NormalSizes{1.0, 0.1, 0.2, 1.8}, [](double r) { return (r - 1.0) * (r - 1.0); }), 0.01,
              5.0 * 0.01 * std::sqrt(2.0 / n));
  EXPECT_NEAR(mean(LogNormalSizes{2.0, 0.3, 0.1, 40.0}, [](double r) { return std::log(0.5 * r); }), 0.0,
              5.0 * 0.3 / std::sqrt(n));
  for (int i = 0; i < 1000; ++i) {
    const double r = drawRadius(NormalSizes{1.0, 0.5, 0.9, 1.05}, random);
    EXPECT_TRUE(r >= 0.9 && r <= 1.05);
  }
}

TEST(Sizes, AGradingCurveComesBackAsTheMassThatPasses) {
  const GradingCurve curve{{0.5, 1.0, 1.5, 2.0, 4.0}, {0.0, 0.2, 0.2, 0.7, 1.0}};
  RandomStream random(2);
  const int n = 400000;
  std::vector<double> mass(5, 0.0);
  double total = 0.0, halfway = 0.0;
  for (int i = 0; i < n; ++i) {
    const double d = 2.0 * drawRadius(curve, random), m = d * d * d;
    ASSERT_TRUE(d >= 0.5 * (1.0 - 1e-12) && d <= 4.0 * (1.0 + 1e-12));
    total += m;
    for (std::size_t k = 0; k < 5; ++k)
      if (d <= curve.diameter[k] * (1.0 + 1e-12)) mass[k] += m;
    if (d <= std::sqrt(8.0)) halfway += m;  // between 2 and 4 in the logarithm
  }
  for (std::size_t k = 0; k < 5; ++k) EXPECT_NEAR(mass[k] / total, curve.passing[k], 0.01) << k;
  EXPECT_NEAR(halfway / total, 0.85, 0.01);
}

TEST(Sizes, MeanVolumesAndBoundsAreThoseOfWhatIsDrawn) {
  const int n = 200000;
  for (const Sizes& sizes :
       {Sizes{UniformSizes{1.0, 3.0}}, Sizes{NormalSizes{1.0, 0.2, 0.9, 1.8}}, Sizes{NormalSizes{1.0, 0.0, 0.5, 2.0}},
        Sizes{LogNormalSizes{2.0, 0.3, 0.5, 3.0}}, Sizes{SizeClasses{{2.0, 1.0, 1.5}, {1.0, 3.0, 4.0}}},
        Sizes{GradingCurve{{0.5, 1.0, 1.5, 2.0, 4.0}, {0.0, 0.2, 0.2, 0.7, 1.0}}}}) {
    RandomStream random(5);
    double sum = 0.0, squares = 0.0, least = 1e9, most = 0.0;
    for (int i = 0; i < n; ++i) {
      const double r = drawRadius(sizes, random), volume = 4.0 / 3.0 * std::numbers::pi * r * r * r;
      sum += volume / n;
      squares += volume * volume / n;
      least = std::min(least, r);
      most = std::max(most, r);
    }
    const double error = std::sqrt(std::max(0.0, squares - sum * sum) / n), rounding = n * 1e-16 * sum;
    EXPECT_NEAR(meanVolume(sizes), sum, 4.0 * error + 2.0 * rounding) << sizes.index();
    EXPECT_LE(boundsOf(sizes).smallest, least * (1.0 + 1e-12));
    EXPECT_GE(boundsOf(sizes).largest, most * (1.0 - 1e-12));
  }
  EXPECT_EQ(boundsOf(SizeClasses{{2.0, 1.0, 1.5}, {1.0, 3.0, 4.0}}).smallest, 1.0);
}

TEST(Sizes, ClassesComeInTheirNumbers) {
  RandomStream random(3);
  const SizeClasses sizes{{2.0, 1.0}, {1.0, 3.0}};
  const int n = 100000;
  int large = 0;
  for (int i = 0; i < n; ++i) {
    const double r = drawRadius(sizes, random);
    ASSERT_TRUE(r == 1.0 || r == 2.0);
    large += r == 2.0;
  }
  EXPECT_NEAR(static_cast<double>(large) / n, 0.25, 4.0 * std::sqrt(0.25 * 0.75 / n));
}

TEST(Sizes, BadOnesAreRefused) {
  for (const Sizes& sizes :
       {Sizes{UniformSizes{2.0, 1.0}}, Sizes{UniformSizes{0.0, 1.0}}, Sizes{NormalSizes{1.0, 0.01, 2.0, 3.0}},
        Sizes{LogNormalSizes{1.0, -0.1, 0.5, 2.0}}, Sizes{SizeClasses{}}, Sizes{SizeClasses{{1.0}, {}}},
        Sizes{SizeClasses{{1.0}, {0.0}}}, Sizes{SizeClasses{{-1.0}, {1.0}}}, Sizes{GradingCurve{{1.0}, {1.0}}},
        Sizes{GradingCurve{{1.0, 2.0}, {0.1, 1.0}}}, Sizes{GradingCurve{{2.0, 1.0}, {0.0, 1.0}}}})
    EXPECT_THROW(validate(sizes), InputError);
}

TEST(Lattices, HaveTheirSolidFractionAndNeighbours) {
  const struct {
    Lattice lattice;
    double fraction;
    int neighbours;
  } cases[] = {{Lattice::simpleCubic, std::numbers::pi / 6.0, 6},
               {Lattice::bodyCentred, std::numbers::pi * std::sqrt(3.0) / 8.0, 8},
               {Lattice::faceCentred, std::numbers::pi / std::sqrt(18.0), 12},
               {Lattice::hexagonal, std::numbers::pi / std::sqrt(18.0), 12}};
  for (const auto& c : cases) {
    const Packing block = latticeBlock(c.lattice, {4, 4, 3}, 0.5, 1.0);
    EXPECT_NEAR(solidFraction(block), c.fraction, 1e-14);
    EXPECT_EQ(2 * contactsOf(block, 1e-12).count, c.neighbours * static_cast<int>(block.centre.size()));
    EXPECT_LE(contactsOf(block).largest, 1e-14);
    const Packing filled = fillWithLattice(c.lattice, {{1, 1, 1}, {7, 6, 5}}, 0.5, 1.0);
    EXPECT_LE(contactsOf(filled).largest, 1e-14);
    EXPECT_GT(solidFraction(filled), 0.6 * c.fraction);
    for (const Vec3& x : filled.centre)
      for (int k = 0; k < 3; ++k) EXPECT_TRUE(x[k] >= 1.5 - 1e-12 && x[k] <= (Vec3{6.5, 5.5, 4.5})[k] + 1e-8);
  }
  EXPECT_EQ(fillWithLattice(Lattice::simpleCubic, {{0, 0, 0}, {3, 2, 1}}, 0.5, 1.0).centre.size(), 6u);
  const double cell = std::sqrt(2.0);  // of faces-centred cubes
  const auto repeated = [&](double x) {
    return fillWithLattice(Lattice::faceCentred, {{0, 0, 0}, {x, 3 * cell, 3 * cell}}, 0.5, 1.0, {true, true, true});
  };
  EXPECT_EQ(repeated(3 * cell).centre.size(), 108u);
  EXPECT_EQ(repeated(3 * cell * (1.0 + 1e-8)).centre.size(), 108u);
  EXPECT_THROW(repeated(3 * cell + 1e-5), InputError);
  EXPECT_THROW(repeated(0.4 * cell), InputError);
  EXPECT_THROW(fillWithLattice(Lattice::simpleCubic, {{0, 0, 0}, {3, 2, 0.9}}, 0.5, 1.0), InputError);
  EXPECT_THROW(latticeBlock(Lattice::hexagonal, {1, 0, 1}, 0.5, 1.0), InputError);
}

TEST(GrowPacking, ReachesTheSolidFractionWithTheSizesDrawn) {
  for (const bool periodic : {true, false}) {
    PackingReport report;
    const Sizes sizes = LogNormalSizes{0.05, 0.2, 0.03, 0.1};
    const Packing packing = growPacking(sizes, box(1.0, periodic), {.solidFraction = 0.55, .seed = 4}, report);
    EXPECT_TRUE(report.reached);
    EXPECT_EQ(report.scale, 1.0);
    EXPECT_NEAR(solidFraction(packing), 0.55, 0.002);
    EXPECT_NEAR(report.solidFraction, solidFraction(packing), 1e-14);
    EXPECT_LE(contactsOf(packing).largest, 1e-3);
    RandomStream random(4);
    for (const double r : packing.radius) ASSERT_EQ(r, drawRadius(sizes, random));
    for (std::size_t i = 0; i < packing.centre.size(); ++i)
      for (int k = 0; k < 3; ++k) {
        const double room = periodic ? 0.0 : (1.0 - 1.001e-3) * packing.radius[i];
        ASSERT_TRUE(packing.centre[i][k] >= room && packing.centre[i][k] <= 1.0 - room);
      }
    Particles particles;
    EXPECT_EQ(addPacking(particles, packing, Density{1000.0}), 0);
    EXPECT_EQ(particles.x, packing.centre);
  }
}

TEST(GrowPacking, IsDenseWhereAskedAndTheSameForTheSameSeed) {
  PackingReport report;
  const Sizes sizes = UniformSizes{0.06, 0.06};
  const Packing dense = growPacking(sizes, box(1.0, true), {.solidFraction = 0.62, .seed = 7}, report);
  EXPECT_TRUE(report.reached) << report.solidFraction;
  EXPECT_EQ(growPacking(sizes, box(1.0, true), {.solidFraction = 0.62, .seed = 7}, report).centre, dense.centre);
  EXPECT_NE(growPacking(sizes, box(1.0, true), {.solidFraction = 0.62, .seed = 8}, report).centre, dense.centre);
}

TEST(GrowPacking, IsTheSameForAnyThreads) {
  std::vector<Vec3> once;
  for (const int count : {1, 2, 3}) {
    setThreads(count);
    PackingReport report;
    const geometry::Periodicity space{{{0, 0, 0}, {1, 1, 1}}, {true, true, false}};
    Packing packing = growPacking(UniformSizes{0.025, 0.035}, space, {.solidFraction = 0.5, .seed = 9}, report);
    ASSERT_GT(packing.centre.size(), 4096u);
    compressToPressure(packing, {.pressure = 100.0, .iterations = 100});
    if (once.empty()) once = packing.centre;
    EXPECT_EQ(packing.centre, once) << count;
  }
  setThreads(1);
}

TEST(GrowPacking, SaysHowFarItCameWhereSpheresJam) {
  PackingReport report;
  const Packing packing =
      growPacking(UniformSizes{0.08, 0.08}, box(1.0, true), {.solidFraction = 0.72, .seed = 2}, report);
  EXPECT_FALSE(report.reached);
  EXPECT_LT(report.scale, 1.0);
  EXPECT_GT(report.solidFraction, 0.60);
  EXPECT_LT(report.solidFraction, 0.70);
  EXPECT_NEAR(report.solidFraction, solidFraction(packing), 1e-14);
  EXPECT_LE(report.largestOverlap, 1e-3);
  EXPECT_NEAR(report.largestOverlap, contactsOf(packing).largest, 1e-12);
}

TEST(CompressToPressure, PressesWithThePressureWantedAndIsNearIsostatic) {
  PackingReport grown;
  Packing packing = growPacking(UniformSizes{0.055, 0.075}, box(1.0, true), {.solidFraction = 0.56, .seed = 3}, grown);
  const double stiffness = 1e5;
  double fraction = 0.0;
  for (const double pressure : {200.0, 5000.0}) {
    const PackingReport report = compressToPressure(packing, {.stiffness = stiffness, .pressure = pressure});
    ASSERT_TRUE(report.reached) << report.pressure;
    const Contacts contacts = contactsOf(packing);
    EXPECT_NEAR(stiffness * contacts.virial / (3.0 * packing.volume()), pressure, 2e-3 * pressure);
    EXPECT_NEAR(report.coordination, 2.0 * contacts.count / static_cast<double>(packing.centre.size()), 0.1);
    EXPECT_LT(report.unbalanced, 0.01);
    EXPECT_GT(report.coordination, 5.3);  // frictionless spheres that press: 6 without those that rattle
    EXPECT_LT(report.coordination, 7.0);
    EXPECT_GT(report.solidFraction, std::max(0.62, fraction));
    fraction = report.solidFraction;
  }
  EXPECT_LT(fraction, 0.72);
}

TEST(CompressToPressure, WorksBetweenWallsToo) {
  PackingReport grown;
  Packing packing = growPacking(UniformSizes{0.08, 0.08}, box(1.0, false), {.solidFraction = 0.5, .seed = 5}, grown);
  const PackingReport report = compressToPressure(packing, {.stiffness = 1e5, .pressure = 1000.0});
  ASSERT_TRUE(report.reached);
  // Force on the walls over their area, from the overlaps with them.
  double force = 0.0, area = 0.0;
  for (int k = 0; k < 3; ++k) {
    for (std::size_t i = 0; i < packing.centre.size(); ++i) {
      force += 1e5 * std::max(0.0, packing.radius[i] - (packing.centre[i][k] - packing.space.box.lower[k]));
      force += 1e5 * std::max(0.0, packing.radius[i] - (packing.space.box.upper[k] - packing.centre[i][k]));
    }
    area += 2.0 * packing.volume() / packing.space.length(k);
  }
  EXPECT_NEAR(force / area, 1000.0, 10.0);
}

TEST(Packings, BadRequestsAreRefused) {
  PackingReport report;
  const Sizes sizes = UniformSizes{0.1, 0.1};
  EXPECT_THROW(growPacking(sizes, box(1.0, true), {.solidFraction = 0.8}, report), InputError);
  EXPECT_THROW(growPacking(sizes, box(0.15, false), {}, report), InputError);
  EXPECT_THROW(growPacking(sizes, box(0.3, true), {}, report), InputError);
  EXPECT_THROW(growPacking(sizes, box(-1.0, true), {}, report), InputError);
  Packing nothing{{}, {}, box(1.0, true)};
  EXPECT_THROW(compressToPressure(nothing, {}), InputError);
}

}  // namespace
}  // namespace dovetail::dem
