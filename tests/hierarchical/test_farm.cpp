// Farms in one process: workers that answer late and in any order.
#include <gtest/gtest.h>

#include <deque>
#include <random>

#include "dovetail/core/lost_error.hpp"
#include "farm/farm_plan.hpp"
#include "farm/farmed_field.hpp"
#include "farm/worker.hpp"
#include "farm_bodies.hpp"

namespace dovetail::hierarchical {
namespace {

/// Letters wait until somebody must wait for them; whose turn it is then is drawn.
class LateMail final : public Mail {
public:
  LateMail(int ranks, unsigned seed) : workers_(static_cast<std::size_t>(ranks)), random_(seed) {}
  int ranks() const override { return static_cast<int>(workers_.size()); }
  void send(int to, std::vector<char> bytes) override {
    workers_.at(static_cast<std::size_t>(to)).letters.push_back(std::move(bytes));
    ++sent;
  }
  void settle() override {}
  Letter receive() override {
    for (;;) {
      const std::size_t rank = 1 + random_() % (workers_.size() - 1);
      Worker& worker = workers_[rank];
      if (!worker.replies.empty() && random_() % 2 == 0) {
        Letter letter{static_cast<int>(rank), std::move(worker.replies.front())};
        worker.replies.pop_front();
        return letter;
      }
      if (worker.letters.empty()) continue;
      std::optional<std::vector<char>> reply = worker.worker.answer(std::move(worker.letters.front()));
      worker.letters.pop_front();
      if (reply) worker.replies.push_back(std::move(*reply));
    }
  }
  int sent = 0;

private:
  struct Worker {
    FarmWorker worker;
    std::deque<std::vector<char>> letters, replies;
  };
  std::vector<Worker> workers_;
  std::mt19937 random_;
};

template <class Settings>
std::shared_ptr<fem::PointField> farmOf(const Settings& settings, Mail& mail, FarmMoving moving = FarmMoving::atRandom,
                                        std::vector<rve::Rve> samples = threeCells()) {
  const std::size_t n = samples.size();
  return farmedField(
      {std::make_shared<const std::vector<rve::Rve>>(std::move(samples)), settings},
      [n](const fem::PointPlace& place) { return inTurn(place) % n; }, mail, moving);
}

TEST(Farm, LoadStepsHaveTheDigitsOfOneProcess) {
  for (const Operator tangent : {Operator::elasticTangent, Operator::averagedTangent}) {
    const QuasiStaticCells settings{.tangent = tangent};
    const Outcomes here = inLoadSteps(fieldHere(threeCells(), settings));
    const bool remembers = tangent == Operator::averagedTangent;
    for (const int ranks : remembers ? std::vector{3} : std::vector{1, 2, 3, 5})
      for (const FarmMoving moving : {FarmMoving::atRandom, FarmMoving::whereItPays}) {
        LateMail mail(ranks, 7u + static_cast<unsigned>(ranks));
        EXPECT_EQ(inLoadSteps(farmOf(settings, mail, moving)), here) << ranks << " ranks";
        EXPECT_EQ(mail.sent > 0, ranks > 1);
      }
  }
}

TEST(Farm, ExplicitStepsAndStatesHaveTheDigitsOfOneProcess) {
  const Outcomes here = inExplicitSteps(fieldHere(threeCells(), DynamicCells{}), 10, 20);
  for (const int ranks : {1, 2, 3, 5}) {
    LateMail mail(ranks, 11u * static_cast<unsigned>(ranks));
    const auto field = farmOf(DynamicCells{}, mail);
    EXPECT_EQ(inExplicitSteps(field, 10, 20), here) << ranks << " ranks";
    const FarmReport* const report = farmReport(*field);
    ASSERT_NE(report, nullptr);
    EXPECT_EQ(std::accumulate(report->points.begin(), report->points.end(), std::size_t{0}), 8u);
    EXPECT_EQ(report->moves > 0, ranks > 1);
    EXPECT_EQ(report->busy.size(), static_cast<std::size_t>(ranks));
  }
}

TEST(Farm, ThreadsOfItDoNotChangeADigit) {
  const auto outcomes = [](int threads) {
    return onThreads(threads, [] {
      LateMail mail(3, 5);
      return inLoadSteps(farmOf(QuasiStaticCells{}, mail));
    });
  };
  EXPECT_EQ(outcomes(1), outcomes(3));
}

TEST(Farm, StatesGoFromOneProcessToAFarmAndBack) {
  LateMail mail(3, 1);
  Asked here(fieldHere(threeCells(), QuasiStaticCells{}), 7), farm(farmOf(QuasiStaticCells{}, mail), 7);
  const Eigen::Matrix3d F = rve::plane(1.0, 2e-4, 0.0, 0.9996), G = rve::plane(1.0, 1e-4, 0.0, 0.9993);
  here(F), here.field().commit();
  ByteWriter fromHere;
  here.field().save(fromHere);
  ByteReader toFarm(fromHere.bytes());
  farm.field().load(toFarm);
  EXPECT_TRUE(toFarm.atEnd());
  EXPECT_EQ(here(G, true), farm(G, true));
  EXPECT_EQ(here.P, farm.P);
  EXPECT_EQ(here.tangent, farm.tangent);
  EXPECT_EQ(here.energy, farm.energy);
  EXPECT_EQ(here.dissipated, farm.dissipated);
  farm.field().commit();
  ByteWriter fromFarm;
  farm.field().save(fromFarm);
  ByteReader back(fromFarm.bytes());
  here.field().load(back);
  here.field().commit();
  EXPECT_EQ(here(F), farm(F));
}

TEST(Farm, DamagedStatesAreRefusedAndChangeNothing) {
  LateMail mail(3, 2);
  Asked farm(farmOf(QuasiStaticCells{}, mail), 5);
  const Eigen::Matrix3d F = rve::plane(1.0, 2e-4, 0.0, 0.9996);
  ByteWriter start;
  farm.field().save(start);
  std::vector<char> half = start.bytes(), fewer = start.bytes();
  half.resize(half.size() / 2);
  fewer[0] = 4;
  for (const std::vector<char>& bytes : {half, fewer}) {
    ByteReader damaged(bytes);
    EXPECT_THROW(farm.field().load(damaged), InputError);
  }
  ByteWriter after;
  farm.field().save(after);
  EXPECT_EQ(start.bytes(), after.bytes());
  EXPECT_EQ(farm(F), Asked(fieldHere(threeCells(), QuasiStaticCells{}), 5)(F));
}

TEST(Farm, PointsWithoutAnswerSayWhatTheySayInOneProcess) {
  LateMail mail(4, 3);
  Asked here(fieldHere(threeCells(), QuasiStaticCells{}), 6), farm(farmOf(QuasiStaticCells{}, mail), 6);
  here(rve::plane(1.5, 0.0, 0.0, 1.5)), farm(rve::plane(1.5, 0.0, 0.0, 1.5));
  EXPECT_FALSE(here.reason[5].empty());
  EXPECT_EQ(here.reason, farm.reason);
}

TEST(Farm, WhatGoesWrongAtAWorkerIsToldWithItsRank) {
  LateMail mail(2, 4);
  Asked farm(farmOf(DynamicCells{}, mail), 2);
  farm(rve::plane(1.0, 0.0, 0.0, 0.9995), false, 1.0, true);
  ByteWriter nothing;
  try {
    farm.field().save(nothing);  // where the step began was not kept
    FAIL();
  } catch (const NumericalError& error) {
    EXPECT_NE(std::string(error.what()).find("[rank 1]"), std::string::npos) << error.what();
  }
  farm.field().commit();
  farm.field().save(nothing);  // goes on
}

TEST(Farm, CellsOfOthersCanBeLookedAt) {
  LateMail mail(3, 6);
  Asked here(fieldHere(threeCells(), QuasiStaticCells{}), 130), farm(farmOf(QuasiStaticCells{}, mail), 130);
  const Eigen::Matrix3d F = rve::plane(1.0, 2e-4, 0.0, 0.9996);
  const auto stressesOf = [](const Asked& asked) {
    std::vector<Eigen::Matrix3d> stresses;
    for (std::size_t p = 0; p < 130; ++p)
      EXPECT_TRUE(visitCell(const_cast<Asked&>(asked).field(), p,
                            [&](const rve::Rve& cell) { stresses.push_back(rve::nominalStress(cell)); }));
    return stresses;
  };
  EXPECT_EQ(stressesOf(here), stressesOf(farm));
  here(F), farm(F);
  here.field().commit(), farm.field().commit();
  const auto after = stressesOf(farm);
  EXPECT_EQ(stressesOf(here), after);
  EXPECT_EQ(copiesAt(farm.field(), 129), 1);
  EXPECT_THROW(farm.field().point(130), std::out_of_range);
}

TEST(Farm, ADamagedShareIsToldUntilItIsLoadedAnew) {
  LateMail mail(2, 5);
  const auto field = farmedField(
      {std::make_shared<const std::vector<rve::Rve>>(threeCells()), QuasiStaticCells{}},
      [](const fem::PointPlace& place) { return place.element == 1 ? 99u : 0u; }, mail);
  EXPECT_NO_THROW(Asked(field, 1));
  Asked farm(field, 4);  // element 1 is rank 1's, and there is no sample 99
  const Eigen::Matrix3d F = rve::plane(1.0, 2e-4, 0.0, 0.9996);
  for (int again = 0; again < 2; ++again) {
    EXPECT_THROW(farm(F), LostError);
    farm.field().revert();
  }
  Asked other(farmOf(QuasiStaticCells{}, mail), 4);  // another field has no part in it
  EXPECT_EQ(other(F), Asked(fieldHere(threeCells(), QuasiStaticCells{}), 4)(F));
}

TEST(Farm, AskedForTangentsAloneAfterALoadItAnswersAll) {
  LateMail mail(3, 10);
  Asked here(fieldHere(threeCells(), QuasiStaticCells{}), 4), farm(farmOf(QuasiStaticCells{}, mail), 4);
  const Eigen::Matrix3d F = rve::plane(1.0, 2e-4, 0.0, 0.9996);
  for (Asked* const asked : {&here, &farm}) {
    ByteWriter start;
    asked->field().save(start);
    (*asked)(F);
    ByteReader back(start.bytes());
    asked->field().load(back);
    std::ranges::fill(asked->P, 0.0);
    (*asked)(F, true, 1.0, false, false);
  }
  EXPECT_NE(farm.P[0], 0.0);
  EXPECT_EQ(here.P, farm.P);
  EXPECT_EQ(here.dissipated, farm.dissipated);
  EXPECT_EQ(here.tangent, farm.tangent);
}

TEST(Farm, CellsWithMassesOfTheirOwnStay) {
  std::vector<rve::Rve> cells = threeCells();
  EXPECT_TRUE(mayTravel(cells));
  cells[1].inertia[0] *= 2.0;
  EXPECT_FALSE(mayTravel(cells));
}

TEST(Farm, OpenedAnewItBeginsAnew) {
  LateMail mail(3, 9);
  const auto field = farmOf(QuasiStaticCells{}, mail);
  const Eigen::Matrix3d F = rve::plane(1.0, 2e-4, 0.0, 0.9996);
  Asked first(field, 5);
  first(F), field->commit();
  Asked second(field, 3);
  EXPECT_EQ(second(F), Asked(fieldHere(threeCells(), QuasiStaticCells{}), 3)(F));
  EXPECT_EQ(farmReport(*field)->evaluations, 1);
}

TEST(Farm, TwoFieldsShareTheWorkers) {
  LateMail mail(3, 8);
  Asked one(farmOf(QuasiStaticCells{}, mail, FarmMoving::atRandom, oneCell()), 3);
  const Eigen::Matrix3d F = rve::plane(1.0, 2e-4, 0.0, 0.9996), G = rve::plane(1.0, 0.0, 0.0, 0.9998);
  {
    Asked other(farmOf(DynamicCells{}, mail), 4);
    EXPECT_EQ(other(G), Asked(fieldHere(threeCells(), DynamicCells{}), 4)(G));
    other.field().commit();
    EXPECT_EQ(one(F), Asked(fieldHere(oneCell(), QuasiStaticCells{}), 3)(F));
    one.field().commit();
  }
  EXPECT_EQ(one(F), Asked(fieldHere(oneCell(), QuasiStaticCells{}), 3)(F));
}

TEST(Farm, MovesShortenTheWaitUntilTheyDoNotPay) {
  std::mt19937 random(3);
  std::lognormal_distribution<double> seconds(-3.0, 0.7);
  for (const int ranks : {2, 5, 10}) {
    FarmLoads loads{{}, {}, std::vector<int>(static_cast<std::size_t>(ranks), 1)};
    loads.threads.back() = 2;
    for (int p = 0; p < 200; ++p) loads.owner.push_back(p % ranks), loads.seconds.push_back(seconds(random));
    const double before = std::ranges::max(timesOfRanks(loads));
    const std::vector<FarmMove> moves = worthwhileMoves(loads, 1e-4);
    EXPECT_TRUE(worthwhileMoves(loads, 1e3).empty());
    for (const FarmMove& move : moves) loads.owner[move.point] = move.to;
    const double total = std::accumulate(loads.seconds.begin(), loads.seconds.end(), 0.0);
    const double after = std::ranges::max(timesOfRanks(loads));
    EXPECT_LT(after, before);
    EXPECT_LT(after, 1.01 * total / (ranks + 1));
    EXPECT_TRUE(worthwhileMoves(loads, 1e-4).empty());
  }
}

TEST(Farm, AnIdleRankAndALongPointAreSeen) {
  const FarmLoads loads{{0, 0, 0}, {8.0, 1.0, 1.0}, {1, 1}};
  const std::vector<FarmMove> moves = worthwhileMoves(loads, 1e-3);
  FarmLoads after = loads;
  for (const FarmMove& move : moves) after.owner[move.point] = move.to;
  EXPECT_EQ(std::ranges::max(timesOfRanks(after)), 8.0);
  EXPECT_EQ(timesOfRanks({{0}, {4.0}, {4}}), std::vector<double>{4.0});
  EXPECT_TRUE(worthwhileMoves({{0, 0, 0, 0}, {8.0, 1.0, 1.0, 1.0}, {4, 4}}, 1e-3).empty());
}

TEST(Farm, ReplaysAreTheSumsOfWhatTheyReplay) {
  const RecordedStep step{{1.0, 2.0, 3.0, 4.0}, {1.0, 2.0, 3.0, 4.0}};
  const std::vector<RecordedStep> steps{step, step};
  const Replay alone = replay(steps, 1, 0.1, 0.1), two = replay(steps, 2, 0.0, 0.1),
               costly = replay(steps, 2, 0.5, 99.0);
  EXPECT_EQ(alone.alone, 40.0);
  EXPECT_EQ(alone.farm, 40.0);
  EXPECT_EQ(alone.moves, 0u);
  EXPECT_EQ(two.moves, 2u);  // 1 + 3 and 2 + 4 become 1 + 4 and 2 + 3
  EXPECT_DOUBLE_EQ(two.farm, 12.0 + 0.2 + 10.0);
  EXPECT_DOUBLE_EQ(costly.farm, 24.0 + 4 * 0.5);
}

}  // namespace
}  // namespace dovetail::hierarchical
