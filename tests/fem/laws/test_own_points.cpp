// Points of any state and size: who asks them, in which order, and their checkpoints.
#include <gtest/gtest.h>

#include <chrono>
#include <mutex>
#include <thread>

#include "dovetail/core/error.hpp"
#include "dovetail/core/parallel.hpp"
#include "dovetail/fem/model/checkpoint.hpp"
#include "dovetail/fem/solve/statics.hpp"
#include "watched_field.hpp"

namespace dovetail::fem {
namespace {

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
