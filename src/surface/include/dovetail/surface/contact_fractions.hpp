// Contacts that act with a fraction of what their law says, and what they store when that fraction changes.
#pragma once

#include <span>
#include <vector>

namespace dovetail::surface {

/// The energy w W V stored by the contacts of a particle of weight w changes with V by the work of their forces. Its
/// change with the fraction W, between two evaluations ½ w (V + V') (W' − W), is not the work of a force and is booked
/// here. (Changes of w are booked by their cause, except for tied particles that leave the contact, W' = 0, with their
/// former w.)
struct ContactFractions {
  /// Particles that touch, ascending; tied ones, whose contacts do not act, have the fraction 0.
  struct Touching {
    std::vector<int> particle;
    std::vector<double> weight, fraction, energy;  ///< of the particle, W, and what its contacts store, J
  };
  Touching now, before;
  double made = 0.0;  ///< J so far
  /// For a contact that no longer acts, in the one evaluation that yields the energy it would store.
  static constexpr double faded = 1e-100;

  /// Whether contacts of a particle did so in the evaluation before.
  bool acted(int particle) const;

  /// Of the evaluation under way: contacts of a particle with overlaps and fractions, one after the other.
  void begin();
  void add(int particle, double weight, double overlap, double fraction);
  /// @param particle, energy  of the contacts that act, J
  void book(std::span<const int> particle, std::span<const double> energy);
  void renumber(std::span<const int> newNumber);
  /// Of a state that has been read: whether its lists fit each other.
  bool isWhole() const;
  template <class Archive, class Self>
  static void archive(Archive& archive, Self& self) {
    archive(self.now.particle, self.now.weight, self.now.fraction, self.now.energy, self.made);
  }

private:
  double overlaps_ = 0.0;  // m, of the last particle
};

}  // namespace dovetail::surface
