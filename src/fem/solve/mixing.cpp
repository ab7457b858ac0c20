#include "mixing.hpp"

#include <algorithm>

#include "newton_tools.hpp"

namespace dovetail::fem::detail {

namespace {

void subtract(double factor, std::span<const double> x, std::span<double> y) {
  for (std::size_t i = 0; i < y.size(); ++i) y[i] -= factor * x[i];
}

}  // namespace

void Mixing::clear() {
  last_.clear();
  way_.clear();
  change_.clear();
  move_.clear();
}

void Mixing::better(std::span<double> increment) {
  if (!way_.empty()) {
    std::vector<double> change(increment.begin(), increment.end());
    subtract(1.0, last_, change);
    for (std::size_t i = 0; i < way_.size(); ++i) way_[i] += change[i];
    change_.insert(change_.begin(), std::move(change));
    move_.insert(move_.begin(), std::move(way_));
    change_.resize(std::min(change_.size(), depth_));
    move_.resize(change_.size());
  }
  last_.assign(increment.begin(), increment.end());
  way_.clear();
  // Gram–Schmidt, the newest first: what adds no direction is left out.
  std::vector<std::vector<double>> basis = change_, along = move_;
  std::vector<double> left(last_);
  for (std::size_t j = 0; j < basis.size(); ++j) {
    const double whole = innerProduct(basis[j], basis[j]);
    for (std::size_t k = 0; k < j; ++k) {
      const double square = innerProduct(basis[k], basis[k]);
      if (square == 0.0) continue;
      const double factor = innerProduct(basis[k], basis[j]) / square;
      subtract(factor, basis[k], basis[j]);
      subtract(factor, along[k], along[j]);
    }
    const double square = innerProduct(basis[j], basis[j]);
    if (!(square > 1e-12 * whole)) {
      std::fill(basis[j].begin(), basis[j].end(), 0.0);
      continue;
    }
    const double factor = innerProduct(basis[j], left) / square;
    subtract(factor, basis[j], left);
    subtract(factor, along[j], increment);
  }
}

}  // namespace dovetail::fem::detail
