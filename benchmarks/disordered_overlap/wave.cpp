#include "wave.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include "dovetail/core/error.hpp"
#include "dovetail/dem/model/walls.hpp"

namespace dovetail::disordered_overlap {

namespace {

constexpr double slabThickness = 2.0 * grain::diameter;
constexpr int samples = 80;

/// The means of a run in slabs. Grains belong to the slab where they were at first: they hardly move.
class Slabs {
public:
  Slabs(const dem::Model& packing, double height) {
    const auto count = static_cast<std::size_t>(height / slabThickness);
    const double lid = dem::primitiveWall(packing, lidOfPressed).point.z;
    for (std::size_t k = 0; k < count; ++k) depth.push_back((static_cast<double>(k) + 0.5) * slabThickness);
    slab_.assign(static_cast<std::size_t>(packing.particles.nextId), -1);
    mass.assign(count, 0.0);
    const dem::Particles& p = packing.particles;
    for (std::size_t i = 0; i < p.size(); ++i) {
      const int k = static_cast<int>(std::floor((lid - p.x[i].z) / slabThickness));
      if (k < 0 || k >= static_cast<int>(count)) continue;
      slab_[static_cast<std::size_t>(p.id[i])] = k;
      mass[static_cast<std::size_t>(k)] += p.mass[i];
    }
  }
  std::vector<double> means(const dem::Particles& p, int axis) const {
    std::vector<double> sum(depth.size(), 0.0);
    for (std::size_t i = 0; i < p.size(); ++i)
      if (const int k = slab_[static_cast<std::size_t>(p.id[i])]; k >= 0)
        sum[static_cast<std::size_t>(k)] += p.mass[i] * p.v[i][axis];
    for (std::size_t k = 0; k < sum.size(); ++k) sum[k] /= mass[k];
    return sum;
  }
  std::vector<double> depth, mass;

private:
  std::vector<int> slab_;  // by id
};

/// Velocity of the solid at a height, by the means of its nodes there.
class SolidProfile {
public:
  SolidProfile(const JoinedColumn& column, const SolidPlace& place)
      : height_(static_cast<std::size_t>(std::lround((place.top - place.bottom) / place.element)) + 1, 0.0),
        count_(height_.size(), 0.0) {
    const fem::Nodes& nodes = column.run.solid(0).nodes();
    for (const Vec3& X : column.mesh.X)
      plane_.push_back(static_cast<std::size_t>(std::lround((X.z - place.bottom) / place.element)));
    for (std::size_t n = 0; n < plane_.size(); ++n) count_[plane_[n]] += 1.0;
    for (std::size_t n = 0; n < plane_.size(); ++n)
      height_[plane_[n]] += (nodes.X[n].z + nodes.u[n].z) / count_[plane_[n]];
  }
  void take(const fem::Nodes& nodes, int axis) {
    value_.assign(height_.size(), 0.0);
    for (std::size_t n = 0; n < plane_.size(); ++n) value_[plane_[n]] += nodes.v[n][axis] / count_[plane_[n]];
  }
  double at(double z) const {
    const auto above = std::upper_bound(height_.begin() + 1, height_.end() - 1, z);
    const auto k = static_cast<std::size_t>(above - height_.begin());
    const double s = (z - height_[k - 1]) / (height_[k] - height_[k - 1]);
    return (1.0 - s) * value_[k - 1] + s * value_[k];
  }

private:
  std::vector<std::size_t> plane_;  // of each node
  std::vector<double> height_, count_, value_;
};

struct Pulse {
  double start, duration, speed;  // s, s, m/s
  int axis;
  double sign;
};

/// Half of a raised cosine's period up and down again: v (1 − cos)/2.
void drive(coupling::CoupledRun& run, const Pulse& pulse) {
  dem::primitiveWall(run.grains, lidOfPressed).motion = [pulse](double time, dem::PrimitiveWall& lid) {
    const double s = (time - pulse.start) / pulse.duration;
    const double v = s > 0.0 && s < 1.0 ? 0.5 * pulse.speed * (1.0 - std::cos(2.0 * std::numbers::pi * s)) : 0.0;
    lid.velocity = {};
    lid.velocity[pulse.axis] = pulse.sign * v;
  };
}

SolidPlace placeOf(const dem::Model& packing, const WaveOptions& s) {
  const double lid = dem::primitiveWall(packing, lidOfPressed).point.z;
  return {.width = widthOf(packing),
          .bottom = lid - s.depth(),
          .border = lid - s.alone(),
          .top = lid - s.shared(),
          .element = s.element};
}

/// What the ledger of a run hold, J.
struct Books {
  double friction, overlap, residual;
};
Books booksOf(coupling::CoupledRun& run) {
  const EnergyLedger& l = run.ledger();
  return {l.joules("particles: friction"), l.joules("overlap: lost"), l.residual()};
}

/// The grains above the overlap as they are at the end.
void keepGrains(const dem::Particles& p, double above, WaveRun& result) {
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < p.size(); ++i)
    if (p.x[i].z > above) order.push_back(i);
  std::ranges::sort(order, {}, [&p](std::size_t i) { return p.id[i]; });
  for (const std::size_t i : order) {
    result.id.push_back(p.id[i]);
    result.v.push_back(p.v[i]);
    result.omega.push_back(p.omega[i]);
    result.mass.push_back(p.mass[i]);
    result.radius.push_back(p.radius[i]);
  }
}

/// Sends the pulse through a run that is at rest. @param column  null: all is grains
WaveRun send(coupling::CoupledRun& run, const JoinedColumn* column, const SolidPlace& place, const Slabs& slabs,
             const WaveOptions& s) {
  const auto begin = std::chrono::steady_clock::now();
  WaveRun result;
  result.dt = run.dt();
  result.atRest = run.kineticEnergy();
  result.form.depth = slabs.depth;
  result.form.mass = slabs.mass;
  const int axis = s.shear ? 0 : 2;
  const double start = run.time();
  const Books before = booksOf(run);
  drive(run, {start, s.duration(), s.strain * s.speed, axis, s.shear ? 1.0 : -1.0});
  const auto steps = std::lround(s.end() / samples / run.dt());
  std::optional<SolidProfile> profile;
  if (column) profile.emplace(*column, place);
  for (int k = 0; k < samples; ++k) {
    run.advance(steps);
    if (result.pulse == 0.0 && run.time() - start >= s.duration()) result.pulse = 2.0 * run.kineticEnergy();
    std::vector<double> v = slabs.means(run.grains.particles, axis);
    if (profile) {
      profile->take(column->run.solid(0).nodes(), axis);
      for (std::size_t j = 0; j < v.size(); ++j) {
        if (slabs.depth[j] > s.shared() - slabThickness) v[j] = std::numeric_limits<double>::quiet_NaN();
        if (slabs.depth[j] > s.alone()) v[j] = profile->at(place.bottom + s.depth() - slabs.depth[j]);
      }
    }
    result.form.time.push_back(run.time() - start);
    result.form.velocity.push_back(std::move(v));
  }
  const Books after = booksOf(run);
  result.friction = after.friction - before.friction;
  result.overlap = after.overlap - before.overlap;
  result.residual = after.residual - before.residual;
  keepGrains(run.grains.particles, place.top + slabThickness, result);
  result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return result;
}

void rest(coupling::CoupledRun& run, double kinetic) {
  const RestReport report = coupling::relax(run, {.tolerance = kinetic, .steps = 60000});
  if (!report.atRest)
    throw NumericalError("the column does not come to rest: kinetic energy is " + std::to_string(report.residual) +
                             " of the elastic one",
                         "wave in a column", "take another seed");
}

}  // namespace

WavePair runPair(const dem::Model& packing, const WaveOptions& s, const Moduli& moduli) {
  const SolidPlace place = placeOf(packing, s);
  const Slabs slabs(packing, s.depth());
  WavePair pair;
  pair.particles = packing.particles.size();
  const auto joined = joinSolid(packing, floorOfPressed, place, solidOf(moduli), s.join);
  startWith(joined->run, 0.5);
  rest(joined->run, s.rest);
  const double interval = s.end() / samples;
  const double dt = interval / std::ceil(interval / (s.weight * joined->run.criticalStep().dt));
  joined->run.start(dt);
  pair.joined = send(joined->run, joined.get(), place, slabs, s);
  coupling::CoupledRun full(packing);
  startWith(full, 0.5);
  rest(full, s.rest);
  full.start(dt);
  pair.full = send(full, nullptr, place, slabs, s);
  return pair;
}

Reflected reflected(const WavePair& pair) {
  const WaveRun &a = pair.joined, &b = pair.full;
  std::vector<std::size_t> partner(static_cast<std::size_t>(std::ranges::max(b.id)) + 1, b.id.size());
  for (std::size_t k = 0; k < b.id.size(); ++k) partner[static_cast<std::size_t>(b.id[k])] = k;
  double energy = 0.0;
  for (std::size_t k = 0; k < a.id.size(); ++k) {
    if (a.id[k] >= static_cast<std::int64_t>(partner.size())) continue;
    const std::size_t j = partner[static_cast<std::size_t>(a.id[k])];
    if (j == b.id.size()) continue;
    energy += a.mass[k] *
              (squaredNorm(a.v[k] - b.v[j]) + 0.4 * a.radius[k] * a.radius[k] * squaredNorm(a.omega[k] - b.omega[j]));
  }
  double slabs = 0.0;
  const std::vector<double>&va = a.form.velocity.back(), &vb = b.form.velocity.back();
  for (std::size_t k = 0; k < va.size() && std::isfinite(va[k]); ++k)
    slabs += a.form.mass[k] * (va[k] - vb[k]) * (va[k] - vb[k]);
  return {energy / b.pulse, slabs / b.pulse};
}

double misfit(const Waveform& a, const Waveform& b, double depth) {
  double difference = 0.0, size = 0.0;
  for (std::size_t t = 0; t < b.time.size(); ++t)
    for (std::size_t k = 0; k < b.depth.size(); ++k) {
      if (b.depth[k] < depth) continue;
      difference += std::pow(a.velocity[t][k] - b.velocity[t][k], 2);
      size += std::pow(b.velocity[t][k], 2);
    }
  return std::sqrt(difference / size);
}

Waveform mean(const std::vector<const Waveform*>& forms) {
  Waveform sum = *forms.front();
  for (std::size_t t = 0; t < sum.time.size(); ++t) {
    sum.velocity[t].assign(sum.depth.size(), 0.0);
    for (const Waveform* form : forms)
      for (std::size_t k = 0; k < sum.depth.size(); ++k)
        sum.velocity[t][k] += form->velocity[t][k] / static_cast<double>(forms.size());
  }
  return sum;
}

}  // namespace dovetail::disordered_overlap
