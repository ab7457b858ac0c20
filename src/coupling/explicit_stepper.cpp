// Explicit solids: kick · drift · kick, own forces at the ends of macro steps.
#include <optional>

#include "dovetail/core/finite.hpp"
#include "dovetail/fem/motion/booked_motion.hpp"
#include "dovetail/fem/motion/support_kick.hpp"
#include "solid_stepper.hpp"

namespace dovetail::coupling {

namespace {

class ExplicitStepper final : public SolidStepper {
public:
  using SolidStepper::SolidStepper;

  void start(double dt, int K) override {
    dt_ = dt;
    K_ = K;
    inStep_ = false;
    if (solid_) carryOver(solid_->ledger);
    solid_.emplace(*model_, options_.massFraction, macroStep());
    side.mass = &solid_->motion.mass();
    solid_->sample();
    showOwn();
  }

  void begin(bool sampled) override {
    inStep_ = true;
    if (K_ > 1 && sampled) uBefore_ = model_->nodes.u, forceBefore_ = ownForce();
    halfKick(model_->t + 0.5 * macroStep());
  }

  void kickByLoad() override {
    if (K_ == 1 || side.load.touched.empty()) return;
    push();
  }

  /// Prescribed paths leave the mean velocity of their macro step at its inner steps: supports carry the nodes there.
  void drift() override {
    if (K_ == 1 || !solid_->supportsMove()) return solid_->motion.drift(dt_);
    const Momenta before = fem::momentaOf(model_->nodes, *side.mass);
    solid_->motion.drift(dt_);
    side.outside.give("supports", fem::momentaOf(model_->nodes, *side.mass) - before);
  }
  void jump() override {}
  std::vector<Vec3> seenVelocities(bool) const override { return model_->nodes.v; }
  void showVelocities(bool) override {}
  void hideVelocities() override {}

  void findForces(bool sampled) override {
    sampled_ = sampled;
    added_ = {};
    solid_->evaluate(macroStep(), sampled, inStep_);
    showOwn();
  }

  /// Without sub-steps the load kicks together with the own forces.
  void takeLoad() override { addToOwn(side.load); }
  void takeMacroLoad(const NodalLoad& load) override {
    macroLoad = load;
    addToOwn(load);
  }

  void end() override {
    halfKick(model_->t);
    solid_->accept(macroStep(), true);
    inStep_ = false;
    if (sampled_) solid_->sample();
  }

  void stepUnder(const NodalLoad& load) override {
    kickTouched(load, 0.5 * macroStep());  // first here and last there: own forces work at the same velocities
    halfKick(model_->t + 0.5 * macroStep());
    solid_->motion.drift(macroStep());
    inStep_ = true;
    findForces(true);
    halfKick(model_->t);
    kickTouched(load, 0.5 * macroStep());
    solid_->accept(macroStep(), true);
    inStep_ = false;
    solid_->sample();
  }

  std::vector<Vec3> forces() const override {
    std::vector<Vec3> force = model_->nodes.f;
    if (!side.own.empty()) return force;
    for (const int node : side.load.touched)
      force[static_cast<std::size_t>(node)] += side.load.force[static_cast<std::size_t>(node)];
    return force;
  }
  double kineticEnergy() const override { return solid_->motion.kineticEnergy(); }
  void restart() override {
    uBefore_.clear();
    forceBefore_.clear();
    solid_->evaluate(macroStep(), true, false);
    solid_->sample();
    showOwn();
  }

  void sample(EnergyLedger& ledger) override {
    copyChannels(solid_->ledger, kineticEnergy(), ledger);
    if (K_ > 1) ledger.set(side.name + ": time splitting", EnergyLedger::Kind::stored, splitting());
  }

  void save(ByteWriter& archive) override {
    solid_->save(archive, "coupled explicit");
    archive(loads.given, loads.turnedOver, loads.turnedOverAngular, added_);
  }
  std::shared_ptr<SavedSolid> read(ByteReader& archive) const override {
    auto state = std::make_shared<Saved>();
    state->state = solid_->read(archive, "coupled explicit");
    archive(state->loads.given, state->loads.turnedOver, state->loads.turnedOverAngular, state->added);
    return state;
  }
  void adopt(SavedSolid& state) override {
    auto& saved = dynamic_cast<Saved&>(state);
    solid_->adopt(*saved.state);
    loads = std::move(saved.loads);
    added_ = saved.added;
    takeNodes();
  }

protected:
  const ImpulseLedger& ownImpulses() const override { return solid_->impulses; }
  bool renewOwnNodes() override {
    if (!solid_->renewNodes(macroStep())) return false;
    added_ = {};
    takeNodes();
    return true;
  }

private:
  struct Saved final : SavedSolid {
    ImpulseLedger::Channel loads{"connectors", {}};
    Momenta added;
    std::shared_ptr<fem::BookedMotion::State> state;
  };

  double macroStep() const { return K_ * dt_; }
  /// They may have become others.
  void takeNodes() {
    side.mass = &solid_->motion.mass();
    uBefore_.clear();
    forceBefore_.clear();
    showOwn();
  }
  void showOwn() { side.own = K_ == 1 ? std::span<const Vec3>(model_->nodes.f) : std::span<const Vec3>(); }

  void addToOwn(const NodalLoad& load) {
    added_ += totalOf(load, model_->nodes);
    for (const int node : load.touched) {
      const auto n = static_cast<std::size_t>(node);
      model_->nodes.f[n] += load.force[n];
    }
  }

  void halfKick(double time) {
    loads.give(0.5 * macroStep() * added_);
    if (!solid_->halfKick(macroStep(), time, true))
      requireFinite(model_->nodes.v, "node", "velocity", side.name + ", t = " + formatNumber(model_->t) + " s");
  }

  void push() {
    if (side.mass->isDiagonal()) return kickTouched(side.load, 0.5 * dt_);
    loads.give(0.5 * dt_ * totalOf(side.load, model_->nodes));
    std::vector<Vec3> given = side.load.force;
    for (Vec3& value : given) value *= 0.5 * dt_;
    side.kick(given);
  }

  /// Without what constraints answer to them.
  std::vector<Vec3> ownForce() const {
    std::vector<Vec3> force = model_->nodes.f;
    for (const int node : macroLoad.touched)
      force[static_cast<std::size_t>(node)] -= macroLoad.force[static_cast<std::size_t>(node)];
    return force;
  }

  /// What impulses of macro steps of length h store, J: with V the energy of the solid's own forces, g and g_f the
  /// gradients of V and of what acts at every step, the scheme conserves to leading order, beside the energy itself, h²
  /// [v·V''v/12 − g·M⁻¹g_f/12 − g·M⁻¹g/24] (Baker–Campbell–Hausdorff series of half kick · fast steps · half kick), a
  /// state function; M⁻¹g as far as constraints let it. V''v by the difference of the forces over the macro step.
  double splitting() const {
    const fem::Nodes& nodes = model_->nodes;
    const double h = macroStep();
    const std::vector<Vec3> force = ownForce();
    std::vector<Vec3> slow = nodes.f, fast = side.load.force;
    side.mass->solve(slow);
    side.mass->solve(fast);
    double sum = 0.0;
    for (std::size_t n = 0; n < nodes.f.size(); ++n) {
      sum -= h * h * dot(force[n], fast[n] / 12.0 + slow[n] / 24.0);
      if (!uBefore_.empty()) sum -= dot(force[n] - forceBefore_[n], nodes.u[n] - uBefore_[n]) / 12.0;
    }
    return sum;
  }

  bool inStep_ = false;  // between a macro step's begin() and end(): the forces found there are accepted
  std::optional<fem::BookedMotion> solid_;
  bool sampled_ = true;
  Momenta added_;  // N, N m: loads among the own forces
  std::vector<Vec3> uBefore_, forceBefore_;
};

}  // namespace

std::unique_ptr<SolidStepper> makeExplicitStepper(std::unique_ptr<fem::Model> model, const SolidOptions& options) {
  return std::make_unique<ExplicitStepper>(std::move(model), options);
}

}  // namespace dovetail::coupling
