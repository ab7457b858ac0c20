// Grains that enter and leave a model while it runs.
#pragma once

#include <variant>

#include "dovetail/dem/model/model.hpp"
#include "dovetail/dem/setup/insertion.hpp"

namespace dovetail::dem {

/// An insertion into the model, between its times `from` and `until`: clear of its particles and walls, through its
/// periods. What came in is booked as entered (mass, momentum, kinetic and gravity energy; it has no contacts, so that
/// these add nothing).
class InsertionTerm final : public Term {
public:
  /// @throws InputError as makeInsertion
  explicit InsertionTerm(const InsertionOptions& settings) : insertion(makeInsertion(settings)) {}
  Insertion insertion;

  std::string name() const override { return "insertion"; }
  std::unique_ptr<Term> clone() const override { return std::make_unique<InsertionTerm>(*this); }
  std::string code() const override { return "settings of an insertion"; }
  void check(const Model& m) const override;
  void exchange(Model& m, const Step& step) override;
  void save(ByteWriter& writer) const override;
  void load(ByteReader& reader) override;

private:
  std::int64_t replaced_ = 0;  // leavers that have been made due again
};

/// What lies behind a plane, on the side to which the normal points.
struct HalfSpace {
  Vec3 point;   ///< m
  Vec3 normal;  ///< of any length but 0
  friend constexpr bool operator==(const HalfSpace&, const HalfSpace&) = default;
};

/// Removes particles whose centres lie in a region, clumps as soon as one member does. Booked as left: mass, momentum,
/// kinetic and gravity energy, and what their contacts stored.
class OutletTerm final : public Term {
public:
  using Region = std::variant<geometry::Box, HalfSpace>;
  Region region;
  int every = 1;     ///< steps between two checks
  Exchanged passed;  ///< through here so far; clumps count once

  std::string name() const override { return "outlet"; }
  std::unique_ptr<Term> clone() const override { return std::make_unique<OutletTerm>(*this); }
  void check(const Model& m) const override;
  void exchange(Model& m, const Step& step) override;
  void save(ByteWriter& writer) const override;
  void load(ByteReader& reader) override;

private:
  /// Particles that may reach the region before the next search for pairs: all within the skin of the list.
  struct Near {
    std::vector<int> particles;
    std::int64_t builds = -1, revision = -1;  ///< of the pair list and of the particles
    Region region;
  };
  Near near_;
  void lookAround(const Model& m);
};

/// Starts an insertion; it and outlets act in the order in which they were added.
/// @throws InputError as makeInsertion
InsertionTerm& addInsertion(Model& m, const InsertionOptions& settings);
OutletTerm& addOutlet(Model& m, const OutletTerm::Region& region);

}  // namespace dovetail::dem
