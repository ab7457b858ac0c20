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
#include "dovetail/dem/model/loads.hpp"
#include "dovetail/io/interruption.hpp"
#include "step_plan.hpp"

namespace dovetail::wave {

namespace {

constexpr double stableFactor = 1.5;

const std::vector<std::string> seriesNames{"time_s",
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
  explicit Runner(const Settings& settings) : penalty_(penaltyOf(settings)), bar_(makeBar(settings, penalty_)) {
    result_.settings = settings;
    bar_.run->profile = Profile(settings.profile);
    if (settings.profile) grains().profile = &bar_.run->profile;
    result_.series = io::TimeSeries(seriesNames);
    prepareStep();
    prepareLedger();
    countParts();
  }

  RunResult run(const Observer& observer) {
    observer_ = observer;
    const auto begin = std::chrono::steady_clock::now();
    try {
      figures().finished = loop();
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
  dem::Model& grains() { return bar_.run->grains; }
  const dem::Particles& particles() { return grains().particles; }
  bool splits() const { return bar_.solid && K_ > 1 && settings().fem == FemStepper::explicitDifferences; }

  void prepareStep() {
    const Settings& s = settings();
    figures().critical = criticalStep(s, bar_);
    const StepPlan plan = planSteps(s, figures().critical);
    K_ = plan.stepsPerWindow;
    windows_ = plan.windows;
    figures().dt = dt_ = plan.dt;
  }

  void prepareLedger() {
    EnergyLedger& ledger = result_.ledger;
    kineticParticles_ = ledger.addStored("kinetic, particles");
    elasticContacts_ = ledger.addStored("elastic, contacts");
    if (bar_.solid) {
      kineticSolid_ = ledger.addStored("kinetic, solid");
      elasticSolid_ = ledger.addStored("elastic, solid");
      stored_ = ledger.addStored("stored in the coupling");
      coupling_ = ledger.addBooked("lost in the coupling");
    }
    if (splits()) splitting_ = ledger.addStored("time splitting");
    if (settings().absorber > 0.0 && bar_.solid) absorbed_ = ledger.addBooked("absorber");
    if (!grains().terms.all<dem::DriveTerm>().empty()) external_ = ledger.addBooked("drive (minus its work)");
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
      f.elements = bar_.mesh.elementCount();
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
    Balance sum{dem::momentum(particles()), -bar_.run->totals().ontoSolids};
    for (const auto* drive : grains().terms.all<dem::DriveTerm>()) sum.given += drive->supportImpulse;
    return sum;
  }

  /// The channels of the run under the names of the case.
  void setLedger() {
    const EnergyLedger& run = bar_.run->ledger();
    EnergyLedger& ledger = result_.ledger;
    ledger.set(kineticParticles_, run.joules("particles: kinetic"));
    ledger.set(elasticContacts_, run.joules("particles: contacts"));
    if (bar_.solid) {
      ledger.set(kineticSolid_, run.joules("solid: kinetic"));
      ledger.set(elasticSolid_, run.joules("solid: elastic"));
      ledger.set(stored_, bar_.tie->stored());
      ledger.set(coupling_, bar_.tie->lost() - bar_.tie->absorbed());
    }
    if (splitting_) ledger.set(*splitting_, run.joules("solid: time splitting"));
    if (absorbed_) ledger.set(*absorbed_, absorbed());
    if (external_) ledger.set(*external_, -externalWork());
  }

  /// Returns whether it went to the end; if it was interrupted, `failure` says so.
  bool loop() {
    bar_.run->start(dt_, {.stepsPerWindow = K_});
    if (bar_.tie) figures().coupledNodes = bar_.tie->operators().rows();
    setLedger();
    result_.ledger.open();
    start_ = balance();
    const std::int64_t sampleEvery = std::clamp<std::int64_t>(windows_ / 2000, 8 / std::min(8, K_), 1000);
    const double end = endTime(settings());
    const std::int64_t frameEvery = std::max<std::int64_t>(
        1, std::llround(settings().outputInterval / (K_ * dt_ * static_cast<double>(sampleEvery))));
    Progress progress(settings().fullDem ? "particles alone" : "wave", 1.0, !settings().quiet);
    sample();
    observe();
    for (std::int64_t w = 1, samples = 0; w <= windows_; ++w) {
      const bool ends = w == windows_ || io::interruption() != 0, now = w % sampleEvery == 0 || ends;
      bar_.run->step(now);
      if (!now) continue;
      sample();
      if (++samples % frameEvery == 0 || ends) observe();
      progress.update(grains().time / end, "t = " + formatNumber(std::round(1e5 * grains().time) / 1e5) + " s");
      if (ends && w < windows_) {
        figures().failure = Error(io::nameOfInterruption(), moment(grains().time, steps()), "run it again").what();
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
    largestMomentum_ = std::max(largestMomentum_, norm(bar_.run->totals().momentum));
    largestMomentumGap_ =
        std::max(largestMomentumGap_, norm(now.momentum - start_.momentum - (now.given - start_.given)));
    if (bar_.tie) sampleGap();
    double stored = result_.ledger.stored();
    if (bar_.solid) stored -= result_.ledger.channels()[stored_].joules;
    result_.energy.push_back({grains().time, stored});
    sampleSeries();
  }

  void sampleGap() {
    const arlequin::OverlapTie& tie = *bar_.tie;
    std::vector<Vec3> rate(tie.operators().rows());
    arlequin::gapOf(tie.operators(), tie.overlap(), particles().v, bar_.solid->nodes().v, rate);
    double mismatch = 0.0, speed = 0.0;
    for (const Vec3& v : rate) mismatch += squaredNorm(v);
    for (const int i : tie.overlap().particle) speed += squaredNorm(particles().v[static_cast<std::size_t>(i)]);
    mismatchSquared_ += mismatch / static_cast<double>(rate.size());
    speedSquared_ += speed / static_cast<double>(tie.overlap().size());
    for (const Vec3& g : tie.gap()) figures().gapMax = std::max(figures().gapMax, norm(g));
  }

  void sampleSeries() {
    double massSolid = 0.0, momentumSolid = 0.0;
    if (bar_.solid) {
      for (const double m : bar_.solid->nodes().mass) massSolid += m;
      momentumSolid = fem::momentum(bar_.solid->nodes()).y;
    }
    const auto& channels = result_.ledger.channels();
    const auto joules = [&](EnergyLedger::Id id) { return bar_.solid ? channels[id].joules : 0.0; };
    result_.series.append(std::vector<double>{grains().time, massOfParticles(), massSolid, dem::momentum(particles()).y,
                                              momentumSolid, channels[kineticParticles_].joules,
                                              channels[elasticContacts_].joules, joules(kineticSolid_),
                                              joules(elasticSolid_), joules(stored_), result_.ledger.stored(),
                                              couplingWork(), absorbed(), externalWork(), result_.ledger.residual()});
  }

  void observe() {
    if (!observer_) return;
    const auto begin = std::chrono::steady_clock::now();
    observer_({grains().time, bar_, result_.series});
    observerSeconds_ += secondsSince(begin);
  }

  std::int64_t steps() { return std::llround(grains().time / dt_); }

  void close() {
    result_.profile = bar_.run->profile;
    RunFigures& f = figures();
    const EnergyLedger& ledger = result_.ledger;
    f.steps = steps();
    f.endTime = grains().time;
    if (f.energyInput == 0.0) f.energyInput = mostInput_;
    const double input = f.energyInput;
    f.energyFinal = ledger.stored();
    f.absorbedShare = absorbed() / input;
    f.lostShare = (externalWork() + ledger.storedAtOpening() - f.energyFinal - absorbed()) / input;
    const double storedInCoupling = bar_.tie ? ledger.channels()[stored_].joules : 0.0;
    f.couplingWorkShare = (couplingWork() + storedInCoupling) / input;
    f.ledgerResidual = ledger.largestResidual() / input;
    f.momentumResidual = largestMomentum_ > 0.0 ? largestMomentumGap_ / largestMomentum_ : 0.0;
    f.largestExcess = largestStored_ / mostInput_;
    f.stable = f.finished && f.largestExcess <= stableFactor;
    f.overlapMismatch = speedSquared_ > 0.0 ? std::sqrt(mismatchSquared_ / speedSquared_) : 0.0;
    f.paperDissipatedShare = settings().signal == Signal::impulse
                                 ? dissipatedShare(result_.energy, settings().particlesPerEdge)
                                 : std::numeric_limits<double>::quiet_NaN();
    result_.pairs = std::move(grains().pairs);
    result_.particles = std::move(particles());
    if (!bar_.solid) return;
    result_.nodePosition = bar_.solid->nodes().X;
    result_.nodeVelocity = bar_.solid->nodes().v;
  }

  double penalty_;
  Bar bar_;
  Observer observer_;
  RunResult result_;
  EnergyLedger::Id kineticParticles_ = 0, elasticContacts_ = 0, kineticSolid_ = 0, elasticSolid_ = 0, stored_ = 0,
                   coupling_ = 0;
  std::optional<EnergyLedger::Id> splitting_, absorbed_, external_;
  int K_ = 1;
  std::int64_t windows_ = 0;
  double dt_ = 0.0;
  Balance start_;
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
