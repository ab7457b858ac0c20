// What changes a cell of grains, and its operators.
#include <pybind11/functional.h>
#include <pybind11/stl.h>

#include <cmath>
#include <optional>

#include "cells.hpp"
#include "dovetail/rve/equilibrium.hpp"
#include "dovetail/rve/moduli.hpp"

namespace dovetail::python {

namespace {

py::dict dictOf(const RestReport& report) {
  py::dict all;
  all["at_rest"] = report.atRest;
  all["residual"] = report.residual;
  all["steps"] = report.steps;
  return all;
}

RestCriterion criterionOf(std::optional<double> tolerance) {
  if (!tolerance) return {.steps = 0};
  return {.tolerance = *tolerance};
}

py::dict followPath(Cell& cell, const Numbers& F, double inertialNumber, double damping, std::optional<double> rest) {
  const Eigen::Matrix3d to = matrixOf(F, "F");
  const rve::PathReport report = cell.change([&](rve::Rve& now) {
    return rve::followPath(now, to, {.inertialNumber = inertialNumber, .damping = damping, .rest = criterionOf(rest)});
  });
  py::dict all = dictOf(report.rest);
  all["path_steps"] = report.steps;
  all["kinetic_fraction"] = report.kineticFraction;
  return all;
}

void compress(Cell& cell, const Numbers& pressure, std::optional<double> friction, double tolerance, double rest) {
  Vec3 wanted;
  if (pressure.ndim() == 0)
    wanted = Vec3{1, 1, 1} * *pressure.data();
  else
    wanted = vectorsOf(pressure, 1, "pressure").front();
  cell.change([&](rve::Rve& now) {
    rve::compress(now, {.pressure = wanted,
                        .friction = friction.value_or(now.springs.friction),
                        .tolerance = tolerance,
                        .rest = {.tolerance = rest}});
  });
}

int axisOf(const std::string& word) {
  if (word != "x" && word != "y" && word != "z")
    throw InputError("'" + word + "' is no axis", "axis", "give x, y or z");
  return word[0] - 'x';
}

rve::Drive testOf(const rve::Rve& cell, const std::string& name, const std::string& axis,
                  std::optional<double> pressure) {
  if (name == "isotropic") return rve::isotropicCompression(cell.shape);
  if (name == "oedometer") return rve::oedometer(cell.shape, axisOf(axis));
  if (name == "biaxial") return rve::biaxial(cell.shape, axisOf(axis), pressure);
  if (name == "shear") return rve::simpleShear(pressure);
  if (name != "triaxial")
    throw InputError("there is no test '" + name + "'", "test",
                     "give isotropic, oedometer, biaxial, triaxial or shear, or rate and stress");
  if (cell.shape == rve::Shape::disc)
    throw InputError("discs have no triaxial test", "test", "give biaxial, or take spheres");
  return rve::triaxial(axisOf(axis), pressure);
}

py::dict dictOf(const rve::DrivenState& state) {
  py::dict all;
  all["strain"] = state.strain;
  all["F"] = arrayOf(state.F);
  all["stress"] = arrayOf(state.stress);
  all["fabric"] = arrayOf(state.fabric);
  all["volume"] = state.volume;
  all["solid_fraction"] = state.solidFraction;
  all["void_ratio"] = state.voidRatio();
  all["coordination"] = state.coordination;
  all["sliding"] = state.sliding;
  all["unbalanced"] = state.unbalanced;
  all["work"] = state.ledger.work;
  all["friction"] = state.ledger.friction;
  all["damping"] = state.ledger.damping;
  all["bonds"] = state.ledger.bonds;
  all["stored"] = state.stored;
  all["kinetic"] = state.kinetic;
  return all;
}

/// One array for each name, a row a state.
py::dict dictOf(const std::vector<rve::DrivenState>& states) {
  const py::object stack = py::module_::import("numpy").attr("stack");
  py::dict lists;
  for (const rve::DrivenState& state : states)
    for (const auto& [name, value] : dictOf(state)) {
      if (!lists.contains(name)) lists[name] = py::list();
      py::list(lists[name]).append(value);
    }
  py::dict all;
  for (const auto& [name, values] : lists) all[name] = stack(values);
  return all;
}

py::dict drive(Cell& cell, const std::vector<double>& strains, const std::string& test, const std::string& axis,
               std::optional<double> pressure, const std::optional<Numbers>& rate, const std::optional<Numbers>& stress,
               double inertialNumber, double damping, double tolerance, std::optional<double> rest,
               const py::object& each) {
  if (test.empty() == !rate)
    throw InputError("there is no single test", "drive", "give the name of a test, or a rate, and not both");
  if (stress && !rate) throw InputError("there is a stress of no rate", "stress", "give pressure to tests by name");
  if (pressure && rate) throw InputError("there is a pressure of no test", "pressure", "hold it as stress");
  rve::Drive how;
  if (rate)
    how.rate = matrixOf(*rate, "rate");
  else
    how = testOf(cell.now(), test, axis, pressure);
  if (stress) how.stress = matrixOf(*stress, "stress", true);
  rve::DriveOptions options{.inertialNumber = inertialNumber, .damping = damping, .tolerance = tolerance};
  if (rest) options.rest = RestCriterion{.tolerance = *rest};
  const auto look = [&](const rve::DrivenState& state) {
    const py::gil_scoped_acquire lock;
    if (PyErr_CheckSignals() != 0) throw py::error_already_set();
    if (!each.is_none()) cell.show([&] { each(dictOf(state)); });
  };
  return dictOf(cell.change([&](rve::Rve& now) { return rve::drive(now, how, strains, options, look); }));
}

void setSprings(Cell& cell, const py::kwargs& changes) {
  rve::Springs springs = cell.now().springs;
  for (const auto& [key, value] : changes) {
    const std::string name = py::str(key);
    double* const to = name == "modulus"         ? &springs.modulus
                       : name == "stiffness"     ? &springs.stiffness
                       : name == "hertz"         ? &springs.hertz
                       : name == "tangential"    ? &springs.tangential
                       : name == "friction"      ? &springs.friction
                       : name == "rolling"       ? &springs.rolling
                       : name == "rolling_limit" ? &springs.rollingLimit
                                                 : nullptr;
    if (!to) throw InputError("springs have no '" + name + "'", "set_springs", "give names of Rve.springs");
    *to = py::cast<double>(value);
  }
  cell.change([&](rve::Rve& now) { rve::setSprings(now, springs); });
}

Numbers arrayOfTangent(const rve::Tangent& tangent) {
  Numbers all(std::vector<py::ssize_t>{3, 3, 3, 3});
  double* to = all.mutable_data();
  for (int row = 0; row < 9; ++row)
    for (int column = 0; column < 9; ++column) *to++ = tangent(row, column);
  return all;
}

py::dict moduliOf(const Cell& cell, const Numbers& tangent) {
  if (tangent.ndim() != 4 || tangent.size() != 81)
    throw InputError("it is no array of (3, 3, 3, 3)", "tangent", "give what a tangent of the cell is");
  rve::Tangent matrix;
  for (int row = 0; row < 9; ++row)
    for (int column = 0; column < 9; ++column) matrix(row, column) = tangent.data()[9 * row + column];
  const rve::Moduli found = rve::moduliOf(cell.now(), matrix);
  py::dict all;
  all["bulk"] = found.bulk;
  all["shear"] = found.shear;
  return all;
}

void bindRest(py::class_<Cell>& type) {
  type.def(
          "relax",
          [](Cell& c, double tolerance, std::int64_t steps) {
            return dictOf(c.change([&](rve::Rve& now) { return rve::relax(now, {tolerance, steps}); }));
          },
          py::arg("tolerance") = RestCriterion{}.tolerance, py::arg("steps") = RestCriterion{}.steps,
          "To rest under constant F: `at_rest`, `residual` (unbalanced over mean force), `steps`.")
      .def(
          "polish",
          [](Cell& c, double tolerance) {
            return dictOf(c.change([&](rve::Rve& now) { return rve::polish(now, tolerance); }));
          },
          py::arg("tolerance") = 1e-10, "Newton's method, from a relaxed state.")
      .def(
          "deform",
          [](Cell& c, const Numbers& G) {
            const Eigen::Matrix3d by = matrixOf(G, "G");
            c.change([&](rve::Rve& now) { rve::deform(now, by); });
          },
          py::arg("G"), "F becomes G F, grains and all, without time: not at rest afterwards.")
      .def("set_springs", &setSprings, "Other constants of the contacts, by the names of `springs`.")
      .def(
          "repeat", [](Cell& c) { c.change([](rve::Rve& now) { rve::repeat(now); }); }, "Twice the cell, side by side.")
      .def(
          "stop", [](Cell& c) { c.change([](rve::Rve& now) { rve::stop(now); }); }, "All fluctuations become 0.");
}

void bindTangents(py::class_<Cell>& type) {
  type.def(
          "elastic_tangent", [](const Cell& c) { return arrayOfTangent(rve::elasticTangent(c.now())); },
          "dP/dF at rest where nothing slips, Pa; (3, 3, 3, 3), [i, J, k, L] = dP_iJ/dF_kL.")
      .def(
          "frictional_tangent", [](const Cell& c) { return arrayOfTangent(rve::frictionalTangent(c.now())); },
          "The same with springs that slip where they are at the limit.")
      .def(
          "voigt_tangent", [](const Cell& c) { return arrayOfTangent(rve::voigtTangent(c.now())); },
          "The same if all grains move with F: an upper bound.")
      .def(
          "numerical_tangent",
          [](const Cell& c, const Numbers& F, double strain) {
            return arrayOfTangent(rve::numericalTangent(c.now(), matrixOf(F, "F"), {.strain = strain}));
          },
          py::arg("F"), py::arg("strain") = 1e-5, "Differences of the answers themselves on the way to F.")
      .def("moduli", &moduliOf, py::arg("tangent"), "Isotropic part of a tangent: `bulk` and `shear` modulus, Pa.");
}

}  // namespace

void bindCellVerbs(py::class_<Cell>& type) {
  const rve::DriveOptions drives;
  const rve::PathOptions paths;
  const rve::CompressionOptions presses;
  type.def("compress", &compress, py::arg("pressure"), py::kw_only(), py::arg("friction") = py::none(),
           py::arg("tolerance") = presses.tolerance, py::arg("rest") = presses.rest.tolerance,
           "Strains the cell until it presses with so many Pa, or (x, y, z), at rest; `friction` of the contacts "
           "meanwhile, if not their own. F = 1 there, and the ledger begins anew.")
      .def("follow_path", &followPath, py::arg("F"), py::kw_only(), py::arg("inertial_number") = paths.inertialNumber,
           py::arg("damping") = paths.damping, py::arg("rest") = paths.rest.tolerance,
           "From here to F, at most 5 % of strain away, then to rest; rest=None: left in motion.")
      .def("drive", &drive, py::arg("strains"), py::arg("test") = "", py::kw_only(), py::arg("axis") = "y",
           py::arg("pressure") = py::none(), py::arg("rate") = py::none(), py::arg("stress") = py::none(),
           py::arg("inertial_number") = drives.inertialNumber, py::arg("damping") = drives.damping,
           py::arg("tolerance") = drives.tolerance, py::arg("rest") = py::none(), py::arg("each") = py::none(),
           "A test to one strain after the other: isotropic, oedometer, biaxial, triaxial (along `axis`) or shear; "
           "sides keep `pressure` (Pa), or without one the volume. Or the velocity gradient `rate` (3, 3), with "
           "`stress` (3, 3, Pa, NaN where none) held. `rest`: unbalanced force to which it rests at every strain. "
           "Arrays with a row for each strain, the start before them. `each(state)` is called at every one, and may "
           "look at the cell.");
  bindRest(type);
  bindTangents(type);
}

}  // namespace dovetail::python
