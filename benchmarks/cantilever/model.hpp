// Builds the cantilever and its particles from the settings.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "dovetail/coupling/run.hpp"
#include "dovetail/surface/surface_contact.hpp"
#include "reference/beam_case.hpp"
#include "settings.hpp"

namespace dovetail::cantilever {

/// Elements along x, y, z after refinement.
std::array<int, 3> elementCounts(const Settings& settings);

/// The run, and the two of its parts that are looked at.
struct Scene {
  std::unique_ptr<coupling::CoupledRun> run;
  coupling::SolidSide* beam = nullptr;
  surface::SurfaceContact* contact = nullptr;
};

/// The beam at rest with the particles at their static overlap. Axes: x across, y from the clamp, z up, z = 0 on the
/// beam's axis.
/// @throws InputError for impossible settings
Scene makeScene(const Settings& settings, const fem::SolidMesh& mesh);
fem::SolidMesh makeMesh(const Settings& settings);

/// The largest stable step and who sets it.
struct StepLimit {
  double dt;  ///< critical DEM step, s
  std::string setter;
};

/// The largest Σ_i S_i²/m_i of any point of the skin, 1/kg (an upper bound on the smooth surface).
double largestMobility(const Scene& scene);

/// Bounds for the chosen integrators: contacts 2/ω_c with ω_c² = k (1/m_p + mobility); explicit solid 2/ω_e of its
/// worst element, divided by K; both act together if K = 1: ω² = ω_c² + ω_e².
StepLimit criticalStep(const Settings& settings, fem::Model& beam, double mobility);

/// The DEM step asked for. @throws InputError if it exceeds the critical one
double chooseStep(const Settings& settings, const StepLimit& limit);

inline constexpr double longestRun = 100.0;  ///< s, where nobody leaves
/// @throws InputError if steps of dt would take days to the end of the run
void requireFeasible(const Settings& settings, double dt);

/// The same case for the beam references; bendingFactor 1.
BeamCase beamCase(const Settings& settings);
/// Bending stiffness of hex8 over the exact one, 1 + (h_y/h_z)²/(2 n_z²) for ν = 0 (parasitic shear); 1 for other
/// elements.
double lockingFactor(const Settings& settings);

}  // namespace dovetail::cantilever
