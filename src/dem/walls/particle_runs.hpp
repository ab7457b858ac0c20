// Parallel loops over contacts that are sorted by particle.
#pragma once

#include <vector>

#include "dovetail/core/parallel.hpp"

namespace dovetail::dem {

/// body(begin, end) over all contacts; those of one particle are never in two calls.
template <class Body>
void forParticleRuns(const std::vector<int>& particle, const Body& body) {
  const std::size_t n = particle.size();
  const auto runFrom = [&](std::size_t c) {
    while (c > 0 && c < n && particle[c] == particle[c - 1]) ++c;
    return c;
  };
  parallelFor(n, 1024, [&](std::size_t begin, std::size_t end) { body(runFrom(begin), runFrom(end)); });
}

}  // namespace dovetail::dem
