#include <string>

#include "dovetail/core/error.hpp"
#include "dovetail/dem/setup/insertion.hpp"

namespace dovetail::dem {

namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }

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

std::vector<int> removeClumps(Particles& particles, Bodies& bodies, Clumps& clumps, std::span<const int> list) {
  std::vector<char> leaves(bodies.size(), 0);
  for (const int b : list) {
    if (b < 0 || at(b) >= bodies.size())
      throw InputError("body " + std::to_string(b) + " does not exist", "removal",
                       "give numbers from 0 to " + std::to_string(static_cast<long>(bodies.size()) - 1));
    leaves[at(b)] = 1;
  }
  std::vector<int> members;
  for (std::size_t m = 0; m < clumps.size(); ++m)
    if (leaves[at(clumps.body[m])] != 0) members.push_back(clumps.particle[m]);
  const std::vector<int> number = removeParticles(particles, members);
  renumber(bodies, clumps, number);
  return number;
}

}  // namespace dovetail::dem
