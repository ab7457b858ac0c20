// Momentum and mass of a run, and who gave what.
#include <algorithm>
#include <iomanip>
#include <ostream>

#include "dovetail/dem/bodies/body_term.hpp"
#include "dovetail/fem/motion/support_kick.hpp"
#include "run_impl.hpp"

namespace dovetail::coupling {

Totals CoupledRun::Impl::sums() const {
  const dem::Momenta particles = dem::momenta(grains);
  Totals sum;
  sum.momentum = particles.linear;
  sum.angularMomentum = particles.angular;
  for (std::size_t i = 0; i < grains.particles.size(); ++i)
    if (!grains.particles.isMember(i)) sum.mass += grains.particles.weightOf(i) * grains.particles.mass[i];
  for (const dem::BodyTerm* term : grains.terms.all<dem::BodyTerm>())
    for (const double mass : term->bodies.mass) sum.mass += mass;
  for (const auto& solid : solids) {
    const Momenta own = fem::momentaOf(solid->side.nodes(), *solid->side.mass);
    sum.momentum += own.linear;
    sum.angularMomentum += own.angular;
    for (const double mass : solid->side.nodes().mass) sum.mass += mass;
    sum.ontoSolids += solid->loads.given.linear;
  }
  return sum;
}

void CoupledRun::Impl::open() {
  const Totals sum = sums();
  outside.given = {};
  outside.opening = {sum.momentum, sum.angularMomentum};
  outside.massAtOpening = sum.mass;
  outside.entered = grains.entered;
  outside.gone = grains.left;
  for (const auto& solid : solids) solid->side.outside = {};
}

/// Of connectors, if the solids get them at another time than the particles.
Momenta CoupledRun::Impl::lateLoads() const {
  Momenta sum;
  if (options.lag != Lag::none)
    for (const auto& solid : solids) sum += totalOf(solid->side.load, solid->side.nodes());
  return sum;
}

namespace {

Momenta carried(const dem::Exchanged& now, const dem::Exchanged& atOpening) {
  return {now.momentum - atOpening.momentum, now.angularMomentum - atOpening.angularMomentum};
}

/// Moments across an axis that repeats: its sides push and pull at arms of whole periods.
void leaveOutRepeats(const geometry::Periodicity& space, Vec3& moment) {
  for (int axis = 0; axis < 3; ++axis)
    if (space.axes[static_cast<std::size_t>(axis)]) moment[(axis + 1) % 3] = moment[(axis + 2) % 3] = 0.0;
}

}  // namespace

Totals CoupledRun::totals() const {
  impl_->requireStarted("totals");
  Outside& outside = impl_->outside;
  outside.takeCounted(grains);
  Totals sum = impl_->sums();
  sum.given = outside.given;
  sum.given.give("entered", carried(grains.entered, outside.entered));
  sum.given.give("left", -1.0 * carried(grains.left, outside.gone));
  sum.massGained = (grains.entered.mass - outside.entered.mass) - (grains.left.mass - outside.gone.mass);
  ImpulseLedger::Channel all{"total", {}};
  for (const auto& solid : impl_->solids) {
    all.add(solid->loads);
    sum.given.add(solid->side.name + ": ", solid->given());
  }
  all.given = {};
  all.add(sum.given.total());
  sum.turnedOver = all.turnedOver;
  sum.turnedOverAngular = all.turnedOverAngular;
  sum.residual = Momenta{sum.momentum, sum.angularMomentum} - outside.opening - all.given;
  leaveOutRepeats(grains.pairs.periodicity(), sum.residual.angular);
  sum.massResidual = sum.mass - outside.massAtOpening - sum.massGained;
  return sum;
}

namespace {

void line(std::ostream& out, const std::string& name, const Momenta& m) {
  out << "  " << std::left << std::setw(34) << name << std::right << std::scientific << std::setprecision(4);
  for (const Vec3& v : {m.linear, m.angular})
    for (int c = 0; c < 3; ++c) out << std::setw(12) << v[c];
  out << '\n' << std::defaultfloat << std::setprecision(6);
}

}  // namespace

std::ostream& operator<<(std::ostream& out, const Totals& totals) {
  out << "momentum (kg m/s) and angular momentum about the origin (kg m^2/s)\n";
  line(out, "now", {totals.momentum, totals.angularMomentum});
  for (const ImpulseLedger::Channel& channel : totals.given.channels())
    line(out, "given by " + channel.name, channel.given);
  line(out, "residual", totals.residual);
  const auto fraction = [](double part, double whole) { return whole > 0.0 ? part / whole : 0.0; };
  return out << "  residual over all impulses " << fraction(norm(totals.residual.linear), totals.turnedOver)
             << ", over their moments " << fraction(norm(totals.residual.angular), totals.turnedOverAngular)
             << "; mass " << totals.mass << " kg, residual " << totals.massResidual << " kg\n";
}

}  // namespace dovetail::coupling
