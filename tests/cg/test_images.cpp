// Fields of a periodic cell: the same wherever the cell is cut, and complete.
#include <gtest/gtest.h>

#include "dovetail/cg/images.hpp"
#include "dovetail/cg/stress.hpp"
#include "dovetail/core/error.hpp"
#include "random_state.hpp"

namespace dovetail::cg {
namespace {

using testing::RandomState;

constexpr std::array<bool, 3> everyAxis{true, true, true};

struct Cell {
  AverageBox box{{0, 0, 0}, {1.0, 0.8, 0.9}};
  std::vector<Vec3> x, v, to, force;
  std::vector<double> mass;
};

Cell randomCell(unsigned seed) {
  RandomState random(seed);
  Cell cell;
  cell.x = random.vectors(60, -0.4, 2.0);  // not all of them in the box
  cell.v = random.vectors(60, -1.0, 1.0);
  cell.force = random.vectors(60, -1.0, 1.0);
  for (const Vec3& x : cell.x) cell.to.push_back(x + random.vector(-0.1, 0.1));
  for (int i = 0; i < 60; ++i) cell.mass.push_back(random.number(0.5, 2.0));
  return cell;
}

TEST(PeriodicImages, FieldsRepeatWithTheCellAndHoldAllOfIt) {
  const Cell cell = randomCell(1);
  const Kernel kernel{KernelShape::lucy, 3, 0.35};
  const double reach = kernel.width + 0.2;
  const PeriodicImages images = periodicImages(cell.x, cell.box, everyAxis, reach);
  const auto x = images.moved(cell.x), v = images.copied<Vec3>(cell.v), to = images.moved(cell.to),
             force = images.copied<Vec3>(cell.force);
  const auto mass = images.copied<double>(cell.mass);
  const ParticleView particles{x, v, mass};
  const std::vector<Vec3> low{{0, 0, 0}, {0, 0.3, 0.1}, {0.2, 0, 0.4}, {0.7, 0.6, 0}};
  const std::vector<Vec3> high{{1, 0.8, 0.9}, {1, 0.3, 0.1}, {0.2, 0.8, 0.4}, {0.7, 0.6, 0.9}};
  const auto a = particleFields(kernel, low, particles), b = particleFields(kernel, high, particles);
  const auto s = contactStress(kernel, low, {x, to, force}), t = contactStress(kernel, high, {x, to, force});
  for (std::size_t p = 0; p < low.size(); ++p) {
    EXPECT_NEAR(a.density[p], b.density[p], 1e-11 * a.density[p]);
    EXPECT_LE(norm(a.momentum[p] - b.momentum[p]), 1e-10);
    EXPECT_LE((s[p] - t[p]).norm(), 1e-11 * (1.0 + s[p].norm()));
  }
  // Midpoint sums over a period are exact to high order.
  const int n = 30;
  const Vec3 h{1.0 / n, 0.8 / n, 0.9 / n};
  const auto fields = particleFields(kernel, gridPoints({0.5 * h, h, {n, n, n}}), particles);
  double total = 0.0, wanted = 0.0;
  for (const double density : fields.density) total += density * h.x * h.y * h.z;
  for (const double m : cell.mass) wanted += m;
  EXPECT_NEAR(total, wanted, 1e-5 * wanted);
}

TEST(PeriodicImages, CountEachPointOnceWithoutReachAndAlongAxesThatDoNotRepeat) {
  const Cell cell = randomCell(2);
  const PeriodicImages once = periodicImages(cell.x, cell.box, everyAxis, 0.0);
  ASSERT_EQ(once.size(), cell.x.size());
  for (const Vec3& x : once.moved(cell.x))
    for (int k = 0; k < 3; ++k) EXPECT_TRUE(x[k] >= cell.box.lower[k] && x[k] <= cell.box.upper[k]);
  const PeriodicImages none = periodicImages(cell.x, cell.box, {false, false, false}, 5.0);
  EXPECT_EQ(none.moved(cell.x), cell.x);
  EXPECT_THROW(periodicImages(cell.x, {{0, 0, 0}, {1, 0, 1}}, everyAxis, 0.1), InputError);
  EXPECT_THROW(periodicImages(cell.x, cell.box, everyAxis, -0.1), InputError);
}

}  // namespace
}  // namespace dovetail::cg
