// Implicit solids: connectors kick the standing nodes, then these move by a whole macro step.
#include <optional>
#include <utility>

#include "solid_stepper.hpp"

namespace dovetail::coupling {

namespace {

class ImplicitStepper final : public SolidStepper {
public:
  using SolidStepper::SolidStepper;

  void start(double dt, int K) override {
    dt_ = dt;
    K_ = K;
    fem::ImplicitOptions options = options_.implicitOptions;
    options.massFraction = options_.massFraction;
    if (solid_) carryOver(solid_->ledger());
    solid_.emplace(*model_, macroStep(), options);
    side.mass = &solid_->mass();
    side.own = {};
    byOwnForces_.clear();
  }

  void begin(bool) override {
    steps_ = 0;
    jumped_ = false;
    kick(macroLoad, 0.5 * macroStep());
  }
  void kickByLoad() override { kick(side.load, 0.5 * dt_); }
  void drift() override {}
  void jump() override {
    byOwnForces_ = model_->nodes.v;
    solid_->step();
    for (std::size_t n = 0; n < byOwnForces_.size(); ++n) byOwnForces_[n] = model_->nodes.v[n] - byOwnForces_[n];
    jumped_ = true;
  }
  /// Own forces act within the jump, connectors throughout the macro step: velocities go up and down by as much as
  /// either does in a macro step, which is much where nodes are light. Connectors see them as if own forces acted
  /// throughout too.
  void showVelocities(bool timeless) override {
    if (!timeless) ++steps_;
    if (byOwnForces_.empty()) return;
    hidden_ = std::exchange(model_->nodes.v, velocitiesAt(timeless ? steps_ : steps_ - 0.5));
  }
  std::vector<Vec3> seenVelocities(bool timeless) const override {
    return byOwnForces_.empty() ? model_->nodes.v : velocitiesAt(timeless ? steps_ : steps_ + 0.5);
  }
  void hideVelocities() override {
    if (!hidden_.empty()) model_->nodes.v = std::exchange(hidden_, {});
  }
  void findForces(bool) override {}
  void takeLoad() override {}
  void takeMacroLoad(const NodalLoad& load) override { macroLoad = load; }
  void end() override { kick(macroLoad, 0.5 * macroStep()); }

  void stepUnder(const NodalLoad& load) override {
    kick(load, 0.5 * macroStep());
    solid_->step();
    kick(load, 0.5 * macroStep());
  }

  linalg::LinearForecast forecast() override { return solid_->forecast(); }

  /// Newmark's average acceleration lets modes far above the step ring for ever, hardly moving at the ends of steps: no
  /// stop takes anything from them. With γ = 3/2, β = 1 they are gone after two steps.
  void damp(bool on) override {
    const bool averages = !options_.implicitOptions.scheme.conserving &&
                          options_.implicitOptions.scheme.alphaF == 0.0 &&
                          options_.implicitOptions.scheme.alphaM == 0.0;
    if (averages) solid_->use(on ? fem::newmark(1.0, 1.5) : options_.implicitOptions.scheme);
  }
  std::vector<Vec3> forces() const override {
    std::vector<Vec3> force(model_->nodes.X.size());
    for (const auto& term : model_->terms) term->addForces(model_->nodes, {.t = model_->t, .mass = side.mass}, force);
    for (const NodalLoad* const load : {&side.load, &macroLoad})
      for (const int node : load->touched)
        force[static_cast<std::size_t>(node)] += load->force[static_cast<std::size_t>(node)];
    return force;
  }
  double kineticEnergy() const override { return solid_->kineticEnergy(); }
  void restart() override {
    byOwnForces_.clear();
    solid_->restart();
  }
  void sample(EnergyLedger& ledger) override { copyChannels(solid_->ledger(), kineticEnergy(), ledger); }

  void save(ByteWriter& archive) override {
    ByteWriter own;
    solid_->save(own);
    archive(own.bytes(), loads.given, loads.turnedOver, loads.turnedOverAngular, byOwnForces_);
  }
  std::shared_ptr<SavedSolid> read(ByteReader& archive) const override {
    auto state = std::make_shared<Saved>();
    archive(state->bytes, state->loads.given, state->loads.turnedOver, state->loads.turnedOverAngular,
            state->byOwnForces);
    return state;
  }
  void adopt(SavedSolid& state) override {
    auto& saved = dynamic_cast<Saved&>(state);
    ByteReader reader(saved.bytes);
    solid_->load(reader);
    side.mass = &solid_->mass();
    loads = std::move(saved.loads);
    byOwnForces_ = std::move(saved.byOwnForces);
  }

protected:
  const ImpulseLedger& ownImpulses() const override { return solid_->impulses(); }
  bool renewOwnNodes() override {
    if (!solid_->renewNodes()) return false;
    side.mass = &solid_->mass();
    byOwnForces_.clear();
    return true;
  }

private:
  struct Saved final : SavedSolid {
    ImpulseLedger::Channel loads{"connectors", {}};
    std::vector<Vec3> byOwnForces;
    std::vector<char> bytes;
  };

  double macroStep() const { return K_ * dt_; }

  /// After so many steps of the macro step. Between steps particles have the velocities of the instant, within steps
  /// those of half a step before.
  std::vector<Vec3> velocitiesAt(double steps) const {
    const double fraction = steps / K_ - (jumped_ ? 1.0 : 0.0);
    std::vector<Vec3> v = model_->nodes.v;
    for (std::size_t n = 0; n < v.size(); ++n) v[n] += fraction * byOwnForces_[n];
    return v;
  }

  void kick(const NodalLoad& load, double dt) {
    if (load.touched.empty()) return;
    if (side.mass->isDiagonal()) return kickTouched(load, dt);
    loads.give(dt * totalOf(load, model_->nodes));
    std::vector<Vec3> given = load.force;
    for (Vec3& value : given) value *= dt;
    side.kick(given);
  }

  std::optional<fem::ImplicitIntegrator> solid_;
  int steps_ = 0;                  // of the particles in this macro step so far
  bool jumped_ = false;            // in this macro step
  std::vector<Vec3> byOwnForces_;  // change of velocity in the last jump, m/s
  std::vector<Vec3> hidden_;       // velocities while others are shown, m/s
};

}  // namespace

std::unique_ptr<SolidStepper> makeImplicitStepper(std::unique_ptr<fem::Model> model, const SolidOptions& options) {
  return std::make_unique<ImplicitStepper>(std::move(model), options);
}

}  // namespace dovetail::coupling
