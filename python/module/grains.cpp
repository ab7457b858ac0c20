// Grains of a run as arrays in the order of their ids.
#include <pybind11/stl.h>

#include "dovetail/core/error.hpp"
#include "dovetail/dem/model/sample.hpp"
#include "scene_run.hpp"

namespace dovetail::python {

namespace {

struct Grains {
  SceneRun& run;

  const dem::Particles& particles() const { return run.run().grains.particles; }

  Numbers vectors(const std::vector<Vec3>& all) const { return rowsOf(all, run.grains()); }
  Numbers numbers(const std::vector<double>& all) const {
    const std::vector<int>& which = run.grains();
    Numbers some(static_cast<py::ssize_t>(which.size()));
    double* to = some.mutable_data();
    for (const int i : which) *to++ = all[static_cast<std::size_t>(i)];
    return some;
  }
  py::array_t<std::int64_t> ids() const {
    const std::vector<int>& which = run.grains();
    py::array_t<std::int64_t> some(static_cast<py::ssize_t>(which.size()));
    std::int64_t* to = some.mutable_data();
    for (const int i : which) *to++ = particles().id[static_cast<std::size_t>(i)];
    return some;
  }

  void put(std::vector<Vec3> dem::Particles::*field, const Numbers& a, const std::string& what) const {
    run.requireWhole();
    const std::vector<int>& which = run.grains();
    const std::vector<Vec3> given = vectorsOf(a, which.size(), what);
    dem::Particles& to = run.run().grains.particles;
    if (which.empty()) return;
    if ((to.*field).empty())
      throw InputError("grains of this run do not spin", what, "give them laws that exert torques");
    for (const int i : which)
      if (to.isMember(static_cast<std::size_t>(i)))
        throw InputError("grain " + std::to_string(to.id[static_cast<std::size_t>(i)]) + " is part of a clump", what,
                         "leave velocities to the run where there are clumps");
    run.run().change([&] {
      for (std::size_t k = 0; k < which.size(); ++k) (to.*field)[static_cast<std::size_t>(which[k])] = given[k];
    });
  }

  py::dict contacts() const {
    run.requireWhole();
    const dem::ContactSample sample = dem::sampleContacts(run.run().grains);
    const auto idsOf = [&](const std::vector<int>& numbers) {
      py::array_t<std::int64_t> some(static_cast<py::ssize_t>(numbers.size()));
      std::int64_t* to = some.mutable_data();
      for (const int i : numbers) *to++ = i < 0 ? -1 : particles().id[static_cast<std::size_t>(i)];
      return some;
    };
    py::dict all;
    all["first"] = idsOf(sample.first);
    all["second"] = idsOf(sample.second);
    all["point"] = arrayOf(sample.point);
    all["normal"] = arrayOf(sample.normal);
    all["force"] = arrayOf(sample.force);
    return all;
  }
};

}  // namespace

void bindGrains(py::module_& m) {
  py::class_<Grains>(m, "Grains", "Grains of a run. Arrays are copies, one row a grain, in the order of ids.")
      .def(py::init([](SceneRun& run) { return Grains{run}; }), py::keep_alive<1, 2>())
      .def("__len__", [](const Grains& g) { return g.run.grains().size(); })
      .def_property_readonly("id", &Grains::ids, "Names that stay while grains are sorted, enter and leave; (N).")
      .def_property_readonly(
          "x", [](const Grains& g) { return g.vectors(g.particles().x); }, "Centres, m; (N, 3).")
      .def_property(
          "v", [](const Grains& g) { return g.vectors(g.particles().v); },
          [](const Grains& g, const Numbers& a) { g.put(&dem::Particles::v, a, "velocities of grains"); },
          "Velocities, m/s; (N, 3). Energy that setting them brings is booked as a change.")
      .def_property(
          "omega", [](const Grains& g) { return g.vectors(g.particles().omega); },
          [](const Grains& g, const Numbers& a) { g.put(&dem::Particles::omega, a, "spins of grains"); },
          "Angular velocities, rad/s; (N, 3), 0 where grains do not spin. Set as velocities are.")
      .def_property_readonly(
          "f", [](const Grains& g) { return g.vectors(g.particles().f); }, "Forces with weights, N; (N, 3).")
      .def_property_readonly(
          "torque", [](const Grains& g) { return g.vectors(g.particles().torque); },
          "Torques about the centres, N m; (N, 3).")
      .def_property_readonly(
          "radius", [](const Grains& g) { return g.numbers(g.particles().radius); }, "m; (N).")
      .def_property_readonly(
          "mass", [](const Grains& g) { return g.numbers(g.particles().mass); }, "kg; (N).")
      .def("contacts", &Grains::contacts,
           "Contacts that carry a force: ids `first` and `second` (-1: a wall or a solid), `point` (m), `normal` from "
           "the second to the first, `force` on the first (N).");
}

}  // namespace dovetail::python
