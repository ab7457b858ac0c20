// What the first contacts of a model will ask of the step, before there are any.
#pragma once

#include <functional>
#include <limits>
#include <string>

#include "dovetail/dem/model/model.hpp"
#include "dovetail/geometry/box.hpp"

namespace dovetail::dem {

/// What particles may come to hit beside each other: walls, skins of solids.
struct ImpactPartner {
  std::string name;                   ///< as in "a wall"
  const ContactLaws* laws = nullptr;  ///< null: those of the model
  int material = 0;                   ///< row of their table
  double inverseMass = 0.0;           ///< that it gives way with, 1/kg; of a solid at its most yielding place
  double speed = 0.0;                 ///< largest, m/s
  geometry::Box box{};                ///< where it is, m: as much as it takes to tell how far particles may fall
  const void* of = nullptr;           ///< as ContactDemand::Side
  bool inMacroSteps = false;
};

/// The impact that asks for the shortest step, and the one that goes deepest.
struct ImpactLimit {
  double dt = std::numeric_limits<double>::infinity();  ///< s; infinite if nobody can meet
  std::string owner;                                    ///< "an impact of particle 3 with a wall"
  double overlap = 0.0;                                 ///< over the smaller radius; 2: goes through
  std::string deepest;                                  ///< its owner
};

struct ImpactOptions {
  int macroStep = 1;                             ///< K
  std::function<double(const void*)> ownRate{};  ///< ContactDemand::Side::ownRate of a partner; empty: 0
};

/// Of head-on impacts of particles that touch nobody yet, newcomers of insertions included: of those of each material
/// that are moved most easily, with each other, with all others, and with what terms say can be hit, at the largest
/// relative speed there is and what gravity adds on the way down. The stiffness is that at the depth at which the
/// springs have taken up the energy; dashpots, tangential ones too, count with it. Bonded springs have no impacts.
/// @param demand  demandOf(m)
ImpactLimit impactLimit(const Model& m, const ContactDemand& demand, const ImpactOptions& settings = {});

}  // namespace dovetail::dem
