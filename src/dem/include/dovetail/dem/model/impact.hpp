// Limits of the step by impacts that are yet to come.
#pragma once

#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "dovetail/dem/model/model.hpp"
#include "dovetail/geometry/box.hpp"

namespace dovetail::dem {

/// Partners of particles in impacts, beside particles: walls, skins of solids.
struct ImpactPartner {
  std::string name;                   ///< as in "a wall"
  const ContactLaws* laws = nullptr;  ///< null: those of the model
  int material = 0;                   ///< row of their table
  double inverseMass = 0.0;           ///< 1/kg; of a solid at the place where it is largest
  double speed = 0.0;                 ///< largest, m/s
  geometry::Box box{};                ///< where it is, m; limits how far particles may fall
  const void* of = nullptr;           ///< as ContactDemand::Side
  bool inMacroSteps = false;
};

/// The impact with the shortest step, "an impact of particle 3 with a wall", infinite if none is possible; and the
/// deepest one.
struct ImpactLimit : StepLimit {
  double overlap = 0.0;  ///< over the smaller radius; 2: goes through
  std::string deepest;   ///< its owner
};

/// Of a particle that stands for a part of a solid.
struct SolidPart {
  int solid = -1;        ///< its number; parts of one solid never meet; −1: none
  double ownRate = 0.0;  ///< ω² of the solid's own forces, 1/s²; 0: implicit steps, it moves once a macro step
};

struct ImpactOptions {
  int macroStep = 1;                             ///< K
  std::function<double(const void*)> ownRate{};  ///< ContactDemand::Side::ownRate of a partner; empty: 0
  std::vector<SolidPart> parts{};                ///< one per particle; empty: none is part of a solid
};

/// Adds to what contacts ask of a particle what the solid does whose part it is; nothing if no contact asks. Uses
/// demand.macroStep.
/// @param particle number @param mass of the particle, kg @param ownRate SolidPart::ownRate, 1/s²
void addOwnForces(ContactDemand& demand, std::size_t particle, double mass, double ownRate);

/// Of head-on impacts of particles without contacts, inserted ones included: of those of each material with the largest
/// inverse mass, with each other, with all others, and with the partners that terms name, at the largest relative speed
/// and what gravity adds on the way down. The stiffness is that at the depth at which the springs have taken up the
/// energy; dashpots, tangential ones too, count with it. Bonded springs have no impacts.
/// @param demand  demandOf(m)
ImpactLimit impactLimit(const Model& m, const ContactDemand& demand, const ImpactOptions& settings = {});

}  // namespace dovetail::dem
