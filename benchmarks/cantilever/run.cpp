#include "run.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>

#include "dovetail/core/clock.hpp"
#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"
#include "dovetail/core/parallel.hpp"
#include "dovetail/core/progress.hpp"
#include "dovetail/fem/elements/solid.hpp"
#include "dovetail/io/interruption.hpp"
#include "model.hpp"
#include "series_names.hpp"

namespace dovetail::cantilever {

namespace {

constexpr double sampleInterval = 1e-3;      // s, energies and contact
constexpr std::int64_t stepsPerSample = 4;   // at least: a sample costs about half a step
constexpr double trajectoryInterval = 5e-3;  // s
constexpr double seriesInterval = 2e-2;      // s

/// Steps that pass between two things that happen every `interval`, in windows of `window` seconds.
std::int64_t every(double interval, double window) {
  return std::max<std::int64_t>(1, static_cast<std::int64_t>(std::llround(std::min(interval / window, 1e18))));
}

std::string moment(double time, std::int64_t step) {
  return "t = " + formatNumber(time) + " s, step " + std::to_string(step);
}

/// Runs one model and gathers its figures.
class Runner {
public:
  Runner(const Settings& settings, const fem::SolidMesh& mesh) : mesh_(mesh), scene_(makeScene(settings, mesh)) {
    result_.settings = settings;
    scene_.run->profile = Profile(settings.profile);
    if (settings.profile) grains().profile = &scene_.run->profile;
    result_.series = io::TimeSeries(seriesNames);
    prepareStep();
    prepareLedger();
    tipNode_ = mesh_.nodeSets.at("y+").back();
  }

  RunResult run(const Observer& observer) {
    observer_ = observer;
    const auto begin = std::chrono::steady_clock::now();
    try {
      figures().finished = loop();
    } catch (const NumericalError& error) {
      figures().failure = error.what();
    }
    figures().wallSeconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    close();
    return std::move(result_);
  }

private:
  RunFigures& figures() { return result_.figures; }
  const Settings& settings() const { return result_.settings; }
  const fem::Nodes& nodes() const { return scene_.beam->nodes(); }
  dem::Model& grains() const { return scene_.run->grains; }

  void prepareStep() {
    const StepLimit limit = criticalStep(settings(), *scene_.beam->model, largestMobility(scene_));
    figures().criticalDt = limit.dt;
    figures().criticalSetter = limit.setter;
    clock_.dt = figures().dt = chooseStep(settings(), limit);
    requireFeasible(settings(), clock_.dt);
    clock_.substepsPerWindow = settings().femEvery;
  }

  void prepareLedger() {
    EnergyLedger& ledger = result_.ledger;
    kineticParticles_ = ledger.addStored("kinetic, particles");
    elasticContacts_ = ledger.addStored("elastic, contacts");
    gravity_ = ledger.addStored("gravity, particles");
    kineticBeam_ = ledger.addStored("kinetic, beam");
    elasticBeam_ = ledger.addStored("elastic, beam");
    if (multirate()) splitting_ = ledger.addBooked("time splitting");
    dashpots_ = ledger.addBooked("dashpots");
    coupling_ = ledger.addBooked("coupling (minus what it made)");
  }

  /// Explicit solid, stepped every K > 1 DEM steps: the impulses store energy that is booked.
  bool multirate() const {
    return clock_.substepsPerWindow > 1 && settings().fem == FemStepper::explicitDifferences &&
           settings().lag == Lag::none;
  }

  /// The channels of the run under the names of the case; gravity counts from the particles' height at the start.
  void setLedger() {
    const EnergyLedger& run = scene_.run->ledger();
    EnergyLedger& ledger = result_.ledger;
    ledger.set(kineticParticles_, run.joules("particles: kinetic"));
    ledger.set(elasticContacts_, run.joules("particles: contacts"));
    ledger.set(gravity_, run.joules("particles: gravity") - gravityAtStart_);
    ledger.set(kineticBeam_, run.joules("beam: kinetic"));
    // A law without a potential stores the work done against it.
    ledger.set(elasticBeam_, run.joules("beam: beam") + run.joules("beam: work of beam"));
    if (multirate()) ledger.set(splitting_, run.joules("beam: time splitting"));
    ledger.set(dashpots_, run.joules("particles: dashpots"));
    ledger.set(coupling_,
               run.joules("contacts on the beam: lost") + run.joules("loads one step old (minus what they made)"));
  }

  /// Returns whether it went to the end; if it was interrupted, `failure` says so.
  bool loop() {
    scene_.run->start(clock_.dt, {.stepsPerWindow = settings().femEvery, .lag = settings().lag});
    gravityAtStart_ = scene_.run->ledger().joules("particles: gravity");
    setLedger();
    result_.ledger.open();
    sampleTrajectory();
    sampleSeries();
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
        scene_.beam->model->terms.front()->requireValid(nodes(), moment(clock_.time(), clock_.step),
                                                        fem::Scrutiny::inversion);
        sampleSeries();
        const double y = grains().particles.x[0].y / Case{}.length;
        progress.update(settings().until ? clock_.time() / end : 1.0 - std::sqrt(std::max(0.0, 1.0 - y)),
                        "t = " + formatNumber(std::round(100.0 * clock_.time()) / 100.0) + " s");
      }
      if (sample % frameEvery == 0 || stops) observe();
    }
    sampleTrajectory();
    if (stops && !done(end)) {
      figures().failure = Error(io::nameOfInterruption(), moment(clock_.time(), clock_.step), "run it again").what();
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
    scene_.run->step(withEnergy);
    clock_.advanceWindow();
    if (figures().left) return;
    if (!scene_.contact->coupling().inContact()) stepsWithoutContact_ += clock_.substepsPerWindow;
    stepsOnBeam_ += clock_.substepsPerWindow;
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
    const coupling::NodalLoad& load = scene_.beam->load;
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

  void sampleSeries() {
    std::vector<double> row{clock_.time()};
    const auto push = [&](const Vec3& value) { row.insert(row.end(), {value.x, value.y, value.z}); };
    for (int i = 0; i < 2; ++i) {
      push(grains().particles.x[i]);
      push(grains().particles.v[i]);
    }
    double massParticles = 0.0, massBeam = 0.0;
    for (double mass : grains().particles.mass) massParticles += mass;
    for (double mass : nodes().mass) massBeam += mass;
    row.insert(row.end(), {massParticles, massBeam});
    push(dem::momentum(grains().particles));
    push(fem::momentum(nodes()));
    const auto& channels = result_.ledger.channels();
    for (EnergyLedger::Id id : {kineticParticles_, elasticContacts_, gravity_, kineticBeam_, elasticBeam_})
      row.push_back(channels[id].joules);
    row.push_back(result_.ledger.stored());
    row.push_back(channels[dashpots_].joules);
    row.push_back(-channels[coupling_].joules);
    row.push_back(result_.ledger.residual());
    push(nodes().u[tipNode_]);
    result_.series.append(row);
  }

  void observe() {
    if (!observer_) return;
    auto& beam = dynamic_cast<fem::Solid&>(*scene_.beam->model->terms.front());
    const auto energies = beam.elementEnergies(nodes(), {clock_.time(), 0.0});
    observer_({clock_.time(), mesh_, nodes(), grains().particles, scene_.beam->load.force, energies, result_.series});
  }

  void close() {
    result_.profile = scene_.run->profile;
    RunFigures& f = figures();
    const EnergyLedger& ledger = result_.ledger;
    f.steps = clock_.step;
    f.endTime = clock_.time();
    f.energyInitial = ledger.storedAtOpening();
    f.energyMin = ledger.storedMin();
    f.energyMax = ledger.storedMax();
    f.energyDrift = ledger.largestDrift() / f.energyInitial;
    f.ledgerResidual = ledger.largestResidual() / f.energyInitial;
    f.noContactShare =
        stepsOnBeam_ > 0 ? static_cast<double>(stepsWithoutContact_) / static_cast<double>(stepsOnBeam_) : 0.0;
    f.stable = f.finished && f.largestExcess <= 1.5;
    f.lockingFactor = lockingFactor(settings());
  }

  const fem::SolidMesh& mesh_;
  Scene scene_;
  Observer observer_;
  RunResult result_;
  Clock clock_;
  EnergyLedger::Id kineticParticles_, elasticContacts_, gravity_, kineticBeam_, elasticBeam_, splitting_ = 0, dashpots_,
                                                                                              coupling_;
  double gravityAtStart_ = 0.0;
  int tipNode_ = 0;
  std::int64_t stepsWithoutContact_ = 0, stepsOnBeam_ = 0;
};

}  // namespace

PreparedRun prepareRun(const Settings& settings) {
  validate(settings);
  setThreads(settings.threads);
  const auto mesh = std::make_shared<const fem::SolidMesh>(makeMesh(settings));
  const auto runner = std::make_shared<Runner>(settings, *mesh);
  return [mesh, runner](const Observer& observer) { return runner->run(observer); };
}

RunResult run(const Settings& settings, const Observer& observer) { return prepareRun(settings)(observer); }

}  // namespace dovetail::cantilever
