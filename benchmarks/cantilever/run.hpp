// One coupled run and its figures.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "dovetail/core/ledger.hpp"
#include "dovetail/core/profile.hpp"
#include "dovetail/dem/particles/particles.hpp"
#include "dovetail/fem/mesh/solid_mesh.hpp"
#include "dovetail/fem/model/nodes.hpp"
#include "dovetail/io/time_series.hpp"
#include "reference/error_norms.hpp"
#include "settings.hpp"

namespace dovetail::cantilever {

/// What an observer sees of a frame.
struct Frame {
  double time;
  const fem::SolidMesh& mesh;
  const fem::Nodes& nodes;
  const dem::Particles& particles;
  const std::vector<Vec3>& contactLoad;      ///< contact forces on the nodes, N
  const std::vector<double>& elementEnergy;  ///< J
  const io::TimeSeries& series;              ///< up to now
};
using Observer = std::function<void(const Frame&)>;

struct RunFigures {
  bool finished = false;  ///< reached the end it was told
  bool left = false;      ///< particle 1 has passed the free end
  bool stable = false;    ///< finished, no NaN, K + U never above 1.5 (initial + work of gravity)
  std::string failure;    ///< what broke down, when and where

  std::int64_t steps = 0;    ///< DEM steps
  double endTime = 0.0;      ///< s
  double wallSeconds = 0.0;  ///< loop only
  double dt = 0.0, criticalDt = 0.0;
  std::string criticalSetter;

  double leaveTime = 0.0;                                        ///< s, 0 if not left
  double energyInitial = 0.0, energyMin = 0.0, energyMax = 0.0;  ///< J, until leaving
  double energyDrift = 0.0, ledgerResidual = 0.0;                ///< relative to the initial energy
  double lateralDrift = 0.0;                                     ///< m
  double momentResidual = 0.0;  ///< |moments of particle and nodal loads together| / (Σ|f| × beam length)
  double forceResidual = 0.0;   ///< |particle and nodal loads together| / Σ|f|
  double noContactShare = 0.0;
  double largestExcess = 0.0;  ///< max (K + U) / (initial + work of gravity)

  double errorStatic = 0.0, errorStaticAuthors = 0.0;  ///< m, true arm and the authors' arm
  double errorStaticVertical = 0.0;                    ///< m, true arm, Δz alone: what lateral drift does not touch
  // Against the moving-mass beam: at the particle's own y, as the static formula, or at the same time.
  double errorDynamic = 0.0, errorDynamicSameTime = 0.0;              ///< m, exact EI
  double errorDynamicLocked = 0.0, errorDynamicLockedSameTime = 0.0;  ///< m, EI × locking factor
  double lockingFactor = 1.0;
  double referenceLeaveTime = 0.0;  ///< s, moving-mass beam with the exact EI
};

struct RunResult {
  Settings settings;
  RunFigures figures;
  EnergyLedger ledger;
  Profile profile;
  std::vector<PairSample> samples;  ///< trajectory until the end
  io::TimeSeries series{{"time_s"}};
};

/// A run that nothing stands in the way of; to be called once. The observer is called at t = 0 and every
/// outputInterval; it may be empty. Breakdowns and interruptions (dovetail/io/interruption.hpp) are reported in
/// figures.failure, with the state so far; an interrupted run is observed once more at its end.
using PreparedRun = std::function<RunResult(const Observer& observer)>;

/// Builds the model and chooses the step. @throws InputError for impossible settings
PreparedRun prepareRun(const Settings& settings);

/// Prepares and runs.
RunResult run(const Settings& settings, const Observer& observer = {});

/// Whether the run is set beside the moving-mass beam: not if it was told to end before a particle left, because the
/// beam is computed until leaving.
bool comparesWithBeam(const RunResult& result);

/// Fills in the errors against the static and dynamic references. The dynamic ones are computed once per case; NaN
/// where they were not compared, where there is no reference (a contact too stiff for it), or where the run went where
/// the reference never was.
void compareWithReferences(RunResult& result);

/// The moving-mass beam for the settings' contact stiffness and the given bending factor; kept after the first call.
const DynamicReference& dynamicReference(const Settings& settings, double bendingFactor);

}  // namespace dovetail::cantilever
