#include "dovetail/scene/execute.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <ostream>
#include <utility>

#include "build/parts.hpp"
#include "checkpoints.hpp"
#include "dovetail/core/error.hpp"
#include "dovetail/core/failure.hpp"
#include "dovetail/core/finite.hpp"
#include "dovetail/core/parallel.hpp"
#include "dovetail/core/progress.hpp"
#include "dovetail/core/stopwatch.hpp"
#include "dovetail/core/team.hpp"
#include "dovetail/io/interruption.hpp"
#include "dovetail/io/output_folder.hpp"
#include "dovetail/scene/read.hpp"
#include "frames.hpp"
#include "lengthening.hpp"
#include "modes.hpp"
#include "plan.hpp"
#include "run_files.hpp"
#include "series.hpp"
#include "summary.hpp"
#include "warnings/warnings.hpp"

namespace dovetail::scene {

namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

constexpr std::int64_t lookEvery = 20;             // macro steps between two looks at signals
constexpr std::int64_t arcsPerLoadStep = 200;      // of a path of equilibria, at most
constexpr std::int64_t deepEvery = 5 * lookEvery;  // at contacts: a look costs as much as half a step

/// Of a team all ranks, whichever of them a signal has asked.
bool stopsNow() {
  const int signal = static_cast<int>(team().largest(io::interruption()));
  if (signal != 0) io::noteInterruption(signal);
  return signal != 0;
}

double since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

/// A run under way with its files.
class Execution {
public:
  Execution(Scene scene, const RunOptions& settings, std::ostream& log, bool goesOn)
      : scene_(std::move(scene)),
        settings_(settings),
        log_(log),
        identity_(identityOf(scene_)),
        trial_(settings.folder),
        lock_(io::prepareOutputFolder(settings.folder, fileNames(scene_, goesOn)), trial_),
        built_(build(scene_, settings.onRanks)),
        provenance_(io::provenance({{"scene", hashOf(identity_)}})) {
    built_.run->profile = Profile(settings.profile);
    built_.run->grains.profile = settings.profile ? &built_.run->profile : nullptr;
    if (!goesOn) requireInputsElsewhere(scene_.files, settings.folder);
    start(built_, scene_);
    plan_ = planOf(built_, scene_);
    if (plan_.series > 0)
      series_ = std::make_unique<Series>(built_, scene_,
                                         SeriesFiles{settings.folder, provenance_, scene_.output.hdf5, plan_.series});
    if (goesOn) takeState();
    requireSameOnRanks(identity_, *built_.run);
    if (plan_.frames > 0)
      frames_ = std::make_unique<Frames>(built_, scene_, settings.folder, provenance_, progress_.frames);
    for (const std::string& note : built_.notes) log_ << note << '\n';
    if (goesOn) return;
    for (const std::string& warning : warnings(built_, scene_)) remark(warning, true);
    trial_.keep();
    removeEarlierRun(settings_.folder);
    writeScene();
    sample(0);
    frame(0);
  }

  /// @throws what a stage throws; where to go on from is told before
  bool finish() {
    try {
      const bool finished = finishStages();
      setLastWords({});
      return finished;
    } catch (...) {
      setLastWords({});
      if (saved_) log_ << whereToGoOn() << std::endl;
      throw;
    }
  }

private:
  bool finishStages() {
    watch_ = Stopwatch();
    for (; progress_.stage < scene_.stages.size(); ++progress_.stage, progress_.macroStep = 0) {
      begin();
      const Stage& stage = scene_.stages[progress_.stage];
      const auto* const relax = std::get_if<Relax>(&stage.kind);
      const auto* const statics = std::get_if<Statics>(&stage.kind);
      const auto* const modes = std::get_if<FindModes>(&stage.kind);
      if (modes)
        for (const std::string& line : findModes(built_, scene_, progress_.stage, file(modesFile), provenance_))
          remark(line, false);
      if (!(relax ? comeToRest(*relax) : statics ? load(*statics, stage.where) : runFor(plan_.stages[progress_.stage])))
        return stop();
      // Before what only an end has: longer runs go on from here.
      if (progress_.stage + 1 == scene_.stages.size() && plan_.checkpoints > 0) checkpoint();
      relax ? endRest() : statics ? endLoad(*statics) : modes ? void() : endRun();
      countTime();
      log_ << lineOf(progress_.stage) << std::endl;
    }
    if (!progress_.toldOfStep) {
      const StepLimit limit = built_.run->criticalStep();
      if (built_.run->dt() > limit.dt) reportOfStep(built_.run->time(), limit);
    }
    if (const std::string line = scene::lineOf(std::exchange(progress_.deep, {})); !line.empty()) remark(line, true);
    close();
    countRoom();
    summarise();
    return true;
  }

  fs::path file(const char* name) const { return settings_.folder / name; }
  static double rounded(double seconds) { return std::round(1e3 * seconds) / 1e3; }
  static const char* nameOf(const Stage& stage) {
    constexpr std::array names{"relax", "run", "statics", "modes"};
    return names[stage.kind.index()];
  }
  std::string lineOf(std::size_t stage) const {
    return "stage " + std::to_string(stage + 1) + ": " + formatNumber(rounded(taken_[stage].wall)) + " s";
  }
  void countTime() {
    const TimeTaken taken = watch_.lap();
    if (progress_.stage < taken_.size()) taken_[progress_.stage] += taken;
  }
  void remark(const std::string& line, bool warns) {
    progress_.remarks.push_back({line, warns});
    log_ << (warns ? "WARNING: " : "") << line << std::endl;
  }

  /// Newcomers that find no room are dropped: told as soon as it is seen, and counted at the end.
  void lookForRoom() {
    const std::vector<const dem::Insertion*> all = insertionsOf(built_);
    for (std::size_t k = 0; !toldOfRoom_ && k < all.size(); ++k) {
      if (all[k]->refused == 0) continue;
      toldOfRoom_ = true;
      log_ << "WARNING: t = " << built_.run->time() << " s, insertion " << k << ": " << all[k]->refused << " of "
           << all[k]->refused + all[k]->inserted << " grains to insert have found no room" << std::endl;
    }
  }
  void countRoom() {
    const std::vector<const dem::Insertion*> all = insertionsOf(built_);
    for (std::size_t k = 0; k < all.size(); ++k)
      if (all[k]->refused > 0)
        remark("insertion " + std::to_string(k) + ": " + std::to_string(all[k]->refused) + " of " +
                   std::to_string(all[k]->refused + all[k]->inserted) +
                   " grains found no room and were not inserted: make its region larger or its rate lower, or give "
                   "them a larger velocity",
               true);
  }

  void begin() {
    if (progress_.begun.size() > progress_.stage) return;
    progress_.begun.push_back(startOf(built_, scene_, progress_.stage));
    beginStage(built_, scene_, progress_.stage, progress_.begun.back(), Grains::areThere);
    warn();
  }
  bool comeToRest(const Relax& relax) {
    coupling::RestProgress& rest = progress_.rest;
    const RestCriterion criterion{relax.kinetic, relax.macroSteps};
    for (bool ended = false; !ended;) {
      const std::int64_t next = nextLook(progress_.macroStep, relax.macroSteps);
      ended = coupling::relaxOn(*built_.run, criterion, rest, next - progress_.macroStep);
      progress_.macroStep = rest.report.steps;
      lookForRoom();
      warn();
      if (ended) break;
      if (due(plan_.checkpoints)) checkpoint();
      if (stopsNow()) return false;
    }
    return true;
  }
  void endRest() {
    coupling::RestProgress& rest = progress_.rest;
    const std::string line = std::string(rest.report.atRest ? "at rest" : "NOT at rest") + " after " +
                             std::to_string(rest.report.steps) + " macro steps, kinetic over elastic energy " +
                             formatNumber(rest.report.residual) +
                             (rest.report.atRest ? "" : ": give it more macro steps, or run for a time instead");
    remark(line, !rest.report.atRest);
    rest = {};
    sample(0);
    frame(0);
  }
  void endRun() {
    if (!due(plan_.series)) sample(0);
    if (!due(plan_.frames)) frame(0);
  }

  bool load(const Statics& statics, const std::string& where) {
    try {
      return statics.arcLength ? followLoads(statics) : load(statics);
    } catch (const NumericalError& error) {
      throw NumericalError(error.what(), where,
                           statics.arcLength ? "in the scene: larger \"load_steps\", or {\"do\": \"relax\"}"
                                             : "in the scene: larger \"load_steps\", \"control\": \"arc-length\" to "
                                               "follow a snap-through, or {\"do\": \"relax\"}");
    }
  }
  /// Load steps in which time passes are as many instants; otherwise there is but one.
  bool load(const Statics& statics) {
    const double time = statics.time.value_or(0.0) / static_cast<double>(statics.loadSteps);
    while (progress_.macroStep < statics.loadSteps) {
      const auto unstable = built_.run->loadStep(progress_.macroStep++, statics.loadSteps, time);
      for (const std::string& name : unstable)
        if (progress_.macroStep == statics.loadSteps)
          remark("the equilibrium of \"" + name +
                     "\" is not stable: it buckles as soon as anything disturbs it; lower its loads, or run instead",
                 true);
      if (time == 0.0 && progress_.macroStep < statics.loadSteps) {
        if (stopsNow()) return false;
        continue;
      }
      sample(0);
      frame(0);
      if (plan_.checkpoints > 0 && progress_.macroStep < statics.loadSteps) checkpoint();
      if (stopsNow() && progress_.macroStep < statics.loadSteps) return false;
    }
    return true;
  }
  /// Every step is a row and a frame, all of one instant.
  bool followLoads(const Statics& statics) {
    const auto hasCome = [&] {
      bool all = progress_.macroStep > 0;
      for (std::size_t s = 0; s < built_.run->solids(); ++s) all = all && built_.run->loadFactor(s) == 1.0;
      return all;
    };
    while (!hasCome()) {
      if (progress_.macroStep >= arcsPerLoadStep * statics.loadSteps)
        throw NumericalError("the loads have not come on in full after " + std::to_string(progress_.macroStep) +
                                 " steps of the path of equilibria",
                             "", "lower the loads, or take fewer load steps, which makes each step longer");
      for (const std::string& name : built_.run->followLoads(progress_.macroStep++, statics.loadSteps))
        remark("the equilibrium of \"" + name +
                   "\" under its whole load is not stable: it goes on as soon as anything disturbs it",
               true);
      sample(0);
      frame(0, Frames::SameInstant::kept);
      if (hasCome()) break;
      if (plan_.checkpoints > 0 && progress_.macroStep % lookEvery == 0) checkpoint();
      if (stopsNow()) return false;
    }
    return true;
  }
  void endLoad(const Statics& statics) {
    double farthest = 0.0;
    for (std::size_t s = 0; s < built_.run->solids(); ++s)
      for (const Vec3& u : built_.run->solid(s).nodes().u) farthest = std::max(farthest, norm(u));
    const bool follows = statics.arcLength;
    remark("in equilibrium after " + std::to_string(follows ? progress_.macroStep : statics.loadSteps) +
               (follows ? " steps of the path" : " load steps") + ": nodes are up to " + formatNumber(farthest) +
               " m from their undeformed places",
           false);
  }

  bool runFor(std::int64_t macroSteps) {
    coupling::CoupledRun& run = *built_.run;
    dovetail::Progress shown("stage " + std::to_string(progress_.stage + 1), static_cast<double>(macroSteps),
                             settings_.progress);
    const Clock::time_point begun = Clock::now();
    const std::int64_t first = progress_.macroStep;
    while (progress_.macroStep < macroSteps) {
      const std::int64_t before = progress_.macroStep, next = nextLook(before, macroSteps);
      run.advance(next - before, next == macroSteps || isLookedInto(next));
      progress_.macroStep = next;
      warn();
      const double rate = static_cast<double>(next - first) / since(begun);
      shown.update(static_cast<double>(next),
                   "t = " + formatNumber(run.time()) + " s  " + std::to_string(std::llround(rate)) + " macro steps/s");
      if (!shown.shown() && 10 * next / macroSteps > 10 * before / macroSteps && next < macroSteps)
        log_ << "t = " << run.time() << " s, " << 100 * next / macroSteps << " %, " << std::llround(rate)
             << " macro steps/s, " << formatDuration(static_cast<double>(macroSteps - next) / rate) << " to go"
             << std::endl;
      lookForRoom();
      sample(plan_.series);
      frame(plan_.frames);
      if (due(plan_.checkpoints) && next < macroSteps) checkpoint();
      if (stopsNow()) return false;
    }
    return true;
  }

  /// Where the run is looked at next: the same places whenever a run is broken off.
  std::int64_t nextLook(std::int64_t now, std::int64_t end) const {
    std::int64_t next = std::min(end, (now / lookEvery + 1) * lookEvery);
    for (const std::int64_t every : {plan_.series, plan_.frames, plan_.checkpoints})
      if (every > 0) next = std::min(next, (now / every + 1) * every);
    return next;
  }
  /// Looks at signals alone ask nobody for energies.
  bool isLookedInto(std::int64_t macroStep) const {
    return std::ranges::any_of(std::array{plan_.series, plan_.frames, plan_.checkpoints},
                               [&](std::int64_t every) { return every > 0 && macroStep % every == 0; });
  }
  bool due(std::int64_t every) const { return every > 0 && progress_.macroStep % every == 0; }

  /// @param every  macro steps; 0: now
  void sample(std::int64_t every) {
    if (!series_ || (every > 0 && !due(every))) return;
    series_->add(built_);
    warn();
    progress_.rows = series_->rows();
  }
  void warn() {
    if (progress_.macroStep % deepEvery == 0) lookForDeepGrains(built_.run->grains, progress_.deep);
    if (progress_.toldOfStep) return;
    const coupling::CoupledRun& run = *built_.run;
    if (const auto& passed = run.grains.passed) return reportOfStep(passed->time, passed->limit);
    if (series_ && series_->limit() && run.dt() > series_->limit()->dt) reportOfStep(run.time(), *series_->limit());
  }
  void reportOfStep(double time, const StepLimit& limit) {
    progress_.toldOfStep = true;
    remark("at t = " + formatNumber(time) + " s the step exceeds the limit of " + formatNumber(limit.dt) +
               " s set by " + limit.owner + ": take a smaller steps.dt",
           true);
  }
  void frame(std::int64_t every, Frames::SameInstant before = Frames::SameInstant::replaced) {
    if (!frames_ || (every > 0 && !due(every))) return;
    frames_->add(built_, before);
    progress_.frames = frames_->times();
  }
  /// Writes what does not grow with the run.
  void close() {
    if (series_) series_->close(sceneText(scene_));
    if (scene_.output.hdf5) writeSolidsHdf5(settings_.folder, built_, scene_, provenance_);
  }
  void checkpoint() {
    countTime();
    writeTimes(settings_.folder, provenance_, taken_);
    writeCheckpoint(settings_.folder, identity_, progress_, *built_.run);
    keepWords(built_.run->time());
  }
  void keepWords(double saved) {
    saved_ = saved;
    setLastWords(whereToGoOn());
  }
  std::string whereToGoOn() const {
    return "the last checkpoint is of t = " + formatNumber(*saved_) + " s; to go on from there: dovetail resume " +
           settings_.folder.string();
  }
  void writeScene() const {
    io::writeFileAtomically(file("scene.json"), io::provenanceLines(provenance_, "// ") + sceneText(scene_));
  }

  void takeState() {
    const Checkpoint last = lastCheckpoint(settings_.folder, log_, Damaged::isSetAside);
    progress_ = last.progress;
    adopt(last, identity_, built_, scene_);
    keepWords(last.time);
    taken_ = readTimes(settings_.folder, scene_.stages.size());
    if (settings_.until) {
      lengthen(scene_, plan_, progress_, *built_.run, *settings_.until);
      plan_ = planOf(built_, scene_);
      removeEnd(settings_.folder);
      writeScene();
    }
    if (series_) series_->takeUp(progress_.rows);
  }

  bool stop() {
    checkpoint();
    close();
    log_ << io::nameOfInterruption() << " at t = " << built_.run->time() << " s; go on with: dovetail resume "
         << settings_.folder.string() << std::endl;
    team().meet();  // mpirun ends all once one has left, and the first one writes
    return false;
  }

  void summarise() {
    RunNotes notes;
    for (const Remark& one : progress_.remarks) {
      notes.lines.push_back((one.warns ? "WARNING: " : "") + one.text);
      if (one.warns) notes.warnings.push_back(one.text);
    }
    for (const Lines& lines : {strangersIn(built_), hourglassIn(built_)})
      for (const std::string& text : lines) {
        notes.lines.push_back("WARNING: " + text);
        notes.warnings.push_back(text);
      }
    for (std::size_t k = 0; k < scene_.stages.size(); ++k) {
      notes.stages.push_back({k + 1,
                              nameOf(scene_.stages[k]),
                              {rounded(taken_[k].wall), rounded(taken_[k].processor)},
                              progress_.begun[k].time});
      notes.lines.push_back(lineOf(k));
    }
    log_ << writeSummary(settings_.folder, provenance_, scene_, built_, notes, series_ ? &series_->table() : nullptr)
         << "files in " << settings_.folder.string() << std::endl;
  }

  Scene scene_;
  const RunOptions& settings_;
  std::ostream& log_;
  std::string identity_;
  io::FolderOnTrial trial_;
  io::FolderLock lock_;
  Built built_;
  io::KeyValues provenance_;
  Plan plan_;
  std::unique_ptr<Series> series_;
  std::unique_ptr<Frames> frames_;
  Progress progress_;
  std::vector<TimeTaken> taken_ = std::vector<TimeTaken>(scene_.stages.size());  ///< by each stage, in all programs
  Stopwatch watch_;                                                              ///< of what is not counted yet
  bool toldOfRoom_ = false;
  std::optional<double> saved_;  ///< time of the last checkpoint, s
};

}  // namespace

bool run(const Scene& scene, const RunOptions& settings, std::ostream& log) {
  return Execution(scene, settings, log, false).finish();
}

Scene readRun(const fs::path& folder) {
  const fs::path file = folder / "scene.json";
  std::error_code error;
  if (!fs::is_regular_file(file, error))
    throw InputError("this is no folder of a run", folder.string(), "give the one that the run wrote into");
  return readScene(file);
}

bool resume(const RunOptions& settings, std::ostream& log) {
  Scene scene = readRun(settings.folder);
  if (settings.threads) scene.steps.threads = *settings.threads;
  return Execution(std::move(scene), settings, log, true).finish();
}

}  // namespace dovetail::scene
