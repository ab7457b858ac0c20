#include "dovetail/fem/motion/booked_motion.hpp"

#include <algorithm>

#include "dovetail/fem/motion/support_kick.hpp"
#include "force_sum.hpp"
#include "renewal.hpp"
#include "run_state.hpp"

namespace dovetail::fem {

namespace {

bool anySupportMoves(const Model& model, const DofMap& dofs) {
  if (dofs.hasMotion()) return true;
  for (std::size_t n = 0; n < model.nodes.fixed.size(); ++n)
    for (int c = 0; c < 3; ++c)
      if (model.nodes.fixed[n] >> c & 1 && model.nodes.v[n][c] != 0.0) return true;
  return false;
}

}  // namespace

BookedMotion::BookedMotion(Model& model, double massFraction, double h)
    : motion(model, massFraction),
      ledger(model),
      guessesVelocity_(std::ranges::any_of(model.terms, [](const auto& term) { return term->usesVelocity(); })),
      moving_(anySupportMoves(model, motion.dofs())),
      worksAreBooked_(std::ranges::any_of(model.terms, [](const auto& term) { return !term->hasEnergy(); })) {
  motion.dofs().apply(model.t, model.nodes.u);
  motion.dofs().applyVelocity(model.t, h, model.nodes.v);
  findForces(h, true, false);
}

void BookedMotion::findForces(double h, bool withEnergies, bool willAccept) {
  motion.forces(h, withEnergies, willAccept);
  outside_.clear();
  accelerated_ = false;
}

void BookedMotion::accelerate(double h) {
  if (accelerated_) return;
  const Model& model = motion.model();
  acceleration_.assign(model.nodes.u.size(), {});
  if (moving_) motion.dofs().applyAcceleration(model.t, h, acceleration_);
  motion.mass().accelerate(model.nodes.f, acceleration_);
  accelerated_ = true;
}

void BookedMotion::evaluate(double h, bool withEnergies, bool willAccept) {
  if (!guessesVelocity_) return findForces(h, withEnergies, willAccept);
  Model& model = motion.model();
  std::vector<Vec3> guess = model.nodes.v;
  push(h, model.t);
  findForces(h, withEnergies, willAccept);
  model.nodes.v.swap(guess);
}

bool BookedMotion::push(double h, double time) {
  bool finite = true;
  if (motion.mass().isDiagonal()) {
    finite = motion.kick(0.5 * h);
  } else {
    accelerate(h);
    finite = motion.kick(acceleration_, 0.5 * h);
  }
  motion.dofs().applyVelocity(time, h, motion.model().nodes.v);
  return finite;
}

double BookedMotion::workInHalfKick(std::span<const Vec3> force, std::span<const Vec3> before, double h) const {
  return 0.25 * h * (detail::innerProduct(force, before) + detail::innerProduct(force, motion.model().nodes.v));
}

bool BookedMotion::halfKick(double h, double time, bool books) {
  if (!books) return push(h, time);
  const Model& model = motion.model();
  const bool changes = moving_ || worksAreBooked_ || !motion.mass().isDiagonal();
  if (changes) before_ = model.nodes.v;
  const double kinetic = moving_ ? motion.kineticEnergy() : 0.0;
  const bool finite = push(h, time);
  giveImpulses(h, changes);
  for (std::size_t k = 0; k < model.terms.size(); ++k)
    if (const Term& term = *model.terms[k]; !term.hasEnergy())
      ledger.add("work of " + term.name(), -workInHalfKick(motion.loads()[k], before_, h));
  if (moving_) ledger.add("supports", kinetic - motion.kineticEnergy() + workInHalfKick(model.nodes.f, before_, h));
  return finite;
}

bool BookedMotion::renewNodes(double h) {
  if (!detail::renewNodes(motion.model(), ledger, impulses)) return false;
  motion.renew();
  findForces(h, true, false);
  return true;
}

void BookedMotion::giveImpulses(double h, bool changes) {
  const Model& model = motion.model();
  if (outside_.empty()) {
    for (const std::vector<Vec3>& load : motion.loads()) outside_.push_back(momentaOf(model.nodes, load));
    if (!changes) atSupports_ = supportKick(model.nodes, motion.mass(), {}, model.nodes.f, 1.0).impulse;
  }
  for (std::size_t k = 0; k < outside_.size(); ++k)
    if (!motion.loads()[k].empty() && !model.terms[k]->actsWithin())
      impulses.give(model.terms[k]->name(), 0.5 * h * outside_[k]);
  impulses.give("supports", changes ? supportKick(model.nodes, motion.mass(), before_, model.nodes.f, 0.5 * h).impulse
                                    : 0.5 * h * atSupports_);
}

void BookedMotion::save(ByteWriter& archive, const std::string& kind) const {
  const Model& model = motion.model();
  std::vector<Vec3> a = acceleration_;
  a.resize(model.nodes.u.size());  // where masses are lumped, forces say it all
  detail::writeModel(archive, kind, model);
  ledger.save(archive);
  impulses.save(archive);
  detail::writeStart(archive, {a, model.nodes.f, {motion.loads().begin(), motion.loads().end()}});
}

struct BookedMotion::State {
  detail::ModelState model;
  ModelLedger ledger;
  ImpulseLedger impulses;
  detail::StepStart start;
};

std::shared_ptr<BookedMotion::State> BookedMotion::read(ByteReader& archive, const std::string& kind) const {
  detail::ModelState state = detail::readModel(archive, kind, motion.model());
  ModelLedger books = ledger.read(archive);
  ImpulseLedger given;
  given.load(archive);
  return std::make_shared<State>(
      State{std::move(state), std::move(books), std::move(given), detail::readStart(archive, motion.model())});
}

void BookedMotion::adopt(State& state) {
  detail::adopt(std::move(state.model), motion.model());
  if (ownsNodes(motion.model())) motion.renew();
  ledger = std::move(state.ledger);
  impulses = std::move(state.impulses);
  outside_.clear();
  acceleration_ = std::move(state.start.a);
  accelerated_ = true;
  motion.model().nodes.f = std::move(state.start.f);
  motion.setLoads(std::move(state.start.loads));
}

}  // namespace dovetail::fem
