// Stiff and extreme cases: each stays bounded, or is refused with a reason.
#include <cmath>
#include <functional>
#include <limits>
#include <ostream>

#include "dovetail/core/error.hpp"
#include "dovetail/dem/model/walls.hpp"
#include "dovetail/report/text.hpp"
#include "studies.hpp"
#include "tables.hpp"

namespace dovetail::dem_benchmark {

namespace {

using dem::Mass;
using report::format;

template <class Law>
dem::Model sceneOf(const Law& law, double skin = 0.1) {
  dem::Model model;
  model.laws = dem::makeContactLaws(law);
  model.pairs.setSkin(skin);
  return model;
}

/// Largest departure of the balance from its start, relative to `scale` J, over n steps.
double drift(dem::Model& model, double dt, int n, double scale) {
  dem::findForces(model);
  const double start = energies(model).balance();
  double worst = 0.0;
  for (int s = 0; s < n; ++s) {
    advance(model, dt);
    close(model);
    worst = std::max(worst, std::abs(energies(model).balance() - start) / scale);
  }
  return worst;
}

struct Case {
  const char* name;
  const char* wanted;  // of the figure
  double limit;        // largest allowed figure
  std::function<double()> figure;
};

/// Head-on impact of 1 kg at 1 m/s on a partner at rest; returns the drift.
double impact(double massRatio, double sizeRatio, double stiffness, double stepFraction) {
  auto model = sceneOf(dem::ElasticLaw{{stiffness}}, 1e-3);
  addParticle(model.particles, {0, 0, 0}, {1, 0, 0}, 0.5, Mass{1.0});
  addParticle(model.particles, {0.5 + 0.5 * sizeRatio + 1e-6, 0, 0}, {}, 0.5 * sizeRatio, Mass{massRatio});
  const double reduced = massRatio / (1.0 + massRatio), dt = stepFraction * 2.0 * std::sqrt(reduced / stiffness);
  return drift(model, dt, static_cast<int>(10.0 / stepFraction), 0.5);
}

/// A chain of three: a soft contact beside one a million times stiffer.
double stiffNeighbours() {
  dem::LawTable<dem::ElasticLaw> laws(2, dem::ElasticLaw{{1e3}});
  laws.set(1, 1, dem::ElasticLaw{{1e9}});
  dem::Model model;
  model.laws = dem::makeContactLaws(laws);
  model.pairs.setSkin(0.01);
  for (int i = 0; i < 3; ++i) addParticle(model.particles, {0.999 * i, 0, 0}, {}, 0.5, Mass{1.0});
  model.particles.x[2].x = 1.9999;
  model.particles.material = {0, 1, 1};
  model.particles.v[0] = {0.1, 0, 0};
  findPairs(model.particles, model.pairs);
  const double dt = 0.1 * criticalStep(model, 1e-6).dt;
  return drift(model, dt, 20000, 0.005);
}

double deepOverlap(double fraction) {
  auto model = sceneOf(dem::ElasticLaw{{1e3}});
  addParticle(model.particles, {0, 0, 0}, {}, 0.5, Mass{1.0});
  addParticle(model.particles, {1.0 - fraction, 0, 0}, {}, 0.5, Mass{1.0});
  return drift(model, 1e-3, 5000, 0.5e3 * fraction * fraction);
}

double inside() {
  auto model = sceneOf(dem::ElasticLaw{{1e3}});
  addParticle(model.particles, {0, 0, 0}, {}, 5.0, Mass{1e3});
  addParticle(model.particles, {1.0, 0, 0}, {}, 0.5, Mass{1.0});
  return drift(model, 1e-3, 5000, 0.5e3 * 4.5 * 4.5);
}

/// A bonded pair oscillations; growth of its amplitude over 20 000 steps.
double swing(double stepFraction) {
  dem::ElasticLaw law{{1e4}};
  law.normal.bonded = true;
  auto model = sceneOf(law);
  addParticle(model.particles, {0, 0, 0}, {1e-3, 0, 0}, 0.5, Mass{1.0});
  addParticle(model.particles, {1, 0, 0}, {-1e-3, 0, 0}, 0.5, Mass{1.0});
  model.pairs.setSkin(0.1);
  findPairs(model.particles, model.pairs);
  const double dt = stepFraction * criticalStep(model, 1e-9).dt;
  if (stepFraction > 1.0) requireStableStep(model, dt, 1e-9);
  double largest = 0.0;
  for (int s = 0; s < 20000; ++s) {
    advance(model, dt);
    largest = std::max(largest, std::abs(model.particles.x[1].x - model.particles.x[0].x - 1.0));
  }
  return largest / (1e-3 / std::sqrt(2e4) * 2.0);  // of the amplitude in exact time
}

double frictionalPress(double stiffness) {
  auto model = sceneOf(dem::FrictionalLaw{{stiffness, 0.5}, {stiffness, 0.5}}, 0.01);
  addParticle(model.particles, {0, 0, 0.5 + 1e-9}, {0.1, 0, 0}, 0.5, Mass{1.0});
  switchOnRotation(model.particles);
  model.gravity = {0, 0, -10};
  dem::addWall(model, dem::makePlane({}, {0, 0, 1}));
  return drift(model, 0.05 / std::sqrt(stiffness), 20000, 10.0);
}

std::vector<Case> cases() {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  return {
      {"stiffness ratio 1e6, side by side", "energy error", 1e-2, stiffNeighbours},
      {"mass ratio 1e6, impact", "energy error", 1e-2, [] { return impact(1e6, 1.0, 1e6, 0.05); }},
      {"mass ratio 1e-6, impact", "energy error", 1e-2, [] { return impact(1e-6, 1.0, 1e6, 0.05); }},
      {"size ratio 1000, impact", "energy error", 1e-2, [] { return impact(1e6, 1000.0, 1e6, 0.05); }},
      {"stiffness 1e12 N/m, impact", "energy error", 1e-2, [] { return impact(1.0, 1.0, 1e12, 0.05); }},
      {"overlap of 90 % of the diameter", "energy error", 1e-2, [] { return deepOverlap(0.9); }},
      {"coincident centres", "energy error", 1e-2, [] { return deepOverlap(1.0); }},
      {"small sphere inside a large one", "energy error", 1e-2, inside},
      {"frictional contact, 1e9 N/m, 2e4 steps", "energy error", 1e-2, [] { return frictionalPress(1e9); }},
      {"dt at 0.99 of the limit, 2e4 steps", "amplitude", 20.0, [] { return swing(0.99); }},
      {"dt at 1.01 of the limit", "amplitude", 0.0, [] { return swing(1.01); }},
      {"overlap released by one huge step", "energy error", 0.0,
       [] {
         auto model = sceneOf(dem::ElasticLaw{{1e9}});
         addParticle(model.particles, {0, 0, 0}, {}, 0.5, Mass{1.0});
         addParticle(model.particles, {0.5, 0, 0}, {}, 0.5, Mass{1.0});
         return drift(model, 1e-2, 100, 1.0);
       }},
      {"velocity that is not a number", "-", 0.0,
       [nan] {
         auto model = sceneOf(dem::ElasticLaw{{1e3}});
         addParticle(model.particles, {0, 0, 0}, {}, 0.5, Mass{1.0});
         model.particles.v[0].x = nan;
         return drift(model, 1e-3, 1, 1.0);
       }},
      {"restitution 0", "-", 0.0,
       [] {
         validate(dem::LinearSpringDashpot{1e3, 0.0});
         return 0.0;
       }},
      {"radius 0", "-", 0.0,
       [] {
         dem::Particles particles;
         addParticle(particles, {}, {}, 0.0, Mass{1.0});
         return 0.0;
       }},
  };
}

}  // namespace

bool studyStability(const Settings& s, std::ostream& out) {
  bool sound = true, any = false;
  report::Json rows = report::Json::array();
  out << format("%-40s %-14s %-10s %s\n", "case", "figure", "value", "outcome");
  for (const Case& c : cases()) {
    if (std::string(c.name).find(s.only) == std::string::npos) continue;
    any = true;
    std::string value = "-", outcome, message;
    try {
      const double figure = c.figure();
      const bool bounded = figure <= c.limit;
      value = format("%.2e", figure);
      outcome = bounded ? "bounded" : "NOT BOUNDED";
      sound = sound && bounded;
    } catch (const Error& error) {
      outcome = "refused";
      message = error.what();
    }
    out << format("%-40s %-14s %-10s %s%s%s\n", c.name, c.wanted, value.c_str(), outcome.c_str(),
                  message.empty() ? "" : ": ", message.c_str());
    rows.push_back(
        {{"label", c.name}, {"figure", c.wanted}, {"value", value}, {"outcome", outcome}, {"message", message}});
  }
  if (!any) throw InputError("no case has '" + s.only + "' in its name", "--only", "leave it out to see all names");
  writeSummary(s, {{"runs", rows}});
  return sound;
}

}  // namespace dovetail::dem_benchmark
