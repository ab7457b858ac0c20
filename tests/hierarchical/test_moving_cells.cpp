#include <gtest/gtest.h>

#include "dovetail/fem/model/model_mass.hpp"
#include "dovetail/fem/motion/dynamics.hpp"
#include "solids_of_cells.hpp"

namespace dovetail::hierarchical {
namespace {

using rve::plane;

TEST(DynamicCells, StepsOfGrainsStrainThemNoMoreThanAsked) {
  const DynamicCells settings{.strainPerStep = 1e-5, .damping = 0.2};
  rve::Rve whole = threeCells()[0], parts = whole;
  const Eigen::Matrix3d F = plane(1.0, 0.0, 0.0, 1.0 - 9.5e-5);
  stepTo(whole, F, settings);
  for (int k = 1; k <= 10; ++k) {
    const Eigen::Matrix3d next = k == 10 ? F : plane(1.0, 0.0, 0.0, std::pow(1.0 - 9.5e-5, k / 10.0));
    rve::step(parts, 0.8 * parts.state.criticalStep, rve::relativeDeformation(parts, next), 0.2);
  }
  EXPECT_LT((rve::nominalStress(whole) - rve::nominalStress(parts)).norm(), 1e-9 * rve::nominalStress(parts).norm());
  EXPECT_GT(rve::kineticEnergy(whole), 0.0);
}

/// The biaxial body, sheared at a speed that the waves in it pass many times.
struct Moving : Biaxial {
  explicit Moving(std::vector<rve::Rve> samples = threeCells(), double rate = 0.05)
      : Biaxial({1, 2}, cellField(std::move(samples), DynamicCells{}), fem::ElementShape::quad4, rate) {
    fem::addMass(model);
  }
};

constexpr double shortStep = 2e-5;

TEST(DynamicCells, PointsOfARunAreStandAloneCellsToTheLastBit) {
  Moving body;
  fem::ExplicitIntegrator run(body.model, shortStep);
  std::vector<rve::Rve> cells;
  for (int p = 0; p < 8; ++p) cells.push_back(threeCells()[static_cast<std::size_t>(p / 4 + p % 4) % 3]);
  for (int k = 0; k < 50; ++k) {
    run.step();
    const auto sample = body.solid->sample(body.model.nodes, {body.model.t, shortStep});
    for (std::size_t p = 0; p < cells.size(); ++p) stepTo(cells[p], matrixAt(sample.F, p), {});
  }
  const auto sample = body.solid->sample(body.model.nodes, {body.model.t, shortStep});
  for (std::size_t p = 0; p < cells.size(); ++p) EXPECT_EQ(matrixAt(sample.P, p), rve::nominalStress(cells[p]));
}

TEST(DynamicCells, SteppedInPlaceTheyAnswerAsThoseThatKeepTheirStart) {
  Asked kept(cellField(oneCell(), DynamicCells{})), inPlace(cellField(oneCell(), DynamicCells{}));
  for (int k = 1; k <= 30; ++k) {
    const Eigen::Matrix3d F = plane(1.0, 4e-5 * k, 0.0, 1.0 - 5e-5 * k);
    if (k % 7 == 0) inPlace(plane(0.999, 0.0, 0.0, 1.0));  // a look elsewhere in between
    const Eigen::Matrix3d P = kept(F, k % 5 == 0), Q = inPlace(F, k % 5 == 0, 1.0, true);
    EXPECT_EQ(P, Q);
    EXPECT_EQ(kept.energy, inPlace.energy);
    EXPECT_EQ(kept.dissipated, inPlace.dissipated);
    EXPECT_EQ(kept.tangent, inPlace.tangent);
    kept.field().commit(), inPlace.field().commit();
    ByteWriter one, other;
    kept.field().save(one), inPlace.field().save(other);
    EXPECT_TRUE(std::ranges::equal(one.bytes(), other.bytes()));
  }
}

TEST(DynamicCells, SteppedInPlaceTheyRefuseToGoBack) {
  Asked asked(cellField(oneCell(), DynamicCells{}));
  ByteWriter start;
  asked.field().save(start);
  const Eigen::Matrix3d F = plane(1.0, 0.0, 0.0, 0.9995), other = plane(1.0, 0.0, 0.0, 0.999);
  const Eigen::Matrix3d P = asked(F, false, 1.0, true);
  asked(other);
  EXPECT_NE(asked.reason[0].find("was not kept"), std::string::npos) << asked.reason[0];
  asked.field().revert();
  asked(F);
  EXPECT_NE(asked.reason[0].find("was not kept"), std::string::npos) << asked.reason[0];
  ByteWriter nothing;
  EXPECT_THROW(asked.field().save(nothing), NumericalError);
  EXPECT_THROW(visitCell(asked.field(), 0, [](const rve::Rve&) {}), NumericalError);
  ByteReader back(start.bytes());
  asked.field().load(back);
  EXPECT_EQ(asked(F, false, 1.0, true), P);
  asked.field().commit();
  EXPECT_EQ(asked(F, false, 0.0), P);
}

/// A field whose points never hear that their answers will be committed.
class Doubting final : public fem::PointField {
public:
  explicit Doubting(std::shared_ptr<fem::PointField> inner) : inner_(std::move(inner)) {}
  std::string name() const override { return inner_->name(); }
  double density() const override { return inner_->density(); }
  void open(std::span<const fem::PointPlace> places) override { inner_->open(places); }
  void evaluate(const fem::FieldRequest& request) override {
    told += request.willCommit ? 1 : 0;
    fem::FieldRequest asked = request;
    asked.willCommit = false;
    inner_->evaluate(asked);
  }
  void commit() override { inner_->commit(); }
  void revert() override { inner_->revert(); }
  void save(ByteWriter& archive) const override { inner_->save(archive); }
  void load(ByteReader& archive) override { inner_->load(archive); }
  int told = 0;

private:
  std::shared_ptr<fem::PointField> inner_;
};

TEST(DynamicCells, RunsStepThemInPlaceWithTheSameDigits) {
  for (const fem::ExplicitOptions& options : {fem::ExplicitOptions{}, fem::ExplicitOptions{.safety = 0.8}}) {
    const auto doubting = std::make_shared<Doubting>(cellField(threeCells(), DynamicCells{}));
    Moving inPlace;
    Biaxial kept({1, 2}, doubting, fem::ElementShape::quad4, 0.05);
    fem::addMass(kept.model);
    fem::ExplicitIntegrator one(inPlace.model, shortStep, options), other(kept.model, shortStep, options);
    one.run(40), other.run(40);
    EXPECT_EQ(doubting->told, 40);
    EXPECT_EQ(inPlace.model.nodes.u, kept.model.nodes.u);
    EXPECT_EQ(inPlace.model.nodes.v, kept.model.nodes.v);
    EXPECT_EQ(one.ledger().residual(), other.ledger().residual());
  }
}

TEST(DynamicCells, EnergiesReadBetweenStepsDisturbNothing) {
  Moving booked, spared, read;
  fem::ExplicitIntegrator one(booked.model, shortStep), other(spared.model, shortStep, {.energyEvery = 0}),
      looked(read.model, shortStep, {.energyEvery = 0});
  for (int k = 0; k < 4; ++k) {
    one.run(10), other.run(10), looked.run(10);
    const double energy = booked.solid->energy(booked.model.nodes, {booked.model.t, shortStep});
    EXPECT_GT(energy, 0.0);
    EXPECT_EQ(read.solid->energy(read.model.nodes, {read.model.t, shortStep}), energy);
  }
  EXPECT_EQ(booked.model.nodes.u, spared.model.nodes.u);
  EXPECT_EQ(booked.model.nodes.u, read.model.nodes.u);
}

TEST(DynamicCells, RunsGoOnFromBytesOnAnyNumberOfThreads) {
  Moving whole, first, second;
  fem::ExplicitIntegrator all(whole.model, shortStep), before(first.model, shortStep), after(second.model, shortStep);
  all.run(60);
  before.run(25);
  ByteWriter archive;
  before.save(archive);
  ByteReader bytes(archive.bytes());
  after.load(bytes);
  onThreads(3, [&] {
    after.run(35);
    return 0;
  });
  EXPECT_EQ(whole.model.nodes.u, second.model.nodes.u);
  EXPECT_EQ(whole.model.nodes.v, second.model.nodes.v);
}

TEST(DynamicCells, EnergyIsBalancedAcrossTheScales) {
  Moving body;
  fem::ExplicitIntegrator run(body.model, shortStep);
  run.run(500);
  const EnergyLedger& ledger = run.ledger();
  EXPECT_GT(ledger.joules("dissipated by sand"), 1e-3);
  EXPECT_LT(ledger.largestResidual(), 1e-3 * std::abs(ledger.joules("supports")));
}

TEST(DynamicCells, SlowRunsAreNearRest) {
  Moving moving(oneCell(), 0.01);
  fem::ExplicitIntegrator run(moving.model, shortStep);
  run.runUntil(0.02);
  Biaxial resting({1, 2}, cellField(oneCell()), fem::ElementShape::quad4, 0.01);
  fem::solveStatics(resting.model, 0.02, roughly(1e-5, 0.01));
  const Eigen::Matrix3d P = matrixAt(moving.sample().P, 0), Q = matrixAt(resting.sample().P, 0);
  EXPECT_LT(Q(1, 1), -1.2e5);
  EXPECT_NEAR(P(1, 1), Q(1, 1), 0.1 * std::abs(Q(1, 1) + 1e5));
}

TEST(DynamicCells, StepsTurnWithTheFrame) {
  const Eigen::Matrix3d R = rve::turned(0.6), Q = rve::turned(-2.5);
  rve::Rve straight = threeCells()[0], round = straight;
  for (int k = 1; k <= 40; ++k) {
    const Eigen::Matrix3d F = plane(1.0 + 2e-5 * k, 5e-5 * k, 0.0, 1.0 - 1e-4 * k);
    stepTo(straight, F, {});
    stepTo(round, (k % 2 == 0 ? R : Q) * F, {});
  }
  ASSERT_GT(straight.state.ledger.friction, 1e-3 * straight.state.ledger.work);
  const Eigen::Matrix3d expected = R * rve::stress(straight).cauchy * R.transpose();
  EXPECT_LT((rve::stress(round).cauchy - expected).norm(), 1e-11 * expected.norm());
  EXPECT_NEAR(rve::kineticEnergy(round), rve::kineticEnergy(straight), 1e-8 * rve::kineticEnergy(straight));
}

TEST(DynamicCells, StepsOutOfReachAreRefused) {
  rve::Rve cell = threeCells()[0];
  EXPECT_THROW(stepTo(cell, plane(-1.0, 0, 0, 1.0), {}), InputError);
  Eigen::Matrix3d outward = plane(1, 0, 0, 1);
  outward(2, 2) = 1.001;
  EXPECT_THROW(stepTo(cell, outward, {}), InputError);
}

TEST(DynamicCells, StepsWithoutEndAndBadSettingsAreRefused) {
  rve::Rve cell = threeCells()[0];
  const Eigen::Matrix3d F = rve::plane(1.0, 0.0, 0.0, 0.999);
  EXPECT_THROW(stepTo(cell, F, {.strainPerStep = 1e-13}), NumericalError);
  EXPECT_THROW(stepTo(cell, rve::plane(1e6, 0.0, 0.0, 1.0), {.strainPerStep = 1e-5}), NumericalError);
  EXPECT_THROW(stepTo(cell, F, {.strainPerStep = -1.0}), InputError);
  EXPECT_THROW(stepTo(cell, F, {.damping = 1.0}), InputError);
  EXPECT_THROW(relax(cell, F, {.unbalanced = 0.0}), InputError);
  EXPECT_EQ(cell.state.F, Eigen::Matrix3d::Identity());
}

}  // namespace
}  // namespace dovetail::hierarchical
