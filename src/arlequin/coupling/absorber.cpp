#include "dovetail/arlequin/absorber.hpp"

#include "dovetail/core/finite.hpp"

namespace dovetail::arlequin {

namespace {

/// Φ with the gap's rows for columns; weights of nodes without a row are left out and the rest made to sum to one.
cg::Projection onRows(const cg::Projection& interpolation, const std::vector<int>& node) {
  std::vector<int> row(static_cast<std::size_t>(interpolation.columns), -1);
  for (std::size_t r = 0; r < node.size(); ++r) row[static_cast<std::size_t>(node[r])] = static_cast<int>(r);
  std::vector<cg::ProjectionRow> rows(static_cast<std::size_t>(interpolation.rows()));
  for (int k = 0; k < interpolation.rows(); ++k) {
    double sum = 0.0;
    for (int e = interpolation.offsets[k]; e < interpolation.offsets[k + 1]; ++e)
      if (row[interpolation.column[e]] >= 0) sum += interpolation.weight[e];
    for (int e = interpolation.offsets[k]; e < interpolation.offsets[k + 1]; ++e)
      if (row[interpolation.column[e]] >= 0 && sum > 0.0)
        rows[static_cast<std::size_t>(k)].emplace_back(row[interpolation.column[e]], interpolation.weight[e] / sum);
  }
  return cg::fromRows(static_cast<int>(node.size()), rows);
}

}  // namespace

Absorber::Absorber(const Overlap& overlap, const GapOperator& gap, const cg::Projection& interpolation,
                   std::span<const double> particleMass, double rate)
    : overlap_(overlap),
      coarse_(gap.particles),
      coarseBack_(gap.particlesBack),
      fine_(onRows(interpolation, gap.node)),
      fineBack_(cg::transposed(fine_)) {
  requirePositive(rate, "absorber");
  for (std::size_t k = 0; k < overlap.size(); ++k) {
    // No node of its element has a row: there is no mean that it fluctuates about.
    const bool isAlone = fine_.rowColumns(static_cast<int>(k)).empty();
    damping_.push_back(isAlone ? 0.0 : rate * (1.0 - overlap.weight[k]) * particleMass[overlap.particle[k]]);
  }
  force_.assign(overlap.size(), {});
  here_ = back_ = force_;
  rows_.resize(gap.rows());
}

void Absorber::apply(std::span<const Vec3> v, std::span<Vec3> f) {
  for (std::size_t k = 0; k < here_.size(); ++k) here_[k] = v[overlap_.particle[k]];
  cg::apply(coarse_, here_, rows_);
  cg::apply(fine_, rows_, back_);
  for (std::size_t k = 0; k < here_.size(); ++k) here_[k] = damping_[k] * (here_[k] - back_[k]);  // D R v
  cg::apply(fineBack_, here_, rows_);
  cg::apply(coarseBack_, rows_, back_);
  for (std::size_t k = 0; k < here_.size(); ++k) {
    force_[k] = back_[k] - here_[k];
    f[overlap_.particle[k]] += force_[k];
  }
}

}  // namespace dovetail::arlequin
