#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <limits>
#include <random>

#include "cells.hpp"
#include "dovetail/core/error.hpp"
#include "dovetail/rve/rve_archive.hpp"

namespace dovetail::rve {
namespace {

constexpr double notANumber = std::numeric_limits<double>::quiet_NaN();

std::vector<char> bytesOf(const Rve& cell) {
  ByteWriter archive;
  writeState(cell, cell.state, archive);
  return archive.bytes();
}

std::vector<Rve> movedCells() {
  std::vector<Rve> cells{pressedDiscs(60), pressedSpheres(64)};
  followPath(cells[0], plane(0.998, 1e-3, 0.0, 1.001));
  Eigen::Matrix3d F = Eigen::Matrix3d::Identity();
  F(2, 2) = 0.999;
  followPath(cells[1], F, {.rest = {.steps = 0}});  // in motion
  return cells;
}

TEST(CellArchive, CellsGoOnFromAFileWithTheSameDigits) {
  const std::filesystem::path path = std::filesystem::path(testing::TempDir()) / "cells_go_on.cells";
  std::vector<Rve> cells = movedCells();
  Springs rolling = cells[0].springs;
  rolling.rolling = 0.5;
  rolling.rollingLimit = 0.1;
  cells.push_back(cells[0]);
  setSprings(cells.back(), rolling);
  writeSamples(path, cells);
  std::vector<Rve> read = readSamples(path);
  ASSERT_EQ(read.size(), cells.size());
  for (std::size_t k = 0; k < cells.size(); ++k) {
    EXPECT_EQ(bytesOf(cells[k]), bytesOf(read[k]));
    for (Rve* cell : {&cells[k], &read[k]})
      for (int n = 0; n < 20; ++n) step(*cell, 0.5 * cell->state.criticalStep, plane(1.0, 1e-4, 0.0, 0.9999), 0.1);
    EXPECT_EQ(bytesOf(cells[k]), bytesOf(read[k]));
    EXPECT_EQ(nominalStress(cells[k]), nominalStress(read[k]));
  }
  std::filesystem::remove(path);
}

TEST(CellArchive, SpoiltFilesAndFramedCellsAreRefused) {
  const std::filesystem::path path = std::filesystem::path(testing::TempDir()) / "cells_spoilt.cells";
  const Rve cell = squareArray(5);
  writeSamples(path, std::span(&cell, 1));
  {
    std::fstream file(path, std::ios::in | std::ios::out | std::ios::binary);
    file.seekp(200);
    file.put('x');
  }
  EXPECT_THROW(readSamples(path), InputError);
  const Rve cut = framed(pressedDiscs(60), everywhere(Condition::periodic));
  EXPECT_THROW(writeSamples(path, std::span(&cut, 1)), InputError);
  EXPECT_THROW(readSamples(path.string() + " that is not there"), InputError);
  std::filesystem::remove(path);
}

TEST(CellArchive, StatesOfOtherCellsAndCutOnesAreRefused) {
  const Rve cell = squareArray(5);
  const std::vector<char> bytes = bytesOf(cell);
  ByteReader whole(bytes);
  EXPECT_EQ(readState(cell, whole).x, cell.state.x);
  Rve stiffer = cell;
  Springs springs = cell.springs;
  springs.stiffness *= 2.0;
  setSprings(stiffer, springs);
  ByteReader others(bytes);
  EXPECT_THROW(readState(stiffer, others), InputError);
  for (std::size_t length = 0; length < bytes.size(); length += 101) {
    ByteReader cut(std::vector<char>(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(length)));
    EXPECT_THROW(readState(cell, cut), InputError);
  }
}

TEST(CellArchive, WhatDoesNotHoldTogetherIsRefused) {
  const Rve cell = squareArray(5);
  const auto refused = [&](auto&& spoil) {
    CellState state = cell.state;
    spoil(state);
    const auto pass = [&] {
      ByteWriter archive;
      writeState(cell, state, archive);
      ByteReader bytes(archive.bytes());
      readState(cell, bytes);
    };
    EXPECT_THROW(pass(), InputError);
  };
  refused([](CellState& s) { s.contacts.other[0] = 25; });
  refused([](CellState& s) { s.contacts.other[0] = -1; });
  refused([](CellState& s) { s.contacts.other[s.contacts.size() - 1] = 0; });
  refused([](CellState& s) { s.contacts.other[0] = s.contacts.other[1]; });
  refused([](CellState& s) { s.contacts.image[0] = 27; });
  refused([](CellState& s) { s.contacts.image[0] = 4; });  // across the plane
  refused([](CellState& s) { s.contacts.first[1] = 1000; });
  refused([](CellState& s) { s.contacts.stretch[0].pop_back(); });
  refused([](CellState& s) { s.contacts.stretch[0][2] = notANumber; });
  refused([](CellState& s) { s.contacts.stiffness.pop_back(); });
  refused([](CellState& s) { s.contacts.stiffness[3] = -1.0; });
  refused([](CellState& s) { s.contacts.stiffness[3] *= 1.001; });
  refused([](CellState& s) { s.contacts.roll.resize(s.contacts.size()); });
  refused([](CellState& s) { s.contacts.bond.resize(s.contacts.size()); });  // there is no law
  refused([](CellState& s) { s.x[0].pop_back(); });
  refused([](CellState& s) { s.x[2] = s.x[0]; });
  refused([](CellState& s) { s.x[1][4] += 1.0; });
  refused([](CellState& s) { s.spin[2].clear(); });
  refused([](CellState& s) { s.v[1][3] = notANumber; });
  refused([](CellState& s) { s.torque[2][3] = notANumber; });
  refused([](CellState& s) { s.F(0, 0) = -1.0; });
  refused([](CellState& s) { s.virial(0, 0) = notANumber; });
  refused([](CellState& s) { s.lattice.period[0] = s.lattice.period[1]; });
  refused([](CellState& s) { s.lattice.period[2].z *= 1.1; });
  refused([](CellState& s) { s.criticalStep = 0.0; });
  refused([](CellState& s) { s.remainingSkin = 1.0; });
  refused([](CellState& s) { s.remainingSkin = 0.0; });
  refused([](CellState& s) { s.ledger.bonds = notANumber; });
}

TEST(CellArchive, BondsThatNoContactHasAreRefusedByCellAndContact) {
  Rve cell = squareArray(5);
  bond(cell, {.normal = 1e4, .shear = 2e3, .bending = 1e-3});
  const std::filesystem::path path = std::filesystem::path(testing::TempDir()) / "cells_bonded.cells";
  const auto refused = [&](const std::string& what, auto&& spoil) {
    Rve spoilt = cell;
    std::size_t at = 7;
    while (!(cell.state.contacts.bond[at].length > 0.0)) ++at;
    spoil(spoilt.state.contacts, at);
    writeSamples(path, std::vector<Rve>{cell, spoilt});
    try {
      readSamples(path);
      ADD_FAILURE() << what;
    } catch (const InputError& error) {
      const std::string text = error.what();
      EXPECT_NE(text.find("contact " + std::to_string(at) + ","), std::string::npos) << text;
      EXPECT_NE(text.find(what), std::string::npos) << text;
      EXPECT_NE(text.find("cell 1 of"), std::string::npos) << text;
    }
  };
  refused("length", [](Contacts& c, std::size_t at) { c.bond[at].length = notANumber; });
  refused("length", [](Contacts& c, std::size_t at) { c.bond[at].length = -1e-3; });
  refused("fraction", [](Contacts& c, std::size_t at) { c.bond[at].fraction = 1.5; });
  refused("fraction", [](Contacts& c, std::size_t at) { c.bond[at].fraction = 0.0; });
  refused("stretch", [](Contacts& c, std::size_t at) { c.bond[at].stretch = notANumber; });
  refused("turn", [](Contacts& c, std::size_t at) { c.bond[at].turn = -std::numeric_limits<double>::infinity(); });
  refused("not bonded", [](Contacts& c, std::size_t at) { c.bond[at].length = 0.0; });
  refused("stiffness", [](Contacts& c, std::size_t at) { c.stiffness[at] = 1e4; });
  cell.bonds.shearStrength = cell.state.bonds.shearStrength = -1.0;
  writeSamples(path, std::vector<Rve>{cell});
  EXPECT_THROW(readSamples(path), InputError);
  std::filesystem::remove(path);
}

/// Bytes of all kinds of cells with a few of them spoilt: what is read goes on or breaks down, and nothing else
/// happens.
TEST(CellArchive, SpoiltBytesAreAnErrorOrGoOn) {
  std::vector<Rve> cells = movedCells();
  cells.push_back(squareArray(5));
  bond(cells.back(), {.normal = 1e4, .shear = 2e3});
  cells.push_back(pressedSpheres(64));
  setSprings(cells.back(), hertzMindlin(3e8, 0.2, 0.4));
  cells.push_back(framed(pressedDiscs(60), everywhere(Condition::periodic)));
  std::mt19937 random(11);
  int refused = 0, wentOn = 0;
  for (const Rve& cell : cells) {
    const std::vector<char> bytes = bytesOf(cell);
    for (int k = 0; k < 400; ++k) {
      std::vector<char> spoilt = bytes;
      std::uniform_int_distribution<std::size_t> place(8, bytes.size() - 1);
      const std::size_t at = place(random), wide = k % 3 == 0 ? 1 : 8;
      for (std::size_t b = at; b < std::min(at + wide, bytes.size()); ++b) spoilt[b] = static_cast<char>(random());
      ByteReader archive(spoilt);
      Rve read = cell;
      try {
        read.state = readState(cell, archive);
        for (int n = 0; n < 3; ++n) step(read, 0.5 * read.state.criticalStep, 0.999 * Eigen::Matrix3d::Identity(), 0.1);
        ++wentOn;
      } catch (const Error&) {
        ++refused;
      }
    }
  }
  EXPECT_GT(refused, 200);
  EXPECT_GT(wentOn, 200);
}

}  // namespace
}  // namespace dovetail::rve
