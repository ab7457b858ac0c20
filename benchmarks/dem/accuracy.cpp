// Error against run time, law by law: pairs of spheres that collide obliquely and spin, each pair on its own, so that
// errors do not grow with time and all of them are the integrator's and the law's.
#include <algorithm>
#include <array>
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

/// What a collision leaves of one pair.
struct Aftermath {
  std::array<Vec3, 4> motion{};  ///< velocities, m/s, and spins times the radius
  double lost = 0.0;             ///< J
};

double kineticEnergyOf(const dem::Particles& particles, std::size_t i) {
  double twice = particles.mass[i] * squaredNorm(particles.v[i]);
  if (particles.rotates()) twice += momentOfInertia(particles, static_cast<int>(i)) * squaredNorm(particles.omega[i]);
  return 0.5 * twice;
}

std::vector<double> kineticEnergies(const dem::Particles& particles) {
  std::vector<double> energies;
  for (std::size_t i = 0; i < particles.size(); i += 2)
    energies.push_back(kineticEnergyOf(particles, i) + kineticEnergyOf(particles, i + 1));
  return energies;
}

struct Run {
  double nanoseconds = 0.0;  ///< per particle and step
  double residual = 0.0;     ///< of the ledger, over all that was lost
  std::vector<Aftermath> pairs;
};

Run collide(const Laws& laws, int count, int stepsPerContact) {
  dem::Model model = collisions(laws, count);
  model.booking = dem::Booking::on;
  const double dt = contactTime / stepsPerContact;
  dem::findForces(model);
  const double before = energies(model).balance();
  const std::vector<double> kineticBefore = kineticEnergies(model.particles);
  const auto steps = static_cast<std::int64_t>(contactTimes * stepsPerContact);
  const double start = now();
  run(model, dt, steps);
  const double time = now() - start;
  const dem::Energies after = energies(model);
  const std::vector<double> kineticAfter = kineticEnergies(model.particles);
  const double scale = after.lost.lostPower() > 0.0 ? after.lost.lostPower() : after.kinetic;
  Run result{1e9 * time / static_cast<double>(steps) / static_cast<double>(model.particles.size()),
             std::abs(after.balance() - before) / scale,
             {}};
  for (std::size_t k = 0; k < kineticAfter.size(); ++k) {
    Aftermath pair{{model.particles.v[2 * k], model.particles.v[2 * k + 1]}, kineticBefore[k] - kineticAfter[k]};
    if (model.particles.rotates())
      for (std::size_t side = 0; side < 2; ++side)
        pair.motion[2 + side] = model.particles.radius[2 * k + side] * model.particles.omega[2 * k + side];
    result.pairs.push_back(pair);
  }
  return result;
}

/// Over all collisions.
struct Spread {
  double median = 0.0, worst = 0.0;
};

Spread spreadOf(std::vector<double> errors) {
  const auto middle = errors.begin() + static_cast<std::ptrdiff_t>(errors.size() / 2);
  std::nth_element(errors.begin(), middle, errors.end());
  return {*middle, *std::max_element(middle, errors.end())};
}

struct Errors {
  Spread motion;        ///< over the root of the sum of squares of what a pair ends with
  double losses = 0.0;  ///< median of the difference in what pairs lost, over the median of what they lost
};

Errors errorsOf(const Run& run, const Run& reference) {
  std::vector<double> motion, losses, lost;
  for (std::size_t k = 0; k < run.pairs.size(); ++k) {
    const Aftermath &now = run.pairs[k], &exact = reference.pairs[k];
    double error = 0.0, size = 0.0;
    for (std::size_t c = 0; c < exact.motion.size(); ++c) {
      error += squaredNorm(now.motion[c] - exact.motion[c]);
      size += squaredNorm(exact.motion[c]);
    }
    motion.push_back(std::sqrt(error / size));
    losses.push_back(std::abs(now.lost - exact.lost));
    lost.push_back(std::abs(exact.lost));
  }
  const double most = spreadOf(lost).median;
  return {spreadOf(motion), most > 1e-9 ? spreadOf(losses).median / most : 0.0};
}

/// Run time at which the error is as wanted, by a power law between two rows of (error, time); NaN beyond them.
double timeAt(double wanted, const std::vector<std::array<double, 2>>& rows) {
  for (std::size_t k = 1; k < rows.size(); ++k) {
    const auto [coarse, soon] = rows[k - 1];
    const auto [fine, late] = rows[k];
    if (coarse < wanted || fine > wanted) continue;
    return soon * std::pow(late / soon, std::log(coarse / wanted) / std::log(coarse / fine));
  }
  return std::nan("");
}

constexpr double errorWanted = 1e-3;

/// @return rows of the summary
report::Json studyLaw(const Named& law, const Settings& s, int count, int finest, std::ostream& out) {
  report::Json rows = report::Json::array();
  const Run reference = collide(law.laws, count, finest);
  Errors before;
  std::vector<std::array<double, 2>> front;
  for (const int steps : {10, 20, 40, 80, 160}) {
    Run best = collide(law.laws, count, steps);
    for (int repeat = 1; repeat < s.repeats; ++repeat)
      best.nanoseconds = std::min(best.nanoseconds, collide(law.laws, count, steps).nanoseconds);
    const Errors errors = errorsOf(best, reference);
    const double perImpact = 2e-3 * best.nanoseconds * contactTimes * steps;  // µs
    const auto fall = [&](double coarse, double fine) {
      return steps > 10 && fine > 0.0 ? format("%5.1f", coarse / fine) : std::string(5, ' ');
    };
    out << format("%-32s %6d %9.1e %s %9.1e %s %9.1e %s %9.1e %9.1f %9.3f\n", steps == 10 ? law.name : "", steps,
                  errors.motion.median, fall(before.motion.median, errors.motion.median).c_str(), errors.motion.worst,
                  fall(before.motion.worst, errors.motion.worst).c_str(), errors.losses,
                  fall(before.losses, errors.losses).c_str(), best.residual, best.nanoseconds, perImpact);
    rows.push_back({{"law", law.name},
                    {"steps_per_contact", steps},
                    {"error", errors.motion.median},
                    {"worst_error", errors.motion.worst},
                    {"losses_error", errors.losses},
                    {"residual", best.residual},
                    {"us_per_impact", perImpact}});
    front.push_back({errors.motion.median, perImpact});
    before = errors;
  }
  if (const double time = timeAt(errorWanted, front); std::isfinite(time))
    out << format("%-32s %.3f us per impact at a median error of %.0e\n", "", time, errorWanted);
  return rows;
}

}  // namespace

void studyAccuracy(const Settings& s, std::ostream& out) {
  const int count = s.quick ? 200 : 4000, finest = s.quick ? 640 : 2560;
  out << format(
             "%d collisions of pairs, oblique and spinning, each touching at its own moment of a step; reference: "
             "%d steps per contact\nerrors beside how many times smaller than with steps twice as long\n",
             count, finest)
      << format("%-32s %6s %9s %5s %9s %5s %9s %5s %9s %9s %9s\n", "law", "steps", "median", "", "worst", "", "losses",
                "", "residual", "ns/step", "us/impact");
  report::Json rows = report::Json::array();
  for (const Named& law : laws())
    for (const report::Json& row : studyLaw(law, s, count, finest, out)) rows.push_back(row);
  writeSummary(s, {{"runs", rows}});
}

}  // namespace dovetail::dem_benchmark
