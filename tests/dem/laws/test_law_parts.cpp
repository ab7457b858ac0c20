// Parts of contact laws one by one: energies and their derivatives, losses, limits, refused input.
#include <gtest/gtest.h>

#include <numbers>

#include "dovetail/core/error.hpp"
#include "dovetail/dem/laws/adhesion.hpp"
#include "dovetail/dem/laws/elastic_plastic.hpp"
#include "dovetail/dem/laws/materials.hpp"
#include "dovetail/dem/laws/restitution.hpp"
#include "dovetail/dem/laws/rolling.hpp"
#include "walls/wall_scenes.hpp"

namespace dovetail::dem {
namespace {

constexpr double pi = std::numbers::pi;

Contact contactAt(double overlap) {
  Contact contact;
  contact.overlap = overlap;
  contact.effectiveMass = 0.3;
  contact.rootMass = std::sqrt(0.3);
  contact.effectiveRadius = 0.02;
  contact.normal = {0, 0, 1};
  contact.dt = 1e-4;
  contact.inverseDt = 1e4;
  contact.overlapBefore = overlap;
  return contact;
}

/// Force along the normal against the derivative of the energy with respect to the overlap.
template <class Law>
void expectForceIsSlopeOfEnergy(const Law& law) {
  const auto prepared = law.prepare();
  const auto at = [&](double overlap) {
    double memory[13] = {};
    return prepared.respond(contactAt(overlap), memory);
  };
  for (const double overlap : {1e-5, 1e-4, 1e-3}) {
    const double h = 1e-4 * overlap;
    const double slope = (at(overlap + h).work.elasticEnergy - at(overlap - h).work.elasticEnergy) / (2.0 * h);
    EXPECT_NEAR(at(overlap).force.z, slope, 1e-7 * (std::abs(slope) + 1e5 * overlap));
  }
}

TEST(LawParts, ElasticAndAdhesiveForcesAreSlopesOfTheirEnergies) {
  expectForceIsSlopeOfEnergy(HertzLaw{{1e9}});
  expectForceIsSlopeOfEnergy(ContactLaw<HertzDashpot, NoTangential, NoRolling, ConstantCohesion>{{1e9}, {}, {}, {0.7}});
  expectForceIsSlopeOfEnergy(
      ContactLaw<HertzDashpot, NoTangential, NoRolling, LinearCohesion>{{1e9}, {}, {}, {1e3, 1e5}});
  expectForceIsSlopeOfEnergy(ContactLaw<HertzDashpot, NoTangential, NoRolling, DmtAdhesion>{{1e9}, {}, {}, {0.3}});
  const ContactLaw<HertzDashpot, NoTangential, NoRolling, DmtAdhesion> dmt{{1e9}, {}, {}, {0.3}};
  EXPECT_NEAR(dmt.prepare().respond(contactAt(0.0), nullptr).force.z, -2.0 * pi * 0.3 * 0.02, 1e-15);
}

TEST(LawParts, HertzAndMindlinStiffnessesAreThoseOfTheBooks) {
  const Material a{70e9, 0.3, 2700.0}, b{200e9, 0.28, 7800.0};
  const auto law = hertzMindlin(a, b, {1.0, 0.5});
  const double overlap = 1e-5, radius = 0.02, area = std::sqrt(radius * overlap);
  const double modulus = 1.0 / ((1.0 - 0.09) / 70e9 + (1.0 - 0.28 * 0.28) / 200e9);
  const double shear = 1.0 / (1.7 / (70e9 / 2.6) + 1.72 / (200e9 / 2.56));
  double memory[4] = {};
  const ContactSlopes slopes = law.prepare().slopes(contactAt(overlap), memory);
  EXPECT_NEAR(slopes.normal.stiffness, 2.0 * modulus * area, 1e-6 * modulus * area);
  EXPECT_NEAR(slopes.tangential.stiffness, 8.0 * shear * area, 1e-6 * shear * area);
  EXPECT_NEAR(mindlinRatio(a, a), 2.0 * 0.7 / 1.7, 1e-14);
}

/// Work of a force along a path of overlaps, by the trapezoidal rule, and what the law stores and loses on it.
struct Path {
  double worst = 0.0, lost = 0.0, stored = 0.0, work = 0.0, leastLoss = 0.0, leastForce = 0.0;
};

Path follow(const ElasticPlastic& part, const std::function<double(double)>& overlapAt, int steps) {
  const auto prepared = ContactLaw<ElasticPlastic>{part}.prepare();
  double memory[2] = {}, before = 0.0, forceBefore = 0.0;
  Path path;
  for (int s = 1; s <= steps; ++s) {
    const Contact contact = contactAt(overlapAt(static_cast<double>(s) / steps));
    const ContactResponse response = prepared.respond(contact, memory);
    path.work += 0.5 * (response.force.z + forceBefore) * (contact.overlap - before);
    path.lost += response.work.lostPower() * contact.dt;
    path.stored = response.work.storedEnergy();
    path.leastLoss = std::min(path.leastLoss, response.work.plasticPower);
    path.leastForce = std::min(path.leastForce, response.force.z);
    path.worst = std::max(path.worst, std::abs(path.work - path.lost - path.stored));
    before = contact.overlap;
    forceBefore = response.force.z;
  }
  return path;
}

TEST(LawParts, PlasticContactsBookWhatTheyTake) {
  // In, out, in deeper, out into the pull, in again, and away.
  const auto overlapAt = [](double s) { return 1e-3 * (0.5 + 0.4 * s) * (1.0 - std::cos(6.0 * pi * s)); };
  for (const double cohesion : {0.0, 3e4}) {
    const ElasticPlastic part{1e5, 4e5, cohesion};
    const Path coarse = follow(part, overlapAt, 4000), fine = follow(part, overlapAt, 8000);
    EXPECT_LE(fine.worst, 1e-5 * fine.lost);
    EXPECT_NEAR(coarse.worst / fine.worst, 4.0, 2.5);  // only the trapezoidal rule errs, at the kinks
    EXPECT_GE(fine.leastLoss, 0.0);
    EXPECT_GE(fine.stored, 0.0);
    EXPECT_EQ(fine.leastForce<-1.0, cohesion> 0.0);
    EXPECT_EQ(fine.leastForce<0.0, cohesion> 0.0);
  }
}

TEST(LawParts, AContactCutOffInItsPullLosesTheRestOfTheDent) {
  const ElasticPlastic part{1e5, 4e5, 3e4};
  const auto prepared = part.prepare();
  double memory[1] = {};
  prepared.respond(contactAt(1e-3), memory);
  const double overlap = 0.3e-3;  // on −k_c δ
  const NormalResponse last = prepared.respond(contactAt(overlap), memory);
  EXPECT_NEAR(last.force, -3e4 * overlap, 1e-10);
  // What is stored, and what pulling the grains apart takes.
  EXPECT_NEAR(prepared.remembered(memory), last.energy + 0.5 * 3e4 * overlap * overlap, 1e-12);
}

TEST(LawParts, DashpotsForARestitutionAreInverse) {
  for (const double e : {0.001, 0.01, 0.1, 0.13533, 0.14, 0.5, 0.9, 1.0}) {
    EXPECT_NEAR(reboundWithoutTension(dampingRatioWithoutTension(e)), e, 1e-9);
    EXPECT_NEAR(reboundWithoutTension(dampingRatioOf(e)), restitutionWithoutTension(e), 1e-12);
  }
  EXPECT_NEAR(reboundWithoutTension(0.99999), reboundWithoutTension(1.00001), 1e-4);
}

/// The displacements of one step at the velocities that the contact has.
void moveOn(Contact& contact) {
  contact.separated = contact.dt * contact.separating;
  contact.slipped = contact.dt * contact.slip;
  contact.turned = contact.dt * contact.spin;
}

/// What happens to a memory before the law answers.
template <class Law>
void carryMemory(double* memory, const Vec3& normal, double twist) {
  for (int c = 0; c < Law::memory; ++c) {
    if ((Law::carries >> c & 1u) == 0) continue;
    const Vec3 now = carried({memory[c], memory[c + 1], memory[c + 2]}, normal, twist);
    for (int k = 0; k < 3; ++k) memory[c + k] = now[k];
  }
}

/// A law in two roles: particle and partner exchanged.
TEST(LawParts, RolesCanChange) {
  using Law = ContactLaw<ElasticPlastic, MindlinSpring, RollingAndTwisting>;
  const Law law{{1e5, 4e5, 3e4}, {0.8, 0.3, 0.5}, {{0.2, 0.5, 0.1}, {0.1, 0.3, 0.2}}, {}};
  const auto prepared = law.prepare();
  Random random(5);
  double memory[Law::memory] = {}, turned[Law::memory] = {}, couples = 0.0;
  Contact contact = contactAt(1e-3);
  for (int s = 0; s < 50; ++s) {
    contact.normal = normalized(contact.normal + random.vector(1e-2));
    contact.overlap = random(0.5e-3, 1e-3);
    contact.separating = random(-1.0, 1.0);
    contact.slip = random.vector(0.5);
    contact.slip -= dot(contact.slip, contact.normal) * contact.normal;
    contact.spin = random.vector(10.0);
    moveOn(contact);
    Contact mirrored = contact;
    for (Vec3* v : {&mirrored.normal, &mirrored.slip, &mirrored.spin, &mirrored.slipped, &mirrored.turned}) *v = -*v;
    const double twist = random(-1e-2, 1e-2);
    carryMemory<Law>(memory, contact.normal, twist);
    carryMemory<Law>(turned, mirrored.normal, -twist);
    const ContactResponse a = prepared.respond(contact, memory), b = prepared.respond(mirrored, turned);
    EXPECT_LE(norm(a.force + b.force), 1e-12 * norm(a.force));
    EXPECT_LE(norm(a.couple + b.couple), 1e-12 * norm(a.couple) + 1e-15);
    couples += norm(a.couple);
    for (int c = 0; c < Law::memory; ++c) {
      const double sign = (Law::turns >> c & 1u) != 0 ? -1.0 : 1.0;
      EXPECT_NEAR(memory[c], sign * turned[c], 1e-13 * std::abs(memory[c]));
    }
  }
  EXPECT_GT(couples, 0.0);
}

/// Any path of slip, spin and load: springs store, sliders and dashpots lose, nothing is gained. The work of the
/// springs by the trapezoidal rule is what they store and lose, to the last digits.
TEST(LawParts, NoTangentialOrRollingPathCreatesEnergy) {
  using Law = ContactLaw<HertzDashpot, MindlinSpring, RollingAndTwisting>;
  for (const double damping : {0.0, 1.0}) {
    const Law law{{1e8, 0.5}, {0.8, 0.3, damping}, {{0.2, 0.5, damping}, {0.1, 0.3, damping}}, {}};
    const auto prepared = law.prepare();
    Random random(6);
    double memory[Law::memory] = {}, energy = 0.0, least = 0.0, worst = 0.0, total = 0.0;
    Vec3 force, couple;
    Contact contact = contactAt(1e-3);
    for (int s = 0; s < 20000; ++s) {
      if (s % 50 == 0) {
        contact.overlap = contact.overlapBefore = random(0.0, 1e-3);
        contact.slip = random.vector(0.2);
        contact.slip.z = 0.0;
        contact.spin = random.vector(5.0);
        moveOn(contact);
      }
      const ContactResponse r = prepared.respond(contact, memory);
      const Vec3 tangential{r.force.x, r.force.y, 0.0};
      const double dashpots = r.work.dissipatedPower;  // that of the normal one is nought: nothing approaches
      const double lost = (r.work.frictionPower + r.work.rollingPower + dashpots) * contact.dt;
      const double now = r.work.tangentialEnergy + r.work.rollingEnergy;
      const double in =
          -0.5 * contact.dt * (dot(tangential + force, contact.slip) + dot(r.couple + couple, contact.spin));
      least = std::min(least, lost);
      worst = std::max(worst, std::abs(in - (now - energy) - lost));
      total += lost;
      energy = now;
      force = tangential;
      couple = r.couple;
    }
    EXPECT_GT(total, 0.0);
    EXPECT_GE(least, -1e-4 * total);  // where a spring that falls behind its load is turned round within a step
    if (damping == 0.0) {
      EXPECT_LE(worst, 1e-14 * total);
    }
  }
}

TEST(LawParts, CouplesAreLimitedByTheirFriction) {
  using Law = ContactLaw<HertzDashpot, NoTangential, RollingAndTwisting>;
  const Law law{{1e9}, {}, {{0.2, 0.5}, {0.1, 0.3}}, {}};
  const auto prepared = law.prepare();
  double memory[Law::memory] = {};
  Contact contact = contactAt(1e-4);
  contact.spin = {30.0, 40.0, 70.0};
  moveOn(contact);
  ContactResponse last;
  for (int s = 0; s < 1000; ++s) last = prepared.respond(contact, memory);
  const double repulsion = last.force.z, radius = contact.effectiveRadius;
  EXPECT_LE(norm(last.couple -
                 Vec3{-0.6 * 0.2 * radius * repulsion, -0.8 * 0.2 * radius * repulsion, -0.1 * radius * repulsion}),
            1e-12 * norm(last.couple));
  EXPECT_NEAR(last.work.rollingPower, radius * repulsion * (0.2 * 50.0 + 0.1 * 70.0), 1e-9 * last.work.rollingPower);
}

TEST(LawParts, MixingRules) {
  EXPECT_DOUBLE_EQ(mean(Mean::harmonic, 2.0, 6.0), 3.0);
  EXPECT_DOUBLE_EQ(mean(Mean::geometric, 2.0, 8.0), 4.0);
  EXPECT_DOUBLE_EQ(mean(Mean::arithmetic, 2.0, 8.0), 5.0);
  EXPECT_DOUBLE_EQ(mean(Mean::smaller, 2.0, 8.0), 2.0);
  EXPECT_DOUBLE_EQ(mean(Mean::larger, 2.0, 8.0), 8.0);
  const std::vector<Material> materials{{70e9, 0.3, 2700.0}, {INFINITY, 0.3, 0.0}, {200e9, 0.28, 7800.0}};
  const std::vector<Surface> surfaces{{0.9, 0.2}, {0.9, 0.8}, {0.4, 0.2}};
  const auto table = hertzMindlinTable(materials, surfaces);
  EXPECT_DOUBLE_EQ(table.at(1, 0).tangential.friction, 0.4);
  EXPECT_DOUBLE_EQ(table.at(2, 0).normal.restitution, 0.6);
  EXPECT_DOUBLE_EQ(table.at(2, 1).normal.effectiveModulus, 200e9 / (1.0 - 0.28 * 0.28));
}

TEST(LawParts, TheEquivalentSpringGoesAsDeepAsHertz) {
  const Material a{70e9, 0.3, 2700.0};
  const double radius = 0.01, mass = 0.02, speed = 3.0;
  const auto law = hertzMindlin(a, a, {});
  const double k = equivalentStiffness(a, a, radius, mass, speed);
  EXPECT_NEAR(speed * std::sqrt(mass / k) / law.normal.largestOverlap(mass, radius, speed), 1.0, 1e-12);
}

template <class Part>
void expectRefused(const Part& part, const std::string& field) {
  try {
    validate(part);
    ADD_FAILURE() << field << " was taken";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("[" + field + "]: "), std::string::npos) << error.what();
  }
}

TEST(LawParts, BadParametersAreRefusedWithFieldAndRemedy) {
  expectRefused(HertzDashpot{0.0}, "effective modulus");
  expectRefused(HertzDashpot{1e9, 0.0}, "restitution");
  expectRefused(HertzDashpot{1e9, NAN}, "restitution");
  expectRefused(HertzDashpot{1e9, 0.5, true, true}, "nominal");
  expectRefused(MindlinSpring{0.0, 0.1}, "ratio of tangential to normal stiffness");
  expectRefused(MindlinSpring{0.8, -0.1}, "friction coefficient");
  expectRefused(MindlinSpring{0.8, 0.1, INFINITY}, "damping ratio of the tangential spring");
  expectRefused(ElasticPlastic{0.0, 1.0}, "loading stiffness");
  expectRefused(ElasticPlastic{2.0, 1.0}, "unloading stiffness");
  expectRefused(ElasticPlastic{1.0, 2.0, -1.0}, "cohesion stiffness");
  expectRefused(ElasticPlastic{1.0, 2.0, 0.0, NAN}, "damping ratio");
  expectRefused(RollingResistance{-0.1, 1.0}, "rolling friction");
  expectRefused(RollingResistance{0.1, 0.0}, "rolling stiffness ratio");
  expectRefused(TwistingResistance{0.1, 1.0, -1.0}, "twisting damping ratio");
  expectRefused(ConstantCohesion{-1.0}, "cohesion force");
  expectRefused(LinearCohesion{1.0, NAN}, "cohesion pressure");
  expectRefused(DmtAdhesion{-1.0}, "work of adhesion");
  EXPECT_NO_THROW(validate(ElasticPlastic{1.0, 1.0}));
  const Material good{1e9, 0.3, 1000.0}, rigid{INFINITY, 0.3, 0.0};
  EXPECT_THROW(hertzMindlin(good, {0.0, 0.3, 1.0}, {}), InputError);
  EXPECT_THROW(hertzMindlin(good, {1e9, 0.6, 1.0}, {}), InputError);
  EXPECT_THROW(hertzMindlin({1e9, 0.3, -1.0}, good, {}), InputError);
  EXPECT_THROW(hertzMindlin(rigid, rigid, {}), InputError);
  EXPECT_THROW(hertzMindlin(good, rigid, {0.0, 0.1}), InputError);
  EXPECT_THROW(prepare(HertzLaw{{1e9, 0.0}}), InputError);
  LawTable<HertzLaw> table(3, HertzLaw{{1e9}});
  table.set(2, 1, HertzLaw{{1e9, 1.5}});
  try {
    prepare(table);
    ADD_FAILURE() << "a restitution of 1.5 was taken";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("[law between materials 1 and 2]"), std::string::npos) << error.what();
  }
  EXPECT_THROW(hertzMindlinTable(std::vector<Material>{good}, {}), InputError);
  EXPECT_THROW(hertzMindlinTable(std::vector<Material>{rigid}, std::vector<Surface>{{}}), InputError);
}

}  // namespace
}  // namespace dovetail::dem
