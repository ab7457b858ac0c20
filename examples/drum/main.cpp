// Beads in a slowly turning drum flow down a slope that stays. Its angle is compared with what the friction law of
// dense flows says for the rate of shear in the flowing layer.
#include <array>
#include <cstdio>
#include <iostream>

#include "common/beads.hpp"
#include "common/options.hpp"
#include "common/report.hpp"
#include "dovetail/core/profile.hpp"
#include "dovetail/core/progress.hpp"
#include "dovetail/io/output_folder.hpp"
#include "dovetail/io/time_series.hpp"

namespace {

using namespace dovetail;
using namespace dovetail::example;
using Scene = dem::Model;

const Beads beads;
const double d = beads.diameter, tau = beads.fallTime(), dt = beads.step();
constexpr double froude = 0.002;  // ω² R/g; rolling regime: 1e-4 … 1e-2 (Mellmann, Powder Technol. 118, 2001)
constexpr double degree = std::numbers::pi / 180.0;

struct Size {
  double radius, width;  // of the drum and of its period along the axis y, m: it is endless, without end walls
};

/// Friction of dense flows of glass beads, μ(I) = μ_s + (μ_2 − μ_s)/(1 + I0/I): Jop, Forterre & Pouliquen, Nature 441,
/// 2006. I = (rate of shear) d/√(pressure/density of a bead).
double frictionOfFlow(double inertialNumber) {
  const double first = std::tan(20.9 * degree), second = std::tan(32.76 * degree);
  return first + (second - first) / (1.0 + 0.279 / inertialNumber);
}

/// Half a drum of beads at rest, with the surface already inclined by about 24 degrees: gravity is inclined while they
/// settle.
Scene halfFilledDrum(const Size& size, Profile& profile) {
  const double radius = size.radius;
  Scene drum = emptyModel(beads, SlidingLaw{beads.normal(), beads.tangential()}, profile);
  drum.pairs.setPeriodicity({{{-radius, 0.0, -radius}, {radius, size.width, radius}}, {false, true, false}});
  const Vec3 down = normalized(Vec3{-std::tan(24.0 * degree), 0.0, -1.0});
  const dem::Packing block = looseBeads(beads, drum.pairs.periodicity(), 1);
  for (std::size_t i = 0; i < block.centre.size(); ++i) {
    const Vec3& x = block.centre[i];
    if (std::hypot(x.x, x.z) + block.radius[i] < radius && dot(x, down) > -0.12 * radius)
      dem::addParticle(drum.particles, x, {}, block.radius[i], dem::Density{beads.density});
  }
  dem::switchOnRotation(drum.particles);
  dem::addWall(drum, dem::makeCylinder({}, {0, 1, 0}, radius)).skin = 0.2 * d;
  const Vec3 gravity = drum.gravity;
  drum.gravity = beads.gravity * down;
  dem::run(drum, dt, static_cast<std::int64_t>(6.0 * tau / dt));
  drum.gravity = gravity;
  return drum;
}

/// Slope of a straight line through the highest beads in the middle of the drum, in columns one bead wide: tan(angle),
/// and the height of the line at x = 0, m. The slope goes down towards +x.
std::array<double, 2> surfaceLine(const dem::Particles& particles, const Size& size) {
  const double half = 0.5 * size.radius, width = size.width;
  const auto columns = static_cast<std::size_t>(2.0 * half / d), rows = static_cast<std::size_t>(width / d);
  std::vector<double> top(columns * rows, -size.radius);
  for (std::size_t i = 0; i < particles.size(); ++i) {
    const Vec3& x = particles.x[i];
    if (std::abs(x.x) >= half) continue;
    const double along = x.y - width * std::floor(x.y / width);
    const auto column = std::min(columns - 1, static_cast<std::size_t>((x.x + half) / d));
    double& highest = top[column * rows + std::min(rows - 1, static_cast<std::size_t>(along / d))];
    highest = std::max(highest, x.z);
  }
  double n = 0, sx = 0, sz = 0, sxx = 0, sxz = 0;
  for (std::size_t k = 0; k < top.size(); ++k) {
    const double x = (static_cast<double>(k / rows) + 0.5) * d - half;
    n += 1, sx += x, sz += top[k], sxx += x * x, sxz += x * top[k];
  }
  const double slope = (n * sxz - sx * sz) / (n * sxx - sx * sx);
  return {-slope, (sz - slope * sx) / n};
}

/// Angle of the line from the axis to the centre of mass with the vertical, rad: the surface's, if that is straight.
double angleOfMass(const dem::Particles& particles) {
  Vec3 moment;
  for (std::size_t i = 0; i < particles.size(); ++i) moment += particles.mass[i] * particles.x[i];
  return std::atan2(-moment.x, -moment.z);
}

/// Mean speed down the slope by depth below the surface, in the middle of the drum.
struct VelocityProfile {
  static constexpr double layer = 0.5;  // thickness of a layer, d
  std::array<double, 40> sum{}, count{};

  void add(const dem::Particles& particles, double angle, double height) {
    const Vec3 along{std::cos(angle), 0, -std::sin(angle)}, outward{std::sin(angle), 0, std::cos(angle)};
    for (std::size_t i = 0; i < particles.size(); ++i) {
      const Vec3 from = particles.x[i] - Vec3{0, 0, height};
      const double depth = -dot(from, outward) + 0.5 * d;
      if (std::abs(dot(from, along)) > 3.0 * d || depth < 0.0) continue;
      const auto bin = static_cast<std::size_t>(depth / d / layer);
      if (bin >= sum.size()) continue;
      sum[bin] += dot(particles.v[i], along);
      count[bin] += 1.0;
    }
  }
  double depth(std::size_t bin) const { return (static_cast<double>(bin) + 0.5) * layer * d; }  // m
  double speed(std::size_t bin) const { return sum[bin] / count[bin]; }                         // m/s

  /// Where beads no longer go down, m.
  double thickness() const {
    std::size_t end = 1;
    while (end + 1 < sum.size() && count[end] > 0.0 && speed(end) > 0.0) ++end;
    const double a = speed(end - 1), b = speed(end);
    return depth(end - 1) + layer * d * a / (a - b);
  }

  /// I in the upper part of the layer, where the speed is at least a third of that at the surface and falls evenly with
  /// depth: the slope of a straight line there, and the weight (solid fraction 0.58) of what lies above its middle.
  double inertialNumber(double angle) const {
    double n = 0, sx = 0, sy = 0, sxx = 0, sxy = 0;
    for (std::size_t bin = 1; speed(bin) > speed(1) / 3.0; ++bin) {
      const double x = depth(bin), y = speed(bin);
      n += 1, sx += x, sy += y, sxx += x * x, sxy += x * y;
    }
    const double rate = -(n * sxy - sx * sy) / (n * sxx - sx * sx);
    return rate * d / std::sqrt(0.58 * beads.gravity * std::cos(angle) * sx / n);
  }
};

struct Measured {
  std::vector<double> time, angle, angleOfMass;  // s, rad, rad
  VelocityProfile profile;                       // of the steady part
  double meanAngle = 0.0, deviation = 0.0, meanOfMass = 0.0;
};

/// Turns the drum; the last 60 % count.
Measured turn(Scene& drum, const Size& size, double speed, double angle, int samples) {
  Measured m;
  Progress progress("drum", samples);
  dem::primitiveWall(drum, 0).angularVelocity = {0, speed, 0};
  const double start = drum.time;
  double n = 0.0, squares = 0.0;
  runAndWatch(drum, dt, angle / speed, samples, [&](const Scene& now) {
    const auto [slope, height] = surfaceLine(now.particles, size);
    m.time.push_back(now.time - start);
    m.angle.push_back(std::atan(slope));
    m.angleOfMass.push_back(angleOfMass(now.particles));
    progress.update(static_cast<double>(m.time.size()), std::to_string(m.angle.back() / degree).substr(0, 4) + " deg");
    if (m.time.back() < 0.4 * angle / speed) return;
    m.profile.add(now.particles, m.angle.back(), height);
    n += 1.0;
    m.meanAngle += m.angle.back();
    m.meanOfMass += m.angleOfMass.back();
    squares += m.angle.back() * m.angle.back();
  });
  m.meanAngle /= n;
  m.meanOfMass /= n;
  m.deviation = std::sqrt(std::max(0.0, squares / n - m.meanAngle * m.meanAngle));
  return m;
}

void write(const Options& options, const Measured& m, const Scene& drum) {
  const io::KeyValues origin = io::provenance({{"quick", options.quick ? "yes" : "no"}});
  io::TimeSeries series({"time_s", "surface_deg", "centre_of_mass_deg"}), layers({"depth_m", "speed_m_per_s"});
  for (std::size_t k = 0; k < m.time.size(); ++k)
    series.append({m.time[k], m.angle[k] / degree, m.angleOfMass[k] / degree});
  for (std::size_t bin = 0; bin < m.profile.sum.size(); ++bin)
    if (m.profile.count[bin] > 0.0) layers.append({m.profile.depth(bin), m.profile.speed(bin)});
  io::writeCsv(options.out / "drum.csv", series, origin);
  io::writeCsv(options.out / "drum_layers.csv", layers, origin);
  writeParticles(options.out, "drum_particles", drum.time, drum.particles, origin);
}

bool run(const Options& options) {
  if (!options.out.empty()) io::prepareOutputFolder(options.out, {"drum.csv", "drum_layers.csv", "drum_particles.csv"});
  const Size size = options.quick ? Size{14.0 * d, 4.0 * d} : Size{20.0 * d, 6.0 * d};
  const double speed = std::sqrt(froude * beads.gravity / size.radius);
  Profile profile(true);
  Scene drum = halfFilledDrum(size, profile);
  std::cout << drum.particles.size() << " beads of " << d << " m in a drum of radius " << size.radius << " m, "
            << speed * 30.0 / std::numbers::pi << " turns a minute, Froude number " << froude << '\n';
  ModelLedger ledger(dem::energies(drum));
  const Measured m = turn(drum, size, speed, options.quick ? 0.3 : 0.9, options.quick ? 60 : 200);
  ledger.set(dem::energies(drum));
  printStep(std::cout, dt, dem::criticalStep(drum), drum.particles);
  std::cout << '\n'
            << ledger.ledger() << "  residual: " << ledger.relativeResidual() << " of what was lost\n\n"
            << profile;
  const double inertial = m.profile.inertialNumber(m.meanAngle);
  const double law = std::atan(frictionOfFlow(inertial)) / degree, angle = m.meanAngle / degree;
  const double tolerance = options.quick ? 6.0 : 2.0;
  std::printf("\nangle of the surface %.1f +- %.1f degrees, of the centre of mass %.1f\n", angle, m.deviation / degree,
              m.meanOfMass / degree);
  std::printf("flowing layer %.1f d thick, inertial number %.3f\n", m.profile.thickness() / d, inertial);
  std::printf("law of Jop et al. at that number: %.1f degrees; off by %.1f (tolerance %.0f)\n", law, angle - law,
              tolerance);
  const bool good = std::abs(angle - law) < tolerance;
  std::printf("%s\n", good ? "within the tolerance" : "NOT within the tolerance");
  if (!options.out.empty()) write(options, m, drum);
  return good;
}

}  // namespace

int main(int argc, char** argv) {
  return runExample(argc, argv, "drum", "Beads in a turning drum; the angle of their slope against the law of flow.",
                    run);
}
