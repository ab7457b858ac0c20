#include "run.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <memory>

#include "dovetail/core/finite.hpp"
#include "dovetail/core/progress.hpp"
#include "dovetail/dem/model/loads.hpp"
#include "dovetail/io/interruption.hpp"
#include "dovetail/scene/read.hpp"

namespace dovetail::wave {

using benchmark::moment;

namespace {

constexpr double stableFactor = 1.5;

class Runner {
public:
  explicit Runner(const Settings& settings) : penalty_(penaltyOf(settings)), bar_(makeBar(settings, penalty_)) {
    result_.settings = settings;
    result_.byPlace = bar_.byPlace;
    run_.profile = Profile(settings.profile);
    if (settings.profile) grains().profile = &run_.profile;
    prepareStep();
    prepareBooks();
    countParts();
  }

  RunResult run(const Observer& observer) {
    observer_ = observer;
    benchmark::conduct(figures(), [this] { return loop(); });
    close();
    return std::move(result_);
  }

private:
  RunFigures& figures() { return result_.figures; }
  const Settings& settings() const { return result_.settings; }
  dem::Model& grains() { return run_.grains; }
  const dem::Particles& particles() { return grains().particles; }

  void prepareStep() {
    const Settings& s = settings();
    figures().critical = criticalStep(s, bar_);
    const StepPlan plan = planSteps(s, figures().critical);
    K_ = plan.stepsPerMacroStep;
    macroSteps_ = plan.macroSteps;
    figures().dt = dt_ = plan.dt;
    scene::Scene& scene = bar_.scene;
    scene.steps.dt = {dt_, ""};
    scene.output.frames = s.outputInterval;
    result_.scene = scene::sceneText(scene);
  }

  void setLedger() {
    ofRun_ = &run_.ledger();
    recorder_.setLedger();
  }

  /// The channels of the run under the names of the case.
  void prepareBooks() {
    const auto of = [this](const char* channel) { return [this, channel] { return ofRun_->joules(channel); }; };
    const auto kinetic = recorder_.stored("kinetic, particles", of("particles: kinetic"));
    const auto contacts = recorder_.stored("elastic, contacts", of("particles: contacts"));
    std::optional<EnergyLedger::Id> kineticSolid, elasticSolid;
    if (bar_.solid) {
      kineticSolid = recorder_.stored("kinetic, solid", of("bar: kinetic"));
      elasticSolid = recorder_.stored("elastic, solid", of("bar: elements"));
      stored_ = recorder_.stored("stored in the coupling", [this] { return bar_.tie->stored(); });
      recorder_.booked("lost in the coupling", [this] { return bar_.tie->lost() - bar_.tie->absorbed(); });
    }
    if (bar_.solid && K_ > 1 && !settings().implicit()) recorder_.stored("time splitting", of("bar: time splitting"));
    if (settings().absorber > 0.0 && bar_.solid) recorder_.booked("absorber", [this] { return absorbed(); });
    if (!grains().terms.all<dem::DriveTerm>().empty())
      recorder_.booked("drive (minus its work)", [this] { return -externalWork(); });

    recorder_.column("time_s", [this] { return grains().time; });
    recorder_.column("mass_particles_kg", [this] { return massOfParticles(); });
    recorder_.column("mass_solid_kg", [this] { return massOfSolid(); });
    recorder_.column("momentum_particles_y_Ns", [this] { return dem::momentum(particles()).y; });
    recorder_.column("momentum_solid_y_Ns", [this] { return bar_.solid ? fem::momentum(bar_.solid->nodes()).y : 0.0; });
    recorder_.column("kinetic_particles_J", kinetic);
    recorder_.column("elastic_contacts_J", contacts);
    recorder_.column("kinetic_solid_J", kineticSolid);
    recorder_.column("elastic_solid_J", elasticSolid);
    recorder_.column("stored_coupling_J", stored_);
    recorder_.column("energy_total_J", [this] { return result_.ledger.stored(); });
    recorder_.column("coupling_work_J", [this] { return couplingWork(); });
    recorder_.column("absorbed_J", [this] { return absorbed(); });
    recorder_.column("external_work_J", [this] { return externalWork(); });
    recorder_.column("ledger_residual_J", [this] { return result_.ledger.residual(); });
  }

  void countParts() {
    RunFigures& f = figures();
    f.particles = grains().particles.size();
    double mass = massOfParticles();
    if (settings().fullDem) {  // without the wall
      f.particles -= static_cast<std::size_t>(particlesPerLayer(settings()));
      mass -= particlesPerLayer(settings()) * particleMass(settings());
    }
    if (bar_.solid) {
      f.elements = bar_.built.meshes.front().elementCount();
      f.overlapParticles = bar_.tie->overlap().size();
      for (const double m : bar_.solid->nodes().mass) mass += m;
      f.penalty = penalty_;
    }
    const double side = Case{}.side, exact = bulkDensity() * side * side * barLength(settings());
    f.massResidual = std::abs(mass - exact) / exact;
  }

  double massOfParticles() {
    double mass = 0.0;
    for (std::size_t i = 0; i < particles().size(); ++i) mass += particles().weightOf(i) * particles().mass[i];
    return mass;
  }

  double massOfSolid() const {
    double mass = 0.0;
    if (bar_.solid)
      for (const double m : bar_.solid->nodes().mass) mass += m;
    return mass;
  }

  /// What the coupling did to both models together: what its store gives back, less what it loses, J.
  double couplingWork() const {
    return bar_.tie ? -bar_.tie->stored() - (bar_.tie->lost() - bar_.tie->absorbed()) : 0.0;
  }
  double absorbed() const { return bar_.tie ? bar_.tie->absorbed() : 0.0; }
  double externalWork() { return grains().booked.walls; }

  /// Momentum of the particles, and what drives gave them less what they gave to the solid: they change alike.
  struct Balance {
    Vec3 momentum, given;
  };
  Balance balance() {
    Balance sum{dem::momentum(particles()), -run_.totals().ontoSolids};
    for (const auto* drive : grains().terms.all<dem::DriveTerm>()) sum.given += drive->supportImpulse;
    return sum;
  }

  /// Returns whether it went to the end; if it was interrupted, `failure` says so.
  bool loop() {
    run_.start(dt_, {.stepsPerMacroStep = K_});
    if (bar_.tie) figures().coupledNodes = bar_.tie->operators().rows();
    setLedger();
    result_.ledger.open();
    start_ = balance();
    const std::int64_t sampleEvery = std::clamp<std::int64_t>(macroSteps_ / 2000, 8 / std::min(8, K_), 1000);
    const double end = endTime(settings());
    const std::int64_t frameEvery = std::max<std::int64_t>(
        1, std::llround(settings().outputInterval / (K_ * dt_ * static_cast<double>(sampleEvery))));
    Progress progress(settings().fullDem ? "particles alone" : "wave", 1.0, !settings().quiet);
    sample();
    observe();
    for (std::int64_t w = 1, samples = 0; w <= macroSteps_; ++w) {
      const bool ends = w == macroSteps_ || io::interruption() != 0, now = w % sampleEvery == 0 || ends;
      run_.advance(1, now);
      if (!now) continue;
      sample();
      if (++samples % frameEvery == 0 || ends) observe();
      progress.update(grains().time / end, "t = " + formatNumber(std::round(1e5 * grains().time) / 1e5) + " s");
      if (ends && w < macroSteps_) {
        figures().failure = benchmark::interrupted(grains().time, steps());
        return false;
      }
    }
    return true;
  }

  void sample() {
    dem::requireFinite(particles(), moment(grains().time, steps()));
    if (bar_.solid) requireFinite(bar_.solid->nodes().v, "node", "velocity", moment(grains().time, steps()));
    setLedger();
    result_.ledger.close();
    const double booked = externalWork() + result_.ledger.storedAtOpening();
    largestStored_ = std::max(largestStored_, result_.ledger.stored());
    mostInput_ = std::max(mostInput_, booked);
    if (grains().time >= driveTime(settings()) * (1.0 - 1e-12) && figures().energyInput == 0.0)
      figures().energyInput = booked;
    const Balance now = balance();
    largestMomentum_ = std::max(largestMomentum_, norm(run_.totals().momentum));
    largestMomentumGap_ =
        std::max(largestMomentumGap_, norm(now.momentum - start_.momentum - (now.given - start_.given)));
    if (bar_.tie) sampleGap();
    double stored = result_.ledger.stored();
    if (stored_) stored -= result_.ledger.channels()[*stored_].joules;
    result_.energy.push_back({grains().time, stored});
    recorder_.addRow();
  }

  void sampleGap() {
    const arlequin::ArlequinCoupling& tie = *bar_.tie;
    std::vector<Vec3> rate(tie.operators().rows());
    arlequin::gapOf(tie.operators(), tie.overlap(), particles().v, bar_.solid->nodes().v, rate);
    double mismatch = 0.0, speed = 0.0;
    for (const Vec3& v : rate) mismatch += squaredNorm(v);
    for (const int i : tie.overlap().particle) speed += squaredNorm(particles().v[static_cast<std::size_t>(i)]);
    mismatchSquared_ += mismatch / static_cast<double>(rate.size());
    speedSquared_ += speed / static_cast<double>(tie.overlap().size());
    for (const Vec3& g : tie.gap()) figures().gapMax = std::max(figures().gapMax, norm(g));
  }

  void observe() {
    if (!observer_) return;
    const auto begin = std::chrono::steady_clock::now();
    std::vector<double> fraction;
    for (std::size_t i = 0; i < particles().size(); ++i) fraction.push_back(particles().weightOf(i));
    Frame frame{grains().time,
                nullptr,
                nullptr,
                particles(),
                result_.series,
                &*result_.velocityProfile,
                {},
                {},
                {},
                {{"particles_fraction", fraction}}};
    if (bar_.solid) {
      frame.mesh = &bar_.built.meshes.front();
      frame.nodes = &bar_.solid->nodes();
      frame.nodeScalars = {{"particles_fraction", bar_.tie->overlap().nodalWeight}};
    }
    addLayers(*result_.velocityProfile, settings(), bar_.byPlace, frame);
    observer_(frame);
    figures().wallSeconds -= benchmark::secondsSince(begin);
  }

  std::int64_t steps() { return std::llround(grains().time / dt_); }

  void close() {
    result_.profile = run_.profile;
    RunFigures& f = figures();
    const EnergyLedger& ledger = result_.ledger;
    f.steps = steps();
    f.endTime = grains().time;
    if (f.energyInput == 0.0) f.energyInput = mostInput_;
    const double input = f.energyInput;
    f.energyFinal = ledger.stored();
    f.absorbedFraction = absorbed() / input;
    f.lostFraction = (externalWork() + ledger.storedAtOpening() - f.energyFinal - absorbed()) / input;
    const double storedInCoupling = stored_ ? ledger.channels()[*stored_].joules : 0.0;
    f.couplingWorkFraction = (couplingWork() + storedInCoupling) / input;
    f.ledgerResidual = ledger.largestResidual() / input;
    f.momentumResidual = largestMomentum_ > 0.0 ? largestMomentumGap_ / largestMomentum_ : 0.0;
    f.largestExcess = largestStored_ / mostInput_;
    f.stable = f.finished && f.largestExcess <= stableFactor;
    f.overlapMismatch = speedSquared_ > 0.0 ? std::sqrt(mismatchSquared_ / speedSquared_) : 0.0;
    f.paperDissipatedFraction = settings().impulse() ? dissipatedFraction(result_.energy, settings().particlesPerEdge)
                                                     : std::numeric_limits<double>::quiet_NaN();
    result_.pairs = std::move(grains().pairs);
    result_.particles = std::move(particles());
    if (!bar_.solid) return;
    result_.nodePosition = bar_.solid->nodes().X;
    result_.nodeVelocity = bar_.solid->nodes().v;
  }

  double penalty_;
  Bar bar_;
  coupling::CoupledRun& run_ = bar_.run();
  Observer observer_;
  RunResult result_;
  benchmark::Recorder recorder_{result_};
  const EnergyLedger* ofRun_ = nullptr;
  std::optional<EnergyLedger::Id> stored_;  // of the coupling
  int K_ = 1;
  std::int64_t macroSteps_ = 0;
  double dt_ = 0.0;
  Balance start_;
  double largestMomentum_ = 0.0, largestMomentumGap_ = 0.0, largestStored_ = 0.0, mostInput_ = 0.0;
  double mismatchSquared_ = 0.0, speedSquared_ = 0.0;
};

}  // namespace

benchmark::PreparedRun<RunResult> prepareRun(const Settings& settings) {
  return [runner = std::make_shared<Runner>(settings)](const Observer& observer) { return runner->run(observer); };
}

RunResult run(const Settings& settings, const Observer& observer) { return prepareRun(settings)(observer); }

}  // namespace dovetail::wave
