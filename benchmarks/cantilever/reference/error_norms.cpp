#include "reference/error_norms.hpp"

#include <algorithm>
#include <cmath>

#include "dovetail/core/error.hpp"

namespace dovetail::cantilever {
namespace {

template <class Height>
double pairDistance(const PairSample& sample, const BeamCase& beam, Height&& height) {
  double sum = 0.0;
  for (const Vec3& x : sample.x) {
    const double dx = x.x - std::copysign(beam.startX, x.x), dz = x.z - height(sample.time, x.y);
    sum += dx * dx + dz * dz;
  }
  return std::sqrt(sum);
}

std::size_t samplesOnBeam(std::span<const PairSample> samples, const BeamCase& beam, double until) {
  std::size_t count = 0;
  while (count < samples.size() && samples[count].time <= until &&
         std::max(samples[count].x[0].y, samples[count].x[1].y) <= beam.length)
    ++count;
  if (count < 2)
    throw InputError("fewer than two samples of the particles on the beam", "samples",
                     "sample from the start, more often");
  return count;
}

template <class Height>
PairError integrateError(std::span<const PairSample> samples, const BeamCase& beam, Height&& height) {
  PairError error{.mean = 0.0, .largest = 0.0, .until = samples.back().time};
  double previous = pairDistance(samples[0], beam, height);
  error.largest = previous;
  for (std::size_t i = 1; i < samples.size(); ++i) {
    const double current = pairDistance(samples[i], beam, height);
    error.largest = std::max(error.largest, current);
    error.mean += 0.5 * (previous + current) * (samples[i].time - samples[i - 1].time);
    previous = current;
  }
  error.mean /= samples.back().time - samples.front().time;
  return error;
}

}  // namespace

PairError errorFromStatic(std::span<const PairSample> samples, const BeamCase& beam, const StaticOptions& settings) {
  const std::size_t count = samplesOnBeam(samples, beam, HUGE_VAL);
  return integrateError(samples.first(count), beam, [&](double, double y) { return staticHeight(beam, y, settings); });
}

PairError errorFromDynamicAtTime(std::span<const PairSample> samples, const BeamCase& beam,
                                 const DynamicReference& reference) {
  const std::size_t count = samplesOnBeam(samples, beam, reference.leaveTime);
  return integrateError(samples.first(count), beam, [&](double time, double) { return reference.at(time).z; });
}

PairError errorFromDynamicAtY(std::span<const PairSample> samples, const BeamCase& beam,
                              const DynamicReference& reference) {
  const std::size_t count = samplesOnBeam(samples, beam, HUGE_VAL);
  return integrateError(samples.first(count), beam, [&](double, double y) { return reference.atY(y).z; });
}

std::vector<PairSample> pairSamples(const BeamCase& beam, const DynamicReference& reference) {
  std::vector<PairSample> samples;
  for (std::size_t i = 0; i < reference.time.size(); ++i)
    samples.push_back(
        {reference.time[i],
         {Vec3{beam.startX, reference.y[i], reference.z[i]}, Vec3{-beam.startX, reference.y[i], reference.z[i]}}});
  return samples;
}

}  // namespace dovetail::cantilever
