// What a sweep over contacts stored and lost.
#pragma once

namespace dovetail::dem {

/// Whether a sweep over contacts reports energies and losses; without them they cost nothing.
enum class Booking { on, off };

/// Sums over the contacts of one force evaluation.
struct ContactWork {
  double elasticEnergy = 0.0;     ///< J stored in normal springs (adhesion included, < 0 there) now
  double dissipatedPower = 0.0;   ///< W lost to dashpots (and to a tension cut-off) now
  double tangentialEnergy = 0.0;  ///< J stored in tangential springs now
  double frictionPower = 0.0;     ///< W lost to sliding, and to tangential springs whose contact ended, in this step
  double rollingEnergy = 0.0;     ///< J stored in rolling and torsional springs now
  double rollingPower = 0.0;      ///< W lost to rolling and torsional resistance in this step, ended contacts included
  double plasticPower = 0.0;      ///< W lost to plastic deformation of contacts in this step
  double fracturePower = 0.0;     ///< W lost with bonds that broke in this step

  double storedEnergy() const { return elasticEnergy + tangentialEnergy + rollingEnergy; }
  double lostPower() const { return dissipatedPower + frictionPower + rollingPower + plasticPower + fracturePower; }
  ContactWork& operator+=(const ContactWork& b) {
    elasticEnergy += b.elasticEnergy;
    dissipatedPower += b.dissipatedPower;
    tangentialEnergy += b.tangentialEnergy;
    frictionPower += b.frictionPower;
    rollingEnergy += b.rollingEnergy;
    rollingPower += b.rollingPower;
    plasticPower += b.plasticPower;
    fracturePower += b.fracturePower;
    return *this;
  }
};

}  // namespace dovetail::dem
