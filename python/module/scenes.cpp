// Scenes as a whole: what the program's verbs do.
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <filesystem>
#include <ostream>
#include <sstream>

#include "callbacks.hpp"
#include "dovetail/io/interruption.hpp"
#include "dovetail/io/output_folder.hpp"
#include "dovetail/scene/execute.hpp"
#include "dovetail/scene/read.hpp"
#include "scene_run.hpp"

namespace dovetail::python {

namespace fs = std::filesystem;

namespace {

scene::Scene sceneOf(const std::string& text, const std::string& name, const fs::path& folder,
                     const std::vector<std::string>& settings) {
  return scene::sceneFromText(text, name, folder, settings);
}

void runScene(const scene::Scene& scene, const fs::path& folder, bool replace, const py::function& write,
              bool progress) {
  if (!replace) io::requireNoRun(folder);
  const io::InterruptionGuard guard;
  Lines lines(write);
  std::ostream log(&lines);
  const bool finished = [&] {
    const py::gil_scoped_release free;
    return scene::run(scene, {.folder = folder, .progress = progress}, log);
  }();
  endAs(finished);
}

void resumeRun(const fs::path& folder, std::optional<double> until, const py::function& write, bool progress) {
  const io::InterruptionGuard guard;
  Lines lines(write);
  std::ostream log(&lines);
  const bool finished = [&] {
    const py::gil_scoped_release free;
    return scene::resume({.folder = folder, .progress = progress, .until = until}, log);
  }();
  endAs(finished);
}

std::string checkScene(const scene::Scene& scene) {
  std::ostringstream log;
  const py::gil_scoped_release free;
  scene::check(scene, log);
  return log.str();
}

}  // namespace

void bindScenes(py::module_& m) {
  py::class_<scene::Scene>(m, "Scene", "All that a scene file says.")
      .def(py::init(&sceneOf), py::arg("text"), py::arg("name"), py::arg("folder"), py::arg("settings"))
      .def("__str__", &scene::sceneText, "The scene in full, in SI units, as JSON.");
  m.def("read_scene", [](const fs::path& file, const std::vector<std::string>& settings) {
    return scene::readScene(file, settings);
  });
  m.def("run_scene", &runScene);
  m.def("resume_run", &resumeRun);
  m.def("check_scene", &checkScene);
  m.def("schema", &scene::schemaText, "JSON Schema of scenes, as text.");
}

}  // namespace dovetail::python
