// What a file of cells asks for: banks of cells, and tests of them.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "dovetail/rve/drive.hpp"
#include "dovetail/scene/make_cells.hpp"

namespace dovetail::program {

enum class TestKind { isotropic, oedometer, biaxial, triaxial, shear };

/// A test of all cells of a bank.
struct CellTest {
  std::string where, name;
  TestKind kind = TestKind::biaxial;
  std::string cells;  ///< name of the bank; empty: the only one
  int axis = 1;       ///< that is shortened
  bool constantVolume = false;
  std::optional<double> pressure;  ///< all round, before the test; Pa
  double strain = scene::required;
  std::optional<double> backTo;  ///< strain to which it goes back at the end
  int outputs = 100;
  std::optional<double> rest;  ///< unbalanced force at every output
  double inertialNumber = 1e-3;
};

/// Secant moduli of all cells.
struct SecantPlan {
  double least = 1e-5, most = 1e-2;
  int outputs = 10;
};

struct CellPlan {
  std::string title;
  scene::Parameters parameters;
  std::vector<scene::Cells> cells;
  std::optional<SecantPlan> secants;
  std::vector<CellTest> tests;

  /// The bank that a test is of.
  const scene::Cells& cellsOf(const CellTest& test) const;
};

/// @throws InputError as scene::readScene; for names that are there twice or stand for nothing, and tests that the
/// grains cannot take
CellPlan readCellPlan(const std::string& file, const std::vector<std::string>& settings);

/// How a test drives a cell whose sides have this pressure.
rve::Drive driveOf(const CellTest& test, rve::Shape shape, double pressure);

/// All that makes a bank, as text.
std::string textOfCells(scene::Cells cells);

std::string cellReference();
std::string cellSchema();

}  // namespace dovetail::program
