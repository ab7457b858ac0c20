// Runs a bar and gathers its figures.
#pragma once

#include <iosfwd>
#include <string>
#include <vector>

#include "common/outputs.hpp"
#include "common/report.hpp"
#include "model.hpp"
#include "settings.hpp"

namespace dovetail::wave {

using benchmark::Frame, benchmark::Observer;

struct RunFigures : benchmark::RunFigures {
  std::size_t particles = 0, overlapParticles = 0, elements = 0, coupledNodes = 0;
  arlequin::CriticalStep critical{};
  double penalty = 0.0;  ///< in use, Pa/m²

  double energyInput = 0.0, energyFinal = 0.0;  ///< J; final without booked channels
  double lostFraction = 0.0, absorbedFraction = 0.0, couplingWorkFraction = 0.0;
  double ledgerResidual = 0.0, momentumResidual = 0.0, massResidual = 0.0;
  double overlapMismatch = 0.0, gapMax = 0.0;
  double paperDissipatedFraction = 0.0;

  bool compared = false;  ///< with a run of particles alone
  double waveformErrorFem = 0.0, waveformErrorDem = 0.0, reflectedFraction = 0.0, speedRatio = 0.0;
};

/// Energy without booked channels, at the samples.
struct EnergySample {
  double t, joules;
};

/// Of the velocity profile, "model": 0 nodes of the solid, 1 particles, 2 particles alone over the whole bar, at the
/// end, once compared; "particles_fraction": the weight w there, 0 … 1.
struct RunResult : benchmark::RunData {
  RunResult() {
    velocityProfile.emplace(
        std::vector<std::string>{"time_s", "model", "y_m", "velocity_y_m_per_s", "particles_fraction"});
  }
  Settings settings;
  RunFigures figures;
  std::vector<EnergySample> energy;
  dem::Particles particles;  ///< at the end
  dem::PairList pairs;
  std::vector<int> byPlace;                      ///< see Bar
  std::vector<Vec3> nodePosition, nodeVelocity;  ///< at the end; empty without a solid
};

/// Builds the model and chooses the step. @throws InputError for impossible settings
benchmark::PreparedRun<RunResult> prepareRun(const Settings& settings);

/// Prepares and runs.
RunResult run(const Settings& settings, const Observer& observer = {});

/// Compares a coupled run, if the settings say so, with particles alone over the whole length, which is run once for
/// settings that agree in all that concerns it and kept.
void compare(RunResult& result);

/// Adds the layers of a frame to a velocity profile: nodes, then particles, each by rising y.
/// @param byPlace  see Bar
void addLayers(io::TimeSeries& table, const Settings& settings, const std::vector<int>& byPlace, const Frame& frame);

/// Energy at time t, linear between samples, J; NaN outside.
double energyAt(const std::vector<EnergySample>& energy, double t);

/// Fraction of the energy that is lost while the impulse passes the overlap, as the authors count it: from 19.3 to 60.8
/// ms for one particle per element, from 19.9 to 81.7 ms else. NaN if the samples do not cover that time.
double dissipatedFraction(const std::vector<EnergySample>& energy, int particlesPerEdge);

/// All figures, as reports and summaries have them.
benchmark::Lines linesOf(const RunResult& result);
/// What was computed, its errors against particles alone, its balances, its time, dt against the critical step and who
/// sets it.
void printReport(std::ostream& out, const RunResult& result);

}  // namespace dovetail::wave
