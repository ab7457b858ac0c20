// Solids of a run as arrays by nodes.
#include <pybind11/stl.h>

#include "dovetail/fem/model/model.hpp"
#include "scene_run.hpp"

namespace dovetail::python {

namespace {

struct Solid {
  SceneRun& run;
  std::size_t number;

  const coupling::SolidSide& side() const { return run.run().solid(number); }
  const fem::Nodes& nodes() const { return side().nodes(); }
};

Numbers placesOf(const Solid& s) {
  std::vector<Vec3> x = s.nodes().X;
  for (std::size_t n = 0; n < x.size(); ++n) x[n] += s.nodes().u[n];
  return arrayOf(x);
}

}  // namespace

void bindSolids(py::module_& m) {
  py::class_<Solid>(m, "Solid", "A solid of a run. Arrays are copies, one row a node.")
      .def(py::init([](SceneRun& run, std::size_t number) {
             return Solid{run, number};
           }),
           py::keep_alive<1, 2>())
      .def_property_readonly(
          "name", [](const Solid& s) { return s.side().name; }, "That of the scene.")
      .def(
          "__len__", [](const Solid& s) { return s.nodes().X.size(); }, "Number of nodes.")
      .def_property_readonly(
          "X", [](const Solid& s) { return arrayOf(s.nodes().X); }, "Undeformed places, m; (N, 3).")
      .def_property_readonly(
          "u", [](const Solid& s) { return arrayOf(s.nodes().u); }, "Displacements, m; (N, 3).")
      .def_property_readonly("x", &placesOf, "Places, m; (N, 3).")
      .def_property_readonly(
          "v", [](const Solid& s) { return arrayOf(s.nodes().v); }, "Velocities, m/s; (N, 3).")
      .def_property_readonly(
          "mass", [](const Solid& s) { return arrayOf(s.nodes().mass); }, "Lumped masses, kg; (N).")
      .def(
          "reactions",
          [](const Solid& s) {
            s.run.requireWhole();
            return arrayOf(s.run.run().reactions(s.number).supports);
          },
          "Of supports on the nodes, N; (N, 3), 0 at those that are free.");
}

}  // namespace dovetail::python
