#include "run.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>
#include <numeric>

#include "dovetail/core/clock.hpp"
#include "dovetail/core/finite.hpp"
#include "dovetail/core/progress.hpp"
#include "dovetail/fem/elements/solid.hpp"
#include "dovetail/io/interruption.hpp"
#include "dovetail/scene/read.hpp"
#include "model.hpp"

namespace dovetail::cantilever {

using benchmark::moment;

namespace {

constexpr double sampleInterval = 1e-3;      // s, energies and contact
constexpr std::int64_t stepsPerSample = 4;   // at least: a sample costs about half a step
constexpr double trajectoryInterval = 5e-3;  // s
constexpr double seriesInterval = 2e-2;      // s

/// Steps that pass between two things that happen every `interval`, in macro steps of `macro step` seconds.
std::int64_t every(double interval, double macroStep) {
  return std::max<std::int64_t>(1, static_cast<std::int64_t>(std::llround(std::min(interval / macroStep, 1e18))));
}

/// Runs one model and gathers its figures.
class Runner {
public:
  explicit Runner(const Settings& settings) : model_(makeModel(settings)) {
    result_.settings = settings;
    run_.profile = Profile(settings.profile);
    if (settings.profile) grains().profile = &run_.profile;
    prepareStep();
    prepareBooks();
    tipNode_ = mesh().nodeSets.at("y+").back();
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
  const fem::SolidMesh& mesh() const { return model_.built.meshes.front(); }
  const fem::Nodes& nodes() const { return model_.beam->nodes(); }
  dem::Model& grains() const { return run_.grains; }

  void prepareStep() {
    const StepLimit limit = criticalStep(settings(), model_);
    figures().criticalDt = limit.dt;
    figures().criticalSetter = limit.owner;
    clock_.dt = figures().dt = chooseStep(settings(), limit);
    requireFeasible(settings(), clock_.dt);
    scene::Scene& scene = model_.scene;
    scene.steps.dt = {clock_.dt, ""};
    scene.output.frames = settings().outputInterval;
    result_.scene = scene::sceneText(scene);
    clock_.substepsPerMacroStep = settings().femEvery;
  }

  void setLedger() {
    ofRun_ = &run_.ledger();
    recorder_.setLedger();
  }

  /// The channels of the run under the names of the case; gravity counts from the particles' height at the start.
  void prepareBooks() {
    const auto of = [this](const char* channel) { return ofRun_->joules(channel); };
    const auto kinetic = recorder_.stored("kinetic, particles", [of] { return of("particles: kinetic"); });
    const auto contacts = recorder_.stored("elastic, contacts", [of] { return of("particles: contacts"); });
    gravity_ =
        recorder_.stored("gravity, particles", [of, this] { return of("particles: gravity") - gravityAtStart_; });
    const auto kineticBeam = recorder_.stored("kinetic, beam", [of] { return of("beam: kinetic"); });
    // A law without a potential stores the work done against it.
    const auto beam =
        recorder_.stored("elastic, beam", [of] { return of("beam: elements") + of("beam: work of elements"); });
    // Explicit solid, stepped every K > 1 DEM steps: the impulses store energy that is booked.
    if (clock_.substepsPerMacroStep > 1 && !settings().implicit() && settings().lag == "none")
      recorder_.booked("time splitting", [of] { return of("beam: time splitting"); });
    const auto dashpots = recorder_.booked("dashpots", [of] { return of("particles: dashpots"); });
    const auto coupling = recorder_.booked("coupling (minus what it made)", [of] {
      return of("grains on beam (skin): lost") + of("staggering error (minus what it made)");
    });

    recorder_.column("time_s", [this] { return clock_.time(); });
    for (const std::size_t i : {0, 1}) {
      recorder_.columns("", std::to_string(i + 1) + "_m", [this, i] { return grains().particles.x[i]; });
      recorder_.columns("v", std::to_string(i + 1) + "_m_per_s", [this, i] { return grains().particles.v[i]; });
    }
    const auto sum = [](const std::vector<double>& masses) {
      return std::accumulate(masses.begin(), masses.end(), 0.0);
    };
    recorder_.column("mass_particles_kg", [this, sum] { return sum(grains().particles.mass); });
    recorder_.column("mass_beam_kg", [this, sum] { return sum(nodes().mass); });
    recorder_.columns("momentum_particles_", "_Ns", [this] { return dem::momentum(grains().particles); });
    recorder_.columns("momentum_beam_", "_Ns", [this] { return fem::momentum(nodes()); });
    recorder_.column("kinetic_particles_J", kinetic);
    recorder_.column("elastic_contacts_J", contacts);
    recorder_.column("gravity_particles_J", gravity_);
    recorder_.column("kinetic_beam_J", kineticBeam);
    recorder_.column("elastic_beam_J", beam);
    recorder_.column("energy_total_J", [this] { return result_.ledger.stored(); });
    recorder_.column("dashpots_J", dashpots);
    recorder_.column("made_by_coupling_J", [this, coupling] { return -result_.ledger.channels()[coupling].joules; });
    recorder_.column("ledger_residual_J", [this] { return result_.ledger.residual(); });
    recorder_.columns("tip_d", "_m", [this] { return nodes().u[static_cast<std::size_t>(tipNode_)]; });
  }

  /// Returns whether it went to the end; if it was interrupted, `failure` says so.
  bool loop() {
    run_.start(clock_.dt,
               {.stepsPerMacroStep = settings().femEvery, .lag = static_cast<coupling::Lag>(model_.scene.steps.lag)});
    gravityAtStart_ = run_.ledger().joules("particles: gravity");
    setLedger();
    result_.ledger.open();
    sampleTrajectory();
    recorder_.addRow();
    observe();

    const double end = settings().until.value_or(longestRun);
    const std::int64_t sampleEvery = std::max(stepsPerSample, every(sampleInterval, clock_.coarseStep()));
    const double sampled = clock_.coarseStep() * static_cast<double>(sampleEvery);
    const std::int64_t trajectoryEvery = every(trajectoryInterval, sampled);
    const std::int64_t seriesEvery = every(seriesInterval, sampled);
    const std::int64_t frameEvery = every(settings().outputInterval, sampled);
    Progress progress("cantilever", 1.0, !settings().quiet);
    bool stops = false;
    for (std::int64_t sample = 1; !done(end) && !stops; ++sample) {
      for (std::int64_t w = 1; w <= sampleEvery && !done(end) && !stops; ++w) {
        stops = io::interruption() != 0;
        // The last step is sampled too.
        advance(w == sampleEvery || stops || clock_.time() + 1.5 * clock_.coarseStep() >= end);
      }
      if (figures().left && !settings().until) break;
      sampleEnergy();
      if (sample % trajectoryEvery == 0) sampleTrajectory();
      if (sample % seriesEvery == 0 || stops) {
        model_.beam->model->terms.front()->requireValid(nodes(), moment(clock_.time(), clock_.step),
                                                        fem::Scrutiny::inversion);
        recorder_.addRow();
        const double y = grains().particles.x[0].y / Case{}.length;
        progress.update(settings().until ? clock_.time() / end : 1.0 - std::sqrt(std::max(0.0, 1.0 - y)),
                        "t = " + formatNumber(std::round(100.0 * clock_.time()) / 100.0) + " s");
      }
      if (sample % frameEvery == 0 || stops) observe();
    }
    sampleTrajectory();
    if (stops && !done(end)) {
      figures().failure = benchmark::interrupted(clock_.time(), clock_.step);
      return false;
    }
    if (!settings().until && !figures().left)
      throw NumericalError("particle 0 has not left the beam", moment(clock_.time(), clock_.step),
                           "look at the trajectory, or give --until");
    return true;
  }

  bool done(double end) const {
    return clock_.time() >= end * (1.0 - 1e-12) || (result_.figures.left && !settings().until);
  }

  void advance(bool withEnergy) {
    const double yBefore = grains().particles.x[0].y;
    run_.advance(1, withEnergy);
    clock_.advanceMacroStep();
    if (figures().left) return;
    if (!model_.contact->coupling().inContact()) stepsWithoutContact_ += clock_.substepsPerMacroStep;
    stepsOnBeam_ += clock_.substepsPerMacroStep;
    const double y = grains().particles.x[0].y, length = Case{}.length;
    if (y <= length) return;
    figures().left = true;
    figures().leaveTime = clock_.time() - clock_.coarseStep() * (y - length) / (y - yBefore);
  }

  void sampleEnergy() {
    dem::requireFinite(grains().particles, moment(clock_.time(), clock_.step));
    requireFinite(nodes().v, "node", "velocity", moment(clock_.time(), clock_.step));
    setLedger();
    if (figures().left) return;
    result_.ledger.close();
    const auto& channels = result_.ledger.channels();
    const double workOfGravity = channels[gravity_].joulesAtOpening - channels[gravity_].joules;
    const double mechanical = result_.ledger.stored() - channels[gravity_].joules;
    const double allowed = result_.ledger.storedAtOpening() + std::max(0.0, workOfGravity);
    figures().largestExcess = std::max(figures().largestExcess, mechanical / allowed);
    const Case beam;
    figures().lateralDrift = std::max({figures().lateralDrift, std::abs(grains().particles.x[0].x - beam.startX),
                                       std::abs(grains().particles.x[1].x + beam.startX)});
    sampleBalance();
  }

  /// Forces and moments of the contacts on particles and nodes together must vanish.
  void sampleBalance() {
    Vec3 force, about;
    double size = 0.0;
    for (std::size_t i = 0; i < grains().particles.size(); ++i) {
      const Vec3 contact = grains().particles.f[i] - grains().particles.mass[i] * grains().gravity;
      force += contact;
      about += cross(grains().particles.x[i], contact);
      size += norm(contact);
    }
    const coupling::NodalLoad& load = model_.beam->load;
    for (int node : load.touched) {
      force += load.force[node];
      about += cross(nodes().X[node] + nodes().u[node], load.force[node]);
    }
    if (size == 0.0) return;
    figures().forceResidual = std::max(figures().forceResidual, norm(force) / size);
    figures().momentResidual = std::max(figures().momentResidual, norm(about) / (size * Case{}.length));
  }

  void sampleTrajectory() {
    result_.samples.push_back({clock_.time(), {grains().particles.x[0], grains().particles.x[1]}});
  }

  void observe() {
    if (!observer_) return;
    const auto begin = std::chrono::steady_clock::now();
    auto& beam = dynamic_cast<fem::Solid&>(*model_.beam->model->terms.front());
    const auto energies = beam.elementEnergies(nodes(), {clock_.time(), 0.0});
    observer_({clock_.time(),
               &mesh(),
               &nodes(),
               grains().particles,
               result_.series,
               nullptr,
               {{"contact_load_N", model_.beam->load.force}},
               {},
               {{"strain_energy_J", energies}},
               {}});
    figures().wallSeconds -= benchmark::secondsSince(begin);
  }

  void close() {
    result_.profile = run_.profile;
    RunFigures& f = figures();
    const EnergyLedger& ledger = result_.ledger;
    f.steps = clock_.step;
    f.endTime = clock_.time();
    f.energyInitial = ledger.storedAtOpening();
    f.energyMin = ledger.storedMin();
    f.energyMax = ledger.storedMax();
    f.energyDrift = ledger.largestDrift() / f.energyInitial;
    f.ledgerResidual = ledger.largestResidual() / f.energyInitial;
    f.noContactFraction =
        stepsOnBeam_ > 0 ? static_cast<double>(stepsWithoutContact_) / static_cast<double>(stepsOnBeam_) : 0.0;
    f.stable = f.finished && f.largestExcess <= 1.5;
    f.lockingFactor = lockingFactor(settings());
  }

  Model model_;
  coupling::CoupledRun& run_ = model_.run();
  Observer observer_;
  RunResult result_;
  Clock clock_;
  benchmark::Recorder recorder_{result_};
  const EnergyLedger* ofRun_ = nullptr;
  EnergyLedger::Id gravity_ = 0;
  double gravityAtStart_ = 0.0;
  int tipNode_ = 0;
  std::int64_t stepsWithoutContact_ = 0, stepsOnBeam_ = 0;
};

}  // namespace

benchmark::PreparedRun<RunResult> prepareRun(const Settings& settings) {
  return [runner = std::make_shared<Runner>(settings)](const Observer& observer) { return runner->run(observer); };
}

RunResult run(const Settings& settings, const Observer& observer) { return prepareRun(settings)(observer); }

}  // namespace dovetail::cantilever
