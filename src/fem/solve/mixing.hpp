// Increments with the same factors, bettered by those before them.
#pragma once

#include <span>
#include <vector>

namespace dovetail::fem::detail {

/// Anderson's mixing, type II: of the increments d(q) = K⁻¹ r(q) at earlier states q, the combination of differences
/// that takes most away from the present one, in the least squares, is what the states may be moved by for nothing: the
/// new increment is d − Σ γ_j (Δq_j + Δd_j) (Anderson 1965; Walker & Ni 2011, eq. 2.2).
class Mixing {
public:
  explicit Mixing(int depth) : depth_(static_cast<std::size_t>(depth)) {}

  std::size_t depth() const { return depth_; }
  void clear();
  /// Betters the increment found at the present state.
  void better(std::span<double> increment);
  /// The state has moved by that much from where better() was asked last.
  void moved(std::span<const double> way) { way_.assign(way.begin(), way.end()); }

private:
  std::size_t depth_;
  std::vector<double> last_, way_;                  // increment and move of the state before
  std::vector<std::vector<double>> change_, move_;  // Δd and Δq + Δd, newest first
};

}  // namespace dovetail::fem::detail
