// Layers of the bar: velocities along it, and a coupled run beside particles alone over the whole length.
#include <algorithm>
#include <cmath>
#include <map>
#include <memory>

#include "dovetail/dem/pairs/pair_collide.hpp"
#include "run.hpp"

namespace dovetail::wave {

namespace {

/// Mean of a layer of particles or nodes.
struct LayerSum {
  double y = 0.0, velocity = 0.0, fraction = 0.0;
  int count = 0;

  void add(double place, double speed, double weight) {
    y += place;
    velocity += speed;
    fraction += weight;
    ++count;
  }
  void append(io::TimeSeries& table, double time, int model) const {
    table.append({time, static_cast<double>(model), y / count, velocity / count, fraction / count});
  }
};

/// Settings of the run of particles alone; those that do not concern it are set to one value.
Settings particlesAlone(const Settings& settings, double dt) {
  Settings alone;
  alone.fullDem = true;
  alone.particlesPerEdge = settings.particlesPerEdge;
  alone.demLength = settings.demLength;
  alone.overlap = settings.overlap;
  alone.femLength = solidElements(settings) * Case{}.elementSize;
  alone.lengthen = false;
  alone.tension = settings.tension;
  alone.signal = settings.signal;
  alone.pulseElements = settings.pulseElements;
  alone.cycles = settings.cycles;
  alone.amplitude = settings.amplitude;
  alone.until = endTime(settings);
  alone.dtFactor = dt / contactTime(settings) * (1.0 + 1e-12);
  alone.threads = settings.threads;
  alone.quiet = settings.quiet;
  return alone;
}

const RunResult& keptRun(const Settings& alone) {
  static std::vector<std::unique_ptr<RunResult>> kept;
  for (const auto& result : kept)
    if (describe(result->settings) == describe(alone)) return *result;
  constexpr std::size_t most = 16;
  if (kept.size() == most) kept.erase(kept.begin());
  kept.push_back(std::make_unique<RunResult>(run(alone)));
  return *kept.back();
}

/// Mean velocity of each layer, m/s; that of the wall's layer mirrored, so that the bar's end has none.
std::vector<Vec3> layerMeans(const Settings& s, const RunResult& alone) {
  const dem::Particles& particles = alone.particles;
  const auto perLayer = static_cast<std::size_t>(particlesPerLayer(s));
  std::vector<Vec3> mean(particles.size() / perLayer);
  for (std::size_t k = 0; k < particles.size(); ++k)
    mean[k / perLayer] +=
        (1.0 / static_cast<double>(perLayer)) * particles.v[static_cast<std::size_t>(alone.byPlace[k])];
  mean.back() = -mean[mean.size() - 2];
  return mean;
}

/// Natural cubic spline through values at the places 0, 1, 2 …
class CubicSpline {
public:
  explicit CubicSpline(std::vector<Vec3> value) : value_(std::move(value)), curvature_(value_.size()) {
    const std::size_t n = value_.size();
    std::vector<double> pivot(n, 4.0);
    for (std::size_t i = 1; i + 1 < n; ++i) curvature_[i] = 6.0 * (value_[i - 1] - 2.0 * value_[i] + value_[i + 1]);
    for (std::size_t i = 2; i + 1 < n; ++i) {
      pivot[i] -= 1.0 / pivot[i - 1];
      curvature_[i] -= (1.0 / pivot[i - 1]) * curvature_[i - 1];
    }
    for (std::size_t i = n - 2; i > 0; --i) curvature_[i] = (1.0 / pivot[i]) * (curvature_[i] - curvature_[i + 1]);
  }
  Vec3 operator()(double place) const {
    const double first = std::clamp(std::floor(place), 0.0, static_cast<double>(value_.size() - 2));
    const auto i = static_cast<std::size_t>(first);
    const double b = place - first, a = 1.0 - b;
    return a * value_[i] + b * value_[i + 1] +
           (1.0 / 6.0) * ((a * a * a - a) * curvature_[i] + (b * b * b - b) * curvature_[i + 1]);
  }

private:
  std::vector<Vec3> value_, curvature_;  // second derivatives, 0 at both ends
};

void compareSolid(RunResult& result, const RunResult& alone) {
  const Settings& s = result.settings;
  const std::vector<Vec3> means = layerMeans(s, alone);
  const CubicSpline layer(means);  // layer l lies at (l + ½) d
  double error = 0.0, size = 0.0;
  for (std::size_t n = 0; n < result.nodePosition.size(); ++n) {
    if (result.nodePosition[n].y <= s.demLength + 1e-9) continue;
    const Vec3 reference = layer(result.nodePosition[n].y / s.diameter() - 0.5);
    error += squaredNorm(result.nodeVelocity[n] - reference);
    size += squaredNorm(reference);
  }
  for (std::size_t l = 0; l + 1 < means.size(); ++l)  // without the wall's
    result.velocityProfile->append(
        {result.figures.endTime, 2.0, (static_cast<double>(l) + 0.5) * s.diameter(), means[l].y, 1.0});
  result.figures.waveformErrorFem = std::sqrt(error / size);
}

/// Of each particle in Bar::byPlace.
std::vector<std::size_t> placesOf(const RunResult& result) {
  std::vector<std::size_t> place(result.byPlace.size());
  for (std::size_t k = 0; k < place.size(); ++k) place[static_cast<std::size_t>(result.byPlace[k])] = k;
  return place;
}

/// Particles outside of the mesh, which carry everything alone.
void compareParticles(RunResult& result, const RunResult& alone) {
  const Settings& s = result.settings;
  const auto count = static_cast<std::size_t>(particlesPerLayer(s) * layers(s, s.demLength - s.overlap));
  const auto there = [&](std::size_t place) { return static_cast<std::size_t>(alone.byPlace[place]); };
  const std::vector<std::size_t> place = placesOf(result);
  double difference = 0.0, size = 0.0, energy = 0.0;
  for (const Vec3& v : alone.particles.v) size += squaredNorm(v);
  for (std::size_t i = 0; i < place.size(); ++i)
    if (place[i] < count) difference += squaredNorm(result.particles.v[i] - alone.particles.v[there(place[i])]);
  energy = 0.5 * particleMass(s) * difference;
  for (const auto& pair : result.pairs.pairs()) {
    const auto i = static_cast<std::size_t>(pair[0]), j = static_cast<std::size_t>(pair[1]);
    if (place[i] >= count || place[j] >= count) continue;
    double ours = dem::pairContact(result.particles, i, j).overlap,
           theirs = dem::pairContact(alone.particles, there(place[i]), there(place[j])).overlap;
    if (!s.tensile()) {
      ours = std::max(ours, 0.0);
      theirs = std::max(theirs, 0.0);
    }
    energy += 0.5 * s.contactStiffness() * (ours - theirs) * (ours - theirs);
  }
  result.figures.waveformErrorDem = std::sqrt(difference / size);
  result.figures.reflectedFraction = energy / result.figures.energyInput;
}

}  // namespace

void addLayers(io::TimeSeries& table, const Settings& s, const std::vector<int>& byPlace, const Frame& frame) {
  std::map<long, LayerSum> nodes;  // by half element sizes, so that rounding cannot split a layer
  for (std::size_t n = 0; frame.nodes && n < frame.nodes->X.size(); ++n) {
    const double y = frame.nodes->X[n].y;
    nodes[std::lround(2.0 * y / Case{}.elementSize)].add(y, frame.nodes->v[n].y, frame.nodeScalars[0].second[n]);
  }
  for (const auto& [place, layer] : nodes) layer.append(table, frame.time, 0);
  const auto perLayer = static_cast<std::size_t>(particlesPerLayer(s));
  const dem::Particles& p = frame.particles;
  const std::size_t count = p.size() / perLayer - (s.fullDem ? 1 : 0);  // without the wall
  for (std::size_t l = 0; l < count; ++l) {
    LayerSum layer;
    for (std::size_t k = l * perLayer; k < (l + 1) * perLayer; ++k) {
      const auto i = static_cast<std::size_t>(byPlace[k]);
      layer.add((static_cast<double>(l) + 0.5) * s.diameter(), p.v[i].y, p.weightOf(i));
    }
    layer.append(table, frame.time, 1);
  }
}

void compare(RunResult& result) {
  if (!result.settings.compare || result.settings.fullDem || !result.figures.finished) return;
  const RunResult& alone = keptRun(particlesAlone(result.settings, result.figures.dt));
  if (!alone.figures.finished) return;
  compareSolid(result, alone);
  compareParticles(result, alone);
  result.figures.speedRatio = result.figures.wallSeconds / alone.figures.wallSeconds;
  result.figures.compared = true;
}

}  // namespace dovetail::wave
