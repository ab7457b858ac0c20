// Effective masses and radii of pairs: a file of its own, because these loops gain from vectors where the others lose.
#include "dovetail/dem/pairs/pair_collide.hpp"

namespace dovetail::dem::detail {

void gatherMasses(const Particles& particles, std::span<const std::array<int, 2>> pairs, ContactBlock& block) {
  const double* const mass = particles.mass.data();
  ContactBlock::Row a, b;
  for (std::size_t l = 0; l < pairs.size(); ++l) {
    a[l] = mass[pairs[l][0]];
    b[l] = mass[pairs[l][1]];
  }
  if (!particles.weight.empty())
    for (std::size_t l = 0; l < pairs.size(); ++l) {
      a[l] *= particles.weight[static_cast<std::size_t>(pairs[l][0])];
      b[l] *= particles.weight[static_cast<std::size_t>(pairs[l][1])];
    }
  for (std::size_t l = 0; l < pairs.size(); ++l) {
    const double both = a[l] * (b[l] / (a[l] + b[l]));
    block.rootMass[l] = std::sqrt(both);
    block.inverseMass[l] = both > 0.0 ? 1.0 / (both > 0.0 ? both : 1.0) : 0.0;
  }
}

void makeRadii(std::size_t n, ContactBlock& block) {
  for (std::size_t l = 0; l < n; ++l)
    block.effectiveRadius[l] = block.radiusI[l] * (block.radiusJ[l] / (block.radiusI[l] + block.radiusJ[l]));
}

}  // namespace dovetail::dem::detail
