#include "dovetail/fem/model/term.hpp"

#include <algorithm>
#include <cmath>

#include "dovetail/linalg/block_matrix.hpp"

namespace dovetail::fem {

void Term::addStiffness(const Nodes& nodes, const Instant& now, std::span<double> k) {
  if (!hasEnergy()) return;
  linalg::MatrixPattern pattern(k.size());
  addPattern(pattern);
  linalg::BlockMatrix K(std::move(pattern));
  addTangent(nodes, now, K);
  for (std::size_t n = 0; n < k.size(); ++n) {
    double largest = 0.0;
    for (std::size_t c = 0; c < 3; ++c) {
      double sum = 0.0;
      for (int place = K.offsets()[n]; place < K.offsets()[n + 1]; ++place)
        for (std::size_t d = 0; d < 3; ++d)
          sum += std::abs(K.values()[9 * static_cast<std::size_t>(place) + 3 * c + d]);
      largest = std::max(largest, sum);
    }
    k[n] += largest;
  }
}

}  // namespace dovetail::fem
