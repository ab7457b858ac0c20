// A scene that is run step by step.
#pragma once

#include <pybind11/functional.h>

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "arrays.hpp"
#include "dovetail/scene/build.hpp"
#include "dovetail/scene/series_row.hpp"

namespace dovetail::python {

/// Built and started as its scene describes it; stages and outputs are left to runs of the whole scene.
class SceneRun {
public:
  /// @param solids  of Python's own, by their names
  /// @throws InputError as scene::build and scene::start; if the first stage changes something
  SceneRun(scene::Scene scene, const py::dict& solids);

  /// Macro steps; asks Python now and then whether somebody wants to end (Ctrl-C), which ends between two of them.
  /// @throws InputError if steps is negative or a callback has broken the run off before
  void advance(std::int64_t steps);
  /// A state of this scene. @throws InputError as CoupledRun::load
  void take(const std::vector<char>& state);
  /// @throws InputError after a step that was broken off
  void requireWhole();

  /// Forces on grains beside all others: function(t, x, v), s, m, m/s, gives N for each grain, (N, 3), in the order of
  /// ids. @throws InputError, before anything has changed, for another shape or numbers that are not finite
  void addForce(const std::string& name, py::function function);

  /// Nobody but the caller, who is given the run, uses it until release(). @throws InputError as run()
  scene::Built& hold();
  void release() { held_ = false; }

  const scene::Scene& scene() const { return scene_; }
  /// Ends the last step first: its second half kick is left open for the next one.
  /// @throws InputError while a step is under way: from a callback, or from another thread; while it is held
  scene::Built& built();
  coupling::CoupledRun& run() { return *built().run; }
  /// Numbers of the grains by ascending id, without those that stand for points of solids.
  const std::vector<int>& grains();
  /// Of the series, with probes that were looked up at the start.
  const scene::SeriesRow& row() const { return *row_; }

private:
  void requireFree() const;
  void requireUnbroken() const;
  void step(const std::function<void()>& part);
  const std::vector<int>& grainsNow();

  scene::Scene scene_;
  scene::Built built_;
  std::unique_ptr<scene::SeriesRow> row_;
  std::vector<int> grains_;
  std::int64_t grainsOf_ = -1;
  bool broken_ = false, steps_ = false, held_ = false;
};

/// An object of Python's, which is copied and let go of with the interpreter's lock alone.
std::shared_ptr<py::object> held(py::object object);

/// Puts solids of Python's own into a run that has not started. @throws InputError for what is missing or does not fit
void addOwnSolids(scene::Built& built, const py::dict& solids);

/// Numbers of rows, (M, perRow). @throws InputError unless they are, each below `below`
std::vector<int> numbersOf(const py::array_t<std::int64_t, py::array::c_style>& rows, std::size_t perRow,
                           std::size_t below, const std::string& what);

void bindScenes(py::module_& m);
void bindRun(py::module_& m);
void bindGrains(py::module_& m);
void bindSolids(py::module_& m);
void bindLooking(py::module_& m);
void bindStudies(py::module_& m);
void bindCalibration(py::module_& m);
void bindCells(py::module_& m);
void bindViews(py::module_& m);
void bindDrives(py::module_& m);
void bindFiles(py::module_& m);

}  // namespace dovetail::python
