// Velocity along the bar: means over the layers of particles and of nodes.
#pragma once

#include "run.hpp"

namespace dovetail::wave {

/// A table with a row per layer and time. Column "model": 0 nodes of the solid, 1 particles, 2 particles alone over the
/// whole bar; "particles_share": the weight w there, 0 … 1.
io::TimeSeries emptyProfile();

/// Adds the layers of a frame, those of the nodes first, each by rising y.
void appendProfile(io::TimeSeries& table, const Settings& settings, const Frame& frame);

/// Adds the layers of the run of particles alone at the end, if there was one.
void appendParticlesAlone(io::TimeSeries& table, const RunResult& result);

}  // namespace dovetail::wave
