#include "dovetail/rve/rve_archive.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <bit>
#include <cmath>
#include <type_traits>

#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"
#include "make_rve.hpp"
#include "own_state.hpp"

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
void listFields(Archive& archive, State& state, Matrix& F, Matrix& virial) {
  archive(state.lattice.period, F, virial, state.remainingSkin, state.criticalStep, state.ledger);
  for (auto* field : {&state.x, &state.v, &state.spin, &state.force, &state.torque, &state.contacts.stretch})
    for (auto& component : *field) archive(component);
  auto& contacts = state.contacts;
  archive(contacts.first, contacts.other, contacts.image, contacts.stiffness, contacts.roll, contacts.tangent,
          contacts.bond);
}

/// FNV-1a, number by number, of what does not change; inertias tell discs from spheres.
std::uint64_t checksum(const Rve& cell) {
  std::uint64_t hash = 14695981039346656037u;
  const auto add = [&hash](double number) { hash = (hash ^ std::bit_cast<std::uint64_t>(number)) * 1099511628211u; };
  const Springs& springs = cell.springs;
  for (const double number :
       {springs.modulus, springs.stiffness, springs.hertz, springs.tangential, springs.friction, springs.rolling,
        springs.rollingLimit, cell.bonds.normal, cell.bonds.shear, cell.bonds.bending, cell.bonds.tensileStrength,
        cell.bonds.shearStrength, cell.bonds.bendingStrength, cell.density, cell.volume, cell.skin})
    add(number);
  for (const std::vector<double>* numbers : {&cell.radius, &cell.mass, &cell.inertia})
    for (const double number : *numbers) add(number);
  for (const int grain : cell.frame.grain) add(grain);
  for (const Condition condition : cell.frame.on) add(static_cast<double>(condition));
  return hash;
}

bool finite(const std::vector<double>& values) {
  return std::ranges::all_of(values, [](double value) { return std::isfinite(value); });
}

enum class Use { moves, turns };

/// Whether there is one number a grain of the components in use: of discs x, y of motions and z of turns.
bool fits(const Rve& cell, const Components& field, Use use) {
  for (std::size_t k = 0; k < 3; ++k) {
    const bool inUse = cell.shape == Shape::sphere || (k == 2) == (use == Use::turns);
    if (field[k].size() != (inUse ? cell.size() : 0) || !finite(field[k])) return false;
  }
  return true;
}

/// Bonds are all there or none, and a cell without a law has none.
bool fits(const Rve& cell, const std::vector<Bond>& bonds, std::size_t contacts) {
  if (bonds.empty()) return true;
  return bonds.size() == contacts && cell.bonds.normal > 0.0 && std::ranges::all_of(bonds, [](const Bond& b) {
           return std::isfinite(b.length + b.fraction + b.stretch + b.turn) && b.length >= 0.0 && b.fraction >= 0.0;
         });
}

bool fits(const Rve& cell, const Contacts& contacts) {
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
         contacts.roll.size() == (cell.springs.rolls() ? size : 0) && finite(contacts.roll) &&
         contacts.tangent.size() == (cell.springs.elasticSpheres() && cell.springs.slides() ? size : 0) &&
         finite(contacts.tangent) && fits(cell, contacts.bond, size);
}

bool fits(const Rve& cell, const CellState& state) {
  for (const Vec3& period : state.lattice.period)
    if (!std::isfinite(norm(period))) return false;
  const RveLedger& ledger = state.ledger;
  return state.F.allFinite() && state.F.determinant() > 0.0 && state.virial.allFinite() &&
         state.lattice.volume() > 0.0 && state.remainingSkin <= cell.skin && std::isfinite(state.remainingSkin) &&
         std::isfinite(state.criticalStep) && state.criticalStep > 0.0 &&
         std::isfinite(ledger.work + ledger.friction + ledger.damping + ledger.bonds) &&
         fits(cell, state.x, Use::moves) && fits(cell, state.v, Use::moves) && fits(cell, state.force, Use::moves) &&
         fits(cell, state.spin, Use::turns) && fits(cell, state.torque, Use::turns) && fits(cell, state.contacts);
}

constexpr const char* samplesKind = "cells of grains";

/// What a cell is made of, for both ways; axes as numbers, so that any byte is one.
struct Made {
  std::uint8_t isDisc = 0;
  std::array<std::uint8_t, 3> repeats{};
  std::array<Vec3, 3> period;
  Springs springs;
  BondLaw bonds;
  double density = 0.0, volume = 0.0;
  double skin = 0.0;
  std::vector<Vec3> centre;
  std::vector<double> radius;
};

template <class Archive, class AnyMade>
requires std::is_same_v<std::remove_const_t<AnyMade>, Made>
void archiveFields(Archive& archive, AnyMade& made) {
  archive(made.isDisc, made.repeats, made.period, made.springs, made.bonds, made.density, made.volume, made.skin,
          made.centre, made.radius);
}

Made madeOf(const Rve& cell) {
  const CellState& state = cell.state;
  Made made{cell.shape == Shape::disc,
            {},
            state.lattice.period,
            cell.springs,
            cell.bonds,
            cell.density,
            cell.volume,
            cell.skin,
            {},
            cell.radius};
  for (std::size_t k = 0; k < 3; ++k) made.repeats[k] = state.lattice.axes[k];
  for (std::size_t i = 0; i < cell.size(); ++i)
    made.centre.push_back({state.x[0][i], state.x[1][i], state.x[2].empty() ? 0.0 : state.x[2][i]});
  return made;
}

Rve cellOf(const Made& made) {
  geometry::Lattice lattice{.period = made.period};
  for (std::size_t k = 0; k < 3; ++k) lattice.axes[k] = made.repeats[k] != 0;
  Rve cell = cellWithoutContacts({made.isDisc ? Shape::disc : Shape::sphere, made.centre, made.radius, made.density},
                                 lattice, made.springs);
  cell.bonds = made.bonds;
  cell.volume = requirePositive(made.volume, "volume of a cell");
  cell.skin = requirePositive(made.skin, "skin of a cell");
  return cell;
}

}  // namespace

void writeState(const Rve& cell, const CellState& state, ByteWriter& archive) {
  requireOwn(cell, state);
  archive(checksum(cell));
  const Numbers F = numbersOf(state.F), virial = numbersOf(state.virial);
  listFields(archive, state, F, virial);
}

CellState readState(const Rve& cell, ByteReader& archive) {
  std::uint64_t writtenFor = 0;
  archive(writtenFor);
  if (writtenFor != checksum(cell))
    throw InputError("the state is of a cell with other grains or springs", "cell of grains",
                     "read it into the cell that wrote it");
  CellState state;
  state.lattice.axes = cell.state.lattice.axes;
  state.springs = cell.springs;
  state.bonds = cell.bonds;
  Numbers F, virial;
  listFields(archive, state, F, virial);
  state.F = Eigen::Map<const Eigen::Matrix3d>(F.data());
  state.virial = Eigen::Map<const Eigen::Matrix3d>(virial.data());
  if (!fits(cell, state))
    throw InputError("the state is inconsistent", "cell of grains", "take an older file, this one is damaged");
  return state;
}

void writeSamples(const std::filesystem::path& path, std::span<const Rve> cells) {
  ByteWriter archive;
  for (const Rve& cell : cells) {
    if (!cell.frame.empty())
      throw InputError("a cell has a frame", path.string(), "write the periodic cell, and cut it after reading");
    archive(madeOf(cell));
    writeState(cell, cell.state, archive);
  }
  writeChecked(path, samplesKind, archive.bytes());
}

std::vector<Rve> readSamples(const std::filesystem::path& path) {
  ByteReader archive(readChecked(path, samplesKind));
  std::vector<Rve> cells;
  while (!archive.atEnd()) {
    Made made;
    archive(made);
    cells.push_back(cellOf(made));
    cells.back().state = readState(cells.back(), archive);
  }
  return cells;
}

}  // namespace dovetail::rve
