#include "implicit_step.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"
#include "solve/newton_tools.hpp"

namespace dovetail::fem::detail {

void validate(const ImplicitOptions& options) {
  requirePositive(options.relativeTolerance, "relativeTolerance");
  requireNonNegative(options.absoluteTolerance, "absoluteTolerance");
  requirePositive(options.refactorContraction, "refactorContraction");
  if (options.maxIterations < 1 || options.refactorAfter < 1)
    throw InputError("no iterations are allowed", "ImplicitOptions",
                     "give maxIterations and refactorAfter of 1 or more");
  if (options.maxCuts < 0 || options.maxAugmentations < 0 || options.energyEvery < 0)
    throw InputError("a count is negative", "ImplicitOptions", "give 0 or more");
}

ImplicitStep::ImplicitStep(Model& model, const DofMap& dofs, ModelMass& mass, const ImplicitOptions& options,
                           Profile& profile)
    : model_(model),
      dofs_(dofs),
      mass_(mass),
      options_(options),
      profile_(profile),
      solver_(dofs, options.linear, &model.nodes),
      matrix_(zeroTangent(model)),
      start_(model),
      end_(model),
      conserves_(model.terms.size(), 0),
      residual_(dofs.size()),
      increment_(dofs.size()) {
  const std::size_t n = model.nodes.u.size();
  for (std::vector<Vec3>* field : {&a0_, &a1_, &base_, &correction_, &inertia_, &work_, &start_.total, &end_.total})
    field->resize(n);
  if (conserving()) mean_ = model.nodes;
}

void ImplicitStep::begin(double h) {
  solver_.drop();
  start_.evaluate(model_, model_.nodes, {model_.t, 0.0, &mass_}, start_.total,
                  false);  // terms that remember take their past from it
  if (conserving()) return;
  addStartRates(h);
  std::fill(a0_.begin(), a0_.end(), Vec3{});
  dofs_.applyAcceleration(model_.t, h, a0_);
  mass_.accelerate(start_.total, a0_);
}

/// What terms that feel rates exert beside, because nodes are moving: the difference that moving on for a short time
/// makes to their forces. (Their past says how they moved before whatever started this run, if it says anything.)
void ImplicitStep::addStartRates(double h) {
  if (std::ranges::none_of(model_.terms, [](const auto& term) { return term->feelsRates(); })) return;
  constexpr double fraction = 1e-3;  // of the step
  const Instant now{model_.t, fraction * h, &mass_};
  Nodes moved = model_.nodes;
  for (std::size_t n = 0; n < moved.u.size(); ++n) moved.u[n] += fraction * h * moved.v[n];
  std::vector<Vec3> with(moved.u.size()), without(moved.u.size());
  for (const auto& term : model_.terms)
    if (term->feelsRates()) {
      term->addForces(moved, now, with);
      term->addForces(model_.nodes, now, without);
    }
  for (std::size_t n = 0; n < with.size(); ++n) start_.total[n] += with[n] - without[n];
}

/// Brings constraints into the correction, and u, v and the acceleration of the balance to what it says.
void ImplicitStep::applyCorrection() {
  const double h = h_;
  const Scheme& s = options_.scheme;
  Nodes& nodes = model_.nodes;
  for (std::size_t n = 0; n < base_.size(); ++n) nodes.u[n] = base_[n] + correction_[n];
  dofs_.apply(model_.t + h, nodes.u);
  for (std::size_t dof = 0; dof < dofs_.freeRow().size(); ++dof) {
    const std::size_t n = dof / 3;
    const int c = static_cast<int>(dof % 3);
    if (dofs_.freeRow()[dof] < 0) correction_[n][c] = nodes.u[n][c] - base_[n][c];
  }
  const double toAcceleration = conserving() ? 2.0 / (h * h) : 1.0 / (s.beta * h * h);
  for (std::size_t n = 0; n < base_.size(); ++n) {
    const Vec3 a = toAcceleration * correction_[n];
    a1_[n] = a;
    nodes.v[n] = conserving() ? v0_[n] + h * a : v0_[n] + h * ((1.0 - s.gamma) * a0_[n] + s.gamma * a);
    inertia_[n] = conserving() ? a : (1.0 - s.alphaM) * a + s.alphaM * a0_[n];
  }
  for (std::size_t n = 0; n < base_.size(); ++n)
    for (int c = 0; c < 3; ++c)
      if (nodes.fixed[n] >> c & 1) nodes.v[n][c] = v0_[n][c], inertia_[n][c] = 0.0;
  dofs_.applyVelocity(model_.t + h, h, nodes.v);
  // The balance holds at t + (1 − α_F) h; half-way the second difference is the change of velocity over the step.
  dofs_.applyAcceleration(model_.t + h * (conserving() ? 0.5 : 1.0 - s.alphaF), h, inertia_);
}

double ImplicitStep::evaluate() {
  applyCorrection();
  findForces();
  return balance();
}

void ImplicitStep::findForces() {
  const Profile::Stage stage(profile_, "forces");
  if (conserving()) return findConservingForces();
  end_.evaluate(model_, model_.nodes, atEnd(), end_.total, false);
}

void ImplicitStep::findConservingForces() {
  for (std::size_t n = 0; n < u0_.size(); ++n) {
    mean_.u[n] = 0.5 * (u0_[n] + model_.nodes.u[n]);
    mean_.v[n] = (model_.nodes.u[n] - u0_[n]) / h_;
  }
  std::fill(end_.total.begin(), end_.total.end(), Vec3{});
  for (std::size_t k = 0; k < model_.terms.size(); ++k) {
    Term& term = *model_.terms[k];
    std::vector<Vec3>& load = end_.loads[k];
    std::fill(load.begin(), load.end(), Vec3{});
    const std::span<Vec3> to = load.empty() ? std::span<Vec3>(end_.total) : std::span<Vec3>(load);
    conserves_[k] = term.addConservingForces(model_.nodes, u0_, atEnd(), to);
    if (!conserves_[k]) term.addForces(mean_, inMiddle(), to);
    for (std::size_t n = 0; n < load.size(); ++n) end_.total[n] += load[n];
  }
}

std::vector<std::string> ImplicitStep::termsAtMeanState() const {
  std::vector<std::string> names;
  for (std::size_t k = 0; k < conserves_.size(); ++k)
    if (conserving() && !conserves_[k] && model_.terms[k]->hasEnergy()) names.push_back(model_.terms[k]->name());
  return names;
}

/// Fills residual_ and sets the tolerance; returns the norm.
double ImplicitStep::balance() {
  const Profile::Stage stage(profile_, "balance");
  const double fraction = conserving() ? 1.0 : 1.0 - options_.scheme.alphaF;
  std::vector<Vec3>& push = inertia_;
  mass_.multiply(inertia_, work_);
  const double inertiaNorm = normOf(work_);
  for (std::size_t n = 0; n < push.size(); ++n) {
    push[n] = fraction * end_.total[n] - work_[n];
    if (!conserving()) push[n] += options_.scheme.alphaF * start_.total[n];
  }
  dofs_.reduce(push, residual_);
  double largest = std::max(inertiaNorm, normOf(end_.total));
  for (std::size_t k = 0; k < end_.loads.size(); ++k)
    if (!model_.terms[k]->hasEnergy()) largest = std::max(largest, normOf(end_.loads[k]));
  tolerance_ = options_.relativeTolerance * largest + options_.absoluteTolerance +
               resolution_.at(std::max(normOf(model_.nodes.u), normOf(base_)));
  return normOf(residual_);
}

/// The matrix of the step. Conserving forces have tangents that are not symmetric by as much as elements turn in the
/// step: only if `exact` are they taken so, and by direct methods.
bool ImplicitStep::factor(bool exact) {
  const Scheme& s = options_.scheme;
  const double h = h_;
  {
    const Profile::Stage stage(profile_, "assembly");
    matrix_.setZero();
    if (conserving()) {
      addMeanTangents();
      resolution_.measure(matrix_, model_.nodes.X);
      mass_.addTo(matrix_, 2.0 / (h * h));
    } else {
      const Instant now = atEnd();
      for (const auto& term : model_.terms) term->addDamping(model_.nodes, now, rowsFor(*term, matrix_));
      for (double& value : matrix_.values()) value *= s.gamma / (s.beta * h);
      addTangents(model_, now, matrix_);
      for (double& value : matrix_.values()) value *= 1.0 - s.alphaF;
      resolution_.measure(matrix_, model_.nodes.X);
      mass_.addTo(matrix_, (1.0 - s.alphaM) / (s.beta * h * h));
    }
  }
  const Profile::Stage stage(profile_, "factorisation");
  bool symmetric = isSymmetric();
  const bool keep = exact && !solver_.iterates();
  if (conserving() && symmetric && !keep) matrix_.symmetrise();
  if (conserving() && keep) symmetric = false;
  factoredStep_ = h;
  return solver_.factor(matrix_, symmetric);
}

bool ImplicitStep::isSymmetric() const {
  return std::ranges::all_of(model_.terms, [](const auto& term) { return term->isSymmetric(); });
}

void ImplicitStep::addMeanTangents() {
  const Instant middle = inMiddle();
  for (std::size_t k = 0; k < model_.terms.size(); ++k)
    if (!conserves_[k]) model_.terms[k]->addDamping(mean_, middle, rowsFor(*model_.terms[k], matrix_));
  for (double& value : matrix_.values()) value *= 2.0 / h_;
  for (std::size_t k = 0; k < model_.terms.size(); ++k)
    if (!conserves_[k]) model_.terms[k]->addTangent(mean_, middle, rowsFor(*model_.terms[k], matrix_));
  for (double& value : matrix_.values()) value *= 0.5;
  for (std::size_t k = 0; k < model_.terms.size(); ++k)
    if (conserves_[k])
      model_.terms[k]->addConservingTangent(model_.nodes, u0_, atEnd(), rowsFor(*model_.terms[k], matrix_));
}

bool ImplicitStep::direct(double loosest) {
  const Profile::Stage stage(profile_, "solution");
  startCorrection_ = correction_;
  solver_.solve(residual_, increment_, loosest);
  return true;
}

void ImplicitStep::moveTo(double fraction) {
  part_ = increment_;
  for (double& value : part_) value *= fraction;
  correction_ = startCorrection_;
  dofs_.addIncrement(part_, correction_);
}

NewtonResult ImplicitStep::attempt(double h, Guess guess) {
  h_ = h;
  u0_ = model_.nodes.u;
  v0_ = model_.nodes.v;
  bool guessed = false;
  const NewtonResult result = attemptStep(model_, atEnd(), options_.maxAugmentations, [&] {
    if (!guessed) {
      setBase();
      makeGuess(guess);
      guessed = true;
    }
    return newton(*this, {options_.maxIterations, conserving() ? LineSearch::afterBreakdown : LineSearch::always,
                          options_.refactorAfter, options_.refactorContraction});
  });
  if (!result.failure.empty()) solver_.drop();
  return result;
}

std::vector<Vec3> ImplicitStep::meanForce() const {
  std::vector<Vec3> mean = end_.total;
  if (!conserving())
    for (std::size_t n = 0; n < mean.size(); ++n) mean[n] = 0.5 * (mean[n] + start_.total[n]);
  return mean;
}

double ImplicitStep::loadWork(std::size_t term, const std::vector<Vec3>& motion) const {
  const double end = innerProduct(end_.loads[term], motion);
  return conserving() ? end : 0.5 * (end + innerProduct(start_.loads[term], motion));
}

std::vector<Vec3> ImplicitStep::weighted(std::vector<Vec3> end, const std::vector<Vec3>& start) const {
  const Scheme& s = options_.scheme;
  const double gamma = s.alphaF == 0.0 && s.alphaM == 0.0 ? s.gamma : 0.5;
  if (!conserving())
    for (std::size_t n = 0; n < end.size(); ++n) end[n] = gamma * end[n] + (1.0 - gamma) * start[n];
  return end;
}

void ImplicitStep::save(ByteWriter& archive) const {
  writeStart(archive, {a0_, start_.total, start_.loads});
  archive(factoredStep_, resolution_);
  solver_.save(archive);
}

ImplicitStep::State ImplicitStep::read(ByteReader& archive) const {
  StepStart start = readStart(archive, model_);
  const double factoredStep = readNumber(archive, "step of the factors");
  ForceResolution resolution;
  archive(resolution);
  return {std::move(start), factoredStep, resolution, solver_.read(archive, matrix_)};
}

void ImplicitStep::restart(State state) {
  a0_ = std::move(state.start.a);
  start_.total = std::move(state.start.f);
  start_.loads = std::move(state.start.loads);
  factoredStep_ = state.factoredStep;
  resolution_ = state.resolution;
  solver_.adopt(std::move(state.factored));
}

void ImplicitStep::accept() {
  if (conserving()) return;
  a0_.swap(a1_);
  std::swap(start_, end_);
}

}  // namespace dovetail::fem::detail
