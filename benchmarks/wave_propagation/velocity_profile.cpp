#include "velocity_profile.hpp"

#include <cmath>
#include <map>

namespace dovetail::wave {

namespace {

enum Kind { nodes = 0, particles = 1, particlesAlone = 2 };

struct LayerSum {
  double y = 0.0, velocity = 0.0, share = 0.0;
  int count = 0;

  void add(double place, double speed, double weight) {
    y += place;
    velocity += speed;
    share += weight;
    ++count;
  }
};

void append(io::TimeSeries& table, double time, Kind kind, const LayerSum& layer) {
  const double n = layer.count;
  table.append({time, static_cast<double>(kind), layer.y / n, layer.velocity / n, layer.share / n});
}

void appendNodes(io::TimeSeries& table, double time, const Bar& bar) {
  std::map<long, LayerSum> layers;  // by half element sizes, so that rounding cannot split a layer
  const fem::Nodes& solid = bar.solid->nodes();
  for (std::size_t n = 0; n < solid.X.size(); ++n)
    layers[std::lround(2.0 * solid.X[n].y / Case{}.elementSize)].add(solid.X[n].y, solid.v[n].y,
                                                                     bar.tie->overlap().nodalWeight[n]);
  for (const auto& [place, layer] : layers) append(table, time, nodes, layer);
}

}  // namespace

io::TimeSeries emptyProfile() {
  return io::TimeSeries({"time_s", "model", "y_m", "velocity_y_m_per_s", "particles_share"});
}

void appendProfile(io::TimeSeries& table, const Settings& s, const Frame& frame) {
  if (frame.bar.solid) appendNodes(table, frame.time, frame.bar);
  const auto perLayer = static_cast<std::size_t>(particlesPerLayer(s));
  const dem::Particles& p = frame.bar.run->grains.particles;
  const std::size_t count = p.size() / perLayer - (s.fullDem ? 1 : 0);  // without the wall
  for (std::size_t l = 0; l < count; ++l) {
    LayerSum layer;
    for (std::size_t i = l * perLayer; i < (l + 1) * perLayer; ++i)
      layer.add((static_cast<double>(l) + 0.5) * particleDiameter(s), p.v[i].y, p.weightOf(i));
    append(table, frame.time, particles, layer);
  }
}

void appendParticlesAlone(io::TimeSeries& table, const RunResult& result) {
  const double d = particleDiameter(result.settings);
  for (std::size_t l = 0; l < result.aloneVelocity.size(); ++l)
    table.append({result.figures.endTime, static_cast<double>(particlesAlone), (static_cast<double>(l) + 0.5) * d,
                  result.aloneVelocity[l].y, 1.0});
}

}  // namespace dovetail::wave
