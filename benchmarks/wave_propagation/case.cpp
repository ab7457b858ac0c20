// Figures of the case, and its scene.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "dovetail/arlequin/constraint.hpp"
#include "dovetail/fem/model/model_mass.hpp"
#include "dovetail/report/table.hpp"
#include "settings.hpp"

namespace dovetail::wave {

namespace {

constexpr double pi = std::numbers::pi;
constexpr double clearance = 0.8;  // m, of the pulse's tail past the overlap

/// When the pulse's tail is 0.8 m past the overlap; for the impulse, when its front could be back at the start.
double measuringTime(const Settings& s) {
  const double travel = (s.demLength + clearance) / waveSpeed();
  return s.impulse() ? 2.0 * travel : driveTime(s) + travel;
}

}  // namespace

double particleMass(const Settings& s) { return Case{}.particleDensity * pi / 6.0 * std::pow(s.diameter(), 3); }
double bulkDensity() { return Case{}.particleDensity * pi / 6.0; }
double waveSpeed() { return std::sqrt(Case{}.youngsModulus / bulkDensity()); }
double contactTime(const Settings& s) { return pi * std::sqrt(0.5 * particleMass(s) / s.contactStiffness()); }
double angularFrequency(const Settings& s) { return 2.0 * pi * waveSpeed() / (s.pulseElements * Case{}.elementSize); }
double driveTime(const Settings& s) { return s.impulse() ? 0.0 : 2.0 * pi * s.cycles / angularFrequency(s); }

double endTime(const Settings& s) {
  if (s.until) return *s.until;
  return s.scheme == "paper" && !s.untilPast ? 0.1 : measuringTime(s);
}

int solidElements(const Settings& s) {
  const double h = Case{}.elementSize;
  double length = s.femLength;
  if (s.lengthen && (s.scheme != "paper" || s.untilPast))
    length = std::max(length, waveSpeed() * endTime(s) - (s.demLength - s.overlap) + 2.0 * h);
  return static_cast<int>(std::ceil(length / h - 1e-9));
}

double barLength(const Settings& s) { return s.demLength - s.overlap + solidElements(s) * Case{}.elementSize; }

double massFraction(const Settings& s) {
  if (s.mass == "matched") return fem::matchedFraction(s.diameter(), Case{}.elementSize);
  return s.mass == "consistent" ? 1.0 : 0.0;
}

double penaltyOf(const Settings& s) {
  if (s.penalty > 0.0) return s.penalty;
  if (s.constraint == "dashpot") return 1e10 * s.particlesPerEdge * s.particlesPerEdge;
  return arlequin::automaticPenalty(Case{}.youngsModulus * s.stiffnessRatio, Case{}.elementSize);
}

namespace {

using report::Json;

Json boxOf(double from, double to) {
  const double half = 0.5 * Case{}.side;
  return {{-half, from, -half}, {half, to, half}};
}

Json layers(const char* name, const Settings& s, double from, double to) {
  return {{"from", "lattice"},
          {"lattice", "simple-cubic"},
          {"name", name},
          {"radius", 0.5 * s.diameter()},
          {"density", Case{}.particleDensity},
          {"box", boxOf(from, to)}};
}

/// The first layer, which is driven or pushed, and all others; of particles alone one more, which is the wall at the
/// end: held, it fixes the bar's last point.
void addParticles(const Settings& s, Json& scene) {
  const double d = s.diameter(), end = s.fullDem ? barLength(s) : s.demLength;
  Json groups{layers("first", s, 0.0, d), layers("others", s, d, end)}, drives = Json::array();
  if (s.impulse())
    groups[0]["velocity"] = {0.0, s.amplitude * Case{}.velocity * s.particlesPerEdge, 0.0};
  else
    drives.push_back({{"group", "first"}, {"velocity", {0, "t < period ? v0*(1 - cos(omega*t)) : 0", 0}}});
  if (s.fullDem) {
    groups.push_back(layers("wall", s, end, end + d));
    drives.push_back({{"group", "wall"}, {"velocity", {0, 0, 0}}});
  }
  scene["particles"] = groups;
  scene["drives"] = drives;
}

Json materialOf(const Settings& s) {
  Json material{{"law", "axial-springs"},
                {"youngs_modulus", Case{}.youngsModulus * s.stiffnessRatio},
                {"density", bulkDensity() * s.densityRatio}};
  if (s.material == "kirchhoff") material.update({{"law", "St-Venant-Kirchhoff"}, {"poisson_ratio", 0}});
  return material;
}

Json solidOf(const Settings& s) {
  const double h = Case{}.elementSize, start = s.demLength - s.overlap;
  const int along = solidElements(s);
  return {{"name", "bar"},
          {"mesh", "box"},
          {"cells", {2, along, 2}},
          {"box", boxOf(start, start + along * h)},
          {"material", materialOf(s)},
          {"stepping", s.implicit() ? "implicit" : "explicit"},
          {"consistent_mass", massFraction(s)},
          {"supports", Json::array({Json::object({{"on", "y+"}})})}};
}

Json overlapOf(const Settings& s, double penalty) {
  const double h = Case{}.elementSize;
  return {{"type", "overlap"},
          {"solid", "bar"},
          {"axis", "y"},
          {"solid_border", s.demLength - s.overlap},
          {"particle_border", s.demLength},
          {"profile", s.weightProfile},
          {"floor", s.weightFloor},
          {"constraint", s.constraint},
          {"penalty", s.constraint == "multiplier" ? Json("auto") : Json(penalty)},
          {"dashpot_matrix", s.dashpotMatrix},
          {"order", s.order},
          {"gap", s.gap},
          {"rows", s.rows},
          {"kernel", s.cgWidth * h},
          {"kernel_shape", s.kernel},
          {"kernel_normalised", s.normalised == "on"},
          {"kernel_reach", s.kernelReach},
          {"absorber", s.absorber * waveSpeed() / h}};
}

}  // namespace

std::vector<std::string> changesOfScene(const Settings& s, double penalty) {
  Json scene{{"v0", s.amplitude * Case{}.cosineVelocity},
             {"omega", angularFrequency(s)},
             {"period", driveTime(s)},
             {"contact.stiffness", s.contactStiffness()},
             {"contact.bonded", s.tensile()},
             {"stages.0.time", endTime(s)},
             {"steps.per_macro_step", s.fullDem ? 1 : s.femEvery},
             {"steps.threads", s.threads},
             {"solids", Json::array()},
             {"couplings", Json::array()}};
  addParticles(s, scene);
  if (!s.fullDem) scene["solids"].push_back(solidOf(s));
  if (!s.fullDem) scene["couplings"].push_back(overlapOf(s, penalty));
  return benchmark::changesOf(scene);
}

}  // namespace dovetail::wave
