// Momentum, and who gave it.
#pragma once

#include <string>
#include <vector>

#include "dovetail/core/archive.hpp"
#include "dovetail/core/vec3.hpp"

namespace dovetail {

/// A sum, and the sum of the moments about the origin: of motion or impulses, kg m/s and kg m²/s; of forces, N and N m.
struct Momenta {
  Vec3 linear, angular;

  /// Adds one that acts at x, m.
  void add(const Vec3& x, const Vec3& one) {
    linear += one;
    angular += cross(x, one);
  }
  Momenta& operator+=(const Momenta& b) {
    linear += b.linear;
    angular += b.angular;
    return *this;
  }
  friend Momenta operator-(const Momenta& a, const Momenta& b) { return {a.linear - b.linear, a.angular - b.angular}; }
  friend Momenta operator*(double s, const Momenta& a) { return {s * a.linear, s * a.angular}; }
  friend bool operator==(const Momenta&, const Momenta&) = default;
};

/// What has been given so far, by who gave it.
class ImpulseLedger {
public:
  struct Channel {
    std::string name;
    Momenta given;  ///< in all, kg m/s and kg m²/s
    /// Sums of the magnitudes of its parts, kg m/s and kg m²/s: what round-off is relative to.
    double turnedOver = 0.0, turnedOverAngular = 0.0;

    void give(const Momenta& impulse);
    void add(const Channel& other);
  };

  /// Adds to the channel of that name, which appears with its first impulse.
  void give(const std::string& name, const Momenta& impulse);
  /// The same for those who give at every step. @param number  where the channel was last; looked up and set where that
  /// is another's by now
  void give(const std::string& name, const Momenta& impulse, int& number);
  /// Adds the channels of another book, each named prefix + its name.
  void add(const std::string& prefix, const ImpulseLedger& other);
  const std::vector<Channel>& channels() const { return channels_; }
  /// Of all channels.
  Channel total() const;

  void save(ByteWriter& archive) const;
  /// @throws InputError if the bytes end too early
  void load(ByteReader& archive);

private:
  Channel& channel(const std::string& name);
  std::vector<Channel> channels_;
};

}  // namespace dovetail
