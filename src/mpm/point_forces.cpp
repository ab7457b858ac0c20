#include <algorithm>

#include "deformation.hpp"
#include "dovetail/core/error.hpp"
#include "dovetail/core/parallel.hpp"
#include "dovetail/fem/laws/point_material.hpp"
#include "points.hpp"

namespace dovetail::mpm::detail {

namespace {
constexpr std::size_t pointChunk = 512;
}

using fem::Instant;
using fem::Nodes;
using fem::Wanted;

Points::Points(const MaterialPoints& points, std::shared_ptr<fem::PointField> field, const PointOptions& options)
    : options_(options),
      answers_(std::move(field)),
      carried_{{}, points.x, points.v, {}},
      volume_(points.volume),
      F0_(9 * points.x.size(), 0.0) {
  carried_.v.resize(points.x.size());
  if (options.transfer == Transfer::apic) carried_.moment.assign(F0_.size(), 0.0);
  for (std::size_t k = 0; k < F0_.size(); ++k) F0_[k] = k % 9 % 4 == 0 ? 1.0 : 0.0;
  std::vector<fem::PointPlace> places;
  for (std::size_t p = 0; p < points.x.size(); ++p) {
    carried_.mass.push_back(answers_.field().density() * volume_[p]);
    places.push_back({-1, static_cast<int>(p), points.x[p], volume_[p]});
  }
  answers_.open(places);
}

void Points::requireSameNodes(const Nodes& nodes) const {
  if (nodes.u.size() != rows_.nodes())
    throw InputError(
        "there are " + std::to_string(nodes.u.size()) + " nodes for a grid of " + std::to_string(rows_.nodes()),
        options_.name, "use mpm::makeModel");
}

std::vector<Vec3> Points::places(const Nodes& nodes) const {
  requireSameNodes(nodes);
  std::vector<Vec3> x = carried_.x;
  for (std::size_t p = 0; p < x.size(); ++p) x[p] += valueAt(rows_, p, nodes.u);
  return x;
}

std::size_t Points::memory() const {
  const auto bytes = [](const auto&... all) { return ((all.capacity() * sizeof(all[0])) + ...); };
  std::size_t marked = 0;
  for (const auto& [anchors, markers] : marked_)
    marked += bytes(anchors.first, anchors.point, markers.X, markers.images, markers.map.offsets, markers.map.column,
                    markers.map.weight);
  return answers_.memory() + bytes(carried_.x, carried_.v, carried_.moment, carried_.mass, volume_, F0_, v0_) +
         bytes(rows_.cell, rows_.node, rows_.flip, rows_.reached, rows_.weight, rows_.slope, rows_.firstOfCell,
               rows_.pointOfCell, rows_.firstOfNode, rows_.entryOfNode, rows_.X, rows_.fixed) +
         marked;
}

void Points::findDeformation(std::span<const Vec3> u) {
  detail::findDeformation(rows_, options_.grid.plane, F0_, u, answers_.F());
}

/// Unless the points have answered for this state. Those of a new grid have: their state is the one that was accepted.
void Points::ask(const Nodes& nodes, const Instant& now, Wanted wanted) {
  requireSameNodes(nodes);
  wanted.toRead |= isNew_;
  if (answers_.knows(nodes.u, now, wanted)) return;
  findDeformation(nodes.u);
  answers_.ask(nodes.u, now, wanted, options_.name);
}

void Points::addAnswers(std::span<Vec3> f) const {
  addStresses(rows_, options_.grid.plane, F0_, answers_.P(), volume_, f);
}

double Points::volumeSum(std::span<const double> perVolume) const {
  return parallelSum(volume_.size(), pointChunk, [&](std::size_t begin, std::size_t end) {
    double sum = 0.0;
    for (std::size_t p = begin; p < end; ++p) sum += volume_[p] * perVolume[p];
    return sum;
  });
}

double Points::stored() const { return beyond_ + volumeSum(answers_.energy()); }

void Points::addForces(const Nodes& nodes, const Instant& now, std::span<Vec3> f) {
  ask(nodes, now, {.energy = !now.willCommit});
  isNew_ = false;
  addAnswers(f);
}

double Points::addForcesAndEnergy(const Nodes& nodes, const Instant& now, std::span<Vec3> f) {
  ask(nodes, now, {});
  isNew_ = false;
  addAnswers(f);
  return stored();
}

double Points::energy(const Nodes& nodes, const Instant& now) {
  ask(nodes, now, {.toRead = true});
  return stored();
}

double Points::commit(const Nodes& nodes, const Instant& now) {
  ask(nodes, now, {.energy = false});
  answers_.commit();
  return volumeSum(answers_.dissipated());
}

void Points::requireValid(const Nodes& nodes, const std::string& when, fem::Scrutiny) {
  findDeformation(nodes.u);
  for (std::size_t p = 0; p < rows_.points(); ++p)
    if (const std::string reason = fem::whyInverted(&answers_.F()[9 * p]); !reason.empty())
      throw NumericalError("point " + std::to_string(p) + " of \"" + options_.name + "\" " + reason, when,
                           "take a smaller step, a finer grid or a smaller load");
}

}  // namespace dovetail::mpm::detail
