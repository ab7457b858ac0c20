// A run, step by step.
#include <pybind11/stl.h>

#include <sstream>

#include "dovetail/core/error.hpp"
#include "dovetail/coupling/rest.hpp"
#include "scene_run.hpp"

namespace dovetail::python {

namespace {

py::dict ledgerOf(SceneRun& run) {
  run.requireWhole();
  const EnergyLedger& ledger = run.run().ledger();
  py::dict all;
  for (const EnergyLedger::Channel& channel : ledger.channels()) all[py::str(channel.name)] = channel.joules;
  all["residual"] = ledger.residual();
  return all;
}

py::dict dictOf(const Momenta& momenta) {
  py::dict both;
  both["linear"] = arrayOf(momenta.linear);
  both["angular"] = arrayOf(momenta.angular);
  return both;
}

py::dict totalsOf(SceneRun& run) {
  run.requireWhole();
  const coupling::Totals totals = run.run().totals();
  py::dict all, given;
  for (const ImpulseLedger::Channel& channel : totals.given.channels())
    given[py::str(channel.name)] = dictOf(channel.given);
  all["momentum"] = arrayOf(totals.momentum);
  all["angular_momentum"] = arrayOf(totals.angularMomentum);
  all["mass"] = totals.mass;
  all["given"] = given;
  all["residual"] = dictOf(totals.residual);
  all["turned_over"] = totals.turnedOver;
  return all;
}

std::vector<std::pair<double, std::string>> limitsOf(SceneRun& run) {
  run.requireWhole();
  std::vector<std::pair<double, std::string>> all;
  for (const StepLimit& limit : scene::limits(run.built(), run.scene())) all.emplace_back(limit.dt, limit.owner);
  return all;
}

py::bytes stateOf(SceneRun& run) {
  run.requireWhole();
  const std::vector<char> state = run.run().save();
  return {state.data(), state.size()};
}

void load(SceneRun& run, const py::bytes& state) {
  const std::string_view bytes = state;
  run.take(std::vector<char>(bytes.begin(), bytes.end()));
}

std::string textOf(SceneRun& run) {
  run.requireWhole();
  std::ostringstream text;
  coupling::report(run.run(), text);
  return text.str();
}

}  // namespace

void bindRun(py::module_& m) {
  py::class_<SceneRun>(m, "Run")
      .def(py::init([](const scene::Scene& scene, const py::dict& solids) {
             return std::make_unique<SceneRun>(scene, solids);
           }),
           py::arg("scene"), py::arg("solids"))
      .def("_advance", &SceneRun::advance)
      .def("_add_force", &SceneRun::addForce)
      .def_property_readonly(
          "time", [](SceneRun& r) { return r.run().time(); }, "s")
      .def_property_readonly(
          "dt", [](SceneRun& r) { return r.run().dt(); }, "Step of the grains, s.")
      .def_property_readonly(
          "macro_step", [](SceneRun& r) { return r.run().macroStep(); }, "Step of the solids, s.")
      .def_property_readonly(
          "kinetic_energy", [](SceneRun& r) { return r.run().kineticEnergy(); }, "Of all, J.")
      .def_property_readonly("ledger", &ledgerOf, "Energy by channel, J, and what no channel has, `residual`.")
      .def_property_readonly("totals", &totalsOf,
                             "Momentum (kg m/s), angular momentum about the origin (kg m2/s) and mass (kg); who gave "
                             "them; what nobody gave, `residual`, beside all that was `turned_over`.")
      .def_property_readonly("limits", &limitsOf, "Limits of the step now: (s, what sets it).")
      .def_property_readonly(
          "notes", [](SceneRun& r) { return r.built().notes; }, "Decisions that the scene leaves open.")
      .def_property_readonly("scene", &SceneRun::scene, py::return_value_policy::copy, "What the run was built from.")
      .def_property_readonly("_solids",
                             [](SceneRun& r) {
                               std::vector<std::string> names;
                               for (std::size_t k = 0; k < r.run().solids(); ++k)
                                 names.push_back(r.run().solid(k).name);
                               return names;
                             })
      .def(
          "stop",
          [](SceneRun& r) {
            r.requireWhole();
            r.run().stop();
          },
          "All velocities become 0; booked.")
      .def("save", &stateOf, "The state as bytes.")
      .def("load", &load, py::arg("state"),
           "Goes on from a state of this scene, to the same digits; what is damaged or of other parts is refused.")
      .def("__str__", &textOf);
}

}  // namespace dovetail::python
