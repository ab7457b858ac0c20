// A solid of a run, as connectors see it.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "dovetail/core/impulses.hpp"
#include "dovetail/core/vec3.hpp"
#include "dovetail/coupling/nodal_load.hpp"
#include "dovetail/dem/model/contact_step.hpp"
#include "dovetail/fem/model/model.hpp"
#include "dovetail/fem/model/model_mass.hpp"

namespace dovetail::coupling {

enum class Stepping {
  explicitSteps,  ///< nodes drift with the particles, the solid's own forces act every K-th step
  implicitSteps   ///< nodes are held fixed during K steps of the particles, and take one free step in their middle
};

/// Positions and velocities of the nodes belong to the same instant as those of the particles, except within macro
/// steps of implicit solids: there nodes lag or lead by up to half a macro step.
struct SolidSide {
  std::string name;
  fem::Model* model = nullptr;
  const fem::ModelMass* mass = nullptr;
  Stepping stepping = Stepping::explicitSteps;
  bool isInStep = true;  ///< nodes and particles are at the same instant; particles are located only then
  NodalLoad load;        ///< N, of all connectors in the evaluation under way: they add to it
  /// Forces of the solid's own terms in this evaluation, N, one per node; empty where they act at other instants only
  /// (macro steps of several steps, implicit solids). For constraints, which are computed from the sum of all forces.
  std::span<const Vec3> own;

  double supportWork = 0.0;  ///< J, by supports that move, in kicks by connectors
  ImpulseLedger outside;     ///< impulses of supports in kicks by connectors, and other external impulses

  /// v += M⁻¹ impulse (kg m/s) of the free components, between the kicks of a step; books what supports take of it.
  /// @return M⁻¹ impulse, m/s
  std::vector<Vec3> kick(std::span<const Vec3> impulse);

  /// Of the nodes, 1/kg, 0 where they are held; as light as consistent masses make them under forces on all of them,
  /// or on one place.
  enum class Forces { any, atOnePlace };
  std::vector<double> inverseMasses(Forces forces = Forces::any) const;
  /// Its number among the sides of a demand, whose masses are the nodes: all connectors of a solid use the same masses.
  int addTo(dem::ContactDemand& demand) const;

  fem::Nodes& nodes() { return model->nodes; }
  const fem::Nodes& nodes() const { return model->nodes; }
};

}  // namespace dovetail::coupling
