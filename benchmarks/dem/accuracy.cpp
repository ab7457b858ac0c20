// Error against run time, law by law: pairs of spheres that collide obliquely and spin, each pair on its own, so that
// errors do not grow with time and all of them are the integrator's and the law's.
#include <algorithm>
#include <cmath>
#include <ostream>
#include <random>

#include "dovetail/core/error.hpp"
#include "dovetail/report/text.hpp"
#include "measure.hpp"
#include "scenes.hpp"
#include "studies.hpp"
#include "tables.hpp"

namespace dovetail::dem_benchmark {

namespace {

using report::format;
using Laws = std::shared_ptr<const dem::ContactLaws>;

/// How long a linear contact of two of 1 kg lasts, s; the others are as stiff.
const double contactTime = 3.14159265358979324 * std::sqrt(0.5 / stiffness);
constexpr double contactTimes = 8.0;  // from before the first touch to after the last

struct Named {
  const char* name;
  Laws laws;
};

template <class Normal, class Tangential, class Rolling, class Adhesion>
dem::ContactLaw<Normal, Tangential, Rolling, Adhesion> lawOf(const Normal& normal, const Tangential& tangential,
                                                             const Rolling& rolling, const Adhesion& adhesion) {
  return {normal, tangential, rolling, adhesion};
}

std::vector<Named> laws() {
  const dem::LinearSpringDashpot linear{stiffness, 0.5};
  const dem::TangentialSpring friction{2.0 / 7.0 * stiffness, 0.3}, damped{2.0 / 7.0 * stiffness, 0.3, 0.5};
  const dem::HertzDashpot hertz{.effectiveModulus = 15000.0, .restitution = 0.5};
  const dem::MindlinSpring mindlin{.stiffnessRatio = 0.8, .friction = 0.3};
  const dem::RollingAndTwisting rolling{{0.1, 0.2, 0.1}, {0.05, 0.1, 0.1}};
  dem::Cohesion cohesion;
  cohesion.force = 5.0;
  return {{"linear, elastic", makeContactLaws(dem::ElasticLaw{{stiffness}})},
          {"linear", makeContactLaws(dem::ElasticLaw{linear})},
          {"linear + friction", makeContactLaws(dem::FrictionalLaw{linear, friction})},
          {"linear + friction with dashpot", makeContactLaws(dem::FrictionalLaw{linear, damped})},
          {"linear + friction + rolling", makeContactLaws(lawOf(linear, friction, rolling, dem::NoAdhesion{}))},
          {"linear + friction + cohesion", makeContactLaws(lawOf(linear, friction, dem::NoRolling{}, cohesion))},
          {"linear + friction + bridge",
           makeContactLaws(lawOf(linear, friction, dem::NoRolling{}, dem::LiquidBridge{2.0, 1e-3, 0.2}))},
          {"Hertz", makeContactLaws(dem::HertzLaw{hertz})},
          {"Hertz + Mindlin", makeContactLaws(dem::HertzMindlinLaw{hertz, mindlin})},
          {"Hertz + Mindlin + rolling", makeContactLaws(lawOf(hertz, mindlin, rolling, dem::NoAdhesion{}))},
          {"elastic-plastic + friction",
           makeContactLaws(lawOf(dem::ElasticPlastic{stiffness, 3.0 * stiffness, 0.5 * stiffness, 0.1}, friction,
                                 dem::NoRolling{}, dem::NoAdhesion{}))}};
}

/// Pairs far from each other, whose spheres approach at 0.5 to 1 m/s and slip and spin as fast.
dem::Model collisions(const Laws& laws, int count) {
  dem::Model model;
  model.laws = laws;
  std::mt19937 random(1);
  std::uniform_real_distribution<double> number(-1.0, 1.0);
  const auto vector = [&] { return Vec3{number(random), number(random), number(random)}; };
  const int width = static_cast<int>(std::ceil(std::cbrt(count)));
  for (int k = 0; k < count; ++k) {
    const Vec3 place{4.0 * (k % width), 4.0 * (k / width % width), 4.0 * (k / width / width)};
    const Vec3 normal = normalized(vector() + Vec3{0.0, 0.0, 1e-9});
    const double gap = 0.01 * (1.0 + number(random)) + 1e-4;
    addParticle(model.particles, place, {}, 0.5, dem::Mass{1.0});
    addParticle(model.particles, place + (1.0 + gap) * normal, {}, 0.5, dem::Mass{1.0});
  }
  if (laws->rotates()) switchOnRotation(model.particles);
  for (std::size_t i = 0; i < model.particles.size(); i += 2) {
    const Vec3 along = normalized(model.particles.x[i + 1] - model.particles.x[i]), drift = vector();
    model.particles.v[i] = drift + (0.375 + 0.125 * number(random)) * along + 0.25 * vector();
    model.particles.v[i + 1] = drift - (0.375 + 0.125 * number(random)) * along;
    for (std::size_t k = i; laws->rotates() && k < i + 2; ++k) model.particles.omega[k] = vector();
  }
  return model;
}

struct Run {
  double nanoseconds;        // per particle and step
  double residual;           // of the ledger, over all that was lost
  std::vector<Vec3> motion;  // velocities at the end, m/s, and spins times the radius
};

Run collide(const Laws& laws, int count, int stepsPerContact) {
  dem::Model model = collisions(laws, count);
  model.booking = dem::Booking::on;
  const double dt = contactTime / stepsPerContact;
  dem::findForces(model);
  const double before = energies(model).balance();
  const auto steps = static_cast<std::int64_t>(contactTimes * stepsPerContact);
  const double start = now();
  run(model, dt, steps);
  const double time = now() - start;
  const dem::Energies after = energies(model);
  std::vector<Vec3> motion = model.particles.v;
  for (const Vec3& omega : model.particles.omega) motion.push_back(0.5 * omega);
  const double scale = after.lost.lostPower() > 0.0 ? after.lost.lostPower() : after.kinetic;
  return {1e9 * time / static_cast<double>(steps) / static_cast<double>(model.particles.size()),
          std::abs(after.balance() - before) / scale, motion};
}

/// Root of the mean square of the difference over that of the reference.
double errorOf(const std::vector<Vec3>& motion, const std::vector<Vec3>& reference) {
  double error = 0.0, size = 0.0;
  for (std::size_t k = 0; k < motion.size(); ++k) {
    error += squaredNorm(motion[k] - reference[k]);
    size += squaredNorm(reference[k]);
  }
  return std::sqrt(error / size);
}

}  // namespace

void studyAccuracy(const Settings& s, std::ostream& out) {
  const int count = s.quick ? 200 : 4000, finest = s.quick ? 640 : 2560;
  out << format("%d collisions of pairs, oblique and spinning; reference: %d steps per contact\n", count, finest)
      << format("%-32s %8s %10s %10s %12s %14s\n", "law", "steps", "error", "residual", "ns per step", "us per impact");
  report::Json rows = report::Json::array();
  for (const Named& law : laws()) {
    const Run reference = collide(law.laws, count, finest);
    for (const int steps : {10, 20, 40, 80, 160}) {
      Run best = collide(law.laws, count, steps);
      for (int repeat = 1; repeat < s.repeats; ++repeat)
        best.nanoseconds = std::min(best.nanoseconds, collide(law.laws, count, steps).nanoseconds);
      const double error = errorOf(best.motion, reference.motion);
      const double perImpact = 2e-3 * best.nanoseconds * contactTimes * steps;  // µs
      out << format("%-32s %8d %10.1e %10.1e %12.1f %14.3f\n", steps == 10 ? law.name : "", steps, error, best.residual,
                    best.nanoseconds, perImpact);
      rows.push_back({{"law", law.name},
                      {"steps_per_contact", steps},
                      {"error", error},
                      {"residual", best.residual},
                      {"us_per_impact", perImpact}});
    }
  }
  writeSummary(s, {{"runs", rows}});
}

}  // namespace dovetail::dem_benchmark
