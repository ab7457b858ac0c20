// Forces of an overlap tie.
#include "dovetail/arlequin/arlequin_coupling.hpp"

#include <algorithm>
#include <string>

#include "arlequin_coupling_impl.hpp"
#include "dovetail/core/error.hpp"
#include "dovetail/core/parallel.hpp"
#include "dovetail/dem/bodies/body_term.hpp"
#include "gap/kept_gap.hpp"

namespace dovetail::arlequin {

namespace {

constexpr std::size_t chunkSize = 256;

}  // namespace

void ArlequinCoupling::Impl::number(const dem::Particles& particles) {
  memberOf.assign(particles.size(), -1);
  for (std::size_t k = 0; k < overlap.size(); ++k)
    memberOf[static_cast<std::size_t>(overlap.particle[k])] = static_cast<int>(k);
  known = particles.revision;
}

/// Values of the rows at some nodes, for the rows that there are now: 0 where there was none.
std::vector<Vec3> ArlequinCoupling::Impl::inRows(std::span<const Vec3> values, std::span<const int> nodes) const {
  std::vector<int> rowOf(setting.mesh.X.size(), -1);
  for (std::size_t r = 0; r < nodes.size(); ++r) rowOf[static_cast<std::size_t>(nodes[r])] = static_cast<int>(r);
  std::vector<Vec3> moved(parts.gap.rows());
  for (std::size_t r = 0; r < moved.size(); ++r)
    if (const int old = rowOf[static_cast<std::size_t>(parts.gap.node[r])]; old >= 0)
      moved[r] = values[static_cast<std::size_t>(old)];
  return moved;
}

/// Rows that were there keep their gap and their λ; others start without.
void ArlequinCoupling::Impl::ready(const dem::Model& m) {
  if (known != m.particles.revision || memberOf.size() != m.particles.size()) number(m.particles);
  if (stale || (needsMass() && massOf != side.mass)) {
    TieParts next = makeParts(setting, overlap, m);
    addConstraint(setting, overlap, m, side, next, std::move(parts.constraint));
    parts = std::move(next);
    stale = false;
    massOf = side.mass;
    if (rowNode != parts.gap.node) {
      for (auto* values : {&kept, &now, &increment, &macroIncrement, &atMacroStep, &lambda})
        *values = isFollowed() ? inRows(*values, rowNode) : std::vector<Vec3>(parts.gap.rows());
      rowNode = parts.gap.node;
    }
  }
  if (!refit) return;
  refit = false;
  hasWideRows() ? keepForces(m) : keepGap(m);
  if (!parts.constraint->stores()) return;
  std::vector<Vec3> forces(now.size());
  parts.constraint->evaluate({now, increment, {}, {}, 1.0}, forces);
  lost += storedNow;
  storedNow = storedWith(forces);
  lost -= storedNow;
}

double ArlequinCoupling::Impl::storedWith(std::span<const Vec3> forces) const {
  return parts.constraint->stores() ? 0.5 * sumOfProducts(now, forces) : 0.0;
}

/// Brings the gap up to the step under way before ties change: λ of the step before does its half of the work.
void ArlequinCoupling::Impl::advance(const dem::Model& m) {
  const bool stood = side.stepping == coupling::Stepping::implicitSteps && nodesBefore == nodes().u;
  updateGap(m, false);
  if (actsInMacroSteps()) return;
  lost += 0.5 * sumOfProducts(lambda, increment) + storedNow;
  if (!parts.constraint->needsRates()) parts.constraint->evaluate({now, increment, {}, {}, 1.0}, lambda);
  storedNow = storedWith(lambda);
  lost -= storedNow;
  advanced = true;
  if (!stood) return;
  // The solid's jump has stored what half a kick to come was to do to the nodes: now the new ties do it.
  std::vector<Vec3> ofNodes(now.size());
  gapOfMembers(parts.gap, std::vector<Vec3>(overlap.size()), nodes().v, ofNodes);
  lost -= 0.5 * m.step.dt * sumOfProducts(lambda, ofNodes);
}

/// The impulses of multipliers that bring the rate of the gap to `goal`, m/s, at the start and where ties have been
/// made anew.
void ArlequinCoupling::Impl::comply(dem::Model& m, std::span<const Vec3> goal) {
  std::vector<Vec3> rate(parts.gap.rows()), excess(rate.size()), none(rate.size()), impulses(rate.size());
  gapOf(parts.gap, overlap, m.particles.v, nodes().v, rate);
  for (std::size_t r = 0; r < rate.size(); ++r) excess[r] = rate[r] - goal[r];
  parts.constraint->evaluate({now, none, none, excess, 1.0}, impulses);
  const std::vector<double> mass = yieldingMasses(m);
  std::vector<Vec3> onParticles(m.particles.size()), onNodes(nodes().v.size());
  pullParticles(parts.gap, overlap, impulses, onParticles);
  pullNodes(parts.gap, impulses, onNodes);
  for (const int i : overlap.particle) {
    const auto at = static_cast<std::size_t>(i);
    m.particles.v[at] += (1.0 / mass[at]) * onParticles[at];
  }
  if (!loadsNobody) side.kick(onNodes);
  lost += 0.5 * (sumOfProducts(impulses, rate) + sumOfProducts(impulses, goal));
  complies = true;
}

std::vector<Vec3> ArlequinCoupling::Impl::accelerationUnder(const dem::Model& m, std::vector<Vec3> onNodes) const {
  const std::vector<double> mass = yieldingMasses(m);
  std::vector<Vec3> ofMembers(overlap.size()), acceleration(parts.gap.rows());
  parallelFor(ofMembers.size(), chunkSize, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      const auto i = static_cast<std::size_t>(overlap.particle[k]);
      ofMembers[k] = (1.0 / mass[i]) * m.particles.f[i];
    }
  });
  side.mass->solve(onNodes);
  gapOfMembers(parts.gap, ofMembers, onNodes, acceleration);
  return acceleration;
}

void ArlequinCoupling::Impl::evaluate(dem::Model& m, const dem::Step& step) {
  std::vector<Vec3> velocity, acceleration;
  double dt = step.dt;
  if (parts.constraint->needsRates()) {
    velocity.resize(parts.gap.rows());
    if (step.timeless)
      dt = 1.0;
    else
      gapOf(parts.gap, overlap, m.particles.v, nodes().v, velocity);
    std::vector<Vec3> onNodes = side.load.force;
    parallelFor(side.own.size(), 16 * chunkSize, [&](std::size_t begin, std::size_t end) {
      for (std::size_t n = begin; n < end; ++n) onNodes[n] += side.own[n];
    });
    acceleration = accelerationUnder(m, std::move(onNodes));
  }
  parts.constraint->evaluate({now, increment, velocity, acceleration, dt}, lambda);
  slipMembers(m);
}

void ArlequinCoupling::Impl::loadNodes(std::span<const Vec3> forces, coupling::NodalLoad& load) const {
  const std::vector<int>& node = parts.gap.coupledNode;
  std::vector<Vec3> onNodes(node.size());
  parallelFor(node.size(), chunkSize, [&](std::size_t begin, std::size_t end) {
    for (std::size_t n = begin; n < end; ++n)
      onNodes[n] = cg::applyRow(parts.gap.nodesBack, static_cast<int>(n), forces);
  });
  for (std::size_t n = 0; n < node.size(); ++n) load.add(node[n], onNodes[n]);
}

void ArlequinCoupling::Impl::apply(dem::Model& m, const dem::Step& step) {
  if (parts.absorber) parts.absorber->apply(m.particles.v, m.particles.f);
  if (!complies && step.timeless && parts.constraint->needsRates()) comply(m, std::vector<Vec3>(parts.gap.rows()));
  if (actsInMacroSteps()) return;
  evaluate(m, step);
  pullParticles(parts.gap, overlap, lambda, m.particles.f);
  loadNodes(lambda, side.load);
  if (!turnsGap()) return;
  std::vector<Vec3> x;
  for (std::size_t r = 0; r < kept.size(); ++r) {
    if (!(squaredNorm(kept[r]) > 0.0)) continue;
    if (x.empty()) x = positions();
    RowSpin(parts.gap, r, x).addForces(-cross(kept[r], lambda[r]), side.load);
  }
}

ArlequinCoupling::ArlequinCoupling(coupling::SolidSide& side) : Connector(side), impl_(std::make_unique<Impl>(side)) {}
ArlequinCoupling::ArlequinCoupling(const ArlequinCoupling& other)
    : Connector(other), impl_(std::make_unique<Impl>(*other.impl_, this->side())) {}
ArlequinCoupling::ArlequinCoupling(ArlequinCoupling&&) noexcept = default;
ArlequinCoupling::~ArlequinCoupling() = default;

dem::Term::Order ArlequinCoupling::order() const {
  const bool answers = impl_->setting.options.constraint == ConstraintKind::multiplier || impl_->actsInMacroSteps();
  return answers ? Order::constraints : Order::forces;
}

void ArlequinCoupling::check(const dem::Model& m) const {
  for (const int number : impl_->near)
    if (number < 0 || static_cast<std::size_t>(number) >= m.particles.size())
      throw InputError("there is no particle " + std::to_string(number), "near the overlap",
                       "take an older checkpoint");
  for (std::size_t k = 0; k < impl_->overlap.size(); ++k) {
    const auto i = static_cast<std::size_t>(impl_->overlap.particle[k]);
    if (i >= m.particles.size())
      throw InputError("particles were removed without notice to the overlap", "overlap",
                       "remove particles by removeParticles of the model, after the coupling was added");
    const std::string particle = "particle " + std::to_string(m.particles.id[i]);
    if (m.particles.weightOf(i) != impl_->overlap.weight[k])
      throw InputError("the weight of " + particle + " differs from its weight in the overlap", "overlap",
                       "leave Particles::weight to the overlap");
    if (m.particles.isMember(i))
      throw InputError(particle + " of the overlap is a member of a clump, which cannot be weighted", "overlap",
                       "keep clumps out of the overlap");
  }
}

void ArlequinCoupling::addForces(dem::Model& m, const dem::Step& step) {
  Impl& s = *impl_;
  s.ready(m);
  const bool halfIsBooked = s.advanced;
  if (!s.advanced) s.updateGap(m, step.timeless);
  s.slip();
  const double before = s.storedNow, halfBefore = halfIsBooked ? 0.0 : 0.5 * sumOfProducts(s.lambda, s.increment);
  s.apply(m, step);
  s.storedNow = s.storedWith(s.lambda);
  if (step.timeless || s.actsInMacroSteps()) return;
  s.advanced = false;
  s.lost += halfBefore + 0.5 * sumOfProducts(s.lambda, s.increment) - (s.storedNow - before);
}

/// The absorber takes what its force does to the particles over the whole kick.
void ArlequinCoupling::book(dem::Model& m, const dem::Step& step) {
  Impl& s = *impl_;
  s.power = 0.0;
  if (s.parts.absorber)
    for (std::size_t k = 0; k < s.overlap.size(); ++k) {
      const auto i = static_cast<std::size_t>(s.overlap.particle[k]);
      const double mass = m.particles.weightOf(i) * m.particles.mass[i];
      const Vec3 mean = m.particles.v[i] + (0.5 * (step.timeless ? 0.0 : step.dt) / mass) * m.particles.f[i];
      s.power -= dot(s.parts.absorber->force()[k], mean);
    }
  if (!step.timeless) s.absorbed += 0.5 * step.dt * s.power;
}

double ArlequinCoupling::move(dem::Model&, const dem::Step& step) {
  impl_->absorbed += 0.5 * step.dt * impl_->power;
  return 0.0;
}

void ArlequinCoupling::addStiffness(const dem::Model& m, std::span<const Vec3> particles, std::span<const Vec3> nodes,
                                    std::span<Vec3> onParticles, std::span<Vec3> onNodes) const {
  Impl& s = *impl_;
  if (s.setting.options.constraint != ConstraintKind::penalty) return;
  s.ready(m);
  std::vector<Vec3> gap(s.parts.gap.rows()), lambda(gap.size());
  gapOf(s.parts.gap, s.overlap, particles, nodes, gap);
  s.parts.constraint->applyStiffness(gap, lambda);
  for (Vec3& value : lambda) value = -value;
  pullParticles(s.parts.gap, s.overlap, lambda, onParticles);
  pullNodes(s.parts.gap, lambda, onNodes);
}

std::vector<double> ArlequinCoupling::solidWeight() const { return solidWeights(impl_->overlap.nodalWeight); }
void ArlequinCoupling::markTied(std::span<std::uint8_t> tied) const {
  for (std::size_t k = 0; k < impl_->overlap.size(); ++k)
    if (impl_->overlap.place[k].element >= 0) tied[static_cast<std::size_t>(impl_->overlap.particle[k])] = 1;
}
double ArlequinCoupling::stored() const { return impl_->storedNow; }
double ArlequinCoupling::lost() const { return impl_->lost + impl_->absorbed; }
double ArlequinCoupling::absorbed() const { return impl_->absorbed; }
const Overlap& ArlequinCoupling::overlap() const { return impl_->overlap; }
const GapOperator& ArlequinCoupling::operators() const { return impl_->parts.gap; }
std::span<const Vec3> ArlequinCoupling::gap() const { return impl_->now; }
std::span<const Vec3> ArlequinCoupling::lambda() const { return impl_->lambda; }

}  // namespace dovetail::arlequin
