// Grains that go on in another model from a state, with what their contacts remember.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "dovetail/core/error.hpp"
#include "dovetail/dem/bodies/body_term.hpp"
#include "dovetail/dem/model/checkpoint.hpp"
#include "dovetail/dem/setup/packing.hpp"

namespace dovetail::dem {
namespace {

constexpr double dt = 1e-4;  // s

void expectSaid(const std::string& text, const std::string& part) {
  EXPECT_NE(text.find(part), std::string::npos) << text << " lacks " << part;
}

std::shared_ptr<const ContactLaws> sliding(double friction) {
  return makeContactLaws(FrictionalLaw{{.stiffness = 2e4}, {.stiffness = 6e3, .friction = friction}});
}

/// Spheres that rub against each other in a periodic box.
Model rubbing() {
  Model m;
  m.laws = sliding(0.6);
  m.pairs.setPeriodicity({{{0, 0, 0}, {0.4, 0.4, 0.4}}, {true, true, true}});
  addPacking(m.particles, fillWithLattice(Lattice::simpleCubic, {{0, 0, 0}, {0.4, 0.4, 0.4}}, 0.05, 0.0999), {2500.0});
  for (std::size_t i = 0; i < m.particles.size(); ++i) m.particles.v[i].y = m.particles.x[i].x < 0.2 ? 0.1 : -0.1;
  return m;
}

std::string refusalOfGrains(const Model& from, Model to) {
  const std::vector<char> before = saveState(to);
  try {
    loadGrains(saveState(from), "state", to);
  } catch (const InputError& error) {
    EXPECT_TRUE(saveState(to) == before);
    return error.what();
  }
  return "nothing";
}

TEST(GrainsOfAState, AreLookedAtWhateverTheirLaws) {
  Model whole = rubbing();
  run(whole, dt, 50);
  std::vector<char> bytes = saveState(whole);
  const Model content = contentOf(bytes, "state");
  EXPECT_EQ(content.particles.x, whole.particles.x);
  EXPECT_EQ(content.particles.id, whole.particles.id);
  EXPECT_EQ(content.pairs.pairs(), whole.pairs.pairs());
  EXPECT_EQ(content.pairs.periodicity(), whole.pairs.periodicity());
  EXPECT_EQ(content.time, whole.time);
  bytes.resize(bytes.size() - 1);
  EXPECT_THROW(contentOf(bytes, "state"), InputError);
}

TEST(GrainsOfAState, GoOnWithTheSpringsOfTheirContacts) {
  Model whole = rubbing();
  run(whole, dt, 200);
  Model empty = rubbing();
  empty.particles = {};
  Model taken = empty;
  loadGrains(saveState(whole), "state", taken);
  Model forgetful = empty;
  forgetful.particles = whole.particles;
  for (Model* m : {&whole, &taken, &forgetful}) run(*m, dt, 100);
  double apart = 0.0, without = 0.0;
  for (std::size_t i = 0; i < whole.particles.size(); ++i) {
    apart = std::max(apart, norm(taken.particles.v[i] - whole.particles.v[i]));
    without = std::max(without, norm(forgetful.particles.v[i] - whole.particles.v[i]));
  }
  EXPECT_LT(apart, 1e-13);
  EXPECT_GT(without, 1e-4);
  EXPECT_EQ(taken.steps, 100);
}

TEST(GrainsOfAState, ThoseTakenOutBeforeTheStartAreInNoBook) {
  Model whole = rubbing();
  run(whole, dt, 200);
  Model taken = rubbing();
  taken.particles = {};
  loadGrains(saveState(whole), "state", taken);
  removeParticles(taken, std::vector<int>{0, 1, 2, 3});
  findForces(taken);
  const double before = energies(taken).balance();
  advance(taken, dt);
  close(taken);
  EXPECT_NEAR(energies(taken).balance(), before, 1e-4 * energies(taken).contacts);
}

TEST(GrainsOfAState, AreRefusedWhereTheyDoNotFit) {
  Model empty = rubbing();
  empty.particles = {};
  EXPECT_EQ(refusalOfGrains(rubbing(), empty), "nothing");
  expectSaid(refusalOfGrains(rubbing(), rubbing()), "holds particles already");
  Model other = empty;
  other.laws = sliding(0.61);
  expectSaid(refusalOfGrains(rubbing(), other), "parameters of the laws");
  other = empty;
  other.pairs.setPeriodicity({{{0, 0, 0}, {0.4, 0.4, 0.5}}, {true, true, true}});
  expectSaid(refusalOfGrains(rubbing(), other), "periodic space of the state differs");
  Model weighed = rubbing();
  weighed.particles.weight.assign(weighed.particles.size(), 0.5);
  expectSaid(refusalOfGrains(weighed, empty), "have weights of an overlap");
  other = empty;
  other.pairs.setPeriodicity({});
  Model clumped = other;
  addClump(clumped,
           makeClumpShape(std::vector<Vec3>{{0, 0, 0}, {0.03, 0, 0}}, std::vector<double>{0.03, 0.03}, Density{1e3}),
           {});
  expectSaid(refusalOfGrains(clumped, other), "which cannot be read with the grains alone");
}

}  // namespace
}  // namespace dovetail::dem
