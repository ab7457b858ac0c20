#include "compliance.hpp"

#include <algorithm>

#include "dovetail/core/parallel.hpp"

namespace dovetail::arlequin {

namespace {

constexpr std::size_t chunkSize = 256;

}  // namespace

Compliance::Compliance(const GapOperator& gap, const Overlap& overlap, std::span<const double> particleMass,
                       const fem::ModelMass& solid)
    : solid_(solid),
      particles_(gap.particles),
      particlesBack_(gap.particlesBack),
      nodes_(gap.nodes),
      nodesBack_(gap.nodesBack),
      coupledNode_(gap.coupledNode),
      ofParticles_(overlap.size()),
      ofNodes_(coupledNode_.size()) {
  for (const int i : overlap.particle) yield_.push_back(1.0 / particleMass[static_cast<std::size_t>(i)]);
  std::vector<int> place(static_cast<std::size_t>(nodes_.columns), -1);
  for (std::size_t n = 0; n < coupledNode_.size(); ++n)
    place[static_cast<std::size_t>(coupledNode_[n])] = static_cast<int>(n);
  for (int& column : nodes_.column) column = place[static_cast<std::size_t>(column)];
  allNodes_.assign(place.size(), Vec3{1.0, 1.0, 1.0});
  if (!solid.isDiagonal()) return;
  solid.solve(allNodes_);
  for (const int n : coupledNode_) nodeYield_.push_back(allNodes_[static_cast<std::size_t>(n)]);
  allNodes_.clear();
}

/// ofNodes ← M_FE⁻¹ Bᵀ in.
void Compliance::moveNodes(std::span<const Vec3> in) const {
  parallelFor(ofNodes_.size(), chunkSize, [&](std::size_t begin, std::size_t end) {
    for (std::size_t n = begin; n < end; ++n) {
      ofNodes_[n] = cg::applyRow(nodesBack_, static_cast<int>(n), in);
      if (!nodeYield_.empty())
        for (int c = 0; c < 3; ++c) ofNodes_[n][c] *= nodeYield_[n][c];
    }
  });
  if (!nodeYield_.empty()) return;
  std::ranges::fill(allNodes_, Vec3{});
  for (std::size_t n = 0; n < ofNodes_.size(); ++n) allNodes_[static_cast<std::size_t>(coupledNode_[n])] = ofNodes_[n];
  solid_.solve(allNodes_);
  for (std::size_t n = 0; n < ofNodes_.size(); ++n) ofNodes_[n] = allNodes_[static_cast<std::size_t>(coupledNode_[n])];
}

void Compliance::apply(std::span<const Vec3> in, std::span<Vec3> out) const {
  parallelFor(ofParticles_.size(), chunkSize, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k)
      ofParticles_[k] = yield_[k] * cg::applyRow(particlesBack_, static_cast<int>(k), in);
  });
  moveNodes(in);
  parallelFor(out.size(), chunkSize, [&](std::size_t begin, std::size_t end) {
    for (std::size_t r = begin; r < end; ++r)
      out[r] = cg::applyRow(particles_, static_cast<int>(r), ofParticles_) +
               cg::applyRow(nodes_, static_cast<int>(r), ofNodes_);
  });
}

LumpedNodes lumpedNodes(const GapOperator& gap, const fem::ModelMass& solid, int component) {
  const auto size = static_cast<std::size_t>(gap.nodes.columns);
  const std::span<const int> freeRow = solid.dofs().freeRow();
  const auto dof = [&](std::size_t n) { return 3 * n + static_cast<std::size_t>(component); };
  std::vector<Vec3> mass(size);
  solid.multiply(std::vector<Vec3>(size, Vec3{1.0, 1.0, 1.0}), mass);
  std::vector<const fem::Tie*> tieOf(size, nullptr);
  std::vector<double> carried(size);
  for (std::size_t n = 0; n < size; ++n) carried[n] = mass[n].x;
  for (const fem::Tie& tie : solid.dofs().ties()) {
    if (tie.component != component) continue;
    tieOf[static_cast<std::size_t>(tie.node)] = &tie;
    for (const auto& master : tie.masters)
      carried[static_cast<std::size_t>(master.node)] +=
          master.factor * master.factor * mass[static_cast<std::size_t>(tie.node)].x;
  }
  LumpedNodes nodes;
  if (!solid.dofs().hasTies()) {
    nodes.map = gap.nodes;
  } else {
    std::vector<cg::ProjectionRow> rows(gap.rows());
    for (std::size_t r = 0; r < rows.size(); ++r)
      for (int k = gap.nodes.offsets[r]; k < gap.nodes.offsets[r + 1]; ++k) {
        const int n = gap.nodes.column[k];
        if (const fem::Tie* const tie = tieOf[static_cast<std::size_t>(n)])
          for (const auto& master : tie->masters)
            rows[r].emplace_back(master.node, master.factor * gap.nodes.weight[k]);
        else
          rows[r].emplace_back(n, gap.nodes.weight[k]);
      }
    nodes.map = cg::fromRows(gap.nodes.columns, rows);
  }
  nodes.back = cg::transposed(nodes.map);
  nodes.yield.resize(size, 0.0);
  for (std::size_t n = 0; n < size; ++n)
    if (freeRow[dof(n)] >= 0) nodes.yield[n] = 1.0 / carried[n];
  return nodes;
}

}  // namespace dovetail::arlequin
