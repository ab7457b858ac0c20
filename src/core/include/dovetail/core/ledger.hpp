// The energy ledger: every joule has a channel and the residual is printed.
#pragma once

#include <cstddef>
#include <iosfwd>
#include <string>
#include <string_view>
#include <vector>

#include "dovetail/core/archive.hpp"

namespace dovetail {

/// Books the energy of a run by channel, in joules.
///
/// A *stored* channel holds a state function (kinetic, elastic, contact, gravity); its present value is `set`.
/// A *booked* channel accumulates energy that has left the stored channels for good (dashpots, friction, coupling
/// work): `add` a positive amount when stored energy was spent, a negative one when energy came in (external work).
/// After `open()`, residual() = stored now + booked now − (stored + booked at opening): zero if nothing vanished
/// silently.
class EnergyLedger {
public:
  enum class Kind { stored, booked };
  struct Channel {
    std::string name;
    Kind kind;
    double joules = 0.0;
    double joulesAtOpening = 0.0;
  };
  using Id = std::size_t;

  Id addStored(std::string name) { return addChannel(std::move(name), Kind::stored); }
  Id addBooked(std::string name) { return addChannel(std::move(name), Kind::booked); }

  void set(Id id, double joules) { channels_[id].joules = joules; }
  void add(Id id, double joules) { channels_[id].joules += joules; }
  /// The same by name, for channels that are added when first met; booked ones appear with their first joule.
  void set(std::string_view name, Kind kind, double joules);
  void add(std::string_view name, double joules);

  /// Takes the present values as the baseline of residual(), and resets the extremes.
  void open();
  /// Updates the running extremes of total and residual; call once per sampled step.
  void close();

  double stored() const { return sum(Kind::stored); }
  double booked() const { return sum(Kind::booked); }
  double storedAtOpening() const { return storedAtOpening_; }
  double residual() const;

  double storedMin() const { return storedMin_; }
  double storedMax() const { return storedMax_; }
  /// Largest |stored − stored at opening| over the closed steps, J.
  double largestDrift() const { return largestDrift_; }
  /// Largest |residual| over the closed steps, J.
  double largestResidual() const { return largestResidual_; }

  const std::vector<Channel>& channels() const { return channels_; }
  /// Null if there is none of that name and kind.
  const Channel* find(std::string_view name, Kind kind) const;
  /// Of the channel of that name, J; 0 if there is none: channels of what never happened may be absent.
  double joules(std::string_view name) const;

  void save(ByteWriter& archive) const;
  /// What save() wrote; the extremes begin anew. @throws InputError if it is damaged; the ledger is then as it was
  void load(ByteReader& archive);

private:
  Id addChannel(std::string name, Kind kind);
  double sum(Kind kind) const;

  std::vector<Channel> channels_;
  double storedAtOpening_ = 0.0, bookedAtOpening_ = 0.0;
  double storedMin_ = 0.0, storedMax_ = 0.0, largestDrift_ = 0.0, largestResidual_ = 0.0;
};

/// Prints one line per channel and the residual.
std::ostream& operator<<(std::ostream& out, const EnergyLedger& ledger);

}  // namespace dovetail
