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
  Runner(const Settings& settings, const fem::SolidMesh& mesh) : mesh_(mesh), model_(makeModel(settings, mesh)) {
    result_.settings = settings;
    result_.profile = Profile(settings.profile);
    result_.series = io::TimeSeries(seriesNames);
    prepareStep();
    prepareLedger();
    tipNode_ = mesh_.nodeSets.at("y+").back();
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
    figures().wallSeconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    close();
    return std::move(result_);
  }

private:
  RunFigures& figures() { return result_.figures; }
  const Settings& settings() const { return result_.settings; }
  const fem::Nodes& nodes() const { return model_.solid->nodes; }

  void prepareStep() {
    const StepLimit limit = criticalStep(settings(), *model_.solid, largestMobility(model_.seam, nodes()));
    figures().criticalDt = limit.dt;
    figures().criticalSetter = limit.setter;
    clock_.dt = figures().dt = chooseStep(settings(), limit);
    requireFeasible(settings(), clock_.dt);
    clock_.substepsPerWindow = settings().femEvery;
    scheme_.booksCoupling = couplingIsUnbalanced(settings());
    scheme_.skinLags = settings().lag == Lag::loadAndSkin;
    if (settings().fem == FemStepper::newmark) {
      fem::ImplicitOptions options{.scheme = fem::newmark(), .relativeTolerance = 1e-10};
      options.massShare = settings().mass == MassMatrix::consistent ? 1.0 : 0.0;
      newmark_ = std::make_unique<fem::ImplicitMotion>(*model_.solid, options);
    }
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
  bool multirate() const { return clock_.substepsPerWindow > 1 && !newmark_ && settings().lag == Lag::none; }

  double kineticBeam() const { return newmark_ ? newmark_->kineticEnergy() : fem::kineticEnergy(nodes()); }

  void setLedger() {
    EnergyLedger& ledger = result_.ledger;
    double height = 0.0;
    for (std::size_t i = 0; i < model_.discrete.particles.size(); ++i)
      height += model_.discrete.particles.mass[i] * (model_.discrete.particles.x[i].z - startZ_);
    ledger.set(kineticParticles_, dem::kineticEnergy(model_.discrete.particles));
    ledger.set(elasticContacts_, model_.contact.storedEnergy());
    ledger.set(gravity_, -model_.discrete.gravity.z * height);
    ledger.set(kineticBeam_, kineticBeam());
    ledger.set(elasticBeam_, model_.strainEnergy);
    if (multirate()) ledger.set(splitting_, surface::splittingEnergy(nodes(), model_.seam.load(), clock_.coarseStep()));
  }

  surface::WindowSums stepWindow(bool withEnergy) {
    const int K = clock_.substepsPerWindow;
    if (settings().lag != Lag::none)
      return surface::stepStaggered(model_, newmark_.get(), clock_.dt, K, scheme_, withEnergy, result_.profile);
    if (newmark_) return surface::stepImplicit(model_, *newmark_, clock_.dt, K, scheme_, withEnergy, result_.profile);
    return surface::stepExplicit(model_, clock_.dt, K, scheme_, withEnergy, result_.profile);
  }

  void loop() {
    startZ_ = model_.discrete.particles.x[0].z;
    surface::start(model_, clock_.dt, result_.profile);
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
    for (std::int64_t sample = 1; !done(end); ++sample) {
      for (std::int64_t w = 1; w <= sampleEvery && !done(end); ++w)
        advance(w == sampleEvery || clock_.time() + 1.5 * clock_.coarseStep() >= end);  // the last step is sampled too
      if (figures().left && !settings().until) break;
      sampleEnergy();
      if (sample % trajectoryEvery == 0) sampleTrajectory();
      if (sample % seriesEvery == 0) {
        model_.solid->terms.front()->requireValid(nodes(), moment(clock_.time(), clock_.step),
                                                  fem::Scrutiny::inversion);
        sampleSeries();
        const double y = model_.discrete.particles.x[0].y / Case{}.length;
        progress.update(settings().until ? clock_.time() / end : 1.0 - std::sqrt(std::max(0.0, 1.0 - y)),
                        "t = " + formatNumber(std::round(100.0 * clock_.time()) / 100.0) + " s");
      }
      if (observer_ && sample % frameEvery == 0) observe();
    }
    sampleTrajectory();
    if (!settings().until && !figures().left)
      throw NumericalError("particle 0 has not left the beam", moment(clock_.time(), clock_.step),
                           "look at the trajectory, or give --until");
  }

  bool done(double end) const {
    return clock_.time() >= end * (1.0 - 1e-12) || (result_.figures.left && !settings().until);
  }

  void advance(bool withEnergy) {
    const double yBefore = model_.discrete.particles.x[0].y;
    const surface::WindowSums sums = stepWindow(withEnergy);
    result_.ledger.add(dashpots_, sums.dissipated);
    result_.ledger.add(coupling_, -sums.madeByCoupling);
    clock_.advanceWindow();
    if (figures().left) return;
    stepsWithoutContact_ += sums.stepsWithoutContact;
    stepsOnBeam_ += clock_.substepsPerWindow;
    const double y = model_.discrete.particles.x[0].y, length = Case{}.length;
    if (y <= length) return;
    figures().left = true;
    figures().leaveTime = clock_.time() - clock_.coarseStep() * (y - length) / (y - yBefore);
  }

  void sampleEnergy() {
    dem::requireFinite(model_.discrete.particles, moment(clock_.time(), clock_.step));
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
    figures().lateralDrift = std::max({figures().lateralDrift, std::abs(model_.discrete.particles.x[0].x - beam.startX),
                                       std::abs(model_.discrete.particles.x[1].x + beam.startX)});
    sampleBalance();
  }

  /// Forces and moments of the contacts on particles and nodes together must vanish.
  void sampleBalance() {
    Vec3 force, about;
    double size = 0.0;
    for (std::size_t i = 0; i < model_.discrete.particles.size(); ++i) {
      const Vec3 contact = model_.discrete.particles.f[i] - model_.discrete.particles.mass[i] * model_.discrete.gravity;
      force += contact;
      about += cross(model_.discrete.particles.x[i], contact);
      size += norm(contact);
    }
    const coupling::NodalLoad& load = model_.seam.load();
    for (int node : load.touched) {
      force += load.force[node];
      about += cross(nodes().X[node] + nodes().u[node], load.force[node]);
    }
    if (size == 0.0) return;
    figures().forceResidual = std::max(figures().forceResidual, norm(force) / size);
    figures().momentResidual = std::max(figures().momentResidual, norm(about) / (size * Case{}.length));
  }

  void sampleTrajectory() {
    result_.samples.push_back({clock_.time(), {model_.discrete.particles.x[0], model_.discrete.particles.x[1]}});
  }

  void sampleSeries() {
    std::vector<double> row{clock_.time()};
    const auto push = [&](const Vec3& value) { row.insert(row.end(), {value.x, value.y, value.z}); };
    for (int i = 0; i < 2; ++i) {
      push(model_.discrete.particles.x[i]);
      push(model_.discrete.particles.v[i]);
    }
    double massParticles = 0.0, massBeam = 0.0;
    for (double mass : model_.discrete.particles.mass) massParticles += mass;
    for (double mass : nodes().mass) massBeam += mass;
    row.insert(row.end(), {massParticles, massBeam});
    push(dem::momentum(model_.discrete.particles));
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
    auto& beam = dynamic_cast<fem::Solid&>(*model_.solid->terms.front());
    const auto energies = beam.elementEnergies(nodes(), {clock_.time(), 0.0});
    observer_({clock_.time(), mesh_, nodes(), model_.discrete.particles, model_.seam.load().force, energies});
  }

  void close() {
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
  surface::CoupledModel model_;
  Observer observer_;
  RunResult result_;
  Clock clock_;
  surface::Scheme scheme_;
  std::unique_ptr<fem::ImplicitMotion> newmark_;
  EnergyLedger::Id kineticParticles_, elasticContacts_, gravity_, kineticBeam_, elasticBeam_, splitting_ = 0, dashpots_,
                                                                                              coupling_;
  double startZ_ = 0.0;
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
