#include <numeric>
#include <string>

#include "dovetail/core/error.hpp"
#include "dovetail/dem/setup/insertion.hpp"

namespace dovetail::dem {

namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }

template <class T>
void compact(std::vector<T>& values, const std::vector<int>& newNumber) {
  if (values.empty()) return;
  std::size_t count = 0;
  for (std::size_t i = 0; i < newNumber.size(); ++i)
    if (newNumber[i] >= 0) values[count++] = values[i];
  values.resize(count);
}

/// Old → new number when those listed go.
std::vector<int> numbersWithout(std::span<const int> list, std::size_t size, const char* item) {
  std::vector<int> number(size, 0);
  for (const int i : list) {
    if (i < 0 || at(i) >= size)
      throw InputError(std::string(item) + " " + std::to_string(i) + " does not exist", "removal",
                       "give numbers from 0 to " + std::to_string(static_cast<long>(size) - 1));
    number[at(i)] = -1;
  }
  int next = 0;
  for (int& n : number)
    if (n == 0) n = next++;
  return number;
}

bool inside(const Vec3& x, const geometry::Box& box) {
  for (int k = 0; k < 3; ++k)
    if (!(x[k] >= box.lower[k] && x[k] <= box.upper[k])) return false;
  return true;
}

std::vector<int> select(const Particles& particles, const geometry::Box& box, bool wanted) {
  std::vector<int> list;
  for (std::size_t i = 0; i < particles.size(); ++i)
    if (inside(particles.x[i], box) == wanted) list.push_back(static_cast<int>(i));
  return list;
}

}  // namespace

std::vector<int> particlesInside(const Particles& particles, const geometry::Box& box) {
  return select(particles, box, true);
}
std::vector<int> particlesOutside(const Particles& particles, const geometry::Box& box) {
  return select(particles, box, false);
}

std::vector<int> removeParticles(Particles& particles, std::span<const int> list) {
  const std::vector<int> number = numbersWithout(list, particles.size(), "particle");
  if (list.empty()) return number;
  if (particles.id.empty()) {
    particles.id.resize(particles.size());
    std::iota(particles.id.begin(), particles.id.end(), std::int64_t{0});
  }
  compact(particles.x, number);
  compact(particles.v, number);
  compact(particles.f, number);
  compact(particles.radius, number);
  compact(particles.mass, number);
  compact(particles.omega, number);
  compact(particles.torque, number);
  compact(particles.material, number);
  compact(particles.id, number);
  return number;
}

void renumber(Clumps& clumps, std::span<const int> newNumber) {
  for (std::size_t m = 0; m < clumps.size(); ++m)
    if (newNumber[at(clumps.particle[m])] < 0)
      throw InputError("particle " + std::to_string(clumps.particle[m]) + " is a member of body " +
                           std::to_string(clumps.body[m]) + " and is gone",
                       "renumbering of clumps", "take whole clumps out with removeClumps");
  for (int& i : clumps.particle) i = newNumber[at(i)];
}

std::vector<int> removeClumps(Particles& particles, Bodies& bodies, Clumps& clumps, std::span<const int> list) {
  const std::vector<int> body = numbersWithout(list, bodies.size(), "body");
  std::vector<int> members, kept(clumps.size());
  int next = 0;
  for (std::size_t m = 0; m < clumps.size(); ++m) {
    kept[m] = body[at(clumps.body[m])] < 0 ? -1 : next++;
    if (kept[m] < 0) members.push_back(clumps.particle[m]);
  }
  const std::vector<int> number = removeParticles(particles, members);
  compact(clumps.particle, kept);
  compact(clumps.body, kept);
  compact(clumps.offset, kept);
  for (std::size_t m = 0; m < clumps.size(); ++m) {
    clumps.particle[m] = number[at(clumps.particle[m])];
    clumps.body[m] = body[at(clumps.body[m])];
  }
  compact(bodies.x, body);
  compact(bodies.v, body);
  compact(bodies.f, body);
  compact(bodies.mass, body);
  compact(bodies.inertia, body);
  compact(bodies.orientation, body);
  compact(bodies.angularMomentum, body);
  compact(bodies.torque, body);
  return number;
}

}  // namespace dovetail::dem
