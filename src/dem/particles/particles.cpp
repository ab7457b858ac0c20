#include "dovetail/dem/particles/particles.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "dovetail/core/error.hpp"
#include "dovetail/core/farthest.hpp"
#include "dovetail/core/finite.hpp"
#include "dovetail/core/parallel.hpp"
#include "dovetail/core/raw_vector.hpp"

namespace dovetail::dem {

namespace {

std::string place(std::size_t particle, const char* field) {
  return "particle " + std::to_string(particle) + ", " + field;
}

void checkVector(const Vec3& value, std::size_t particle, const char* field) {
  if (!isFinite(value)) throw InputError("not a finite vector", place(particle, field), "give three finite numbers");
}

void checkPositive(double value, std::size_t particle, const char* field) {
  if (!std::isfinite(value) || value <= 0.0)
    throw InputError("the value is " + formatNumber(value), place(particle, field),
                     "give a finite number greater than zero");
}

void checkWeight(double value, std::size_t particle) {
  if (!(value > 0.0 && value <= 1.0))
    throw InputError("the value is " + formatNumber(value), place(particle, "weight"),
                     "give the fraction of the particle that is modelled, above 0 and at most 1");
}

/// Numbers of the particles by ascending id.
const std::vector<int>& byId(const Particles& particles) {
  std::vector<int>& order = particles.byId;
  if (particles.byIdRevision == particles.revision && order.size() == particles.size()) return order;
  order.resize(particles.size());
  std::iota(order.begin(), order.end(), 0);
  const std::int64_t* const id = particles.id.data();
  if (!std::is_sorted(particles.id.begin(), particles.id.end()))
    std::sort(order.begin(), order.end(), [id](int a, int b) { return id[a] < id[b]; });
  particles.byIdRevision = particles.revision;
  return order;
}

void checkIds(const Particles& particles) {
  const std::vector<int>& order = byId(particles);
  for (std::size_t k = 0; k < order.size(); ++k) {
    const auto i = static_cast<std::size_t>(order[k]);
    const std::int64_t id = particles.id[i];
    if (id < 0 || id >= particles.nextId)
      throw InputError("the id is " + std::to_string(id) + ", the next one " + std::to_string(particles.nextId),
                       place(i, "id"), "leave ids to addParticle");
    if (k > 0 && particles.id[static_cast<std::size_t>(order[k - 1])] == id)
      throw InputError("the id " + std::to_string(id) + " is also that of particle " + std::to_string(order[k - 1]),
                       place(i, "id"), "leave ids to addParticle");
  }
}

void checkLength(std::size_t length, std::size_t wanted, const char* field) {
  if (length != wanted)
    throw InputError(
        "the array has " + std::to_string(length) + " entries for " + std::to_string(wanted) + " particles", field,
        "add particles with addParticle, or resize all arrays together");
}

}  // namespace

int addParticle(Particles& particles, const Vec3& x, const Vec3& v, double radius, Mass mass) {
  const std::size_t i = particles.size();
  checkVector(x, i, "position");
  if (isTooFar(x))
    throw InputError("it lies farther than 1e15 m from the origin", place(i, "position"), "give coordinates in metres");
  checkVector(v, i, "velocity");
  checkPositive(radius, i, "radius");
  checkPositive(mass.value, i, "mass");
  if (particles.rotates()) {
    particles.omega.emplace_back();
    particles.torque.emplace_back();
  }
  if (!particles.material.empty()) particles.material.push_back(0);
  if (!particles.weight.empty()) particles.weight.push_back(1.0);
  if (!particles.owner.empty()) particles.owner.push_back(Owner::nobody);
  particles.id.push_back(particles.nextId++);
  ++particles.revision;
  particles.x.push_back(x);
  particles.v.push_back(v);
  particles.f.emplace_back();
  particles.radius.push_back(radius);
  particles.mass.push_back(mass.value);
  return static_cast<int>(i);
}

int addParticle(Particles& particles, const Vec3& x, const Vec3& v, double radius, Density density) {
  checkPositive(density.value, particles.size(), "density");
  return addParticle(particles, x, v, radius,
                     Mass{density.value * (4.0 / 3.0) * std::numbers::pi * radius * radius * radius});
}

int find(const Particles& particles, std::int64_t id) {
  const auto guess = static_cast<std::size_t>(id);
  if (id >= 0 && guess < particles.size() && particles.id[guess] == id) return static_cast<int>(id);
  const std::vector<int>& order = byId(particles);
  const auto idOf = [&](int i) { return particles.id[static_cast<std::size_t>(i)]; };
  const auto found =
      std::lower_bound(order.begin(), order.end(), id, [&](int i, std::int64_t wanted) { return idOf(i) < wanted; });
  return found != order.end() && idOf(*found) == id ? *found : -1;
}

std::vector<int> numbersWithout(const Particles& particles, std::span<const int> list) {
  std::vector<int> number(particles.size(), 0);
  for (const int i : list) {
    if (i < 0 || static_cast<std::size_t>(i) >= number.size())
      throw InputError("particle " + std::to_string(i) + " does not exist", "removal",
                       "give numbers from 0 to " + std::to_string(static_cast<long>(number.size()) - 1));
    number[static_cast<std::size_t>(i)] = -1;
  }
  constexpr std::size_t chunkSize = 16384;
  std::vector<int> next((number.size() + chunkSize - 1) / chunkSize + 1, 0);
  parallelFor(number.size(), chunkSize, [&](std::size_t begin, std::size_t end) {
    int stay = 0;
    for (std::size_t i = begin; i < end; ++i) stay += number[i] == 0 ? 1 : 0;
    next[begin / chunkSize + 1] = stay;
  });
  for (std::size_t c = 1; c < next.size(); ++c) next[c] += next[c - 1];
  parallelFor(number.size(), chunkSize, [&](std::size_t begin, std::size_t end) {
    int& to = next[begin / chunkSize];
    for (std::size_t i = begin; i < end; ++i)
      if (number[i] == 0) number[i] = to++;
  });
  return number;
}

void renumber(Particles& particles, std::span<const int> newNumber) {
  checkLength(newNumber.size(), particles.size(), "new numbers");
  RawVector<int> order(particles.size());
  const std::size_t count = parallelSum(newNumber.size(), 16384, [&](std::size_t begin, std::size_t end) {
    std::size_t stay = 0;
    for (std::size_t i = begin; i < end; ++i)
      if (newNumber[i] >= 0) {
        order[static_cast<std::size_t>(newNumber[i])] = static_cast<int>(i);
        ++stay;
      }
    return stay;
  });
  forEachArray(particles, [&](auto& values) {
    if (values.empty()) return;
    std::remove_reference_t<decltype(values)> moved(count);
    parallelFor(count, 4096, [&](std::size_t begin, std::size_t end) {
      for (std::size_t n = begin; n < end; ++n) moved[n] = values[static_cast<std::size_t>(order[n])];
    });
    values.swap(moved);
  });
  ++particles.revision;
}

std::vector<int> removeParticles(Particles& particles, std::span<const int> list) {
  std::vector<int> number = numbersWithout(particles, list);
  if (!list.empty()) renumber(particles, number);
  return number;
}

void setOwner(Particles& particles, int particle, Owner owner) {
  particles.owner.resize(particles.size(), Owner::nobody);
  particles.owner[static_cast<std::size_t>(particle)] = owner;
}

void switchOnRotation(Particles& particles) {
  particles.omega.resize(particles.size());
  particles.torque.resize(particles.size());
}

void validate(const Particles& particles) {
  const std::size_t n = particles.size();
  checkLength(particles.v.size(), n, "velocity");
  checkLength(particles.f.size(), n, "force");
  checkLength(particles.radius.size(), n, "radius");
  checkLength(particles.mass.size(), n, "mass");
  if (!particles.material.empty()) checkLength(particles.material.size(), n, "material");
  if (!particles.weight.empty()) checkLength(particles.weight.size(), n, "weight");
  if (!particles.owner.empty()) checkLength(particles.owner.size(), n, "owner");
  checkLength(particles.id.size(), n, "id");
  if (particles.rotates() || !particles.torque.empty()) {
    checkLength(particles.omega.size(), n, "angular velocity");
    checkLength(particles.torque.size(), n, "torque");
  }
  for (std::size_t i = 0; i < n; ++i) {
    checkVector(particles.x[i], i, "position");
    checkVector(particles.v[i], i, "velocity");
    checkPositive(particles.radius[i], i, "radius");
    checkPositive(particles.mass[i], i, "mass");
    if (particles.rotates()) checkVector(particles.omega[i], i, "angular velocity");
    checkWeight(particles.weightOf(i), i);
  }
  checkIds(particles);
}

}  // namespace dovetail::dem
