#include "run.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <memory>

#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"
#include "dovetail/core/parallel.hpp"
#include "dovetail/core/progress.hpp"
#include "step_plan.hpp"

namespace dovetail::wave {

namespace {

constexpr double stableFactor = 1.5;

const std::vector<std::string> seriesNames{"t_s",
                                           "mass_particles_kg",
                                           "mass_solid_kg",
                                           "momentum_particles_y_Ns",
                                           "momentum_solid_y_Ns",
                                           "kinetic_particles_J",
                                           "elastic_contacts_J",
                                           "kinetic_solid_J",
                                           "elastic_solid_J",
                                           "stored_coupling_J",
                                           "energy_total_J",
                                           "coupling_work_J",
                                           "absorbed_J",
                                           "external_work_J",
                                           "ledger_residual_J"};

std::string moment(double time, std::int64_t step) {
  return "t = " + formatNumber(time) + " s, step " + std::to_string(step);
}

double secondsSince(std::chrono::steady_clock::time_point begin) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

class Runner {
public:
  explicit Runner(const Settings& settings) : penalty_(penaltyOf(settings)), model_(makeBar(settings, penalty_)) {
    result_.settings = settings;
    result_.profile = Profile(settings.profile);
    result_.series = io::TimeSeries(seriesNames);
    prepareStep();
    prepareLedger();
    countParts();
  }

  RunResult run(const Observer& observer) {
    observer_ = observer;
    const auto begin = std::chrono::steady_clock::now();
    try {
      loop();
      figures().finished = true;
    } catch (const NumericalError& error) {
      figures().failure = error.what();
    }
    figures().wallSeconds = secondsSince(begin) - observerSeconds_;
    close();
    return std::move(result_);
  }

private:
  RunFigures& figures() { return result_.figures; }
  const Settings& settings() const { return result_.settings; }

  void prepareStep() {
    const Settings& s = settings();
    figures().critical = arlequin::criticalStep(model_);
    const StepPlan plan = planSteps(s, figures().critical);
    K_ = plan.stepsPerWindow;
    windows_ = plan.windows;
    figures().dt = dt_ = plan.dt;
    if (!s.fullDem && s.fem == FemStepper::newmark)
      newmark_ = std::make_unique<fem::ImplicitMotion>(makeNewmark(s, model_));
  }

  void prepareLedger() {
    EnergyLedger& ledger = result_.ledger;
    kineticParticles_ = ledger.addStored("kinetic, particles");
    elasticContacts_ = ledger.addStored("elastic, contacts");
    if (model_.solid) {
      kineticSolid_ = ledger.addStored("kinetic, solid");
      elasticSolid_ = ledger.addStored("elastic, solid");
      stored_ = ledger.addStored("stored in the coupling");
      coupling_ = ledger.addBooked("lost in the coupling");
    }
    if (model_.solid && K_ > 1 && !newmark_) splitting_ = ledger.addStored("time splitting");
    if (settings().absorber > 0.0 && model_.solid) absorbed_ = ledger.addBooked("absorber");
    if (!model_.discrete.terms.empty()) external_ = ledger.addBooked("drive (minus its work)");
  }

  void countParts() {
    RunFigures& f = figures();
    f.particles = model_.discrete.particles.size();
    double mass = 0.0;
    for (const double m : model_.discrete.particles.mass) mass += m;
    if (settings().fullDem) {  // without the wall
      f.particles -= static_cast<std::size_t>(particlesPerLayer(settings()));
      mass -= particlesPerLayer(settings()) * particleMass(settings());
    }
    if (model_.solid) {
      f.elements = model_.solid->mesh.elementCount();
      f.overlapParticles = model_.coupling->overlap.size();
      f.coupledNodes = model_.coupling->rows();
      for (const double m : model_.solid->nodes().mass) mass += m;
      f.penalty = penalty_;
    }
    const double side = Case{}.side, exact = bulkDensity() * side * side * barLength(settings());
    f.massResidual = std::abs(mass - exact) / exact;
  }

  void step(bool withEnergy) {
    if (!newmark_)
      arlequin::stepExplicit(model_, dt_, K_, sums_, withEnergy, result_.profile);
    else if (settings().staggered)
      arlequin::stepStaggered(model_, *newmark_, dt_, sums_, withEnergy, result_.profile);
    else
      arlequin::stepImplicit(model_, *newmark_, dt_, K_, sums_, withEnergy, result_.profile);
  }

  void setLedger() {
    EnergyLedger& ledger = result_.ledger;
    const arlequin::Energies e = arlequin::energies(model_, newmark_.get());
    ledger.set(kineticParticles_, e.kineticParticles);
    ledger.set(elasticContacts_, e.elasticContacts);
    if (model_.solid) {
      ledger.set(kineticSolid_, e.kineticSolid);
      ledger.set(elasticSolid_, e.elasticSolid);
      ledger.set(stored_, e.coupling);
      ledger.set(coupling_, -sums_.couplingWork - e.coupling);
    }
    if (splitting_) ledger.set(*splitting_, e.splitting);
    if (absorbed_) ledger.set(*absorbed_, sums_.absorbed);
    if (external_) ledger.set(*external_, -sums_.externalWork);
  }

  void loop() {
    arlequin::start(model_, K_ * dt_, result_.profile);
    setLedger();
    result_.ledger.open();
    momentumStart_ = arlequin::momentum(model_);
    const std::int64_t sampleEvery = std::clamp<std::int64_t>(windows_ / 2000, 8 / std::min(8, K_), 1000);
    const double end = endTime(settings());
    const std::int64_t frameEvery = std::max<std::int64_t>(
        1, std::llround(settings().outputInterval / (K_ * dt_ * static_cast<double>(sampleEvery))));
    Progress progress(settings().fullDem ? "particles alone" : "wave", 1.0, !settings().quiet);
    sample();
    observe();
    for (std::int64_t w = 1, samples = 0; w <= windows_; ++w) {
      const bool now = w % sampleEvery == 0 || w == windows_;
      step(now);
      if (!now) continue;
      sample();
      if (++samples % frameEvery == 0 || w == windows_) observe();
      progress.update(model_.discrete.time / end,
                      "t = " + formatNumber(std::round(1e5 * model_.discrete.time) / 1e5) + " s");
    }
  }

  void sample() {
    arlequin::requireFinite(model_, moment(model_.discrete.time, steps()));
    setLedger();
    result_.ledger.close();
    const double booked = sums_.externalWork + result_.ledger.storedAtOpening();
    largestStored_ = std::max(largestStored_, result_.ledger.stored());
    mostInput_ = std::max(mostInput_, booked);
    if (model_.discrete.time >= driveTime(settings()) * (1.0 - 1e-12) && figures().energyInput == 0.0)
      figures().energyInput = booked;
    const Vec3 momentum = arlequin::momentum(model_);
    largestMomentum_ = std::max(largestMomentum_, norm(momentum));
    largestMomentumGap_ =
        std::max(largestMomentumGap_, norm(momentum - momentumStart_ - sums_.supportImpulse + sums_.handedMomentum));
    if (model_.coupling) sampleGap();
    double stored = result_.ledger.stored();
    if (model_.solid) stored -= result_.ledger.channels()[stored_].joules;
    result_.energy.push_back({model_.discrete.time, stored});
    sampleSeries();
  }

  void sampleGap() {
    const arlequin::Coupling& c = *model_.coupling;
    std::vector<Vec3> rate(c.rows());
    arlequin::gapOf(c.gap, c.overlap, model_.discrete.particles.v, model_.solid->nodes().v, rate);
    double mismatch = 0.0, speed = 0.0;
    for (const Vec3& v : rate) mismatch += squaredNorm(v);
    for (const int i : c.overlap.particle)
      speed += squaredNorm(model_.discrete.particles.v[static_cast<std::size_t>(i)]);
    mismatchSquared_ += mismatch / static_cast<double>(c.rows());
    speedSquared_ += speed / static_cast<double>(c.overlap.size());
    for (const Vec3& g : c.gapNow) figures().gapMax = std::max(figures().gapMax, norm(g));
  }

  void sampleSeries() {
    double massParticles = 0.0, massSolid = 0.0, momentumSolid = 0.0;
    for (const double m : model_.discrete.particles.mass) massParticles += m;
    if (model_.solid) {
      for (const double m : model_.solid->nodes().mass) massSolid += m;
      momentumSolid = fem::momentum(model_.solid->nodes()).y;
    }
    const auto& channels = result_.ledger.channels();
    const auto joules = [&](EnergyLedger::Id id) { return model_.solid ? channels[id].joules : 0.0; };
    result_.series.append(
        std::vector<double>{model_.discrete.time, massParticles, massSolid, dem::momentum(model_.discrete.particles).y,
                            momentumSolid, channels[kineticParticles_].joules, channels[elasticContacts_].joules,
                            joules(kineticSolid_), joules(elasticSolid_), joules(stored_), result_.ledger.stored(),
                            sums_.couplingWork, sums_.absorbed, sums_.externalWork, result_.ledger.residual()});
  }

  void observe() {
    if (!observer_) return;
    const auto begin = std::chrono::steady_clock::now();
    observer_({model_.discrete.time, model_});
    observerSeconds_ += secondsSince(begin);
  }

  std::int64_t steps() const { return std::llround(model_.discrete.time / dt_); }

  void close() {
    RunFigures& f = figures();
    const EnergyLedger& ledger = result_.ledger;
    f.steps = steps();
    f.endTime = model_.discrete.time;
    if (f.energyInput == 0.0) f.energyInput = mostInput_;
    const double input = f.energyInput;
    f.energyFinal = ledger.stored();
    f.absorbedShare = sums_.absorbed / input;
    f.lostShare = (sums_.externalWork + ledger.storedAtOpening() - f.energyFinal - sums_.absorbed) / input;
    const double storedInCoupling = model_.coupling ? ledger.channels()[stored_].joules : 0.0;
    f.couplingWorkShare = (sums_.couplingWork + storedInCoupling) / input;
    f.ledgerResidual = ledger.largestResidual() / input;
    f.momentumResidual = largestMomentum_ > 0.0 ? largestMomentumGap_ / largestMomentum_ : 0.0;
    f.largestExcess = largestStored_ / mostInput_;
    f.stable = f.finished && f.largestExcess <= stableFactor;
    f.overlapMismatch = speedSquared_ > 0.0 ? std::sqrt(mismatchSquared_ / speedSquared_) : 0.0;
    f.paperDissipatedShare = settings().signal == Signal::impulse
                                 ? dissipatedShare(result_.energy, settings().particlesPerEdge)
                                 : std::numeric_limits<double>::quiet_NaN();
    result_.pairs = std::move(model_.discrete.pairs);
    result_.particles = std::move(model_.discrete.particles);
    if (!model_.solid) return;
    result_.nodePosition = model_.solid->nodes().X;
    result_.nodeVelocity = model_.solid->nodes().v;
  }

  double penalty_;
  arlequin::Model model_;
  Observer observer_;
  RunResult result_;
  arlequin::StepSums sums_;
  std::unique_ptr<fem::ImplicitMotion> newmark_;
  EnergyLedger::Id kineticParticles_ = 0, elasticContacts_ = 0, kineticSolid_ = 0, elasticSolid_ = 0, stored_ = 0,
                   coupling_ = 0;
  std::optional<EnergyLedger::Id> splitting_, absorbed_, external_;
  int K_ = 1;
  std::int64_t windows_ = 0;
  double dt_ = 0.0;
  Vec3 momentumStart_;
  double largestMomentum_ = 0.0, largestMomentumGap_ = 0.0, largestStored_ = 0.0, mostInput_ = 0.0;
  double mismatchSquared_ = 0.0, speedSquared_ = 0.0, observerSeconds_ = 0.0;
};

}  // namespace

PreparedRun prepareRun(const Settings& settings) {
  validate(settings);
  setThreads(settings.threads);
  const auto runner = std::make_shared<Runner>(settings);
  return [runner](const Observer& observer) { return runner->run(observer); };
}

RunResult run(const Settings& settings, const Observer& observer) { return prepareRun(settings)(observer); }

}  // namespace dovetail::wave
