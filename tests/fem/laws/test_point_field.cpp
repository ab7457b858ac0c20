// Points that own their state, as elements see them.
#include <gtest/gtest.h>

#include "dovetail/core/error.hpp"
#include "dovetail/core/parallel.hpp"
#include "dovetail/fem/laws/viscosity.hpp"
#include "dovetail/fem/solve/statics.hpp"
#include "watched_field.hpp"

namespace dovetail::fem {
namespace {

std::vector<SolidKind> kindsWithFields() {
  std::vector<SolidKind> kinds = allSolidKinds();
  std::erase_if(kinds, [](const SolidKind& kind) { return kind.formulation == Formulation::enhanced; });
  return kinds;
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
        const double dt = law.solid->stableStep(own)->dt;
        EXPECT_NEAR(dt, field.solid->stableStep(other)->dt, 1e-12 * dt);
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

}  // namespace
}  // namespace dovetail::fem
