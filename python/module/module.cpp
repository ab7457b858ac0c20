// The Python module dovetail._core.
#include <exception>

#include "called_laws.hpp"
#include "dovetail/core/error.hpp"
#include "dovetail/core/parallel.hpp"
#include "scene_run.hpp"

namespace dovetail::python {

namespace {

void bindErrors(py::module_& m) {
  static py::exception<InputError> input(m, "InputError", PyExc_ValueError);
  static py::exception<NumericalError> numerical(m, "NumericalError", PyExc_RuntimeError);
  py::register_exception_translator([](std::exception_ptr thrown) {
    try {
      if (thrown) std::rethrow_exception(thrown);
    } catch (const InputError& error) {
      input(error.what());
    } catch (const NumericalError& error) {
      numerical(error.what());
    }
  });
}

}  // namespace

PYBIND11_MODULE(_core, m) {
  m.doc() = "Grains and solids in one run; import dovetail in place of this.";
  bindErrors(m);
  m.def("set_threads", &setThreads, py::arg("count"), "Threads of all runs from now on; digits do not depend on them.");
  m.def("threads", &threads, "Threads of all runs.");
  bindScenes(m);
  bindRun(m);  // before what takes one, whose docstrings name it
  bindGrains(m);
  bindSolids(m);
  bindLooking(m);
  bindStudies(m);
  bindCalibration(m);
  bindCells(m);
  bindOwnLaws(m);
  bindViews(m);
  bindDrives(m);
  bindFiles(m);
}

}  // namespace dovetail::python
