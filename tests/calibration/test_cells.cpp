// Periodic cells, strained and probed.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "dovetail/calibration/cell_probes.hpp"
#include "dovetail/core/error.hpp"
#include "dovetail/dem/model/sample.hpp"
#include "dovetail/dem/setup/cell.hpp"
#include "dovetail/dem/setup/packing.hpp"
#include "dovetail/dem/setup/random_stream.hpp"
#include "dovetail/dem/setup/relax.hpp"

namespace dovetail::calibration {
namespace {

constexpr double normalStiffness = 1e5, tangentialStiffness = 8e4;  // N/m

std::shared_ptr<const dem::ContactLaws> laws(double friction) {
  dem::FrictionalLaw law;
  law.normal = {.stiffness = normalStiffness, .restitution = 0.5};
  law.tangential = {.stiffness = tangentialStiffness, .friction = friction};
  return dem::makeContactLaws(law);
}

dem::Model cellOf(const dem::Packing& packing, double friction) {
  dem::Model m;
  dem::addPacking(m.particles, packing, {2500.0});
  m.pairs.setPeriodicity(packing.space);
  m.laws = laws(friction);
  return m;
}

/// Far from the origin.
dem::Packing randomPacking(double side) {
  const Vec3 corner{30.0, -70.0, 11.0};
  const geometry::Periodicity space{{corner, corner + Vec3{side, side, side}}, {true, true, true}};
  dem::PackingReport report;
  return dem::growPacking(dem::UniformSizes{0.004, 0.006}, space, {.solidFraction = 0.6}, report);
}

Vec3 scaled(const Vec3& a, const Vec3& b) { return {a.x * b.x, a.y * b.y, a.z * b.z}; }

TEST(Cell, ModulusOfTheCubicLatticeIsStiffnessOverDistance) {
  const double distance = 0.01;
  const dem::Packing lattice =
      dem::latticeBlock(dem::Lattice::simpleCubic, {4, 4, 4}, 0.5 * distance * (1.0 + 1e-5), distance);
  const Moduli found = smallStrainModuli(cellOf(lattice, 0.0), {.strain = 1e-6});
  EXPECT_NEAR(found.youngsModulus, normalStiffness / distance, 1e-4 * normalStiffness / distance);
  EXPECT_NEAR(found.poissonRatio, 0.0, 1e-4);
  EXPECT_NEAR(found.pWaveSpeed, std::sqrt(normalStiffness / distance / found.density), 1e-2);
}

TEST(Cell, ModuliOfGrainsThatDoNotTouchAreRefused) {
  const dem::Packing apart = dem::latticeBlock(dem::Lattice::simpleCubic, {3, 3, 3}, 0.004, 0.01);
  try {
    smallStrainModuli(cellOf(apart, 0.0), {.strain = 1e-6});
    FAIL();
  } catch (const NumericalError& error) {
    EXPECT_NE(std::string(error.what()).find("let its grains touch"), std::string::npos) << error.what();
  }
}

// Every contact, alone: n, overlap and slip follow from the strain, f = k δ n − k_t (motion across n).
TEST(Cell, StrainStretchesNormalAndTangentialSprings) {
  dem::Model m = cellOf(randomPacking(0.045), 1e9);
  for (int k = 0; k < 3; ++k) {
    const geometry::Periodicity space = m.pairs.periodicity();
    ASSERT_TRUE(space.axes[static_cast<std::size_t>(k)]);
  }
  dem::findForces(m);
  const double shrink = -0.01;
  dem::strainCell(m, {shrink, shrink, shrink});  // normal motion alone: no tangential spring is stretched
  dem::findForces(m);
  const dem::ContactSample before = dem::sampleContacts(m);
  ASSERT_GT(before.size(), 100u);
  dem::RandomStream random(7);
  const Vec3 strain{random.uniform(-1e-3, 1e-3), random.uniform(-1e-3, 1e-3), random.uniform(-1e-3, 1e-3)};
  dem::strainCell(m, strain);
  dem::findForces(m);
  const dem::ContactSample after = dem::sampleContacts(m);
  std::size_t compared = 0;
  for (std::size_t a = 0, b = 0; a < after.size(); ++a) {
    while (b < before.size() && (before.first[b] < after.first[a] ||
                                 (before.first[b] == after.first[a] && before.second[b] < after.second[a])))
      ++b;
    if (b == before.size() || before.first[b] != after.first[a] || before.second[b] != after.second[a]) continue;
    const Vec3 d = before.from[b] - before.to[b], change = scaled(strain, d), now = d + change;
    const Vec3 n = (1.0 / norm(now)) * now;
    const double reach = m.particles.radius[static_cast<std::size_t>(after.first[a])] +
                         m.particles.radius[static_cast<std::size_t>(after.second[a])];
    // Springs take the rate halfway, ε/(1 + ε/2), for the motion.
    const Vec3 slip = scaled(
        {strain.x / (1.0 + 0.5 * strain.x), strain.y / (1.0 + 0.5 * strain.y), strain.z / (1.0 + 0.5 * strain.z)}, now);
    const Vec3 across = slip - dot(slip, n) * n;
    const Vec3 expected = normalStiffness * (reach - norm(now)) * n - tangentialStiffness * across;
    EXPECT_NEAR(norm(after.force[a] - expected), 0.0, 1e-6 * norm(expected));
    ++compared;
  }
  EXPECT_GT(compared, 100u);
}

TEST(Cell, StressIsThatOfTheContacts) {
  dem::Model m = cellOf(randomPacking(0.045), 0.3);
  dem::findForces(m);
  dem::strainCell(m, {-0.02, -0.01, 0.0});
  dem::findForces(m);
  const dem::ContactSample contacts = dem::sampleContacts(m);
  Vec3 sum;
  for (std::size_t c = 0; c < contacts.size(); ++c) sum += scaled(contacts.force[c], contacts.from[c] - contacts.to[c]);
  const Vec3 found = cellPressures(m);
  EXPECT_NEAR(norm(found - (1.0 / cellVolume(m)) * sum), 0.0, 1e-12 * norm(found));
  EXPECT_GT(found.x, found.z);
}

// Sheared until contacts slide, brought to rest after every strain.
TEST(Cell, TheLedgerOfAPathCloses) {
  dem::Model start = cellOf(randomPacking(0.045), 0.3);
  compressRve(start, {.pressure = 2e4});
  const auto residualOf = [&](int parts) {
    dem::Model m = start;
    const dem::Energies before = dem::energies(m);
    const double strain = 4e-3 / parts;
    for (int k = 0; k < parts; ++k) {
      dem::strainCell(m, {0.4 * strain, 0.4 * strain, -strain});
      dem::relax(m, {.tolerance = 1e-4}, {.stepFraction = 0.2});
    }
    const dem::Energies after = dem::energies(m);
    const double work = after.external - before.external;
    EXPECT_GT(work, 0.0);
    EXPECT_GT(after.lost.frictionPower - before.lost.frictionPower, 0.05 * work);
    return std::abs(after.balance() - before.balance()) / work;
  };
  const double coarse = residualOf(10), fine = residualOf(40);
  EXPECT_LT(coarse, 2e-4);
  EXPECT_LT(fine, 2e-4);
}

TEST(Cell, ComesToThePressureAndKeepsItWhileSheared) {
  dem::Model m = cellOf(randomPacking(0.045), 0.5);
  const double pressure = 2e4;
  const double bulk = compressRve(m, {.pressure = pressure});
  EXPECT_NEAR(meanOf(cellPressures(m)), pressure, 1e-3 * pressure);
  EXPECT_LT(dem::restOf(m).residual, 1e-5);
  EXPECT_GT(bulk, 10.0 * pressure);
  const TriaxialCurve curve = triaxialCompression(m, {.strain = 2e-3, .increments = 10});
  for (std::size_t k = 1; k < curve.size(); ++k) EXPECT_NEAR(curve.lateral[k], pressure, 0.02 * pressure);
  EXPECT_GT(curve.deviator(10), 0.3 * pressure);
  EXPECT_GT(curve.volume[3], 0.0);  // shrinks at first
}

// A curve whose axial pressure is that of a cone all along.
TriaxialCurve curveOf(double friction, double cohesion, double lateral) {
  const double sine = std::sin(friction), slope = 6.0 * sine / (3.0 - sine),
               intercept = 6.0 * cohesion * std::cos(friction) / (3.0 - sine);
  const double q = (slope * lateral + intercept) / (1.0 - slope / 3.0);
  TriaxialCurve curve;
  for (int k = 0; k <= 20; ++k) {
    curve.strain.push_back(1e-3 * k);
    curve.volume.push_back(-0.2 * 1e-3 * k);
    curve.axial.push_back(lateral + q);
    curve.lateral.push_back(lateral);
  }
  return curve;
}

TEST(Cone, OfCurvesFromAConeIsThatCone) {
  dem::RandomStream random(3);
  for (int trial = 0; trial < 20; ++trial) {
    const double friction = random.uniform(0.2, 0.8), cohesion = random.uniform(100.0, 2000.0);
    const std::vector<TriaxialCurve> curves{curveOf(friction, cohesion, 1e3), curveOf(friction, cohesion, 4e3),
                                            curveOf(friction, cohesion, 9e3)};
    const Cone cone = coneThrough(curves);
    EXPECT_NEAR(cone.frictionAngle, friction, 1e-10);
    EXPECT_NEAR(cone.cohesion, cohesion, 1e-7 * cohesion);
    EXPECT_LT(cone.misfit, 1e-10);
    EXPECT_NEAR(cone.dilatancyAngle, std::asin(0.2 / 2.2), 1e-10);
  }
  EXPECT_NEAR(coneThrough(std::vector{curveOf(0.5, 0.0, 1e3)}).frictionAngle, 0.5, 1e-12);
  EXPECT_NEAR(strengthOf(curveOf(0.5, 0.0, 1e3)).residualAngle, 0.5, 1e-12);
}

TEST(Cell, RefusesWhatIsNoCell) {
  dem::Model m = cellOf(randomPacking(0.045), 0.5);
  EXPECT_THROW(dem::strainCell(m, {0.1, 0.0, 0.0}), InputError);  // forces have not been found
  dem::findForces(m);
  EXPECT_THROW(dem::strainCell(m, {-1.0, 0.0, 0.0}), InputError);
  EXPECT_THROW(dem::strainCell(m, {std::nan(""), 0.0, 0.0}), InputError);
  m.gravity = {0.0, 0.0, -9.81};
  EXPECT_THROW(compressRve(m, {.pressure = 1e3}), InputError);
  m.gravity = {};
  EXPECT_THROW(compressRve(m, {.pressure = -1.0}), InputError);
  geometry::Periodicity open = m.pairs.periodicity();
  open.axes[2] = false;
  m.pairs.setPeriodicity(open);
  dem::findForces(m);
  EXPECT_THROW(dem::strainCell(m, {0.0, 0.0, 0.01}), InputError);
  EXPECT_THROW(triaxialCompression(m, {.increments = 3}), InputError);
}

}  // namespace
}  // namespace dovetail::calibration
