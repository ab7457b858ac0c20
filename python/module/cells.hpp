// Cells of grains of Python's.
#pragma once

#include <Eigen/Core>
#include <utility>

#include "arrays.hpp"
#include "dovetail/core/error.hpp"
#include "dovetail/rve/operators.hpp"
#include "dovetail/rve/rve.hpp"

namespace dovetail::python {

/// A cell that one thread at a time changes, and nobody looks at meanwhile.
class Cell {
public:
  explicit Cell(rve::Rve cell) : cell_(std::move(cell)) {}

  /// @throws InputError while another thread changes it
  const rve::Rve& now() const {
    if (state_ == State::changing)
      throw InputError("the cell is being changed", "Rve", "wait for the end, or take a copy before");
    return cell_;
  }
  /// Changes it while other threads of Python go on. @throws InputError if that is under way
  template <class Act>
  auto change(Act act) {
    if (state_ != State::idle)
      throw InputError("the cell is being changed", "Rve", "wait for the end, or change a copy");
    const Being changing(state_, State::changing);
    const py::gil_scoped_release free;
    return act(cell_);
  }
  /// Within a change, with the interpreter's lock: it can be looked at.
  template <class Act>
  void show(Act act) {
    const Being shown(state_, State::shown);
    act();
  }

private:
  enum class State { idle, changing, shown };
  struct Being {
    Being(State& of, State now) : state(of), before(std::exchange(of, now)) {}
    ~Being() { state = before; }
    Being(const Being&) = delete;
    Being& operator=(const Being&) = delete;
    State& state;
    State before;
  };

  rve::Rve cell_;
  State state_ = State::idle;
};

/// (3, 3)
Numbers arrayOf(const Eigen::Matrix3d& a);
/// (N, 3, 3)
Numbers arrayOf(const std::vector<Eigen::Matrix3d>& a);
/// @throws InputError unless the shape is (3, 3) and all numbers are finite; `open`: some may be NaN
Eigen::Matrix3d matrixOf(const Numbers& a, const char* what, bool open = false);

/// States, ledger and contacts of a cell.
void bindCellState(py::class_<Cell>& type);
/// Its verbs.
void bindCellVerbs(py::class_<Cell>& type);

}  // namespace dovetail::python
