// Laws for pairs of materials.
#pragma once

#include <algorithm>
#include <cstddef>
#include <string>
#include <vector>

#include "dovetail/core/error.hpp"
#include "dovetail/dem/laws/laws.hpp"

namespace dovetail::dem {

/// What the loops over contacts use: laws with their roots and logarithms taken.
template <class Law>
struct PreparedLaws {
  int materials = 1;
  std::vector<typename Law::Prepared> table;  ///< materials², symmetric
  const typename Law::Prepared& at(int a, int b) const { return table[static_cast<std::size_t>(a * materials + b)]; }
  /// How far beyond touch any of them acts, m.
  double reach() const {
    double reach = 0.0;
    for (const auto& law : table) reach = std::max(reach, law.reach());
    return reach;
  }
  /// The most that any of them asks for: contacts of all remember alike.
  Recall recall() const {
    Recall most = Recall::nothing;
    for (const auto& law : table) most = std::max(most, law.recall());
    return most;
  }
  /// Numbers that a contact with a wall remembers, velocities included. Its normal turns as the wall goes and bends, so
  /// velocities are kept whole.
  int wallNumbers() const { return Law::memory + (recall() == Recall::nothing ? 0 : Law::recalled(Recall::motion)); }
  WallMemoryKind wallMemoryKind() const { return {Law::memoryKind, wallNumbers() - Law::memory}; }
  bool usesMass() const {
    for (const auto& law : table)
      if (law.usesMass()) return true;
    return false;
  }
};

/// One law per pair of materials: at(a, b) = at(b, a) acts between particles of material a and b
/// (Particles::material; particles without materials are of material 0).
template <class Law>
class LawTable {
public:
  /// All pairs of `materials` materials get the same law.
  /// @throws InputError if materials is not in 1 … 256
  LawTable(int materials, const Law& law) : materials_(materials) {
    if (materials < 1 || materials > 256)
      throw InputError("a law table for " + std::to_string(materials) + " materials", "contact laws",
                       "give 1 to 256 materials");
    laws_.assign(static_cast<std::size_t>(materials * materials), law);
  }
  void set(int a, int b, const Law& law) { laws_[index(a, b)] = laws_[index(b, a)] = law; }
  const Law& at(int a, int b) const { return laws_[index(a, b)]; }
  int materials() const { return materials_; }
  const std::vector<Law>& laws() const { return laws_; }

private:
  std::size_t index(int a, int b) const {
    if (a < 0 || a >= materials_ || b < 0 || b >= materials_)
      throw InputError("there is no material " + std::to_string(a < 0 || a >= materials_ ? a : b), "contact laws",
                       "give numbers from 0 to " + std::to_string(materials_ - 1));
    return static_cast<std::size_t>(a * materials_ + b);
  }
  int materials_;
  std::vector<Law> laws_;
};

namespace detail {
/// @throws InputError as validate does, naming the materials
template <class Law>
void validateEntry(const Law& law, int a, int b) {
  try {
    validate(law);
  } catch (const InputError& error) {
    throw InputError(error.what(), "law between materials " + std::to_string(a) + " and " + std::to_string(b), "");
  }
}
}  // namespace detail

/// Checks a law and takes its roots and logarithms.
/// @throws InputError as validate does
template <class Normal, class Tangential, class Rolling, class Adhesion>
auto prepare(const ContactLaw<Normal, Tangential, Rolling, Adhesion>& law) {
  validate(law);
  return PreparedLaws<ContactLaw<Normal, Tangential, Rolling, Adhesion>>{1, {law.prepare()}};
}
/// @throws InputError as validate does, naming the materials
template <class Law>
PreparedLaws<Law> prepare(const LawTable<Law>& laws) {
  PreparedLaws<Law> prepared{laws.materials(), {}};
  for (int a = 0; a < laws.materials(); ++a)
    for (int b = a; b < laws.materials(); ++b) detail::validateEntry(laws.at(a, b), a, b);
  for (const Law& law : laws.laws()) prepared.table.push_back(law.prepare());
  return prepared;
}

}  // namespace dovetail::dem
