#include <algorithm>
#include <cmath>

#include "dovetail/core/error.hpp"
#include "points.hpp"

namespace dovetail::mpm::detail {

namespace {
double square(const Vec3& v) { return squaredNorm(v); }
double square(double v) { return v * v; }
}  // namespace

using fem::Nodes;

void Points::addMass(std::span<double> mass) const {
  const std::vector<double> own = massesOf(rows_, carried_);
  for (std::size_t n = 0; n < own.size(); ++n) mass[n] += own[n];
}

void Points::addConsistentMass(linalg::NodeMatrix&) const {
  throw InputError("material points have lumped masses only", options_.name, "set massFraction to 0");
}

/// Points go no farther than nodes do. Nodes at edges, which points hardly reach, go far under little, and may as far
/// as the spacing.
bool Points::wantsOtherNodes(const Nodes& nodes) const {
  const double spacing = options_.grid.spacing, most = options_.renewal * spacing;
  double farthest = 0.0;
  for (const Vec3& u : nodes.u) farthest = std::max(farthest, squaredNorm(u));
  if (!(farthest > most * most)) return false;
  if (farthest > spacing * spacing) return true;
  for (std::size_t p = 0; p < rows_.points(); ++p)
    if (squaredNorm(valueAt(rows_, p, nodes.u)) > most * most) return true;
  return false;
}

void Points::layNodes(Nodes& nodes) {
  rows_ = rowsAt(options_.grid, carried_.x, options_.name);
  for (auto& [anchors, markers] : marked_) findMap(options_.grid, rows_, anchors, carried_.x, markers);
  const std::size_t count = rows_.nodes();
  nodes.X = rows_.X;
  nodes.u.assign(count, {});
  nodes.f.assign(count, {});
  nodes.mass = massesOf(rows_, carried_);
  nodes.fixed = rows_.fixed;
  for (std::size_t n = 0; n < count; ++n)
    if (!(nodes.mass[n] > 0.0)) nodes.fixed[n] = fem::allComponents;
  nodes.v = velocitiesOf(rows_, options_.grid, carried_, nodes.mass);
  v0_ = nodes.v;
  const bool keeps = options_.transfer == Transfer::flip;
  beyond_ = keeps ? detail::kineticEnergy(options_.grid, carried_) - fem::kineticEnergy(nodes) : 0.0;
}

double Points::renewNodes(Nodes& nodes, double t) {
  requireSameNodes(nodes);
  const double before = fem::kineticEnergy(nodes) + beyond_;
  const double keep = std::exp(-options_.damping * (t - laidAt_));
  for (auto& [anchors, markers] : marked_) {
    const std::vector<Vec3> moved = valuesAt(markers, nodes.u);
    for (std::size_t m = 0; m < moved.size(); ++m) markers.X[m] += moved[m];
  }
  leaveGrid(rows_, nodes.u, nodes.v, v0_, keep, carried_);
  F0_.assign(answers_.F().begin(), answers_.F().end());
  ++renewals_;
  laidAt_ = t;
  layNodes(nodes);
  answers_.moveTo(nodes.u);
  isNew_ = true;
  return before - (fem::kineticEnergy(nodes) + beyond_);
}

void Points::save(ByteWriter& archive) const {
  archive(carried_.x, carried_.v, carried_.moment, F0_, laidAt_, renewals_);
  for (const auto& [anchors, markers] : marked_) archive(markers.X);
  answers_.save(archive);
}

std::size_t Points::addMarkers(std::span<const Vec3> x) {
  if (renewals_ > 0)
    throw InputError("the grid has been renewed", options_.name, "add markers before the run, at the first places");
  Marked marked{nearestPoints(options_.grid, carried_.x, x, options_.name), {{x.begin(), x.end()}, {}, {}}};
  if (rows_.points() == 0) rows_ = rowsAt(options_.grid, carried_.x, options_.name);
  findMap(options_.grid, rows_, marked.anchors, carried_.x, marked.markers);
  marked_.push_back(std::move(marked));
  return marked_.size() - 1;
}

const Markers& Points::markers(std::size_t set) const {
  if (set >= marked_.size())
    throw InputError("there is no set " + std::to_string(set) + " of markers", options_.name,
                     "give a number of addMarkers");
  return marked_[set].markers;
}

void Points::load(ByteReader& archive) {
  Carried read = carried_;
  std::vector<double> F0;
  double laidAt = 0.0;
  std::int64_t renewals = 0;
  std::vector<std::vector<Vec3>> marked(marked_.size());
  archive(read.x, read.v, read.moment, F0, laidAt, renewals);
  const auto finite = [](const auto& values) {
    return std::ranges::all_of(values, [](const auto& value) { return std::isfinite(square(value)); });
  };
  if (read.x.size() != carried_.x.size() || read.v.size() != carried_.v.size() ||
      read.moment.size() != carried_.moment.size() || F0.size() != F0_.size())
    throw InputError("the state is that of other points", options_.name, "load it into the model that wrote it");
  if (!finite(read.x) || !finite(read.v) || !finite(read.moment) || !finite(F0) || !std::isfinite(laidAt))
    throw InputError("the state is not finite", options_.name, "take an older one");
  for (std::size_t set = 0; set < marked.size(); ++set) {
    archive(marked[set]);
    if (marked[set].size() != marked_[set].markers.X.size() || !finite(marked[set]))
      throw InputError("the state has other markers", options_.name, "load it into the model that wrote it");
  }
  answers_.load(archive);
  for (std::size_t set = 0; set < marked.size(); ++set) marked_[set].markers.X = std::move(marked[set]);
  carried_ = std::move(read);
  F0_ = std::move(F0);
  laidAt_ = laidAt;
  renewals_ = renewals;
  isNew_ = false;
}

}  // namespace dovetail::mpm::detail
