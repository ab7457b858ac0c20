// Walls and groups of grains that functions of Python's move.
#include <pybind11/stl.h>

#include <cmath>

#include "dovetail/core/error.hpp"
#include "dovetail/scene/own_motion.hpp"
#include "scene_run.hpp"

namespace dovetail::python {

namespace {

using Function = std::optional<py::function>;

std::function<Vec3(double)> vectorOf(const Function& function, const std::string& what) {
  if (!function) return {};
  return [call = held(*function), what](double time) {
    const py::gil_scoped_acquire lock;
    return vectorsOf(py::cast<Numbers>((*call)(time)), 1, what).front();
  };
}

std::function<double(double)> numberOf(const Function& function, const std::string& what) {
  if (!function) return {};
  return [call = held(*function), what](double time) {
    const py::gil_scoped_acquire lock;
    const double value = py::cast<double>((*call)(time));
    if (!std::isfinite(value)) throw InputError("it is not finite", what, "give a finite number");
    return value;
  };
}

struct Turn {
  Function rate;
  Numbers axis;
  std::optional<Numbers> point;
};

scene::OwnPath pathOf(const std::string& what, const Function& displacement, const Function& velocity,
                      const Turn& turn) {
  scene::OwnPath path{.displacement = vectorOf(displacement, "displacement of " + what),
                      .velocity = vectorOf(velocity, "velocity of " + what),
                      .rate = numberOf(turn.rate, "angular velocity of " + what)};
  path.axis = vectorsOf(turn.axis, 1, "axis of " + what).front();
  if (turn.point) path.point = vectorsOf(*turn.point, 1, "point of " + what).front();
  return path;
}

}  // namespace

void bindDrives(py::module_& m) {
  m.def("_move_wall", [](SceneRun& run, const std::string& wall, const Function& displacement, const Function& velocity,
                         const Function& rate, const Numbers& axis, const std::optional<Numbers>& point) {
    run.requireWhole();
    scene::moveWall(run.built(), run.scene(), wall,
                    pathOf("wall \"" + wall + "\"", displacement, velocity, {rate, axis, point}));
  });
  m.def("_drive_grains",
        [](SceneRun& run, const std::vector<std::int64_t>& ids, const Function& displacement, const Function& velocity,
           const Function& spin, const Function& rate, const Numbers& axis, const std::optional<Numbers>& point) {
          run.requireWhole();
          scene::driveGrains(run.built(), ids, pathOf("a drive", displacement, velocity, {rate, axis, point}),
                             vectorOf(spin, "spin of a drive"));
        });
}

}  // namespace dovetail::python
