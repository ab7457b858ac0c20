// Banks of cells, made or read again, and what became of their tests.
#pragma once

#include <filesystem>
#include <functional>
#include <iosfwd>
#include <string>
#include <vector>

#include "cell_plan.hpp"
#include "dovetail/rve/moduli.hpp"

namespace dovetail::program {

/// A cell before any test.
struct CellFigures {
  double solidFraction = 0.0, coordination = 0.0, pressure = 0.0;
  Eigen::Matrix3d fabric = Eigen::Matrix3d::Zero();
  rve::Moduli elastic, frictional, voigt;  ///< of the tangents, Pa
  rve::SecantModuli secants;               ///< empty where none are asked for

  double voidRatio() const { return 1.0 / solidFraction - 1.0; }
};

struct CellBank {
  std::string name;
  std::vector<rve::Rve> cells;
  bool reused = false;
  std::filesystem::path file;
  std::vector<CellFigures> figures;
};

/// What one cell did in a test; a failure says why it went no further.
struct CellCourse {
  std::vector<rve::DrivenState> states;
  std::string failure;
};

struct TestResult {
  const CellTest* test = nullptr;
  rve::Shape shape = rve::Shape::disc;
  double pressure = 0.0;  ///< that sides keep, Pa
  std::vector<CellCourse> courses;

  /// Courses that came to their end.
  std::vector<const CellCourse*> whole() const;
};

struct CellResults {
  std::vector<CellBank> banks;
  std::vector<TestResult> tests;
  bool interrupted = false;
  double seconds = 0.0;

  bool allDone() const;
};

/// Makes the banks, or reads those that the folder has from the same inputs by the same program, and tests all cells,
/// each cell and test a task of its own.
/// @throws InputError as scene::makeCells and driveOf; NumericalError where a cell cannot be made
CellResults testCells(const CellPlan& plan, const std::filesystem::path& folder, std::ostream& log);

/// A column of the curves.
struct CurveColumn {
  const char* name;  ///< with the unit, as in series.csv
  double (*value)(const rve::DrivenState& state);
};
const std::vector<CurveColumn>& curveColumns();

/// Values of a column along a course.
std::vector<double> valuesOf(const CellCourse& course, const CurveColumn& column);

/// A number that a test is done for.
struct TestNumber {
  std::string name, unit;
  std::vector<double> values;  ///< one for each whole course
};
std::vector<TestNumber> numbersOf(const TestResult& result);

double meanOf(const std::vector<double>& values);
double deviationOf(const std::vector<double>& values);  ///< standard, of the sample; 0 of one value

/// Curves as CSV, numbers as JSON, report.html and report.md with its figures. @return the text that is printed
std::string writeCellFiles(const CellPlan& plan, const CellResults& results, const std::filesystem::path& folder,
                           const std::vector<std::string>& shown);
/// Names of the files that the plan's results are written to, but figures.
std::vector<std::string> cellFiles(const CellPlan& plan);

}  // namespace dovetail::program
