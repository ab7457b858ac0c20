// Builds without Ceres fit no parameters.
#include "dovetail/core/error.hpp"
#include "scene_run.hpp"

namespace dovetail::python {

void bindCalibration(py::module_& m) {
  for (const char* const name : {"fit_model", "calibrate_file"})
    m.def(name, [](const py::args&) {
      throw InputError("this build does no calibration", "calibrate", "build with Ceres (libceres-dev)");
    });
}

}  // namespace dovetail::python
