// A scene that is run step by step.
#pragma once

#include <pybind11/functional.h>

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "arrays.hpp"
#include "dovetail/scene/build.hpp"

namespace dovetail::python {

/// Built and started at its first stage, whose changes are made.
class SceneRun {
public:
  /// @throws InputError as scene::build and scene::start
  explicit SceneRun(scene::Scene scene);

  /// Macro steps; asks Python now and then whether somebody wants to end (Ctrl-C), which ends between two of them.
  /// @throws InputError if steps is negative or a callback has broken the run off before
  void advance(std::int64_t steps);
  /// A state of this scene. @throws InputError as CoupledRun::load
  void take(const std::vector<char>& state);
  /// @throws InputError after a step that was broken off
  void requireWhole() const;

  /// Forces on grains beside all others: function(t, x, v) gives N for each grain, in the order of ids.
  void addForce(const std::string& name, py::function function);

  const scene::Scene& scene() const { return scene_; }
  scene::Built& built() { return built_; }
  coupling::CoupledRun& run() { return *built_.run; }
  /// Numbers of the grains by ascending id, without those that stand for points of solids.
  const std::vector<int>& grains();

private:
  scene::Scene scene_;
  scene::Built built_;
  std::vector<int> grains_;
  std::int64_t grainsOf_ = -1;
  bool broken_ = false;
};

void bindScenes(py::module_& m);
void bindRun(py::module_& m);
void bindGrains(py::module_& m);
void bindSolids(py::module_& m);

}  // namespace dovetail::python
