#include "dovetail/rve/cell_archive.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "dovetail/core/error.hpp"

namespace dovetail::rve {

namespace {

using Numbers = std::array<double, 9>;

Numbers numbersOf(const Eigen::Matrix3d& matrix) {
  Numbers numbers;
  std::copy_n(matrix.data(), 9, numbers.begin());
  return numbers;
}

/// The same list for both ways. Which axes repeat is the cell's own.
template <class Archive, class State, class Matrix>
void listFields(Archive& archive, State& state, Matrix& F, Matrix& dyad) {
  archive(state.lattice.period, F, dyad, state.room, state.criticalStep, state.book);
  for (auto* field : {&state.x, &state.v, &state.spin, &state.force, &state.torque, &state.contacts.stretch})
    for (auto& component : *field) archive(component);
  auto& contacts = state.contacts;
  archive(contacts.first, contacts.other, contacts.image, contacts.stiffness, contacts.roll);
}

/// FNV-1a of what does not change; inertias tell discs from spheres.
std::uint64_t checksum(const Cell& cell) {
  ByteWriter constant;
  constant(cell.springs, cell.radius, cell.mass, cell.inertia, cell.density, cell.volume, cell.skin, cell.frame.grain,
           cell.frame.on, cell.frame.area);
  std::uint64_t hash = 14695981039346656037u;
  for (const char byte : constant.bytes()) hash = (hash ^ static_cast<unsigned char>(byte)) * 1099511628211u;
  return hash;
}

bool finite(const std::vector<double>& values) {
  return std::ranges::all_of(values, [](double value) { return std::isfinite(value); });
}

/// Whether components are in use as in the cell's own state, n numbers each.
bool fits(const Components& field, const Components& own, std::size_t n) {
  for (std::size_t k = 0; k < 3; ++k)
    if (field[k].size() != (own[k].empty() ? 0 : n) || !finite(field[k])) return false;
  return true;
}

bool fits(const Cell& cell, const Contacts& contacts) {
  const std::size_t n = cell.size(), size = contacts.size();
  if (contacts.first.size() != n + 1 || contacts.first.front() != 0 ||
      contacts.first.back() != static_cast<int>(size) || !std::ranges::is_sorted(contacts.first))
    return false;
  const auto isGrain = [n](int j) { return j >= 0 && static_cast<std::size_t>(j) < n; };
  for (std::size_t k = 0; k < 3; ++k)
    if (contacts.stretch[k].size() != (k == 0 || cell.shape == Shape::sphere ? size : 0) ||
        !finite(contacts.stretch[k]))
      return false;
  return std::ranges::all_of(contacts.other, isGrain) && contacts.image.size() == size &&
         std::ranges::all_of(contacts.image, [](std::uint8_t image) { return image < 27; }) &&
         contacts.stiffness.size() == size && finite(contacts.stiffness) &&
         contacts.roll.size() == (cell.springs.rolls() ? size : 0) && finite(contacts.roll);
}

bool fits(const Cell& cell, const CellState& state) {
  const CellState& own = cell.state;
  for (const Vec3& period : state.lattice.period)
    if (!std::isfinite(norm(period))) return false;
  const EnergyBook& book = state.book;
  return state.F.allFinite() && state.F.determinant() > 0.0 && state.dyad.allFinite() && state.lattice.volume() > 0.0 &&
         std::isfinite(state.room) && state.criticalStep > 0.0 &&
         std::isfinite(book.work + book.friction + book.damping) && fits(state.x, own.x, cell.size()) &&
         fits(state.v, own.v, cell.size()) && fits(state.spin, own.spin, cell.size()) &&
         fits(state.force, own.force, cell.size()) && fits(state.torque, own.torque, cell.size()) &&
         fits(cell, state.contacts);
}

}  // namespace

void writeState(const Cell& cell, const CellState& state, ByteWriter& archive) {
  archive(checksum(cell));
  const Numbers F = numbersOf(state.F), dyad = numbersOf(state.dyad);
  listFields(archive, state, F, dyad);
}

CellState readState(const Cell& cell, ByteReader& archive) {
  std::uint64_t writtenFor = 0;
  archive(writtenFor);
  if (writtenFor != checksum(cell))
    throw InputError("the state is of a cell with other grains or springs", "cell of grains",
                     "read it into the cell that wrote it");
  CellState state;
  state.lattice.axes = cell.state.lattice.axes;
  Numbers F, dyad;
  listFields(archive, state, F, dyad);
  state.F = Eigen::Map<const Eigen::Matrix3d>(F.data());
  state.dyad = Eigen::Map<const Eigen::Matrix3d>(dyad.data());
  if (!fits(cell, state))
    throw InputError("the state does not hold together", "cell of grains", "take an older file, this one is damaged");
  return state;
}

}  // namespace dovetail::rve
