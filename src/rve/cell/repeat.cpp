// Copies of a cell, side by side.
#include <algorithm>
#include <string>
#include <tuple>

#include "contacts/contact_list.hpp"
#include "dovetail/core/error.hpp"
#include "dovetail/rve/rve.hpp"

namespace dovetail::rve {

namespace {

constexpr const char* where = "copies of a cell";

/// One period of the reduced lattice that repeats.
struct Thinnest {
  std::size_t axis = 0;
  double width = 0.0;  ///< m
};

Thinnest thinnest(const geometry::Lattice& reduced) {
  const std::array<double, 3> widths = reduced.widths();
  Thinnest found;
  for (std::size_t k = 0; k < 3; ++k)
    if (reduced.axes[k] && (found.width == 0.0 || widths[k] < found.width)) found = {k, widths[k]};
  return found;
}

/// Each number twice.
template <class Number>
void doubleEach(std::vector<Number>& numbers) {
  std::vector<Number> twice;
  twice.reserve(2 * numbers.size());
  for (const Number& number : numbers) twice.insert(twice.end(), 2, number);
  numbers = std::move(twice);
}

/// A contact through image n of the period is, from copy c, with copy (c + n) mod 2 through image ⌊(c + n)/2⌋.
struct Copied {
  int other;
  std::uint8_t image;
  std::size_t from;
  bool operator<(const Copied& b) const { return std::tie(other, image) < std::tie(b.other, b.image); }
};

Copied copied(const Contacts& old, std::size_t contact, int copy, std::size_t axis) {
  constexpr std::array<int, 3> place{1, 3, 9};
  const int code = old.image[contact], n = code / place[axis] % 3 - 1;
  const int at = copy + n, image = at < 0 ? -1 : at / 2;
  return {2 * old.other[contact] + (at - 2 * image), static_cast<std::uint8_t>(code + place[axis] * (image - n)),
          contact};
}

template <class Number>
void take(std::vector<Number>& numbers, const std::vector<Copied>& order) {
  if (numbers.empty()) return;
  std::vector<Number> taken;
  taken.reserve(order.size());
  for (const Copied& one : order) taken.push_back(numbers[one.from]);
  numbers = std::move(taken);
}

void repeat(Contacts& contacts, std::size_t axis) {
  std::vector<Copied> order;
  std::vector<int> first{0};
  for (std::size_t i = 0; i + 1 < contacts.first.size(); ++i)
    for (const int copy : {0, 1}) {
      const auto begun = static_cast<std::ptrdiff_t>(order.size());
      for (int c = contacts.first[i]; c < contacts.first[i + 1]; ++c)
        order.push_back(copied(contacts, static_cast<std::size_t>(c), copy, axis));
      std::sort(order.begin() + begun, order.end());
      first.push_back(static_cast<int>(order.size()));
    }
  for (std::vector<double>* numbers : {&contacts.stiffness, &contacts.stretch[0], &contacts.stretch[1],
                                       &contacts.stretch[2], &contacts.roll, &contacts.tangent})
    take(*numbers, order);
  take(contacts.bond, order);
  contacts.first = std::move(first);
  contacts.other.clear(), contacts.image.clear();
  for (const Copied& one : order) {
    contacts.other.push_back(one.other);
    contacts.image.push_back(one.image);
  }
}

void repeat(CellState& s, std::size_t axis) {
  for (Components* field : {&s.x, &s.v, &s.spin, &s.force, &s.torque})
    for (std::vector<double>& component : *field) doubleEach(component);
  const Vec3 period = s.lattice.period[axis];
  for (std::size_t k = 0; k < 3; ++k)
    for (std::size_t i = 1; i < s.x[k].size(); i += 2) s.x[k][i] += period[static_cast<int>(k)];
  s.lattice.period[axis] = 2.0 * period;
  repeat(s.contacts, axis);
  s.virial *= 2.0;
  for (double* energy : {&s.ledger.work, &s.ledger.friction, &s.ledger.damping, &s.ledger.bonds}) *energy *= 2.0;
}

}  // namespace

double relativeWidth(const Rve& cell) {
  geometry::Lattice lattice = cell.state.lattice;
  geometry::reduce(lattice);
  return thinnest(lattice).width / (2.0 * listReach(cell));
}

void repeat(Rve& cell) {
  if (!cell.frame.empty())
    throw InputError("a cell with a frame does not repeat", where, "repeat the periodic cell, and cut it afterwards");
  Rve twice = inCopies(cell, 1, 2);
  updateNeighbourList(cell, true);
  repeat(cell.state, thinnest(cell.state.lattice).axis);
  twice.state = std::move(cell.state);
  cell = std::move(twice);
}

Rve inCopies(const Rve& cell, int are, int wanted) {
  if (are < 1 || wanted < 1 || cell.size() % static_cast<std::size_t>(are) != 0)
    throw InputError(std::to_string(wanted) + " copies of a cell that is " + std::to_string(are) + " of " +
                         std::to_string(cell.size()) + " grains",
                     where, "give numbers above 0 that fit the grains");
  Rve result = cell;
  result.state = {};
  result.state.lattice.axes = cell.state.lattice.axes;
  result.volume = cell.volume / are * wanted;
  const auto from = static_cast<std::size_t>(are), to = static_cast<std::size_t>(wanted);
  const std::size_t size = cell.size() / from * to;
  for (auto numbers : {&Rve::radius, &Rve::mass, &Rve::inertia}) {
    (result.*numbers).resize(size);
    for (std::size_t i = 0; i < size; ++i) (result.*numbers)[i] = (cell.*numbers)[i / to * from];
  }
  return result;
}

}  // namespace dovetail::rve
