// Runs a bar and gathers its figures.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "dovetail/core/ledger.hpp"
#include "dovetail/core/profile.hpp"
#include "dovetail/io/time_series.hpp"
#include "model.hpp"
#include "settings.hpp"

namespace dovetail::wave {

struct RunFigures {
  bool finished = false, stable = false;
  std::string failure;
  std::int64_t steps = 0;
  std::size_t particles = 0, overlapParticles = 0, elements = 0, coupledNodes = 0;
  double wallSeconds = 0.0;  ///< of the loop, sampling included, writing of frames not
  double dt = 0.0, endTime = 0.0;
  arlequin::CriticalStep critical{};
  double penalty = 0.0;  ///< in use, Pa/m²

  double energyInput = 0.0, energyFinal = 0.0;  ///< J; final without booked channels
  double lostShare = 0.0, absorbedShare = 0.0, couplingWorkShare = 0.0;
  double ledgerResidual = 0.0, momentumResidual = 0.0, massResidual = 0.0;
  double largestExcess = 0.0;  ///< kinetic + elastic energy over what was put in
  double overlapMismatch = 0.0, gapMax = 0.0;
  double paperDissipatedShare = 0.0;

  bool compared = false;  ///< with a run of particles alone
  double waveformErrorFem = 0.0, waveformErrorDem = 0.0, reflectedShare = 0.0, speedRatio = 0.0;
};

/// Energy without booked channels, at the samples.
struct EnergySample {
  double t, joules;
};

/// What the models look like at some time.
struct Frame {
  double time;
  const Bar& bar;
  const io::TimeSeries& series;  ///< up to now
};
using Observer = std::function<void(const Frame&)>;

struct RunResult {
  Settings settings;
  RunFigures figures;
  EnergyLedger ledger;
  Profile profile;
  io::TimeSeries series{{"time_s"}};
  std::vector<EnergySample> energy;
  dem::Particles particles;  ///< at the end
  std::vector<double> contactScale;
  dem::PairList pairs;
  std::vector<Vec3> nodePosition, nodeVelocity;  ///< at the end; empty without a solid
  std::vector<Vec3> aloneVelocity;  ///< mean of each layer of particles alone at the end, m/s; empty if not compared
};

/// A run that nothing stands in the way of; to be called once. The observer may be empty. A run that breaks down
/// returns with `failure`, as does one that is interrupted (dovetail/io/interruption.hpp), which is observed once more
/// at its end.
using PreparedRun = std::function<RunResult(const Observer& observer)>;

/// Builds the model and chooses the step. @throws InputError for impossible settings
PreparedRun prepareRun(const Settings& settings);

/// Prepares and runs.
RunResult run(const Settings& settings, const Observer& observer = {});

/// Compares a coupled run with particles alone over the whole length, which is run once for settings that agree in all
/// that concerns it and kept.
void compareWithParticles(RunResult& result);

/// Energy at time t, linear between samples, J; NaN outside.
double energyAt(const std::vector<EnergySample>& energy, double t);

/// Share of the energy that is lost while the impulse passes the overlap, as the authors count it: from 19.3 to 60.8 ms
/// for one particle per element, from 19.9 to 81.7 ms else. NaN if the samples do not cover that time.
double dissipatedShare(const std::vector<EnergySample>& energy, int particlesPerEdge);

}  // namespace dovetail::wave
