// Effective masses and radii of pairs: a file of its own, because these loops gain from vectors where the others lose.
#include "dovetail/core/vector_code.hpp"
#include "dovetail/dem/pairs/pair_collide.hpp"

namespace dovetail::dem::detail {

void gatherMasses(const Particles& particles, std::span<const std::array<int, 2>> pairs, ContactBlock& block) {
  ContactBlock::Row a, b, root, inverse;
  const auto gather = [&](const auto& massOf) {
    for (std::size_t l = 0; l < pairs.size(); ++l) {
      a[l] = massOf(static_cast<std::size_t>(pairs[l][0]));
      b[l] = massOf(static_cast<std::size_t>(pairs[l][1]));
    }
  };
  const double *const mass = particles.mass.data(), *const weight = particles.weight.data();
  if (particles.weight.empty())
    gather([=](std::size_t i) { return mass[i]; });
  else
    gather([=](std::size_t i) { return mass[i] * weight[i]; });
  withVectors([&, count = pairs.size()] {
    const std::size_t n = count;  // a copy that nothing else can change
    for (std::size_t l = 0; l < n; ++l) {
      const double both = a[l] * (b[l] / (a[l] + b[l]));
      root[l] = std::sqrt(both);
      inverse[l] = both > 0.0 ? 1.0 / (both > 0.0 ? both : 1.0) : 0.0;
    }
  });
  std::copy_n(root.begin(), pairs.size(), block.rootMass.begin());
  std::copy_n(inverse.begin(), pairs.size(), block.inverseMass.begin());
}

void makeRadii(std::size_t n, ContactBlock& block) {
  const double *const a = block.radiusI.data(), *const b = block.radiusJ.data();
  double* const effective = block.effectiveRadius.data();
  withVectors([=] {
    for (std::size_t l = 0; l < n; ++l) effective[l] = a[l] * (b[l] / (a[l] + b[l]));
  });
}

}  // namespace dovetail::dem::detail
