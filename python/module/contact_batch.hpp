// All contacts of a sweep at once, for laws that are asked once a sweep.
#pragma once

#include <algorithm>
#include <functional>
#include <span>
#include <vector>

#include "dovetail/dem/laws/contact_passes.hpp"
#include "dovetail/dem/laws/law_table.hpp"
#include "dovetail/dem/pairs/pairs.hpp"
#include "dovetail/dem/walls/primitive_wall.hpp"
#include "dovetail/dem/walls/wall_collide.hpp"

namespace dovetail::python {

/// What such a law remembers and how far it reaches.
struct LawTraits {
  static constexpr int mostMemory = 10;
  int memory = 0;            ///< numbers that a contact remembers for it
  std::vector<int> vectors;  ///< first numbers of the tangential vectors among them, which turn with the contact
  bool rotates = true;       ///< it exerts torques
  bool damps = false;        ///< it has a dashpot, so that contacts remember how they moved in the last step
  double reach = 0.0;        ///< m

  /// With the elastic and tangential energies of the last answer, J, which are booked when the contact ends.
  int kept() const { return memory + 2; }
  /// With velocity and spin of the last step.
  int numbers() const { return kept() + (damps ? 6 : 0); }
  unsigned turns() const;  ///< see laws.hpp
  /// Numbers of which none but their own law knows what they mean: none of the kinds of ContactLaw, in 16 bits.
  unsigned memoryKind() const { return 1u << 16 | static_cast<unsigned>(kept()); }
  dem::WallMemoryKind wallMemoryKind() const { return {memoryKind(), numbers() - kept()}; }
};

/// Contacts of a sweep by columns: number c of contact k is given[c * count + k].
struct Batch {
  enum Given : std::size_t {
    overlap,
    overlapBefore,
    separating,
    mass,
    radius,
    normal,
    slip = 8,
    spin = 11,
    separated = 14,
    slipped,
    turned = 18,
    engagement = 21,
    engagementUntilEnd,
    memory
  };
  enum Answered : std::size_t { force, couple = 3, elastic = 6, tangential, dissipated, friction, answers };
  std::size_t count = 0;
  double dt = 0.0;  ///< s
  std::vector<double> given, answered;
  std::vector<int> first, second;  ///< particles; second −1: a wall or a solid

  /// Room for so many contacts; answers are 0.
  void start(std::size_t contacts, std::size_t columns, double step);
  double* givenColumn(std::size_t c) { return given.data() + c * count; }
  double* answerColumn(std::size_t c) { return answered.data() + c * count; }
  Vec3 answer(std::size_t c, std::size_t k) const {
    return {answered[c * count + k], answered[(c + 1) * count + k], answered[(c + 2) * count + k]};
  }
};

/// Answers all contacts: sets `answered` and the memory among `given`.
using Ask = std::function<void(Batch&)>;

/// ContactLaws::pairs. Forces are added in the order of the chunks. @param batch room that is used
dem::ContactWork answerPairs(const LawTraits& law, dem::Particles& particles, dem::PairList& list, double dt,
                             dem::Booking booking, Batch& batch, const Ask& ask);

/// Contacts with a wall as a block has them, to a batch and back.
class WallBatch {
public:
  WallBatch(const LawTraits& law, double dt, std::size_t contacts, Batch& batch);
  /// Takes the next n contacts, and what they remember, numbers() a contact, of which velocities move on. Returns W
  /// lost with those that do not act.
  double take(dem::detail::ContactBlock& block, std::size_t n, std::span<const int> particle, double* memory);
  void ask(const Ask& ask);
  /// Whether contact c acts; then `index` is its place in the batch.
  bool acts(std::size_t c, std::size_t& index) const;
  double scale(std::size_t c) const { return scales_[c]; }
  double energyScale(std::size_t c) const { return energyScales_[c]; }

private:
  const LawTraits& law_;
  double dt_;
  Batch& batch_;
  std::vector<double> rows_, scales_, energyScales_;
  std::vector<int> places_;
};

namespace detail {
/// For gatherWall: a law of which only the contacts are asked for.
struct Bare {
  static constexpr int memory = 0;
  static constexpr bool rotates = true;
  struct Prepared {};
};
}  // namespace detail

/// What answerWall of the library does, for a batch: sets contacts.force (and couple), their energies, and advances
/// what they remember.
template <class Contacts, class Motion>
dem::ContactWork answerWall(const LawTraits& law, const dem::Particles& particles, Contacts& contacts,
                            std::vector<double>& memory, const dem::detail::WallSide& wall, double dt,
                            dem::Booking booking, const Motion& motion, Batch& batch, const Ask& ask) {
  using dem::detail::blockSize;
  const auto kept = static_cast<std::size_t>(law.kept()), numbers = static_cast<std::size_t>(law.numbers());
  const std::size_t count = contacts.particle.size();
  const bool booked = booking == dem::Booking::on;
  contacts.energy.assign(count, 0.0);
  contacts.sideEnergy.assign(count, 0.0);
  dem::ContactWork work;
  WallBatch all(law, dt, count, batch);
  dem::detail::ContactBlock block;
  for (std::size_t first = 0; first < count; first += blockSize) {
    const std::size_t n = std::min(blockSize, count - first);
    dem::detail::gatherWall<detail::Bare>(particles, contacts, memory, 0, {}, wall, first, n, motion, block);
    const double lost =
        all.take(block, n, std::span(contacts.particle).subspan(first, n), memory.data() + first * numbers);
    if (booked) work.frictionPower += lost;
  }
  all.ask(ask);
  for (std::size_t c = 0; c < count; ++c) {
    std::size_t k = 0;
    const bool acts = all.acts(c, k);
    contacts.force[c] = acts ? all.scale(c) * batch.answer(Batch::force, k) : Vec3{};
    if (law.rotates) contacts.couple[c] = acts ? all.scale(c) * batch.answer(Batch::couple, k) : Vec3{};
    for (std::size_t m = 0; m < kept; ++m)
      memory[c * numbers + m] = acts ? batch.givenColumn(Batch::memory + m)[k] : 0.0;
    if (!acts || !booked) continue;
    contacts.energy[c] = all.energyScale(c) * batch.answerColumn(Batch::elastic)[k];
    contacts.sideEnergy[c] = all.scale(c) * batch.answerColumn(Batch::tangential)[k];
    work.elasticEnergy += contacts.energy[c];
    work.tangentialEnergy += contacts.sideEnergy[c];
    work.dissipatedPower += all.scale(c) * batch.answerColumn(Batch::dissipated)[k];
    work.frictionPower += all.scale(c) * batch.answerColumn(Batch::friction)[k];
  }
  return work;
}

/// J that pairs which have left the list take with them, as fracture those that went with a particle.
dem::ContactWork energyOf(const LawTraits& law, const dem::EndedPairs& left);
/// The same of ended contacts with a wall, W.
double powerOf(const LawTraits& law, const dem::EndedMemories& ended, double dt);

}  // namespace dovetail::python
