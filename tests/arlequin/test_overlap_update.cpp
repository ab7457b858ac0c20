// Overlap ties: turns, flow, restarts, packings, and what is refused.
#include <gtest/gtest.h>

#include "dovetail/core/error.hpp"
#include "dovetail/core/parallel.hpp"
#include "tie_scenes.hpp"

namespace dovetail::arlequin {
namespace {

using namespace test;

/// Loose particles, which do not touch, over and in a bar that stays where it is or moves freely.
TieRun loose(ConstraintKind kind, double penalty, bool hold = true, double width = 0.0) {
  SceneOptions o;
  o.across = 1;
  o.holdEnd = hold;
  o.weights = {WeightProfile::halfCosine, 1e-3};
  TieRun run;
  run.grains.particles = lattice({-0.25, 0, -0.25}, {0.25, 2.5, 0.25}, 2);
  for (double& radius : run.grains.particles.radius) radius *= 0.8;
  run.grains.pairs.setSkin(0.02);
  dem::ElasticLaw law;
  law.normal.stiffness = modulus * 0.25;
  run.grains.laws = dem::makeContactLaws(law);
  const fem::SolidMesh mesh = fem::boxOf(fem::ElementShape::hex8, {1, 6, 1}, {-0.25, 0.5, -0.25}, {0.25, 3.5, 0.25});
  const std::vector<double> weight = barWeights(mesh, o);
  run.take(fem::makeModel(mesh));
  if (hold) fem::fix(run.solid->nodes, fem::nodeSet(mesh, "y+"));
  const fem::StVenantKirchhoff law3{modulus, 0.0, bulk};
  run.solid->add(fem::makeSolid(mesh, fem::pointMaterial(fem::Material(law3)), {.fraction = solidWeights(weight)}));
  CouplingOptions coupling;
  coupling.constraint = kind;
  coupling.penalty = penalty;
  coupling.projection.width = width;
  run.couple(mesh, weight, coupling);
  return run;
}

TEST(Flow, ParticlesComeAndGoWithMassMomentumAndEnergyInTheBooks) {
  for (const ConstraintKind kind : {ConstraintKind::penalty, ConstraintKind::multiplier}) {
    const auto residual = [&](double dt) {
      TieRun run = loose(kind, kind == ConstraintKind::penalty ? 2e5 : 0.0);
      for (std::size_t i = 0; i < run.grains.particles.size(); ++i)
        run.grains.particles.v[i] = {0.01 * run.grains.particles.x[i].z, 0.5, 0.0};
      run.start(dt);
      const double first = run.energy(), mass = run.mass();
      const Vec3 momentum = run.momentum();
      double worst = 0.0;
      const int steps = static_cast<int>(std::lround(0.6 / dt));
      for (int s = 0; s < steps; ++s) {
        run.step(dt);
        worst = std::max(worst, std::abs(run.energy() - first) / first);
        EXPECT_LT(std::abs(run.mass() / mass - 1.0), 1e-13);
        EXPECT_LT(norm(run.momentum() - momentum), 1e-11 * norm(momentum));
      }
      EXPECT_GT(run.tie->state().relocations, 3);
      return worst;
    };
    const double coarse = residual(2e-4), fine = residual(1e-4);
    EXPECT_LT(fine, 1e-2) << static_cast<int>(kind);
    EXPECT_LT(fine, 0.7 * coarse + 1e-6) << static_cast<int>(kind);
  }
}

/// A bed that a belt pushes through the tie, ten elements far.
TEST(Flow, ABedSlidesThroughWithoutACrash) {
  for (const auto& [kind, width] : {std::pair(ConstraintKind::penalty, 0.0),
                                    {ConstraintKind::dashpot, 0.0},
                                    {ConstraintKind::penalty, 0.5},
                                    {ConstraintKind::penalty, 1.25}}) {
    TieRun run = loose(kind, 1e4, true, width);
    dem::Particles& p = run.grains.particles;
    const dem::Particles layer = lattice({-0.25, -5.0, -0.25}, {0.25, 0.0, 0.25}, 2);
    for (std::size_t i = 0; i < layer.size(); ++i)
      dem::addParticle(p, layer.x[i], {}, 0.8 * layer.radius[i], dem::Mass{layer.mass[i]});
    run.start();
    const double mass = run.mass();
    for (int s = 0; s < 12000; ++s) {
      for (std::size_t i = 0; i < p.size(); ++i) p.v[i] = {0.0, 2.0, 0.0};
      run.step(2e-4);
    }
    EXPECT_GT(run.tie->state().removed, 20);
    EXPECT_GT(run.tie->state().admitted, 20);
    EXPECT_LT(std::abs(run.mass() / mass - 1.0), 1e-12);
    dem::requireFinite(p, "the end");
    for (const Vec3& v : run.solid->nodes.v) EXPECT_LT(norm(v), 10.0);
  }
}

TEST(Turn, GapEnergyAndMomentsGoWithTheSolid) {
  SceneOptions o;
  o.holdEnd = false;
  o.across = 1;
  TieRun run = tieBar(o);
  run.start();
  std::mt19937 random(7);
  for (Vec3& x : run.grains.particles.x) x += randomVector(random, 2e-3);
  const auto evaluate = [&] {
    run.side->load.clear();
    dem::clearForces(run.grains.particles);
    dem::Step step;
    step.dt = 1e-100;
    step.timeless = true;
    run.tie->addForces(run.grains, step);
    return run.tie->stored();
  };
  const auto moment = [&] {
    Vec3 sum;
    for (std::size_t i = 0; i < run.grains.particles.size(); ++i)
      sum += cross(run.grains.particles.x[i], run.grains.particles.f[i]);
    for (std::size_t n = 0; n < run.solid->nodes.X.size(); ++n)
      sum += cross(run.solid->nodes.X[n] + run.solid->nodes.u[n], run.side->load.force[n]);
    return sum;
  };
  const double stored = evaluate();
  double size = 0.0;
  for (const Vec3& f : run.grains.particles.f) size += norm(f);
  EXPECT_LT(norm(moment()), 1e-12 * size);
  const std::vector<Vec3> lambda(run.tie->lambda().begin(), run.tie->lambda().end());
  const auto turn = [](const Vec3& x) { return Vec3{-x.y, x.x, x.z}; };
  for (Vec3& x : run.grains.particles.x) x = turn(x);
  for (std::size_t n = 0; n < run.solid->nodes.X.size(); ++n) {
    const Vec3& X = run.solid->nodes.X[n];
    run.solid->nodes.u[n] = turn(X + run.solid->nodes.u[n]) - X;
  }
  EXPECT_NEAR(evaluate(), stored, 1e-11 * stored);
  EXPECT_LT(norm(moment()), 1e-11 * size);
  for (std::size_t r = 0; r < lambda.size(); ++r)
    EXPECT_LT(norm(run.tie->lambda()[r] - turn(lambda[r])), 1e-10 * (norm(lambda[r]) + 1.0));
}

/// Everything turns freely while a part of the gap is kept from earlier ties.
TEST(Turn, TheKeptGapTurnsWithTheSolidAndMakesNoMoment) {
  TieRun run = loose(ConstraintKind::penalty, 1e5, false);
  for (Vec3& v : run.grains.particles.v) v.y = 0.3;
  run.start();
  while (run.tie->state().relocations < 5) run.step(2e-4);
  const Vec3 centre{0.0, 1.5, 0.0}, spin{0.0, 0.0, 8.0};
  Vec3 mean;
  double mass = 0.0;
  for (std::size_t n = 0; n < run.solid->nodes.X.size(); ++n) {
    mean += run.solid->nodes.mass[n] * run.solid->nodes.v[n];
    mass += run.solid->nodes.mass[n];
  }
  mean = mean / mass;
  for (std::size_t i = 0; i < run.grains.particles.size(); ++i)
    run.grains.particles.v[i] = mean + cross(spin, run.grains.particles.x[i] - centre);
  for (std::size_t n = 0; n < run.solid->nodes.X.size(); ++n)
    run.solid->nodes.v[n] = mean + cross(spin, run.solid->nodes.X[n] + run.solid->nodes.u[n] - centre);
  run.start();
  const double first = run.energy();
  const Vec3 angular = run.run->totals().angularMomentum;
  const std::int64_t before = run.tie->state().relocations;
  int steps = 0;
  double worst = 0.0;
  for (; steps < 600 && run.tie->state().relocations == before; ++steps) {
    run.step(1e-4);
    if (run.tie->state().relocations == before) worst = norm(run.run->totals().angularMomentum - angular);
  }
  EXPECT_GT(steps, 60);
  EXPECT_LT(worst, 1e-11 * norm(angular));
  EXPECT_NEAR(run.energy(), first, 1e-3 * first);
}

/// λ before and after the tie lets particles in and locates them anew, at one state.
class Look final : public dem::Term {
public:
  Look(ArlequinCoupling* tie, std::vector<Vec3>* lambda, std::vector<int>* node, Order order)
      : tie_(tie), lambda_(lambda), node_(node), order_(order) {}
  std::string name() const override { return "look"; }
  std::unique_ptr<dem::Term> clone() const override { return std::make_unique<Look>(*this); }
  Order order() const override { return order_; }
  void exchange(dem::Model& m, const dem::Step& step) override {
    if (order_ == Order::partners) {
      dem::Step still = step;
      still.timeless = true;
      tie_->addForces(m, still);
    }
    lambda_->assign(tie_->lambda().begin(), tie_->lambda().end());
    *node_ = tie_->operators().node;
  }

private:
  ArlequinCoupling* tie_;
  std::vector<Vec3>* lambda_;
  std::vector<int>* node_;
  Order order_;
};

TEST(OverlapUpdate, LambdaDoesNotJump) {
  for (const double width : {0.0, 0.5, 1.25}) {
    TieRun run = loose(ConstraintKind::penalty, 1e5, true, width);
    for (Vec3& v : run.grains.particles.v) v.y = 0.2;
    std::vector<Vec3> here, there;
    std::vector<int> nodesHere, nodesThere;
    run.grains.terms.add(Look(run.tie, &here, &nodesHere, dem::Term::Order::partners));
    run.grains.terms.add(Look(run.tie, &there, &nodesThere, dem::Term::Order::damping));
    run.start();
    double worst = 0.0, largest = 0.0;
    int looked = 0;
    for (int s = 0; s < 4000; ++s) {
      const std::int64_t before = run.tie->state().relocations;
      run.step(1e-4);
      if (run.tie->state().relocations == before) continue;
      ++looked;
      double size = 0.0, jump = 0.0;
      for (const Vec3& l : here) size += squaredNorm(l);
      for (std::size_t r = 0; r < there.size(); ++r) {
        const auto at = std::ranges::find(nodesHere, nodesThere[r]);
        const Vec3 was = at == nodesHere.end() ? Vec3{} : here[static_cast<std::size_t>(at - nodesHere.begin())];
        jump += squaredNorm(there[r] - was);
      }
      if (size > 0.0) worst = std::max(worst, std::sqrt(jump / size));
      largest = std::max(largest, std::sqrt(size));
    }
    EXPECT_GT(looked, 5) << width;
    EXPECT_GT(largest, 0.0);
    EXPECT_LT(worst, 1e-9) << width;  // whoever comes or goes
    RecordProperty("largest_jump_" + std::to_string(width), std::to_string(worst));
  }
}

TEST(Restart, GivesTheSameBitsWhileParticlesComeAndGo) {
  for (const auto& [kind, width] : {std::pair(ConstraintKind::penalty, 0.0),
                                    {ConstraintKind::penalty, 0.5},
                                    {ConstraintKind::multiplier, 0.0},
                                    {ConstraintKind::multiplier, 0.5},
                                    {ConstraintKind::dashpot, 0.0}}) {
    const double penalty = kind == ConstraintKind::multiplier ? 0.0 : kind == ConstraintKind::penalty ? 2e5 : 1e5;
    TieRun whole = loose(kind, penalty, true, width), resumed = loose(kind, penalty, true, width);
    for (TieRun* run : {&whole, &resumed}) {
      for (std::size_t i = 0; i < run->grains.particles.size(); ++i)
        run->grains.particles.v[i] = {0.01 * run->grains.particles.x[i].z, 0.5, 0.0};
      run->start(2e-4);
    }
    whole.run->advance(500);
    resumed.run->load(whole.run->save());
    EXPECT_EQ(resumed.run->save(), whole.run->save()) << static_cast<int>(kind);
    whole.run->advance(500);
    resumed.run->advance(500);
    EXPECT_EQ(resumed.run->save(), whole.run->save()) << static_cast<int>(kind);
    EXPECT_GT(whole.tie->state().relocations, 0);
  }
}

/// So many rows, particles and pairs that every loop has several chunks.
/// A bar whose particles touch or are bonded, tied to a solid that is stepped in one way or another.
TieRun shaken(ConstraintKind kind, coupling::Stepping stepping, int K, bool bonded) {
  SceneOptions o;
  o.across = 1;
  o.coupling.constraint = kind;
  TieRun run = tieBar(o, fem::ElementShape::hex8, stepping);
  dem::ElasticLaw law;
  law.normal = {.stiffness = modulus * edge / o.particlesPerEdge, .bonded = bonded};
  run.grains.laws = dem::makeContactLaws(law);
  std::mt19937 random(3);
  for (Vec3& v : run.grains.particles.v) v = randomVector(random, 0.05);
  run.K = K;
  run.start(1e-4);
  return run;
}

TEST(Restart, RightAfterMembersWereTakenOutGivesTheSameBits) {
  for (const ConstraintKind kind : {ConstraintKind::penalty, ConstraintKind::multiplier})
    for (const auto stepping : {coupling::Stepping::explicitSteps, coupling::Stepping::implicitSteps})
      for (const auto& [K, bonded] : {std::pair{1, false}, {1, true}, {4, false}}) {
        TieRun whole = shaken(kind, stepping, K, bonded), parted = shaken(kind, stepping, K, bonded);
        whole.run->advance(50);
        const std::vector<int>& tied = whole.tie->overlap().particle;
        dem::removeParticles(whole.grains, std::vector<int>{tied[5], tied[6], tied[20]});
        parted.run->load(whole.run->save());
        whole.run->advance(20);
        parted.run->advance(20);
        EXPECT_TRUE(whole.run->save() == parted.run->save()) << K << bonded;
      }
}

TEST(Threads, ChangeNoDigitOfLargeTiesThatAreMadeAnew) {
  const auto bytes = [](ConstraintKind kind, double width, int threads) {
    setThreads(threads);
    SceneOptions o;
    o.across = 10;
    o.coupling.constraint = kind;
    o.coupling.projection.width = width;
    TieRun run = tieBar(o);
    std::mt19937 random(3);
    for (Vec3& v : run.grains.particles.v) v = Vec3{0.0, 30.0, 0.0} + randomVector(random, 1.0);
    run.start(1e-4);
    run.run->advance(10);
    EXPECT_GT(run.tie->state().relocations, 0);
    setThreads(detail::processors());
    return run.run->save();
  };
  for (const auto& [kind, width] : {std::pair(ConstraintKind::penalty, 0.0),
                                    {ConstraintKind::penalty, 0.5},
                                    {ConstraintKind::multiplier, 0.0},
                                    {ConstraintKind::multiplier, 0.5}})
    EXPECT_EQ(bytes(kind, width, 1), bytes(kind, width, 3)) << static_cast<int>(kind) << ' ' << width;
}

TEST(OverlapUpdate, BothModelsMovingTogetherChangeNothing) {
  SceneOptions o;
  o.holdEnd = false;
  TieRun run = tieBar(o);
  const Vec3 v{0.1, 0.5, -0.2};
  for (Vec3& each : run.grains.particles.v) each = v;
  for (Vec3& each : run.solid->nodes.v) each = v;
  run.start();
  run.run->advance(3000);
  EXPECT_EQ(run.tie->state().relocations, 0);
  EXPECT_EQ(run.grains.left.mass, 0.0);
  for (const Vec3& each : run.grains.particles.v) EXPECT_LT(norm(each - v), 1e-8);
  for (const Vec3& each : run.solid->nodes.v) EXPECT_LT(norm(each - v), 1e-8);
}

TEST(Numbers, SortingInsertingAndRemovingAreFollowed) {
  TieRun run = loose(ConstraintKind::penalty, 2e5);
  for (Vec3& v : run.grains.particles.v) v.y = 0.3;
  run.grains.sortEvery = 1;
  run.start();
  const double mass = run.mass();
  const Vec3 momentum = run.momentum();
  for (int s = 0; s < 3000; ++s) {
    run.step(2e-4);
    if (s == 1000) {
      dem::removeParticles(run.grains, std::vector<int>{3, 11, 30});
      run.start();
    }
    if (s == 1500) {
      const Vec3 x{0.05, -0.5, 0.0};
      dem::addParticle(run.grains.particles, x, {0.0, 0.5, 0.0}, 0.05, dem::Mass{1.0});
      run.start();
    }
    for (std::size_t k = 0; k < run.tie->overlap().size(); ++k) {
      const auto i = static_cast<std::size_t>(run.tie->overlap().particle[k]);
      ASSERT_LT(i, run.grains.particles.size());
      ASSERT_EQ(run.grains.particles.weight[i], run.tie->overlap().weight[k]);
    }
  }
  EXPECT_NEAR(run.mass(), mass, 1e-12 * mass);
  EXPECT_LT(norm(run.momentum() - momentum), 1e-10 * norm(momentum));
}

}  // namespace
}  // namespace dovetail::arlequin
