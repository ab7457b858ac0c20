// What all particles share: a file of its own, because these loops gain from vectors where those over pairs lose.
#include <algorithm>

#include "dovetail/core/error.hpp"
#include "dovetail/core/vector_code.hpp"
#include "dovetail/dem/pairs/pair_collide.hpp"

namespace dovetail::dem::detail {

void requireMaterials(const Particles& particles, int materials) {
  if (materials == 1) return;
  parallelFor(particles.material.size(), 16384, [&](std::size_t begin, std::size_t end) {
    const auto first = particles.material.begin();
    const auto unknown = std::find_if(first + static_cast<std::ptrdiff_t>(begin),
                                      first + static_cast<std::ptrdiff_t>(end), [=](int m) { return m >= materials; });
    if (const auto i = static_cast<std::size_t>(unknown - first); i < end)
      throw InputError("material " + std::to_string(particles.material[i]) + " has no law",
                       "particle " + std::to_string(i) + ", material",
                       "give materials from 0 to " + std::to_string(materials - 1) + ", or a larger table of laws");
  });
}

void findUniform(const Particles& particles, PairRows& rows) {
  requireMaterials(particles, rows.materials);
  // Where the ends differ nobody looks between them: sizes are either the same or mixed, as a rule.
  const auto uniform = [](const auto& values) {
    if (values.empty() || values.front() != values.back()) return false;
    return parallelSum(values.size(), 16384, [&](std::size_t begin, std::size_t end) {
             std::int64_t differ = 0;  // as wide as what is compared
             withVectors([&, begin, end] {
               const auto* const value = values.data();
               const auto first = value[0];
               const std::size_t last = end;  // a copy that nothing else can change
               std::int64_t count = 0;
               for (std::size_t i = begin; i < last; ++i) count += value[i] != first ? 1 : 0;
               differ = count;
             });
             return differ;
           }) == 0;
  };
  if (rows.materials > 1 && !particles.material.empty())
    rows.material = uniform(particles.material) ? particles.material[0] : -1;
  rows.oneRadius = uniform(particles.radius);
  rows.turns = rows.spins && particles.rotates();
  rows.spinDifferences = rows.rolls || !rows.oneRadius;
  rows.oneMass = rows.mass && particles.weight.empty() && uniform(particles.mass);
}

}  // namespace dovetail::dem::detail
