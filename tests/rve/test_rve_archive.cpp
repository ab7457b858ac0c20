#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "cells.hpp"
#include "dovetail/core/error.hpp"
#include "dovetail/rve/rve_archive.hpp"

namespace dovetail::rve {
namespace {

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
  refused([](CellState& s) { s.contacts.image[0] = 27; });
  refused([](CellState& s) { s.contacts.first[1] = 1000; });
  refused([](CellState& s) { s.contacts.stretch[0].pop_back(); });
  refused([](CellState& s) { s.contacts.stiffness.pop_back(); });
  refused([](CellState& s) { s.x[0].pop_back(); });
  refused([](CellState& s) { s.x[2] = s.x[0]; });
  refused([](CellState& s) { s.spin[2].clear(); });
  refused([](CellState& s) { s.v[1][3] = std::nan(""); });
  refused([](CellState& s) { s.F(0, 0) = -1.0; });
  refused([](CellState& s) { s.lattice.period[0] = s.lattice.period[1]; });
  refused([](CellState& s) { s.criticalStep = 0.0; });
}

}  // namespace
}  // namespace dovetail::rve
