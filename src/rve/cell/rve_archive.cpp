#include "dovetail/rve/rve_archive.hpp"

#include <algorithm>
#include <bit>
#include <string>
#include <type_traits>

#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"
#include "make_rve.hpp"
#include "own_state.hpp"
#include "sound_state.hpp"

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
  for (const Freedom& freedom : cell.frame.freedom) {
    for (const int place : freedom.held) add(place);
    for (const std::vector<std::vector<int>>* sets : {&freedom.together, &freedom.balanced}) {
      add(static_cast<double>(sets->size()));
      for (const std::vector<int>& set : *sets)
        for (const int place : set) add(place);
    }
  }
  return hash;
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

/// @throws InputError if it is not what a cell may be made of
Rve cellOf(const Made& made) {
  geometry::Lattice lattice{.period = made.period};
  for (std::size_t k = 0; k < 3; ++k) lattice.axes[k] = made.repeats[k] != 0;
  const Shape shape = made.isDisc ? Shape::disc : Shape::sphere;
  requireSound(lattice, shape, "periods");
  Rve cell = cellWithoutContacts({shape, made.centre, made.radius, made.density}, lattice, made.springs);
  if (made.bonds != BondLaw{}) validate(made.bonds);
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

namespace {

CellState readState(const Rve& cell, ByteReader& archive, const std::string& where) {
  std::uint64_t writtenFor = 0;
  archive(writtenFor);
  if (writtenFor != checksum(cell))
    throw InputError("the state is of a cell with other grains or springs", where,
                     "read it into the cell that wrote it");
  CellState state;
  state.lattice.axes = cell.state.lattice.axes;
  state.springs = cell.springs;
  state.bonds = cell.bonds;
  Numbers F, virial;
  listFields(archive, state, F, virial);
  state.F = Eigen::Map<const Eigen::Matrix3d>(F.data());
  state.virial = Eigen::Map<const Eigen::Matrix3d>(virial.data());
  requireSound(cell, state, where);
  return state;
}

}  // namespace

CellState readState(const Rve& cell, ByteReader& archive) { return readState(cell, archive, "state of a cell"); }

void writeCells(std::span<const Rve> cells, ByteWriter& archive, const std::string& where) {
  for (const Rve& cell : cells) {
    if (!cell.frame.empty())
      throw InputError("a cell has a frame", where, "write the periodic cell, and cut it after reading");
    archive(madeOf(cell));
    writeState(cell, cell.state, archive);
  }
}

std::vector<Rve> readCells(ByteReader& archive, const std::string& from) {
  std::vector<Rve> cells;
  while (!archive.atEnd()) {
    const std::string where = "cell " + std::to_string(cells.size()) + " of " + from;
    Made made;
    archive(made);
    try {
      cells.push_back(cellOf(made));
    } catch (const InputError& error) {
      throw InputError(std::string("it cannot be made: ") + error.what(), where,
                       "take an older file, this one is damaged");
    }
    cells.back().state = readState(cells.back(), archive, where);
  }
  return cells;
}

void writeSamples(const std::filesystem::path& path, std::span<const Rve> cells) {
  ByteWriter archive;
  writeCells(cells, archive, path.string());
  writeChecked(path, samplesKind, archive.bytes());
}

std::vector<Rve> readSamples(const std::filesystem::path& path) {
  ByteReader archive(readChecked(path, samplesKind));
  return readCells(archive, path.string());
}

}  // namespace dovetail::rve
