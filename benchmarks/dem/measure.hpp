// Throughput, memory and traffic.
#pragma once

#include <algorithm>
#include <chrono>
#include <string>
#include <vector>

#include "dovetail/dem/model/model.hpp"

namespace dovetail::dem_benchmark {

/// Million particle steps per second: of several runs one after the other.
struct Rates {
  double median = 0.0, lowest = 0.0, highest = 0.0;
};

struct Figures {
  std::string name;
  std::size_t particles = 0, pairs = 0, contacts = 0;
  Rates rates;
  double bytesHeld = 0.0;   ///< by particles and lists, per particle
  double bytesMoved = 0.0;  ///< at least, per particle and step; see bytesMovedPerStep
  std::int64_t builds = 0, prunings = 0;
  double nanoseconds() const { return 1e3 / rates.median; }
};

double now();
Rates ratesOf(std::vector<double> millions);

/// Bytes in the arrays of particles and lists.
std::size_t bytesHeld(const dem::Particles& particles, const dem::PairList& list);
/// Bytes that one step must read and write if every array streams through the processor once per sweep: the sweep that
/// moves particles, and the sweep over pairs. Neighbours are taken as found in the cache.
double bytesMovedPerStep(const dem::Particles& particles, const dem::PairList& list, bool mass, bool oneSize);
std::size_t touching(const dem::Particles& particles, const dem::PairList& list);

/// Sustained bandwidth of a = b + s c over arrays far larger than the caches, GB/s (24 bytes per element).
double triadBandwidth(int threads);

/// @param warmUp steps before the clock starts @param forced list made anew at every so many steps; 0 = when needed
inline Figures measure(const std::string& name, dem::Model& model, double dt, int warmUp, int steps, int repeats,
                       int forced = 0) {
  const auto goOn = [&](int count) {
    for (int s = 0; s < count; ++s) {
      if (forced > 0 && model.steps % forced == 0) findPairs(model.particles, model.pairs);
      advance(model, dt);
    }
  };
  goOn(warmUp);
  std::vector<double> millions;
  const std::int64_t builds = model.pairs.builds(), revision = model.pairs.revision();
  for (int r = 0; r < repeats; ++r) {
    const double start = now();
    goOn(steps);
    millions.push_back(1e-6 * steps * static_cast<double>(model.particles.size()) / (now() - start));
  }
  close(model);
  Figures f{.name = name,
            .particles = model.particles.size(),
            .pairs = model.pairs.size(),
            .contacts = touching(model.particles, model.pairs),
            .rates = ratesOf(std::move(millions)),
            .bytesHeld = 0.0,
            .bytesMoved = 0.0,
            .builds = model.pairs.builds() - builds,
            .prunings = model.pairs.revision() - revision};
  const auto [smallest, largest] = std::minmax_element(model.particles.radius.begin(), model.particles.radius.end());
  const auto n = static_cast<double>(f.particles);
  f.bytesHeld = static_cast<double>(bytesHeld(model.particles, model.pairs)) / n;
  f.bytesMoved = bytesMovedPerStep(model.particles, model.pairs, true, *smallest == *largest) / n;
  return f;
}

}  // namespace dovetail::dem_benchmark
