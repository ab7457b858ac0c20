// Energy, momentum and spin of those who come and go, within steps and between them.
#include <gtest/gtest.h>

#include "dovetail/dem/bodies/body_term.hpp"
#include "dovetail/dem/model/checkpoint.hpp"
#include "dovetail/dem/model/loads.hpp"
#include "dovetail/dem/model/walls.hpp"
#include "walls/wall_scenes.hpp"

namespace dovetail::dem {
namespace {

std::shared_ptr<const ContactLaws> rough() { return makeContactLaws(FrictionalLaw{{1e4, 0.5}, {3e3, 0.4, 0.2}}); }

/// Two grains that touch, and rub a plane.
Model rubbing() {
  Model m;
  m.laws = rough();
  m.gravity = {0, 0, -9.81};
  addWall(m, makePlane({}, {0, 0, 1}));
  addParticle(m.particles, {0, 0, 0.099}, {1, 0, 0}, 0.1, Mass{1.0});
  addParticle(m.particles, {0.199, 0, 0.099}, {0.5, 0, 0}, 0.1, Mass{1.0});
  return m;
}

ClumpShape rod() {
  return makeClumpShape(std::vector<Vec3>{{}, {0.1, 0, 0}}, std::vector<double>{0.1, 0.08}, Density{300.0});
}

TEST(Leavers, TakeTheHalfKickOfTheirSpinAlong) {
  const auto left = [](bool clump, bool closes) {
    Model m = rubbing();
    if (clump) addClump(m, rod(), {1, 0, 0.09}, {}, {1, 0, 0}, {0, 3, 0});
    for (int i = 0; i < 20; ++i) advance(m, 1e-4);
    if (closes) close(m);
    removeParticles(m, std::vector<int>{clump ? 2 : 0});
    return std::pair{m.booked.left, m.left.angularMomentum};
  };
  for (const bool clump : {false, true}) {
    const auto [energy, spin] = left(clump, false);
    const auto [expected, expectedSpin] = left(clump, true);
    EXPECT_NEAR(energy, expected, 1e-12 * std::abs(expected));
    EXPECT_LT(norm(spin - expectedSpin), 1e-13);
  }
}

TEST(Newcomers, ThatAreAddedBetweenStepsCountAsEnteredWithTheirContacts) {
  Model m = rubbing();
  run(m, 1e-4, 20);
  const Energies before = energies(m);
  addParticle(m.particles, {0.1, 0.16, 0.098}, {0, 0, 0.5}, 0.1, Mass{1.0});
  addClump(m, rod(), {0.1, -0.17, 0.09}, {}, {1, 0, 0}, {0, 3, 0});
  EXPECT_NEAR(energies(m).balance(), before.balance(), 1e-12);
  EXPECT_GT(energies(m).contacts, before.contacts + 0.1);
  const std::vector<char> state = saveState(m);
  run(m, 1e-5, 1);
  EXPECT_EQ(m.entered.count, 2);
  EXPECT_NEAR(m.entered.mass, 1.0 + bodies(m).bodies.mass[0], 1e-12);
  EXPECT_NEAR(energies(m).balance(), before.balance(), 1e-3 * m.booked.entered);
  Model other;
  other.laws = m.laws;
  loadState(state, "state", other);
  run(other, 1e-5, 1);
  EXPECT_EQ(saveState(other), saveState(m));
}

TEST(Newcomers, TheFirstOnesOfAModelHaveNotEntered) {
  Model m = rubbing();
  run(m, 1e-4, 20);
  EXPECT_EQ(m.entered.count, 0);
  EXPECT_EQ(m.booked.entered, 0.0);
}

TEST(Newcomers, LawsThatAreExchangedBringWhatContactsStoreMore) {
  Model m = rubbing();
  run(m, 1e-4, 20);
  const Energies before = energies(m);
  m.laws = makeContactLaws(FrictionalLaw{{2e4, 0.5}, {6e3, 0.4, 0.2}});
  const Energies after = energies(m);
  EXPECT_NEAR(after.contacts, 2.0 * before.contacts, 1e-9);
  EXPECT_NEAR(after.balance(), before.balance(), 1e-12);
}

/// Puts a grain on another one and on the floor, in one step.
class Thrower final : public Term {
public:
  std::string name() const override { return "thrower"; }
  std::unique_ptr<Term> clone() const override { return std::make_unique<Thrower>(*this); }
  void exchange(Model& m, const Step& step) override {
    if (step.number != 10) return;
    const std::size_t first = m.particles.size();
    addParticle(m.particles, {0.1, 0.16, 0.098}, {0, 0, 0.5}, 0.1, Mass{1.0});
    admitParticles(m, first);
  }
};

TEST(Newcomers, ThatTouchSomebodyWithinAStepBringTheEnergyOfTheirContacts) {
  const auto residual = [](double dt) {
    Model m = rubbing();
    m.terms.add(Thrower());
    const double start = energies(m).balance();
    run(m, dt, 12);
    EXPECT_EQ(m.entered.count, 1);
    return std::abs(energies(m).balance() - start);
  };
  EXPECT_LT(residual(1e-5), 1e-3);  // of 0.3 J
  EXPECT_LT(residual(1e-6), 1e-4);
}

TEST(Clumps, TurnTheirMembersFromTheStart) {
  Model m;
  m.laws = rough();
  addClump(m, rod(), {}, {}, {}, {0, 0, 7});
  findForces(m);
  for (const Vec3& spin : m.particles.omega) EXPECT_LT(norm(spin - Vec3{0, 0, 7}), 1e-13);
}

TEST(Clumps, LongerThanAPeriodAreRefused) {
  const auto with = [](double length, bool first) {
    Model m;
    m.laws = rough();
    const auto shape =
        makeClumpShape(std::vector<Vec3>{{}, {length - 0.2, 0, 0}}, std::vector<double>{0.1, 0.1}, Density{300.0});
    const auto repeat = [&] { m.pairs.setPeriodicity({{{}, {1, 1, 1}}, {false, true, false}}); };
    if (first) repeat();
    addClump(m, shape, {0.5, 0.5, 0.5});
    if (!first) repeat();
    run(m, 1e-5, 1);
  };
  for (const bool first : {true, false}) {
    EXPECT_NO_THROW(with(0.99, first));
    try {
      with(1.01, first);
      FAIL();
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find("clump of body 0"), std::string::npos) << error.what();
    }
  }
}

TEST(BondTouching, TwiceMakesNoBondTwiceAndNeedsNoList) {
  for (const bool listed : {true, false}) {
    Particles p;
    for (int i = 0; i < 4; ++i) addParticle(p, {0.2 * i, 0, 0}, {}, 0.1, Mass{1.0});
    PairList list;
    if (listed) findPairs(p, list);
    Bonds all;
    const BondMaterial material{
        .youngsModulus = 1e6, .poissonRatio = 0.2, .tensileStrength = 1e9, .shearStrength = 1e9};
    EXPECT_EQ(bondTouching(all, p, list, 1e-6, material), 3);
    EXPECT_EQ(bondTouching(all, p, list, 1e-6, material), 0);
    EXPECT_EQ(bondTouching(all, p, list, 0.21, material), 2) << "neighbours but one, beyond the skin";
    EXPECT_EQ(all.size(), 5u);
  }
}

}  // namespace
}  // namespace dovetail::dem
