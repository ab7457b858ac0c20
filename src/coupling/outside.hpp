// What the outside gives to the particles of a run: kick by kick.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "dovetail/core/impulses.hpp"
#include "dovetail/coupling/run.hpp"

namespace dovetail::coupling {

/// Books what the kicks of the particles' steps do, as these are made: half a step after each evaluation of forces, and
/// half a step with the same forces when the next step begins.
class Outside {
public:
  ImpulseLedger given;

  /// The first half kick of a step of dt. Particles that leave before `evaluated` take half a kick of their weight
  /// along.
  void begin(double dt);
  /// Forces have been found. @param onSolids  force of connectors that the solids get at another time, N and N m
  void evaluated(const dem::Model& m, const dem::Step& step, const Momenta& onSolids);
  /// Particles with a new number < 0 are gone.
  void left(const dem::Model& m, std::span<const int> newNumber, const dem::Particles& before);
  /// Impulses that terms count themselves, up to now.
  void takeCounted(const dem::Model& m);

  // At the first start.
  Momenta opening;
  double massAtOpening = 0.0;
  dem::Exchanged entered, gone;

  void save(ByteWriter& archive) const;
  void load(ByteReader& archive);

private:
  struct Source {
    std::string name;
    Momenta force;     // N and N m
    int channel = -1;  // of `given`
  };
  void giveHalf(double dt);
  void put(const std::string& name, const Momenta& force);
  void takeCounted(const dem::Model& m, bool withForces);
  std::vector<Source> forces_;              // of the last evaluation
  std::size_t put_ = 0;                     // so many of them in the evaluation under way
  std::map<std::string, Momenta> counted_;  // by terms themselves, as last seen
  bool underWay_ = false;
};

}  // namespace dovetail::coupling
