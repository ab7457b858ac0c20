// An overlap that is emptied and filled again grain by grain; what a scene of grains on soil refuses.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <numeric>

#include "dovetail/arlequin/arlequin_coupling.hpp"
#include "dovetail/arlequin/initial_equilibrium.hpp"
#include "dovetail/arlequin/weights.hpp"
#include "dovetail/core/error.hpp"
#include "dovetail/coupling/run.hpp"
#include "dovetail/dem/laws/hertz_mindlin.hpp"
#include "dovetail/dem/setup/packing.hpp"
#include "dovetail/dem/setup/streams.hpp"
#include "dovetail/fem/elements/solid.hpp"
#include "dovetail/fem/laws/point_laws.hpp"
#include "dovetail/fem/terms/loads.hpp"

namespace dovetail::arlequin {
namespace {

constexpr double width = 0.06, top = 0.04, depth = 0.02, size = 0.02;  // m
constexpr double nan = std::numeric_limits<double>::quiet_NaN();

/// Grains above z = 0, soil from −depth to top.
struct Bed {
  coupling::CoupledRun run;
  fem::SolidMesh mesh = fem::boxOf(fem::ElementShape::hex8, {3, 3, 6}, {0, 0, -depth}, {width, width, top});
  std::vector<double> weight;
  std::unique_ptr<fem::Model> soil;
  CouplingOptions options;

  Bed() {
    run.grains.laws = dem::makeContactLaws(dem::HertzLaw{{.effectiveModulus = 2.6e7}});
    dem::addPacking(run.grains.particles,
                    dem::fillWithLattice(dem::Lattice::simpleCubic, {{0, 0, 0}, {width, width, 0.05}}, 0.005, 0.00999),
                    {2500.0});
    std::vector<double> place;
    for (const Vec3& X : mesh.X) place.push_back(X.z < -1e-9 ? beyondOverlap : std::clamp(1.0 - X.z / top, 0.0, 1.0));
    weight = nodalWeights(place, {});
    soil = std::make_unique<fem::Model>(fem::makeModel(mesh));
    soil->add(fem::makeSolid(mesh, fem::pointMaterial(fem::neoHookean(5e6, 0.25, 1450.0)),
                             {.fraction = solidWeights(weight)}));
    soil->add(fem::gravity({0.0, 0.0, -9.81}));
    for (const char* side : {"x-", "x+", "y-", "y+", "z-"}) fem::fix(soil->nodes, mesh.nodeSets.at(side));
  }
  ArlequinCoupling& tie() {
    coupling::SolidSide& side = run.addSolid(std::move(soil), {.name = "soil"});
    return run.grains.terms.add(makeArlequinCoupling(run.grains, mesh, weight, side, options));
  }
};

/// Residual over the kinetic energy that three grains bring which are added by hand and fly into an empty overlap.
double residualOfRefill(double dt) {
  Bed bed;
  std::erase_if(bed.soil->terms, [](const auto& term) { return term->name() == "gravity"; });
  bed.tie();
  bed.run.start(dt);
  std::vector<int> all(bed.run.grains.particles.size());
  std::iota(all.begin(), all.end(), 0);
  dem::removeParticles(bed.run.grains, all);
  const std::size_t first = bed.run.grains.particles.size();
  double brought = 0.0;
  for (const Vec3 at : {Vec3{0.02001, 0.02002, 0.047}, {0.04003, 0.0201, 0.046}, {0.031, 0.04001, 0.049}}) {
    const int i = dem::addParticle(bed.run.grains.particles, at, {0.005, 0.002, -0.5}, 0.004, dem::Density{2500.0});
    brought += 0.5 * bed.run.grains.particles.mass[static_cast<std::size_t>(i)] * 0.25;
  }
  dem::admitParticles(bed.run.grains, first);
  double largest = 0.0;
  for (int k = 0; k < 100; ++k) {
    bed.run.advance(static_cast<std::int64_t>(std::lround(3e-4 / dt)));
    largest = std::max(largest, std::abs(bed.run.ledger().residual()));
  }
  EXPECT_EQ(bed.run.grains.terms.all<ArlequinCoupling>()[0]->state().admitted, 3);
  EXPECT_LT(std::abs(bed.run.totals().massResidual), 1e-12);
  return largest / brought;
}

TEST(Refill, GrainsAddedByHandAreTied) {
  const double coarse = residualOfRefill(4e-6), fine = residualOfRefill(2e-6);
  RecordProperty("coarse", std::to_string(coarse));
  RecordProperty("fine", std::to_string(fine));
  EXPECT_LT(coarse, 2e-3);
  EXPECT_LT(fine, 0.3 * coarse);
}

TEST(Refill, RainIntoAnEmptyOverlapMakesNoEnergy) {
  Bed bed;
  std::erase_if(bed.soil->terms, [](const auto& term) { return term->name() == "gravity"; });
  bed.tie();
  dem::addInsertion(bed.run.grains, {.region = {{0.01, 0.01, 0.05}, {0.05, 0.05, 0.09}},
                                     .sizes = dem::UniformSizes{0.004, 0.005},
                                     .density = {2500.0},
                                     .velocity = {0.0, 0.0, -0.5},
                                     .numberPerSecond = 2000.0});
  bed.run.start(4e-6);
  std::vector<int> all(bed.run.grains.particles.size());
  std::iota(all.begin(), all.end(), 0);
  dem::removeParticles(bed.run.grains, all);
  bed.run.advance(17500);
  const EnergyLedger& ledger = bed.run.ledger();
  EXPECT_GT(bed.run.grains.terms.all<ArlequinCoupling>()[0]->state().admitted, 5);
  EXPECT_LT(std::abs(ledger.residual()), -1e-3 * ledger.joules("particles: entered (minus)"));
}

TEST(Refill, AnEmptiedOverlapRunsOn) {
  Bed bed;
  bed.tie();
  bed.run.start(1e-6);
  std::vector<int> all(bed.run.grains.particles.size());
  std::iota(all.begin(), all.end(), 0);
  dem::removeParticles(bed.run.grains, all);
  bed.run.advance(50);
  EXPECT_EQ(bed.run.grains.terms.all<ArlequinCoupling>()[0]->state().members, 0u);
  EXPECT_LT(std::abs(bed.run.totals().massResidual), 1e-12);
}

TEST(TieRefusals, WeightsBeyondZeroAndOneAreNamed) {
  for (const double bad : {nan, -1.0, 1.5}) {
    Bed bed;
    bed.weight[20] = bad;
    try {
      bed.tie();
      ADD_FAILURE() << bad;
    } catch (const InputError& e) {
      EXPECT_NE(std::string(e.what()).find("the weight of node 20 is"), std::string::npos) << e.what();
    }
  }
}

TEST(TieRefusals, AMeshThatIsNotTheSolids) {
  Bed moved;
  for (Vec3& X : moved.mesh.X) X.x += 1e-3;
  EXPECT_THROW(moved.tie(), InputError);
  Bed finer;
  finer.mesh = fem::boxOf(fem::ElementShape::hex8, {3, 3, 7}, {0, 0, -depth}, {width, width, top});
  EXPECT_THROW(finer.tie(), InputError);
}

TEST(TieRefusals, PartsOfKernelsBelowZero) {
  Bed bed;
  bed.options.projection = {.width = size, .kernelCells = -1};
  EXPECT_THROW(bed.tie(), InputError);
}

TEST(TieRefusals, ParticlesThatAllBelongToAnotherOverlap) {
  Bed bed;
  bed.tie();
  EXPECT_THROW(makeArlequinCoupling(bed.run.grains, bed.mesh, bed.weight, bed.run.solid(0), {}), InputError);
}

TEST(InitialEquilibrium, SetsMassesAndRefusesWhatIsTied) {
  Bed bed;
  EXPECT_THROW(initialEquilibrium(bed.run.grains, bed.mesh, *bed.soil, bed.weight, {.rounds = 0}), InputError);
  initialEquilibrium(bed.run.grains, bed.mesh, *bed.soil, bed.weight);
  EXPECT_GT(std::ranges::min(bed.soil->nodes.mass), 0.0);
  bed.tie();
  EXPECT_THROW(initialEquilibrium(bed.run.grains, bed.mesh, *bed.run.solid(0).model, bed.weight), InputError);
}

// A heavy grain that reaches just into the soil: with its weight the surface sinks and leaves it outside, without it
// the surface rises to it again.
TEST(InitialEquilibrium, SettlesThoughAGrainAtTheEdgeComesAndGoes) {
  const Vec3 gravity{0.0, 0.0, -9.81};
  Bed without;
  without.run.grains.gravity = gravity;
  initialEquilibrium(without.run.grains, without.mesh, *without.soil, without.weight);
  const fem::Nodes& nodes = without.soil->nodes;
  const Vec3 place{size, size, top};
  const auto corner = std::ranges::find_if(nodes.X, [&](const Vec3& X) { return norm(X - place) < 1e-9; });
  ASSERT_NE(corner, nodes.X.end());
  const Vec3 surface = *corner + nodes.u[static_cast<std::size_t>(corner - nodes.X.begin())];
  constexpr double radius = 0.002;  // m: clear of the others
  Bed bed;
  bed.run.grains.gravity = gravity;
  dem::addParticle(bed.run.grains.particles, surface + Vec3{0.0, 0.0, radius - 1e-7}, {}, radius, dem::Density{1e5});
  const int rounds = initialEquilibrium(bed.run.grains, bed.mesh, *bed.soil, bed.weight);
  EXPECT_LT(rounds, 10);
  const double moved = bed.soil->nodes.u[static_cast<std::size_t>(corner - nodes.X.begin())].z - (surface - place).z;
  EXPECT_NEAR(moved, 0.0, 1e-8);  // nobody hands the grain's weight over
}

}  // namespace
}  // namespace dovetail::arlequin
