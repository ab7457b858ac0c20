// The scene of a cantilever run, its time step, and the beam that it is compared with.
#pragma once

#include <string>

#include "dovetail/core/step_limit.hpp"
#include "dovetail/scene/build.hpp"
#include "dovetail/surface/surface_contact.hpp"
#include "reference/beam_case.hpp"
#include "settings.hpp"

namespace dovetail::cantilever {

/// scenes/cantilever.json as the settings change it, built, and the two of its parts that are looked at.
struct Model {
  scene::Scene scene;
  scene::Built built;
  coupling::SolidSide* beam = nullptr;
  const surface::SurfaceContact* contact = nullptr;

  coupling::CoupledRun& run() const { return *built.run; }
};
/// The beam at rest with the particles at their static overlap. Axes: x across, y from the clamp, z up, z = 0 on the
/// beam's axis.
/// @throws InputError for impossible settings
Model makeModel(const Settings& settings);

/// Wherever on the skin the particles will be. Bounds for the chosen integrators: contacts 2/ω_c with
/// ω_c² = k (1/m_p + Σ_i S_i²/m_i) at the lightest point; explicit solid 2/ω_e of its worst element, divided by K; both
/// act together if K = 1: ω² = ω_c² + ω_e².
StepLimit criticalStep(const Settings& settings, const Model& model);

/// The DEM step asked for. @throws InputError if it exceeds the critical one
double chooseStep(const Settings& settings, const StepLimit& limit);

/// @throws InputError if steps of dt would take days to the end of the run
void requireFeasible(const Settings& settings, double dt);

/// The same case for the beam references; bendingFactor 1.
BeamCase beamCase(const Settings& settings);
/// Bending stiffness of hex8 over the exact one, 1 + (h_y/h_z)²/(2 n_z²) for ν = 0 (parasitic shear); 1 for other
/// elements.
double lockingFactor(const Settings& settings);

}  // namespace dovetail::cantilever
