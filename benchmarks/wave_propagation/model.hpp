// Builds the bar from the settings: particles and solid with an overlap, or particles alone.
//
// y runs along the bar from the end that is struck. Particles fill 0 ≤ y ≤ dem length, the solid goes on from
// dem length − overlap. Particles are numbered layer by layer along y.
#pragma once

#include "dovetail/arlequin/stepper.hpp"
#include "settings.hpp"

namespace dovetail::wave {

/// Length of the whole bar, m.
double barLength(const Settings& settings);
/// Particles in a layer, and layers of a bar of that length.
int particlesPerLayer(const Settings& settings);
int layers(const Settings& settings, double length);

/// Particles and solid coupled in the overlap.
/// @throws InputError for impossible settings
arlequin::Model makeCoupledBar(const Settings& settings);
/// Particles over the whole length and one layer more, which is the wall at the end: held, it fixes the bar's last
/// point.
arlequin::Model makeParticleBar(const Settings& settings);

/// What the constraint gets: as asked for, the published ε of the dashpot, or automatic, Pa/m².
double penaltyOf(const Settings& settings);
/// Either bar, with that penalty. With a solid that is stepped every K-th time the automatic penalty is softened as far
/// as its oscillations ask for it: impulses every K dt must not meet them in resonance (K dt < π/ω), and a coupling
/// that acts every K dt only must be stable (K dt < 2/ω).
/// @param penalty  what is used on return
/// @throws InputError for impossible settings
arlequin::Model makeBar(const Settings& settings, double& penalty);

/// Newmark for the solid of a coupled bar, with the mass matrix of the settings.
fem::ImplicitMotion makeNewmark(const Settings& settings, arlequin::Model& model);

}  // namespace dovetail::wave
