// The gap of an overlap tie: what of it is of the present ties, what is kept, what slips.
#include <algorithm>

#include "arlequin_coupling_impl.hpp"
#include "dovetail/core/parallel.hpp"
#include "gap/kept_gap.hpp"

namespace dovetail::arlequin {

namespace {

constexpr std::size_t chunkSize = 256;

}  // namespace

Vec3 ArlequinCoupling::Impl::atPlace(const fem::CellPlace& place, std::span<const Vec3> field) const {
  Vec3 sum;
  if (place.element < 0) return sum;
  const Cell cell = cellOf(setting.mesh, place.element);
  for (std::size_t a = 0; a < cell.node.size(); ++a)
    sum += place.shape[a] * field[static_cast<std::size_t>(cell.node[a])];
  return sum;
}

Vec3 ArlequinCoupling::Impl::displacement(const dem::Model& m, std::size_t k) const {
  const Vec3 moved = m.particles.x[static_cast<std::size_t>(overlap.particle[k])] - overlap.x[k];
  const geometry::Periodicity& space = m.pairs.periodicity();
  if (!space.any()) return moved;
  const Vec3 carried = atMember(k, nodes().u);
  return carried + space.minimumImage(moved - carried);
}

std::vector<Vec3> ArlequinCoupling::Impl::displacements(const dem::Model& m) const {
  std::vector<Vec3> q(overlap.size());
  parallelFor(q.size(), chunkSize, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) q[k] = displacement(m, k);
  });
  return q;
}

std::vector<Vec3> ArlequinCoupling::Impl::freshGap(const dem::Model& m) const {
  std::vector<Vec3> gap(parts.gap.rows());
  gapOfMembers(parts.gap, displacements(m), nodes().u, gap);
  return gap;
}

/// The kept part turns with the nodes of its row.
void ArlequinCoupling::Impl::turnKept() {
  const std::vector<Vec3>& u = nodes().u;
  if (turnsGap() && nodesBefore.size() == u.size() &&
      std::ranges::any_of(kept, [](const Vec3& g) { return squaredNorm(g) > 0.0; })) {
    const std::vector<Vec3> x = positions();
    std::vector<Vec3> moved(u.size());
    for (const int n : parts.gap.coupledNode) {
      const auto at = static_cast<std::size_t>(n);
      moved[at] = u[at] - nodesBefore[at];
    }
    parallelFor(kept.size(), chunkSize, [&](std::size_t begin, std::size_t end) {
      for (std::size_t r = begin; r < end; ++r)
        if (squaredNorm(kept[r]) > 0.0) kept[r] = turned(kept[r], RowSpin(parts.gap, r, x).of(moved));
    });
  }
  nodesBefore = u;
}

void ArlequinCoupling::Impl::updateGap(const dem::Model& m, bool timeless) {
  turnKept();
  std::vector<Vec3> next = freshGap(m);
  parallelFor(next.size(), 4 * chunkSize, [&](std::size_t begin, std::size_t end) {
    for (std::size_t r = begin; r < end; ++r) {
      next[r] += kept[r];
      if (!timeless) increment[r] = next[r] - now[r];
    }
  });
  now = std::move(next);
}

std::vector<Vec3> ArlequinCoupling::Impl::motionUnder(std::span<const Vec3> forces) const {
  std::vector<Vec3> moved(overlap.size());
  parallelFor(moved.size(), chunkSize, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k)
      moved[k] = (1.0 / parts.stiffness[k]) * cg::applyRow(parts.gap.particlesBack, static_cast<int>(k), forces);
  });
  return moved;
}

std::vector<Vec3> ArlequinCoupling::Impl::gapUnder(std::span<const Vec3> forces) const {
  std::vector<Vec3> gap(forces.size());
  if (hasWideRows()) {
    cg::apply(parts.gap.particles, motionUnder(forces), gap);
    return gap;
  }
  const std::vector<Vec3> unit(forces.size(), Vec3{1.0, 0.0, 0.0});
  parts.constraint->applyStiffness(unit, gap);
  for (std::size_t r = 0; r < gap.size(); ++r) gap[r] = (1.0 / gap[r].x) * forces[r];
  return gap;
}

/// No member is held farther than its slip length from where the solid is.
void ArlequinCoupling::Impl::slipMembers(const dem::Model& m) {
  if (!hasWideRows() || !isFollowed()) return;
  std::vector<Vec3> moved = motionUnder(lambda);
  bool slips = false;
  for (std::size_t k = 0; k < moved.size(); ++k)
    if (const double length = norm(moved[k]), longest = slipLength(m, k); length > longest) {
      moved[k] *= longest / length;
      slips = true;
    }
  if (!slips) return;
  std::vector<Vec3> next(now.size());
  cg::apply(parts.gap.particles, moved, next);
  for (std::size_t r = 0; r < next.size(); ++r) kept[r] += next[r] - now[r];
  now = std::move(next);
  parts.constraint->evaluate({now, increment, {}, {}, 1.0}, lambda);
}

/// What is beyond the slip length goes out of the kept part.
void ArlequinCoupling::Impl::slip() {
  if (!turnsGap() || hasWideRows() || !isFollowed()) return;
  for (std::size_t r = 0; r < now.size(); ++r)
    if (const double length = norm(now[r]), longest = parts.slipLength[r]; length > longest) {
      const Vec3 excess = (1.0 - longest / length) * now[r];
      kept[r] -= excess;
      now[r] -= excess;
    }
}

}  // namespace dovetail::arlequin
