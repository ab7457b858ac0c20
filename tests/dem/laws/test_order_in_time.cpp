// Velocities and losses of impacts are of second order in the step, under every law, between grains and with walls.
#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>

#include "dovetail/dem/laws/contact_laws.hpp"
#include "dovetail/dem/model/model.hpp"
#include "dovetail/dem/model/walls.hpp"
#include "dovetail/dem/setup/relax.hpp"
#include "walls/wall_scenes.hpp"

namespace dovetail::dem {
namespace {

using Laws = std::shared_ptr<const ContactLaws>;

constexpr double stiffness = 1e4;
const double contactTime = std::numbers::pi * std::sqrt(0.5 / stiffness);

template <class Normal, class Tangential, class Rolling, class Adhesion>
Laws lawsOf(const Normal& normal, const Tangential& tangential, const Rolling& rolling, const Adhesion& adhesion) {
  return makeContactLaws(ContactLaw<Normal, Tangential, Rolling, Adhesion>{normal, tangential, rolling, adhesion});
}

/// Grains of 1 kg at places far from each other.
void addGrain(Model& m, const Vec3& x, const Vec3& v, Random& random) {
  addParticle(m.particles, x, v, 0.5, Mass{1.0});
  if (!m.laws->rotates()) return;
  switchOnRotation(m.particles);
  m.particles.omega.back() = random.vector(1.0);
}

/// Pairs that collide obliquely, each at its own moment of a step.
Model collisions(const Laws& laws) {
  Model m;
  m.laws = laws;
  Random random(3);
  for (int k = 0; k < 60; ++k) {
    const Vec3 place{4.0 * k, 0, 0}, along = normalized(random.vector(1.0) + Vec3{0, 0, 1e-9});
    const Vec3 drift = random.vector(1.0), other = drift - random(0.25, 0.5) * along;
    addGrain(m, place, drift + random(0.25, 0.5) * along + random.vector(0.25), random);
    addGrain(m, place + (1.0 + random(1e-4, 0.02)) * along, other, random);
  }
  return m;
}

/// Grains that hit a floor, of one plane or of facets, which goes up and along.
Model landings(const Laws& laws, bool facets) {
  Model m;
  m.laws = laws;
  Random random(4);
  for (int k = 0; k < 60; ++k)
    addGrain(m, {4.0 * (k % 8), 4.0 * (k / 8), 0.5 + random(1e-4, 0.02)},
             {random(-0.5, 0.5), random(-0.5, 0.5), random(-1.0, -0.5)}, random);
  if (facets) {
    MeshWall& mesh = addWall(m, MeshWall{});
    mesh.wall = squares(1, 1, 60.0);
    for (Vec3& x : mesh.wall.x) x -= Vec3{13.1, 17.3, 0.0};
    prescribe(mesh, steadyMotion({{}, {}, {0.1, 0, 0.2}, {}}), {});
  } else {
    addWall(m, makePlane({}, {0, 0, 1})).velocity = {0.1, 0, 0.2};
  }
  return m;
}

/// What is left of each grain: velocity and surface speed, m/s.
std::vector<std::array<Vec3, 2>> after(Model m, int stepsPerContact) {
  m.booking = Booking::off;
  run(m, contactTime / stepsPerContact, 8 * stepsPerContact);
  std::vector<std::array<Vec3, 2>> left;
  for (std::size_t i = 0; i < m.particles.size(); ++i)
    left.push_back({m.particles.v[i], m.particles.rotates() ? 0.5 * m.particles.omega[i] : Vec3{}});
  return left;
}

double medianError(const Model& m, int stepsPerContact) {
  const auto found = after(m, stepsPerContact), right = after(m, 1280);
  std::vector<double> errors;
  for (std::size_t i = 0; i < right.size(); ++i)
    errors.push_back(std::sqrt((squaredNorm(found[i][0] - right[i][0]) + squaredNorm(found[i][1] - right[i][1])) /
                               (squaredNorm(right[i][0]) + squaredNorm(right[i][1]))));
  std::ranges::nth_element(errors, errors.begin() + 30);
  return errors[30];
}

/// Fourfold per halving, but for what phases make of it.
void expectSecondOrder(const std::string& name, const Model& m) {
  const double coarse = medianError(m, 20), fine = medianError(m, 80);
  EXPECT_LE(coarse, 2e-3) << name;
  EXPECT_LE(fine, std::max(coarse / 7.0, 2e-5)) << name << ": " << coarse;
}

TEST(OrderInTime, IsTwoUnderEveryLaw) {
  const LinearSpringDashpot linear{stiffness, 0.5}, pulling{stiffness, 0.5, true};
  const TangentialSpring friction{2.0 / 7.0 * stiffness, 0.3}, damped{2.0 / 7.0 * stiffness, 0.3, 0.5};
  const HertzDashpot hertz{.effectiveModulus = 15000.0, .restitution = 0.5}, hertzPulling{15000.0, 0.5, true};
  const MindlinSpring mindlin{.stiffnessRatio = 0.8, .friction = 0.3};
  const NoRolling noRolling;
  const NoAdhesion nothing;
  const std::vector<std::pair<std::string, Laws>> all{
      {"linear", makeContactLaws(ElasticLaw{linear})},
      {"linear, pulling", makeContactLaws(ElasticLaw{pulling})},
      {"friction", lawsOf(linear, friction, noRolling, nothing)},
      {"friction without dashpot", lawsOf(LinearSpringDashpot{stiffness}, friction, noRolling, nothing)},
      {"damped friction", lawsOf(linear, damped, noRolling, nothing)},
      {"cohesion", lawsOf(linear, friction, noRolling, Cohesion{ConstantCohesion{5.0}})},
      {"bridge", lawsOf(linear, friction, noRolling, LiquidBridge{2.0, 1e-3, 0.2})},
      {"Hertz", makeContactLaws(HertzLaw{hertz})},
      {"Hertz, pulling", makeContactLaws(HertzLaw{hertzPulling})},
      {"Hertz-Mindlin", lawsOf(hertz, mindlin, noRolling, nothing)},
      {"elastic-plastic",
       lawsOf(ElasticPlastic{stiffness, 3.0 * stiffness, 0.5 * stiffness, 0.1}, friction, noRolling, nothing)}};
  for (const auto& [name, laws] : all) {
    expectSecondOrder(name, collisions(laws));
    expectSecondOrder(name + ", plane", landings(laws, false));
    expectSecondOrder(name + ", facets", landings(laws, true));
  }
}

/// Where friction turns the spin fast, so that a couple at its limit turns too: sliders follow at first order.
TEST(OrderInTime, IsOneOfSlidersThatTurn) {
  const auto laws = lawsOf(LinearSpringDashpot{stiffness, 0.5}, TangentialSpring{2.0 / 7.0 * stiffness, 0.3},
                           RollingAndTwisting{{0.1, 0.2, 0.1}, {0.05, 0.1, 0.1}}, NoAdhesion{});
  expectSecondOrder("rolling", collisions(laws));
  for (const bool facets : {false, true}) {
    const double coarse = medianError(landings(laws, facets), 20), fine = medianError(landings(laws, facets), 80);
    EXPECT_LE(coarse, 4e-3);
    EXPECT_LE(fine, coarse / 3.0);
  }
}

/// A grain that was stopped by hand has no acceleration that a dashpot may count on.
TEST(OrderInTime, ForgottenVelocitiesAreNotCarriedOn) {
  Model m;
  m.laws = makeContactLaws(ElasticLaw{{stiffness, 0.3}});
  for (const double x : {-0.499, 0.499}) addParticle(m.particles, {x, 0, 0}, {-x, 0, 0}, 0.5, Mass{1.0});
  addWall(m, makePlane({0, 0, -0.499}, {0, 0, 1}));
  run(m, 0.02 * contactTime, 10);
  stop(m);
  Model fresh;
  fresh.laws = m.laws;
  for (std::size_t i = 0; i < 2; ++i) addParticle(fresh.particles, m.particles.x[i], {}, 0.5, Mass{1.0});
  addWall(fresh, makePlane({0, 0, -0.499}, {0, 0, 1}));
  findForces(m);
  findForces(fresh);
  for (Model* const model : {&m, &fresh}) run(*model, 0.02 * contactTime, 1);
  EXPECT_LE(norm(m.particles.v[0] - fresh.particles.v[0]), 1e-13 * norm(fresh.particles.v[0]));
  EXPECT_GT(norm(fresh.particles.v[0]), 0.0);
}

}  // namespace
}  // namespace dovetail::dem
