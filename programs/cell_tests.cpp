#include "cell_tests.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <mutex>
#include <ostream>

#include "dovetail/core/error.hpp"
#include "dovetail/core/parallel.hpp"
#include "dovetail/core/progress.hpp"
#include "dovetail/io/interruption.hpp"
#include "dovetail/io/plain_text.hpp"
#include "dovetail/io/provenance.hpp"
#include "dovetail/rve/equilibrium.hpp"
#include "dovetail/rve/operators.hpp"
#include "dovetail/rve/rve_archive.hpp"
#include "dovetail/scene/files.hpp"

namespace dovetail::program {

namespace {

/// The bar on the terminal, from several threads.
class Counter {
public:
  explicit Counter(double total) : progress_("cells", total) {}

  /// @throws NumericalError if the program is asked to end
  void count(const std::string& what) {
    const std::scoped_lock lock(mutex_);
    progress_.update(++done_, what);
    if (io::interruption() != 0) throw NumericalError(io::nameOfInterruption(), what, "");
  }

private:
  std::mutex mutex_;
  Progress progress_;
  double done_ = 0.0;
};

CellBank bankOf(const scene::Cells& cells, const std::filesystem::path& folder, std::ostream& log) {
  if (const auto* const from = std::get_if<scene::CellFile>(&cells.grains)) {
    CellBank bank{cells.name, scene::makeCells(cells), true, from->file, {}};
    log << "cells \"" << bank.name << "\": " << bank.cells.size() << " read from " << from->file << std::endl;
    return bank;
  }
  const auto begun = std::chrono::steady_clock::now();
  std::string inputs = textOfCells(cells) + io::buildInfo().version + io::buildInfo().commit;
  if (const auto* const cut = std::get_if<scene::CutCells>(&cells.grains))
    inputs += scene::hashOf(io::readWhole(cut->file, "packing"));
  CellBank bank{cells.name, {}, false, folder / (cells.name + "-" + scene::hashOf(inputs) + ".cells"), {}};
  bank.reused = std::filesystem::exists(bank.file);
  if (bank.reused) {
    bank.cells = rve::readSamples(bank.file);
  } else {
    bank.cells = scene::makeCells(cells);
    rve::writeSamples(bank.file, bank.cells);
  }
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count();
  log << "cells \"" << bank.name << "\": " << bank.cells.size()
      << (bank.reused ? " read from " + bank.file.string() + ", as their inputs are unchanged"
                      : " made in " + formatDuration(seconds) + ", kept in " + bank.file.string())
      << std::endl;
  return bank;
}

CellFigures figuresOf(const rve::Rve& cell, const CellPlan& plan) {
  CellFigures found{rve::solidFraction(cell),
                    rve::balance(cell).coordination,
                    rve::stress(cell).pressure,
                    rve::fabric(cell),
                    {},
                    {},
                    {},
                    {}};
  found.elastic = rve::moduliOf(cell, rve::elasticTangent(cell));
  found.frictional = rve::moduliOf(cell, rve::frictionalTangent(cell));
  found.voigt = rve::moduliOf(cell, rve::voigtTangent(cell));
  if (plan.secants)
    found.secants =
        rve::secantModuli(cell, rve::growingStrains(plan.secants->least, plan.secants->most, plan.secants->outputs));
  return found;
}

/// To the end, and back if that is asked for.
std::vector<double> strainsOf(const CellTest& test) {
  std::vector<double> strains = rve::equalStrains(test.strain, test.outputs);
  for (int k = 1; test.backTo && k <= test.outputs; ++k)
    strains.push_back(test.strain + (*test.backTo - test.strain) * k / test.outputs);
  return strains;
}

CellCourse courseOf(rve::Rve cell, const CellTest& test, double pressure, Counter& counter) {
  CellCourse course;
  try {
    if (test.pressure)
      rve::compress(cell, {.pressure = {pressure, pressure, pressure}, .friction = cell.springs.friction});
    rve::DriveOptions options{.inertialNumber = test.inertialNumber};
    if (test.rest) options.rest = RestCriterion{.tolerance = *test.rest};
    rve::drive(cell, driveOf(test, cell.shape, pressure), strainsOf(test), options, [&](const rve::DrivenState& state) {
      course.states.push_back(state);
      counter.count(test.name);
    });
  } catch (const NumericalError& error) {
    course.failure = error.what();
  }
  return course;
}

TestResult prepared(const CellTest& test, const CellBank& bank) {
  const rve::Rve& first = bank.cells.front();
  TestResult result{&test, first.shape, test.pressure.value_or(rve::stress(first).pressure), {}};
  result.courses.resize(bank.cells.size());
  driveOf(test, result.shape, result.pressure);
  return result;
}

}  // namespace

std::vector<const CellCourse*> TestResult::whole() const {
  std::vector<const CellCourse*> all;
  for (const CellCourse& course : courses)
    if (course.failure.empty()) all.push_back(&course);
  return all;
}

bool CellResults::allDone() const {
  if (interrupted) return false;
  return std::ranges::all_of(tests, [](const TestResult& one) { return one.whole().size() == one.courses.size(); });
}

CellResults testCells(const CellPlan& plan, const std::filesystem::path& folder, std::ostream& log) {
  const auto begun = std::chrono::steady_clock::now();
  CellResults results;
  for (const scene::Cells& cells : plan.cells) {
    results.banks.push_back(bankOf(cells, folder, log));
    results.banks.back().figures.resize(results.banks.back().cells.size());
  }
  const auto bankNamed = [&](const std::string& name) -> CellBank& {
    return *std::ranges::find(results.banks, name, &CellBank::name);
  };
  // Each cell before its tests, and each cell in each test.
  std::vector<std::function<void(Counter&)>> tasks;
  double total = 0.0;
  for (const CellTest& test : plan.tests) results.tests.push_back(prepared(test, bankNamed(plan.cellsOf(test).name)));
  for (CellBank& bank : results.banks)
    for (std::size_t k = 0; k < bank.cells.size(); ++k, ++total)
      tasks.emplace_back([&bank, &plan, k](Counter& counter) {
        bank.figures[k] = figuresOf(bank.cells[k], plan);
        counter.count(bank.name);
      });
  for (TestResult& result : results.tests) {
    const CellBank& bank = bankNamed(plan.cellsOf(*result.test).name);
    for (std::size_t k = 0; k < bank.cells.size();
         ++k, total += static_cast<double>(strainsOf(*result.test).size() + 1))
      tasks.emplace_back([&result, &bank, k](Counter& counter) {
        result.courses[k] = courseOf(bank.cells[k], *result.test, result.pressure, counter);
      });
  }
  {
    Counter counter(total);
    try {
      parallelTasks(tasks.size(), [&](std::size_t k) { tasks[k](counter); });
    } catch (const Error&) {
      if (io::interruption() == 0) throw;
    }
  }
  results.interrupted = io::interruption() != 0;
  results.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count();
  return results;
}

}  // namespace dovetail::program
