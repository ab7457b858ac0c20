// Particles that move through an overlap: ties are made anew, weights change, some come and some go.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "arlequin_coupling_impl.hpp"
#include "dovetail/core/parallel.hpp"
#include "dovetail/dem/bodies/body_term.hpp"

namespace dovetail::arlequin {

namespace {

constexpr std::size_t chunkSize = 256;
constexpr double shellRadii = 4.0;  // within which particles outside are watched one by one

/// Around all nodes, or those with a weight above 0.
geometry::Box boxOf(const TieSetting& setting, std::span<const Vec3> position, bool weighed) {
  constexpr double far = std::numeric_limits<double>::max();
  geometry::Box box{{far, far, far}, {-far, -far, -far}};
  for (std::size_t n = 0; n < position.size(); ++n)
    if (!weighed || setting.nodalWeight[n] > 0.0)
      for (int c = 0; c < 3; ++c) {
        box.lower[c] = std::min(box.lower[c], position[n][c]);
        box.upper[c] = std::max(box.upper[c], position[n][c]);
      }
  return box;
}

bool contains(const geometry::Box& box, const Vec3& x, const geometry::Periodicity& space) {
  for (int c = 0; c < 3; ++c)
    if (!space.axes[static_cast<std::size_t>(c)] && (x[c] < box.lower[c] || x[c] > box.upper[c])) return false;
  return true;
}

/// Of |velocity(k) − frame|, k < n, m/s; 0 of nobody.
template <class Velocity>
double largestSpeed(std::size_t n, const Vec3& frame, Velocity&& velocity) {
  if (n == 0) return 0.0;
  return std::sqrt(parallelMax(n, 4096, [&](std::size_t begin, std::size_t end) {
    std::array<double, 4> squared{};  // side by side, so that none waits for the one before
    for (std::size_t k = begin; k < end; ++k)
      squared[k % 4] = std::max(squared[k % 4], squaredNorm(velocity(k) - frame));
    return std::ranges::max(squared);
  }));
}

}  // namespace

/// Bounds on how far particles have moved relative to the solid since ties and neighbours were looked at.
void ArlequinCoupling::Impl::watch(dem::Model& m, const dem::Step& step) {
  const std::vector<Vec3>& v = nodes().v;
  const auto ofRow = [&](std::size_t r) { return v[static_cast<std::size_t>(rowNode[r])]; };
  Vec3 frame;
  for (std::size_t r = 0; r < rowNode.size(); ++r) frame += (1.0 / static_cast<double>(rowNode.size())) * ofRow(r);
  double relative = 0.0;
  for (const std::vector<int>* list : {&overlap.particle, &near})
    relative = std::max(relative, largestSpeed(list->size(), frame, [&](std::size_t k) {
                          return m.particles.v[static_cast<std::size_t>((*list)[k])];
                        }));
  memberTravel += step.dt * (relative + largestSpeed(rowNode.size(), frame, ofRow)) / slipLengthOf(meanRadius);
  farTravel += step.moved + step.dt * largestSpeed(v.size(), {}, [&](std::size_t n) { return v[n]; });
  if (!std::isfinite(memberTravel + farTravel))
    throw NumericalError("velocities are not finite", "overlap with \"" + side.name + "\"", "take a smaller step");
}

void ArlequinCoupling::Impl::findNear(const dem::Model& m) {
  near.clear();
  const geometry::Box box = geometry::expanded(boxOf(setting, positions(), true), (shellRadii + 1.0) * largestRadius);
  for (std::size_t i = 0; i < m.particles.size(); ++i)
    if (memberOf[i] < 0 && m.particles.weightOf(i) == 1.0 && !m.particles.isMember(i) &&
        contains(box, m.particles.x[i], m.pairs.periodicity()))
      near.push_back(static_cast<int>(i));
  farTravel = 0.0;
  knownIds = m.particles.nextId;
}

void ArlequinCoupling::Impl::findStrangers(const dem::Model& m, const OverlapLocator& locator) {
  const geometry::Box box = boxOf(setting, positions(), false);
  const double least = setting.options.leastWeight * (1.0 - 1e-6);
  for (std::size_t i = 0; i < m.particles.size(); ++i) {
    if (memberOf[i] >= 0 || m.particles.weightOf(i) != 1.0) continue;
    if (!contains(box, m.particles.x[i], m.pairs.periodicity())) continue;
    const std::optional<double> weight = locator.weightWithin(m.particles.x[i]);
    if (!weight || (*weight >= least && !m.particles.isMember(i))) continue;
    const auto place = std::ranges::lower_bound(strangers, m.particles.id[i]);
    if (place != strangers.end() && *place == m.particles.id[i]) continue;
    if (strangers.empty()) events.firstStranger = m.particles.id[i], events.strangerAt = m.particles.x[i];
    strangers.insert(place, m.particles.id[i]);
  }
}

/// Where members that have moved and those near are now.
OverlapUpdate ArlequinCoupling::Impl::lookAgain(const dem::Model& m, const OverlapLocator& locator) {
  const auto findAgain = [&](int i) {
    const auto at = static_cast<std::size_t>(i);
    return locator.find(m.particles.x[at], m.particles.radius[at]);
  };
  const double stays = turnsGap() ? 0.5 : 0.0;     // shorter ones are left as they are
  std::vector<double> slips(overlap.size(), 0.0);  // over their slip lengths
  std::vector<FoundParticle> again(overlap.size()), arrived(near.size());
  parallelFor(overlap.size(), chunkSize, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      if (overlap.place[k].element >= 0)
        slips[k] = norm(displacement(m, k) - atMember(k, nodes().u)) / slipLength(m, k);
      if (slips[k] > stays) again[k] = findAgain(overlap.particle[k]);
    }
  });
  parallelFor(near.size(), chunkSize, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) arrived[k] = findAgain(near[k]);
  });
  OverlapUpdate update(overlap.nodalWeight, m.particles.size());
  memberTravel = 0.0;
  for (std::size_t k = 0; k < overlap.size(); ++k)
    if (slips[k] > stays) {
      change(update, overlap.particle[k], overlap.weight[k], again[k], overlap.place[k]);
    } else {
      memberTravel = std::max(memberTravel, slips[k]);
      update.tie(overlap.particle[k], {overlap.place[k], overlap.x[k], overlap.weight[k]}, overlap.x[k]);
    }
  for (std::size_t k = 0; k < near.size(); ++k) {
    if (arrived[k].place.element < 0 || isBeyond(arrived[k])) continue;
    change(update, near[k], 1.0, arrived[k], arrived[k].place);
    ++events.admitted;
  }
  findElements(update.next);
  return update;
}

bool ArlequinCoupling::Impl::isBeyond(const FoundParticle& found) const {
  return found.place.element >= 0 && found.weight < setting.options.leastWeight * (1.0 - 1e-6);
}

/// @param last  where it was, whose nodes share the momentum if it is nowhere now
void ArlequinCoupling::Impl::change(OverlapUpdate& update, int particle, double before, const FoundParticle& found,
                                    const fem::CellPlace& last) const {
  update.isMoved[static_cast<std::size_t>(particle)] = 1;
  if (isBeyond(found)) return update.beyond.push_back(particle);
  const bool isTied = found.place.element >= 0;
  update.changes.push_back({particle, before, found.weight, isTied ? found.place : last});
  if (!isTied) return;
  Vec3 material = found.x;
  const Cell cell = cellOf(setting.mesh, found.place.element);
  for (std::size_t a = 0; a < cell.node.size(); ++a)
    material -= found.place.shape[a] * nodes().u[static_cast<std::size_t>(cell.node[a])];
  update.tie(particle, found, material);
}

void ArlequinCoupling::Impl::relocate(dem::Model& m) {
  const std::vector<Vec3> x = positions();
  const OverlapLocator locator(setting.mesh, x, setting.nodalWeight, m.pairs.periodicity());
  OverlapUpdate update = lookAgain(m, locator);
  findStrangers(m, locator);
  if (update.changes.empty() && update.beyond.empty()) return;
  ++events.relocations;
  const ContactsOf contacts(m, update.isMoved, side.model);
  const double before = contacts.energy(m) + storedNow;
  tieAnew(m, update);
  weighPairs(m, update.isMoved);
  lost += before - contacts.energy(m) - storedNow;
  findNear(m);
  if (update.beyond.empty()) return;
  events.removed += static_cast<std::int64_t>(update.beyond.size());
  dem::removeParticles(m, update.beyond);
  number(m.particles);
  findNear(m);
}

/// Weights change hands, and the rows are made of the new members.
void ArlequinCoupling::Impl::tieAnew(dem::Model& m, OverlapUpdate& update) {
  // In macro steps the rate between the kicks about their ends is half of what other forces do: new ties keep it.
  const std::vector<int> nodesOfRows = rowNode;
  std::vector<Vec3> rate(rowNode.size()), impulse(nodes().v.size());
  if (actsInMacroSteps()) gapOf(parts.gap, overlap, m.particles.v, nodes().v, rate);
  overlap = std::move(update.next);
  number(m.particles);
  if (m.particles.weight.empty()) m.particles.weight.assign(m.particles.size(), 1.0);
  for (const OverlapUpdate::Change& change : update.changes) handOver(m, change, impulse);
  kickNodes(impulse);
  stale = true;
  ready(m);
  turnsGap() ? keepForces(m) : startGapAnew(m);
  if (setting.options.constraint == ConstraintKind::multiplier) comply(m, inRows(rate, nodesOfRows));
  gapOf(parts.gap, overlap, m.particles.v, nodes().v, increment);  // of the step, as the new ties see it
  for (Vec3& change : increment) change *= m.step.dt;
  if (!parts.constraint->needsRates() && !actsInMacroSteps())
    parts.constraint->evaluate({now, increment, {}, {}, 1.0}, lambda);
  storedNow = storedWith(lambda);
}

void ArlequinCoupling::exchange(dem::Model& m, const dem::Step& step) {
  Impl& s = *impl_;
  if (!s.isFollowed()) return;
  s.ready(m);
  // Ties made while the solid is behind or ahead would keep that as a gap, across which λ turns the whole.
  const bool inStep = s.side.isInStep, others = inStep && s.knownIds != m.particles.nextId;
  if (others) s.findNear(m);
  s.watch(m, step);
  if (!inStep) return;
  if (s.farTravel > 0.5 * shellRadii * s.largestRadius) {
    s.findNear(m);
    const std::vector<Vec3> x = s.positions();
    s.findStrangers(m, OverlapLocator(s.setting.mesh, x, s.setting.nodalWeight, m.pairs.periodicity()));
  }
  if (!others && s.memberTravel <= 1.0) return;
  s.advance(m);
  s.relocate(m);
}

void ArlequinCoupling::neighbourListUpdated(dem::Model& m) {
  Impl& s = *impl_;
  if (s.known != m.particles.revision) s.number(m.particles);
  s.weights.update(m.particles, m.pairs, s.setting.mesh, s.overlap, s.positions(), s.memberOf);
}

double ArlequinCoupling::renumber(std::span<const int> newNumber, const dem::Particles&) {
  Impl& s = *impl_;
  s.weights.renumber(newNumber);
  Overlap rest;
  rest.nodalWeight = s.overlap.nodalWeight;
  for (std::size_t k = 0; k < s.overlap.size(); ++k) {
    const int number = newNumber[static_cast<std::size_t>(s.overlap.particle[k])];
    if (number < 0) continue;
    addMember(rest, number, std::move(s.overlap.place[k]), s.overlap.x[k], s.overlap.weight[k]);
  }
  findElements(rest);
  if (rest.size() != s.overlap.size()) s.stale = s.refit = true;
  s.overlap = std::move(rest);
  if (s.parts.absorber) s.parts.absorber->renumber(s.overlap.particle);
  for (int& i : s.near) i = newNumber[static_cast<std::size_t>(i)];
  std::erase_if(s.near, [](int i) { return i < 0; });
  s.known = -1;
  return 0.0;
}

}  // namespace dovetail::arlequin
