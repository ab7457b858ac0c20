// Points that own their state, as elements see them.
#include <gtest/gtest.h>

#include <chrono>
#include <mutex>
#include <thread>

#include "dovetail/core/error.hpp"
#include "dovetail/core/parallel.hpp"
#include "dovetail/fem/laws/point_field.hpp"
#include "dovetail/fem/laws/viscosity.hpp"
#include "dovetail/fem/model/checkpoint.hpp"
#include "dovetail/fem/motion/dynamics.hpp"
#include "dovetail/fem/solve/statics.hpp"
#include "plastic_laws.hpp"
#include "solid_helpers.hpp"

namespace dovetail::fem {
namespace {

const J2Plasticity metal{1e7, 0.3, 1000.0, linearYield(2e4, 1e5), 5e4};

std::vector<SolidKind> kindsWithFields() {
  std::vector<SolidKind> kinds = allSolidKinds();
  std::erase_if(kinds, [](const SolidKind& kind) { return kind.formulation == Formulation::enhanced; });
  return kinds;
}

/// A law behind a field that counts and remembers what it is asked.
class Watched : public PointField {
public:
  explicit Watched(std::shared_ptr<PointField> inner) : inner_(std::move(inner)) {}
  std::string name() const override { return inner_->name(); }
  double density() const override { return inner_->density(); }
  bool isSymmetric() const override { return inner_->isSymmetric(); }
  bool hasEnergy() const override { return inner_->hasEnergy(); }
  void open(std::span<const PointPlace> given) override {
    places.assign(given.begin(), given.end());
    inner_->open(given);
  }
  void evaluate(const FieldRequest& request) override {
    ++(request.moved ? states : tangentsAlone);
    energies += request.withEnergy ? 1 : 0;
    const std::pair state(std::vector<double>(request.F.begin(), request.F.end()), request.dt);
    if (request.moved) repeated += static_cast<int>(std::ranges::count(seen_, state));
    seen_.push_back(state);
    inner_->evaluate(request);
    if (spoil >= 0 && request.F[static_cast<std::size_t>(9 * spoil + 8)] > 1.05) {
      if (reason.empty())
        request.P[static_cast<std::size_t>(9 * spoil)] = std::nan("");
      else
        request.reason[static_cast<std::size_t>(spoil)] = reason;
    }
  }
  void commit() override { ++commits, seen_.clear(), inner_->commit(); }
  void revert() override { ++reverts, seen_.clear(), inner_->revert(); }
  void save(ByteWriter& archive) const override { inner_->save(archive); }
  void load(ByteReader& archive) override { inner_->load(archive); }

  std::vector<PointPlace> places;
  int states = 0, energies = 0, repeated = 0, tangentsAlone = 0, commits = 0, reverts = 0, spoil = -1;
  std::string reason;

private:
  std::shared_ptr<PointField> inner_;
  std::vector<std::pair<std::vector<double>, double>> seen_;  // since the last commit
};

SolidScene sceneOfField(const SolidMesh& mesh, std::shared_ptr<PointField> field, Formulation formulation) {
  SolidScene scene{makeModel(mesh), makeSolid(mesh, std::move(field), {.formulation = formulation})};
  scene.model.add(scene.solid);
  return scene;
}

std::vector<double> tangentOf(SolidScene& scene, const Instant& now) {
  linalg::MatrixPattern pattern(scene.model.nodes.u.size());
  scene.solid->addPattern(pattern);
  linalg::BlockMatrix K(std::move(pattern));
  scene.solid->addTangent(scene.model.nodes, now, K);
  return {K.values().begin(), K.values().end()};
}

/// Laws that iterate on four points at a time stop with the slowest of them: neighbours show in the last digits.
void expectSame(std::span<const double> a, std::span<const double> b) {
  ASSERT_EQ(a.size(), b.size());
  double largest = 0.0, difference = 0.0;
  for (std::size_t k = 0; k < a.size(); ++k) {
    largest = std::max(largest, std::abs(a[k]));
    difference = std::max(difference, std::abs(a[k] - b[k]));
  }
  EXPECT_LE(difference, 1e-13 * largest);
}
void expectSame(std::span<const Vec3> a, std::span<const Vec3> b) {
  expectSame(std::span(&a[0].x, 3 * a.size()), std::span(&b[0].x, 3 * b.size()));
}

TEST(PointField, AnswersAsTheLawItself) {
  const std::vector<MaterialPointer> materials = {pointMaterial(metal), pointMaterial(neoHookean(1e6, 0.3, 1000.0)),
                                                  pointMaterial(kelvinVoigt(pointMaterial(metal), 0.01, 1e7, 0.3))};
  for (const SolidKind& kind : kindsWithFields())
    for (const MaterialPointer& material : materials) {
      SCOPED_TRACE(kind.label() + ", " + material->name());
      const SolidMesh mesh = testSolidMesh(kind.shape, true);
      SolidScene law = sceneOf(mesh, material, {.formulation = kind.formulation});
      SolidScene field = sceneOfField(mesh, pointField(material), kind.formulation);
      Nodes &own = law.model.nodes, &other = field.model.nodes;
      std::mt19937 random(3);
      for (int step = 1; step <= 3; ++step) {
        const Instant now{0.1 * step, 0.1};
        for (std::size_t n = 0; n < mesh.X.size(); ++n) own.u[n] = other.u[n] += randomVec3(random, 0.005);
        std::vector<Vec3> f(mesh.X.size()), g(mesh.X.size());
        const double energy = law.solid->addForcesAndEnergy(own, now, f);
        EXPECT_NEAR(energy, field.solid->addForcesAndEnergy(other, now, g), 1e-13 * energy);
        expectSame(f, g);
        expectSame(tangentOf(law, now), tangentOf(field, now));
        expectSame(law.solid->elementEnergies(own, now), field.solid->elementEnergies(other, now));
        expectSame(law.solid->sample(own, now).P, field.solid->sample(other, now).P);
        const double dissipated = law.solid->commit(own, now);
        EXPECT_NEAR(dissipated, field.solid->commit(other, now), 1e-13 * energy);
        EXPECT_EQ(dissipated > 0.0, material->historySize() > 0);
        const double dt = law.solid->stableStep(own).dt;
        EXPECT_NEAR(dt, field.solid->stableStep(other).dt, 1e-12 * dt);
      }
    }
}

TEST(PointField, PlacesFillTheSolidElementByElement) {
  for (const SolidKind& kind : kindsWithFields()) {
    SCOPED_TRACE(kind.label());
    const SolidMesh mesh = testSolidMesh(kind.shape, true);
    auto field = std::make_shared<Watched>(pointField(std::make_shared<PlainNeoHookean>(2e6, 1e6)));
    SolidScene scene = sceneOfField(mesh, field, kind.formulation);
    forcesOf(*scene.solid, scene.model.nodes);
    double volume = 0.0;
    int element = 0, point = 0;
    Vec3 moment;
    for (const PointPlace& place : field->places) {
      if (place.element != element) ++element, point = 0;
      EXPECT_EQ(place.element, element);
      EXPECT_EQ(place.point, point++);
      volume += place.volume;
      moment += place.volume * place.X;
    }
    EXPECT_EQ(static_cast<std::size_t>(element) + 1, mesh.elementCount());
    const std::vector<double> volumes = scene.solid->sample(scene.model.nodes, {}).volume;
    EXPECT_EQ(volume, std::accumulate(volumes.begin(), volumes.end(), 0.0));
    EXPECT_NEAR(volume, volumeOf(solidScene(kind, true)), 1e-6 * volume);
    const double middle = dimensionOf(kind.shape) == 2 ? mesh.X[0].z : 0.65;
    EXPECT_LT(norm(moment / volume - Vec3{0.55, 0.1, middle}), 0.1);
  }
}

/// A bar of two elements pulled along z.
struct Pulled {
  std::shared_ptr<Watched> field;
  SolidScene scene;
  explicit Pulled(std::shared_ptr<PointField> inner, double speed = 0.04)
      : field(std::make_shared<Watched>(std::move(inner))), scene(make(field, speed)) {}

  static SolidScene make(const std::shared_ptr<Watched>& field, double speed) {
    const SolidMesh mesh = boxOf(ElementShape::hex8, {1, 1, 2}, {}, {0.1, 0.1, 0.2});
    SolidScene scene = sceneOfField(mesh, field, Formulation::standard);
    addMass(scene.model);
    scene.model.constraints.hold(nodeSet(mesh, "z-"));
    scene.model.constraints.prescribe(nodeSet(mesh, "z+"), 2, [speed](double t) { return speed * t; });
    return scene;
  }
};

TEST(PointField, IsAskedOncePerState) {
  Pulled moving(pointField(pointMaterial(metal)));
  {
    ExplicitIntegrator run(moving.scene.model, 1e-5);
    const int atStart = moving.field->states;
    run.run(20);
    EXPECT_EQ(moving.field->states - atStart, 20);
    EXPECT_EQ(moving.field->commits, 20);
    EXPECT_EQ(moving.field->tangentsAlone, 0);
  }
  Pulled still(pointField(pointMaterial(metal)));
  const StaticReport report = solveStatics(still.scene.model, 1.0, {.firstStep = 0.25});
  EXPECT_EQ(report.cuts, 0);
  const int steps = static_cast<int>(report.steps.size());
  EXPECT_EQ(still.field->commits, steps);
  EXPECT_EQ(still.field->repeated, 0);
  EXPECT_GT(still.field->tangentsAlone, 0);
}

/// Steps without a ledger spare the points their energy; whoever reads it later gets that of the committed state.
TEST(PointField, EnergiesThatStepsDidNotAskForAreFoundWhenTheyAreRead) {
  const std::vector<MaterialPointer> materials = {pointMaterial(metal),
                                                  pointMaterial(kelvinVoigt(pointMaterial(metal), 0.01, 1e7, 0.3))};
  for (const MaterialPointer& material : materials) {
    Pulled booked(pointField(material)), spared(pointField(material));
    ExplicitIntegrator with(booked.scene.model, 1e-6), without(spared.scene.model, 1e-6, {.energyEvery = 0});
    const int atStart = spared.field->energies;
    for (int round = 1; round <= 3; ++round) {
      with.run(20), without.run(20);
      EXPECT_EQ(spared.field->energies - atStart, round - 1);
      const Instant now{spared.scene.model.t, 1e-6};
      const std::vector<double> P = spared.scene.solid->sample(spared.scene.model.nodes, now).P;
      const double energy = spared.scene.solid->energy(spared.scene.model.nodes, now);
      EXPECT_GT(energy, 0.0);
      EXPECT_NEAR(energy, booked.scene.solid->energy(booked.scene.model.nodes, now), 1e-13 * energy);
      EXPECT_EQ(spared.scene.solid->energy(spared.scene.model.nodes, now), energy);
      expectSame(spared.scene.solid->elementEnergies(spared.scene.model.nodes, now),
                 booked.scene.solid->elementEnergies(booked.scene.model.nodes, now));
      EXPECT_EQ(spared.scene.solid->sample(spared.scene.model.nodes, now).P, P);
      EXPECT_EQ(spared.field->energies - atStart, round);
    }
    EXPECT_EQ(booked.scene.model.nodes.u, spared.scene.model.nodes.u);
    EXPECT_EQ(spared.field->commits, 60);
  }
}

TEST(PointField, APointWithoutAnAnswerCutsTheStepAndIsNamed) {
  for (const std::string reason : {"", "the cell of grains does not settle"})
    for (const int threadCount : {1, 2, 3}) {
      setThreads(threadCount);
      Pulled bar(pointField(pointMaterial(neoHookean(1e6, 0.3, 1000.0))));
      bar.field->spoil = 11;
      bar.field->reason = reason;
      double accepted = 0.0;
      std::vector<Vec3> u;
      const auto remember = [&](const Model& model, const StaticStep&) {
        accepted = model.t, u = model.nodes.u;
        return true;
      };
      try {
        solveStatics(bar.scene.model, 1.0, {.firstStep = 0.125, .smallestStep = 0.01}, remember);
        ADD_FAILURE();
      } catch (const NumericalError& error) {
        const std::string text = error.what();
        EXPECT_NE(text.find("element 1"), std::string::npos) << text;
        EXPECT_NE(text.find("point 3"), std::string::npos) << text;
        EXPECT_NE(text.find(reason.empty() ? "not finite" : reason), std::string::npos) << text;
      }
      EXPECT_GT(accepted, 0.2);
      EXPECT_LT(accepted, 0.27);  // 5 % of the length by 4 % in a unit of time
      EXPECT_EQ(bar.scene.model.t, accepted);
      EXPECT_EQ(bar.scene.model.nodes.u, u);
      EXPECT_GT(bar.field->reverts, 2);
      setThreads(1);
    }
}

/// A spring of neo-Hookean stiffness that hardens with every accepted step and keeps the list of its stretches.
class Growing : public FieldPoint {
public:
  explicit Growing(const PointPlace& place) : stiffness_(1e6 * (1.0 + 0.1 * place.X.z + 0.05 * place.point)) {}
  void evaluate(std::span<const double, 9> F, double, bool, PointAnswer answer) override {
    std::this_thread::sleep_for(slow_);
    const double mu = stiffness_ * (1.0 + 0.1 * static_cast<double>(past_.size()));
    trial_ = F[8];
    answer.energy = answer.dissipated = 0.0;
    for (std::size_t k = 0; k < 9; ++k) {
      const double H = F[k] - (k % 4 == 0 ? 1.0 : 0.0);
      answer.P[k] = mu * H;
      answer.energy += 0.5 * mu * H * H;
    }
    for (std::size_t k = 0; k < answer.tangent.size(); ++k) answer.tangent[k] = k % 10 == 0 ? mu : 0.0;
  }
  void commit() override { past_.push_back(trial_); }
  void revert() override { trial_ = 0.0; }
  void save(ByteWriter& archive) const override { archive(past_); }
  void load(ByteReader& archive) override { archive(past_); }
  void slowDown() { slow_ = std::chrono::milliseconds(3); }

private:
  double stiffness_, trial_ = 0.0;
  std::vector<double> past_;
  std::chrono::milliseconds slow_{0};
};

std::shared_ptr<PointField> growingField() {
  return pointField({.name = "growing", .density = 1000.0, .isSymmetric = true},
                    [](const PointPlace& place) { return std::make_unique<Growing>(place); });
}

TEST(PointField, StatesOfAnySizeGoThroughCheckpoints) {
  Pulled whole(growingField()), first(growingField()), second(growingField());
  ExplicitIntegrator all(whole.scene.model, 1e-5);
  all.run(30);
  ExplicitIntegrator before(first.scene.model, 1e-5), after(second.scene.model, 1e-5);
  before.run(12);
  ByteWriter archive;
  before.save(archive);
  ByteReader bytes(archive.bytes());
  after.load(bytes);
  after.run(18);
  EXPECT_EQ(whole.scene.model.nodes.u, second.scene.model.nodes.u);
  EXPECT_EQ(whole.scene.model.nodes.v, second.scene.model.nodes.v);

  Pulled still(growingField()), restarted(growingField());
  solveStatics(still.scene.model, 0.5, {.firstStep = 0.25});
  ByteWriter half;
  save(still.scene.model, half);
  ByteReader read(half.bytes());
  load(restarted.scene.model, read);
  solveStatics(still.scene.model, 1.0, {.firstStep = 0.25});
  solveStatics(restarted.scene.model, 1.0, {.firstStep = 0.25});
  EXPECT_EQ(still.scene.model.nodes.u, restarted.scene.model.nodes.u);
}

TEST(PointField, StatesOfOtherPointsAreRefusedAndChangeNothing) {
  const SolidMesh small = boxOf(ElementShape::tet4, {1, 1, 1}, {}, {1, 1, 1});
  for (const auto& make :
       {std::function(growingField), std::function([] { return pointField(pointMaterial(metal)); })}) {
    SolidScene a = sceneOfField(small, make(), Formulation::standard);
    Pulled b(make());
    ByteWriter own, other;
    b.scene.solid->addForcesAndEnergy(b.scene.model.nodes, {0.1, 0.1}, b.scene.model.nodes.f);
    b.scene.solid->commit(b.scene.model.nodes, {0.1, 0.1});
    b.scene.solid->save(own);
    forcesOf(*a.solid, a.model.nodes);
    a.solid->save(other);
    ByteReader wrong(other.bytes());
    EXPECT_THROW(b.scene.solid->load(wrong), InputError);
    ByteWriter again;
    b.scene.solid->save(again);
    EXPECT_EQ(own.bytes(), again.bytes());
  }
}

/// Reports in which order points are asked.
struct Order {
  std::mutex mutex;
  std::vector<int> elements;
};
class Slow : public Growing {
public:
  Slow(const PointPlace& place, Order& order) : Growing(place), place_(place), order_(order) {
    if (place.element == 17) slowDown();
  }
  void evaluate(std::span<const double, 9> F, double dt, bool moved, PointAnswer answer) override {
    {
      const std::lock_guard lock(order_.mutex);
      order_.elements.push_back(place_.element);
    }
    Growing::evaluate(F, dt, moved, answer);
  }

private:
  PointPlace place_;
  Order& order_;
};

TEST(PointField, CostlyPointsComeFirstAndResultsGoToTheirPlace) {
  const SolidMesh mesh = boxOf(ElementShape::tet4, {2, 2, 2}, {}, {1, 1, 1});
  const auto forces = [&](int threadCount, Order& order) {
    return onThreads(threadCount, [&] {
      const auto field = pointField({.name = "slow", .density = 1000.0},
                                    [&](const PointPlace& place) { return std::make_unique<Slow>(place, order); });
      SolidScene scene = sceneOfField(mesh, field, Formulation::standard);
      setRandom(scene.model.nodes.u, 0.01, 5);
      forcesOf(*scene.solid, scene.model.nodes);
      setRandom(scene.model.nodes.u, 0.01, 6);
      return forcesOf(*scene.solid, scene.model.nodes);
    });
  };
  Order one, two, three;
  const std::vector<Vec3> f = forces(1, one);
  ASSERT_EQ(one.elements.size(), 2 * mesh.elementCount());
  EXPECT_EQ(one.elements.front(), 0);
  EXPECT_EQ(one.elements[mesh.elementCount()], 17);
  EXPECT_EQ(f, forces(2, two));
  EXPECT_EQ(f, forces(3, three));
}

TEST(PointField, WhatPointsThrowIsTheReason) {
  struct Throws : Growing {
    using Growing::Growing;
    void evaluate(std::span<const double, 9>, double, bool, PointAnswer) override {
      throw InputError("no grains are left", "cell", "fill it");
    }
  };
  SolidScene scene = sceneOfField(boxOf(ElementShape::hex8, {1, 1, 2}, {}, {1, 1, 1}),
                                  pointField({.name = "empty", .density = 1.0},
                                             [](const PointPlace& place) -> std::unique_ptr<FieldPoint> {
                                               if (place.element == 0) return std::make_unique<Growing>(place);
                                               return std::make_unique<Throws>(place);
                                             }),
                                  Formulation::standard);
  try {
    forcesOf(*scene.solid, scene.model.nodes);
    ADD_FAILURE();
  } catch (const NumericalError& error) {
    EXPECT_NE(std::string(error.what()).find("no grains are left"), std::string::npos) << error.what();
    EXPECT_NE(std::string(error.what()).find("element 1"), std::string::npos) << error.what();
  }
}

TEST(PointField, WrongRequestsAreRefused) {
  const SolidMesh mesh = boxOf(ElementShape::hex8, {1, 1, 1}, {}, {1, 1, 1});
  for (const Formulation formulation : {Formulation::enhanced, Formulation::assumedStress})
    EXPECT_THROW(makeSolid(mesh, growingField(), {.formulation = formulation}), InputError);
  EXPECT_THROW(makeSolid(mesh, std::shared_ptr<PointField>{}), InputError);
  EXPECT_THROW(pointField(nullptr), InputError);
  const auto make = [](const PointPlace& place) { return std::make_unique<Growing>(place); };
  EXPECT_THROW(pointField({.name = "", .density = 1.0}, make), InputError);
  EXPECT_THROW(pointField({.name = "x", .density = 0.0}, make), InputError);
  EXPECT_THROW(pointField({.name = "x", .density = 1.0}, nullptr), InputError);
  const auto none =
      pointField({.name = "x", .density = 1.0}, [](const PointPlace&) { return std::unique_ptr<FieldPoint>(); });
  SolidScene scene = sceneOfField(mesh, none, Formulation::standard);
  EXPECT_THROW(forcesOf(*scene.solid, scene.model.nodes), InputError);
}

}  // namespace
}  // namespace dovetail::fem
