// The state of a run in bytes, and back.
#include <optional>

#include "dovetail/core/error.hpp"
#include "dovetail/dem/model/checkpoint.hpp"
#include "run_impl.hpp"

namespace dovetail::coupling {

namespace {

void saveLoad(ByteWriter& archive, const NodalLoad& load) {
  std::vector<Vec3> force;
  for (const int node : load.touched) force.push_back(load.force[static_cast<std::size_t>(node)]);
  archive(load.touched, force);
}

NodalLoad readLoad(ByteReader& archive, std::size_t nodes) {
  std::vector<int> touched;
  std::vector<Vec3> force;
  archive(touched, force);
  NodalLoad load(nodes);
  if (touched.size() != force.size())
    throw InputError("loads and nodes differ in number", "state", "load it into the run that saved it");
  for (std::size_t k = 0; k < touched.size(); ++k) {
    if (touched[k] < 0 || static_cast<std::size_t>(touched[k]) >= nodes)
      throw InputError("there is no node " + std::to_string(touched[k]), "state", "load it into the run that saved it");
    load.add(touched[k], force[k]);
  }
  return load;
}

/// What a state begins with.
struct Head {
  double dt = 0.0;
  int stepsPerMacroStep = 0, lag = 0;
  std::uint64_t solids = 0;
  std::vector<Vec3> macroForce = {};
  double madeByLag = 0.0, broughtToRest = 0.0, changed = 0.0;
  std::vector<char> particles = {};
};
template <class Archive>
void archiveHead(Archive& archive, Head& head) {
  archive(head.dt, head.stepsPerMacroStep, head.lag, head.solids, head.macroForce, head.madeByLag, head.broughtToRest,
          head.changed, head.particles);
}

template <class Archive>
void archivePath(Archive& archive, fem::ParameterPath& path, double& loadFactor) {
  archive(path.at, path.length, path.firstLength, path.lastMove, loadFactor);
}

void requireSame(bool same, const char* what) {
  if (!same)
    throw InputError(std::string("the state has other ") + what, "load", "load it into a run that is set up alike");
}

}  // namespace

/// What has been read of a state.
struct CoupledRun::Impl::State {
  Head head;
  struct Solid {
    std::shared_ptr<SavedSolid> own = {};
    double bookedBefore = 0.0;
    NodalLoad load, macroStep, before;
    std::vector<Vec3> seen;
    double supportWork = 0.0;
    ImpulseLedger outside;
    SolidStepper::StaticWork statics;
    fem::HeldLoad held;
    fem::ParameterPath path;
    double loadFactor = 0.0;
    bool stands = false;
  };
  Outside outside;
  std::vector<Solid> solids;
};

std::vector<char> particlesOf(const std::vector<char>& state) {
  ByteReader archive(state);
  Head head;
  archiveHead(archive, head);
  return head.particles;
}

namespace {

/// A solid's bytes begin with its motion; those of implicit steps are within others.
fem::SavedMotion motionIn(std::vector<char> own, bool implicit) {
  ByteReader archive(std::move(own));
  if (!implicit) return fem::readMotion(archive);
  std::vector<char> inner;
  archive(inner);
  ByteReader within(std::move(inner));
  return fem::readMotion(within);
}

}  // namespace

std::vector<SolidOfState> solidsOf(const std::vector<char>& state) {
  ByteReader archive(state);
  Head head;
  archiveHead(archive, head);
  std::vector<SolidOfState> solids;
  for (std::uint64_t s = 0; s < head.solids; ++s) {
    std::string name;
    std::vector<char> own, rest;
    bool implicit = false;
    archive(name, implicit, own, rest);
    solids.push_back({name, motionIn(std::move(own), implicit)});
  }
  return solids;
}

std::vector<char> CoupledRun::Impl::save() {
  ByteWriter archive;
  Head head{dt,
            options.stepsPerMacroStep,
            static_cast<int>(options.lag),
            solids.size(),
            macroForce,
            madeByLag,
            broughtToRest,
            changed,
            dem::saveState(grains)};
  archiveHead(archive, head);
  for (std::size_t s = 0; s < solids.size(); ++s) {
    const SolidSide& side = solids[s]->side;
    ByteWriter own, rest;
    solids[s]->save(own);
    rest(solids[s]->bookedBefore, static_cast<std::uint64_t>(side.nodes().X.size()));
    saveLoad(rest, side.load);
    saveLoad(rest, solids[s]->macroLoad);
    saveLoad(rest, loadBefore.empty() ? NodalLoad() : loadBefore[s]);
    rest(lagSeen.empty() ? std::vector<Vec3>() : lagSeen[s], side.supportWork);
    side.outside.save(rest);
    const SolidStepper::StaticWork& works = solids[s]->statics;
    rest(works.loads, works.supports, works.dissipated, works.held, solids[s]->stands);
    solids[s]->held.save(rest);
    archivePath(rest, solids[s]->path, solids[s]->loadFactor);
    archive(side.name, side.stepping == Stepping::implicitSteps, own.bytes(), rest.bytes());
  }
  outside.save(archive);
  return archive.bytes();
}

CoupledRun::Impl::State CoupledRun::Impl::read(const std::vector<char>& bytes) const {
  ByteReader archive(bytes);
  State state;
  archiveHead(archive, state.head);
  const Head& head = state.head;
  requireSame(
      head.dt == dt && head.stepsPerMacroStep == options.stepsPerMacroStep && head.lag == static_cast<int>(options.lag),
      "steps or options");
  requireSame(head.solids == solids.size(), "solids");
  for (const auto& solid : solids) {
    const SolidSide& side = solid->side;
    std::string name;
    std::vector<char> own, rest;
    bool implicit = false;
    archive(name, implicit, own, rest);
    requireSame(name == side.name && implicit == (side.stepping == Stepping::implicitSteps), "solids");
    ByteReader reader(std::move(own)), others(std::move(rest));
    State::Solid& saved = state.solids.emplace_back();
    saved.own = solid->read(reader);
    std::uint64_t nodes = 0;
    others(saved.bookedBefore, nodes);
    requireSame(nodes == side.nodes().X.size() || fem::ownsNodes(*side.model), "nodes");
    saved.load = readLoad(others, nodes);
    saved.macroStep = readLoad(others, nodes);
    saved.before = readLoad(others, nodes);
    others(saved.seen, saved.supportWork);
    saved.outside.load(others);
    SolidStepper::StaticWork& works = saved.statics;
    others(works.loads, works.supports, works.dissipated, works.held, saved.stands);
    saved.held.load(others);
    archivePath(others, saved.path, saved.loadFactor);
    requireSame(reader.atEnd() && others.atEnd(), "solids");
    requireSame(options.lag == Lag::none || saved.seen.size() == nodes, "solids");
  }
  state.outside.load(archive);
  requireSame(archive.atEnd(), "data");
  return state;
}

/// None of a run that has broken down: nothing of it is worth keeping.
std::optional<CoupledRun::Impl::State> CoupledRun::Impl::readOwn() {
  dem::close(grains);
  try {
    return read(save());
  } catch (const InputError&) {
    return std::nullopt;
  }
}

void CoupledRun::Impl::adopt(State state) {
  dem::loadState(state.head.particles, "state of a run", grains);
  loadBefore.clear();
  lagSeen.clear();
  madeByLag = state.head.madeByLag;
  broughtToRest = state.head.broughtToRest;
  changed = state.head.changed;
  for (std::size_t s = 0; s < solids.size(); ++s) {
    solids[s]->adopt(*state.solids[s].own);
    solids[s]->bookedBefore = state.solids[s].bookedBefore;
    solids[s]->side.load = std::move(state.solids[s].load);
    solids[s]->side.supportWork = state.solids[s].supportWork;
    solids[s]->side.outside = std::move(state.solids[s].outside);
    solids[s]->statics = state.solids[s].statics;
    solids[s]->stands = state.solids[s].stands;
    solids[s]->held = std::move(state.solids[s].held);
    solids[s]->path = std::move(state.solids[s].path);
    solids[s]->loadFactor = state.solids[s].loadFactor;
    solids[s]->macroLoad = std::move(state.solids[s].macroStep);
    if (options.lag == Lag::none) continue;
    loadBefore.push_back(std::move(state.solids[s].before));
    lagSeen.push_back(std::move(state.solids[s].seen));
  }
  macroForce = std::move(state.head.macroForce);
  outside = std::move(state.outside);
}

std::vector<char> CoupledRun::save() {
  if (!impl_->started) throw InputError("the run has not been started", "save", "call start(dt) first");
  dem::close(grains);
  return impl_->save();
}

void CoupledRun::load(const std::vector<char>& bytes) {
  if (!impl_->started)
    throw InputError("the run has not been started", "load", "set it up as it was and call start(dt)");
  Impl::State state = impl_->read(bytes);
  std::optional<Impl::State> backup = impl_->readOwn();
  try {
    impl_->adopt(std::move(state));
  } catch (...) {
    try {
      if (backup) impl_->adopt(std::move(*backup));
    } catch (const InputError&) {  // numbers that are not finite: of a run that has broken down
    }
    throw;
  }
}

}  // namespace dovetail::coupling
