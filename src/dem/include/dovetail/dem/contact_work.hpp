// What a sweep over contacts stored and lost.
#pragma once

namespace dovetail::dem {

/// Sums over the contacts of one force evaluation.
struct ContactWork {
  double elasticEnergy = 0.0;     ///< J stored in normal springs now
  double dissipatedPower = 0.0;   ///< W lost to dashpots (and to a tension cut-off) now
  double tangentialEnergy = 0.0;  ///< J stored in tangential springs now
  double frictionPower = 0.0;     ///< W lost to sliding, and to tangential springs whose contact ended, in this step

  double storedEnergy() const { return elasticEnergy + tangentialEnergy; }
  double lostPower() const { return dissipatedPower + frictionPower; }
  ContactWork& operator+=(const ContactWork& b) {
    elasticEnergy += b.elasticEnergy;
    dissipatedPower += b.dissipatedPower;
    tangentialEnergy += b.tangentialEnergy;
    frictionPower += b.frictionPower;
    return *this;
  }
};

}  // namespace dovetail::dem
