#include "sound_state.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"
#include "motion/polar.hpp"

namespace dovetail::rve {

namespace {

[[noreturn]] void fail(const std::string& problem, const std::string& where) {
  throw InputError(problem, where, "take an older file, this one is damaged");
}

void require(bool holds, const std::string& problem, const std::string& where) {
  if (!holds) fail(problem, where);
}

void requireSize(std::size_t is, std::size_t shall, const std::string& what, const std::string& where) {
  require(is == shall, "there are " + std::to_string(is) + " " + what + " for " + std::to_string(shall), where);
}

void requireFinite(double value, const std::string& what, const std::string& where) {
  require(std::isfinite(value), what + " is " + formatNumber(value), where);
}

enum class Use { moves, turns };

/// One number a grain of the components in use: of discs x, y of motions and z of turns.
void checkField(const Rve& cell, const Components& field, Use use, const std::string& what, const std::string& where) {
  for (std::size_t k = 0; k < 3; ++k) {
    const bool inUse = cell.shape == Shape::sphere || (k == 2) == (use == Use::turns);
    requireSize(field[k].size(), inUse ? cell.size() : 0, what + " of component " + std::to_string(k), where);
    const auto bad = std::ranges::find_if(field[k], [](double value) { return !std::isfinite(value); });
    if (bad != field[k].end())
      fail("one of the " + what + ", of grain " + std::to_string(bad - field[k].begin()) + ", is " + formatNumber(*bad),
           where);
  }
}

/// Grains are brought into the box with every list, and go no further than the skin until the next.
void checkPlaces(const Rve& cell, const CellState& state, const std::string& where) {
  const std::array<Vec3, 3> rows = geometry::inverse(state.lattice);
  for (std::size_t i = 0; i < cell.size(); ++i) {
    const Vec3 x{state.x[0][i], state.x[1][i], state.x[2].empty() ? 0.0 : state.x[2][i]};
    for (std::size_t k = 0; k < 3; ++k)
      if (state.lattice.axes[k] && !(std::abs(dot(rows[k], x) - 0.5) < 2.0))
        fail("grain " + std::to_string(i) + " lies outside the cell", where);
  }
}

/// The lists of pairs, contact by contact.
class Pairs {
public:
  Pairs(const Rve& cell, const CellState& state, const std::string& where)
      : cell_(cell), contacts_(state.contacts), axes_(state.lattice.axes), where_(where) {}

  void check() {
    checkSizes();
    for (; grain_ < cell_.size(); ++grain_)
      for (int c = contacts_.first[grain_]; c < contacts_.first[grain_ + 1]; ++c) {
        at_ = static_cast<std::size_t>(c);
        checkPartner();
        checkSprings();
        if (!contacts_.bond.empty()) checkBond(contacts_.bond[at_]);
      }
  }

private:
  void checkSizes() const {
    const std::size_t size = contacts_.size();
    const std::vector<int>& first = contacts_.first;
    requireSize(first.size(), cell_.size() + 1, "beginnings of lists", where_);
    require(first.front() == 0 && first.back() == static_cast<int>(size) && std::ranges::is_sorted(first),
            "lists of contacts overlap or are not complete", where_);
    requireSize(contacts_.image.size(), size, "images of contacts", where_);
    requireSize(contacts_.stiffness.size(), size, "stiffnesses of contacts", where_);
    for (std::size_t k = 0; k < 3; ++k)
      requireSize(contacts_.stretch[k].size(), k == 0 || cell_.shape == Shape::sphere ? size : 0,
                  "stretches of component " + std::to_string(k), where_);
    const Springs& springs = cell_.springs;
    requireSize(contacts_.roll.size(), springs.rolls() ? size : 0, "rolls of contacts", where_);
    requireSize(contacts_.tangent.size(), springs.elasticSpheres() && springs.slides() ? size : 0,
                "tangential stiffnesses", where_);
    if (contacts_.bond.empty()) return;
    requireSize(contacts_.bond.size(), size, "bonds of contacts", where_);
    require(cell_.bonds.normal > 0.0, "there are bonds, but no law of them", where_);
  }

  [[noreturn]] void failHere(const std::string& problem) const {
    fail("contact " + std::to_string(at_) + ", of grain " + std::to_string(grain_) + ", " + problem, where_);
  }
  void requireFiniteHere(double value, const char* what) const {
    if (!std::isfinite(value)) failHere(std::string("has ") + what + " of " + formatNumber(value));
  }

  void checkPartner() const {
    const int j = contacts_.other[at_];
    const std::uint8_t image = contacts_.image[at_];
    if (j <= static_cast<int>(grain_) || static_cast<std::size_t>(j) >= cell_.size())
      failHere("is with grain " + std::to_string(j));
    if (image >= 27) failHere("is through image " + std::to_string(image));
    const std::array<int, 3> n{image % 3 - 1, image / 3 % 3 - 1, image / 9 - 1};
    for (std::size_t k = 0; k < 3; ++k)
      if (!axes_[k] && n[k] != 0) failHere("is through an image along an axis that does not repeat");
    if (at_ == static_cast<std::size_t>(contacts_.first[grain_])) return;
    if (!(std::pair(contacts_.other[at_ - 1], contacts_.image[at_ - 1]) < std::pair(j, image)))
      failHere("is listed twice, or out of order");
  }

  void checkSprings() const {
    const double most = normalStiffness(cell_.springs, cell_.radius[grain_],
                                        cell_.radius[static_cast<std::size_t>(contacts_.other[at_])]);
    const double k = contacts_.stiffness[at_];
    if (!(k >= 0.0 && k <= (1.0 + 1e-9) * most))
      failHere("has a stiffness of " + formatNumber(k) + ", its springs one of " + formatNumber(most));
    for (const std::vector<double>& component : contacts_.stretch)
      if (!component.empty()) requireFiniteHere(component[at_], "a stretch");
    if (!contacts_.roll.empty()) requireFiniteHere(contacts_.roll[at_], "a roll");
    if (contacts_.tangent.empty()) return;
    const double kt = contacts_.tangent[at_];
    requireFiniteHere(kt, "a tangential stiffness");
    if (kt < 0.0) failHere("has a tangential stiffness of " + formatNumber(kt));
  }

  void checkBond(const Bond& bond) const {
    requireFiniteHere(bond.length, "a bond with a length");
    requireFiniteHere(bond.fraction, "a bond with a fraction");
    requireFiniteHere(bond.stretch, "a bond with a stretch");
    requireFiniteHere(bond.turn, "a bond with a turn");
    if (bond.length < 0.0) failHere("has a bond with a length of " + formatNumber(bond.length));
    if (bond.length == 0.0) {
      if (bond.fraction != 0.0 || bond.stretch != 0.0 || bond.turn != 0.0) failHere("is not bonded, but has a bond");
      return;
    }
    if (!(bond.fraction > 0.0 && bond.fraction <= 1.0 + 1e-9))
      failHere("has a bond with a fraction of " + formatNumber(bond.fraction));
    if (contacts_.stiffness[at_] != 0.0) failHere("is bonded, and has a stiffness beside the bond's");
  }

  const Rve& cell_;
  const Contacts& contacts_;
  std::array<bool, 3> axes_;
  const std::string& where_;
  std::size_t grain_ = 0, at_ = 0;
};

void checkNumbers(const Rve& cell, const CellState& state, const std::string& where) {
  require(state.F.allFinite() && state.F.determinant() > 0.0, "F is not finite, or turns the cell inside out", where);
  require(cell.shape == Shape::sphere || isPlane(state.F), "F takes discs out of their plane", where);
  require(state.virial.allFinite(), "Σ f ⊗ b is not finite", where);
  require(state.remainingSkin > 0.0 && state.remainingSkin <= cell.skin,
          "the rest of the skin is " + formatNumber(state.remainingSkin) + " m of " + formatNumber(cell.skin), where);
  require(std::isfinite(state.criticalStep) && state.criticalStep > 0.0,
          "the critical step is " + formatNumber(state.criticalStep) + " s", where);
  const RveLedger& ledger = state.ledger;
  for (const double energy : {ledger.work, ledger.friction, ledger.damping, ledger.bonds})
    requireFinite(energy, "an energy of the ledger", where);
  const double expected = cell.volume * state.F.determinant();
  require(std::abs(state.lattice.volume() - expected) <= 1e-6 * expected, "the volume does not match F", where);
}

}  // namespace

void requireSound(const geometry::Lattice& lattice, Shape shape, const std::string& where) {
  for (const Vec3& period : lattice.period) require(isFinite(period), "a period is not finite", where);
  static_cast<void>(geometry::inverse(lattice));
  for (const Vec3& a : lattice.period)
    for (const Vec3& b : lattice.period)
      require(std::abs(dot(a, b)) <= 1e6 * squaredNorm(a), "a period is a million times as long as another", where);
  const auto& [a, b, c] = lattice.period;
  require(shape == Shape::sphere || (a.z == 0.0 && b.z == 0.0 && c.x == 0.0 && c.y == 0.0 && !lattice.axes[2]),
          "the periods of discs are not in their plane", where);
}

void requireSound(const Rve& cell, const CellState& state, const std::string& where) {
  requireSound(state.lattice, cell.shape, where);
  checkNumbers(cell, state, where);
  checkField(cell, state.x, Use::moves, "places", where);
  checkField(cell, state.v, Use::moves, "velocities", where);
  checkField(cell, state.force, Use::moves, "forces", where);
  checkField(cell, state.spin, Use::turns, "spins", where);
  checkField(cell, state.torque, Use::turns, "torques", where);
  checkPlaces(cell, state, where);
  Pairs(cell, state, where).check();
}

}  // namespace dovetail::rve
