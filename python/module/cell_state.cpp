// What a cell of grains is like now.
#include <pybind11/stl.h>

#include "cells.hpp"
#include "dovetail/rve/contact_sample.hpp"
#include "dovetail/rve/rve_archive.hpp"

namespace dovetail::python {

namespace {

/// (N, 3); components that discs do not have are 0.
Numbers rowsOf(const rve::Components& all, std::size_t n) {
  Numbers rows({static_cast<py::ssize_t>(n), py::ssize_t{3}});
  for (std::size_t c = 0; c < 3; ++c)
    for (std::size_t i = 0; i < n; ++i)
      rows.mutable_at(static_cast<py::ssize_t>(i), static_cast<py::ssize_t>(c)) = all[c].empty() ? 0.0 : all[c][i];
  return rows;
}

Numbers ofState(const Cell& cell, rve::Components rve::CellState::*what) {
  const rve::Rve& now = cell.now();
  return rowsOf(now.state.*what, now.size());
}

Numbers latticeOf(const Cell& cell) {
  Eigen::Matrix3d columns;
  for (int k = 0; k < 3; ++k)
    for (int c = 0; c < 3; ++c) columns(c, k) = cell.now().state.lattice.period[static_cast<std::size_t>(k)][c];
  return arrayOf(columns);
}

py::dict balanceOf(const Cell& cell) {
  const rve::Balance found = rve::balance(cell.now());
  py::dict all;
  all["unbalanced"] = found.unbalanced;
  all["mean_force"] = found.meanForce;
  all["coordination"] = found.coordination;
  all["contacts"] = found.contacts;
  all["rattlers"] = found.rattlers;
  all["sliding"] = found.sliding;
  all["bonds"] = found.bonds;
  return all;
}

py::dict ledgerOf(const Cell& cell) {
  const rve::Rve& now = cell.now();
  const rve::RveLedger& book = now.state.ledger;
  py::dict all;
  all["work"] = book.work;
  all["friction"] = book.friction;
  all["damping"] = book.damping;
  all["bonds"] = book.bonds;
  all["stored"] = rve::storedEnergy(now);
  all["kinetic"] = rve::kineticEnergy(now);
  return all;
}

py::dict contactsOf(const Cell& cell) {
  const rve::ContactSample found = rve::sampleContacts(cell.now());
  const auto whole = [](const std::vector<int>& numbers) {
    return py::array_t<int>(static_cast<py::ssize_t>(numbers.size()), numbers.data());
  };
  py::array_t<bool> slides(static_cast<py::ssize_t>(found.size()));
  for (std::size_t c = 0; c < found.size(); ++c) slides.mutable_at(static_cast<py::ssize_t>(c)) = found.slides[c] != 0;
  py::dict all;
  all["first"] = whole(found.first);
  all["second"] = whole(found.second);
  all["branch"] = arrayOf(found.branch);
  all["force"] = arrayOf(found.force);
  all["slides"] = slides;
  return all;
}

py::dict dictOf(const rve::Springs& springs) {
  py::dict all;
  all["modulus"] = springs.modulus;
  all["stiffness"] = springs.stiffness;
  all["hertz"] = springs.hertz;
  all["tangential"] = springs.tangential;
  all["friction"] = springs.friction;
  all["rolling"] = springs.rolling;
  all["rolling_limit"] = springs.rollingLimit;
  return all;
}

py::bytes saved(const Cell& cell) {
  ByteWriter archive;
  rve::writeState(cell.now(), cell.now().state, archive);
  return {archive.bytes().data(), archive.bytes().size()};
}

void load(Cell& cell, const py::bytes& state) {
  const std::string_view bytes = state;
  cell.change([&](rve::Rve& now) {
    ByteReader archive(std::vector<char>(bytes.begin(), bytes.end()));
    const rve::CellState read = rve::readState(now, archive);
    if (!archive.atEnd()) throw InputError("there is more than a state", "Rve.load", "give what Rve.save gave");
    rve::restore(now, read);
  });
}

void bindGrainsOf(py::class_<Cell>& type) {
  type.def("__len__", [](const Cell& c) { return c.now().size(); })
      .def_property_readonly(
          "shape", [](const Cell& c) { return c.now().shape == rve::Shape::disc ? "disc" : "sphere"; },
          "disc or sphere.")
      .def_property_readonly(
          "radius", [](const Cell& c) { return arrayOf(c.now().radius); }, "m; (N).")
      .def_property_readonly(
          "mass", [](const Cell& c) { return arrayOf(c.now().mass); }, "kg; (N).")
      .def_property_readonly(
          "x", [](const Cell& c) { return ofState(c, &rve::CellState::x); }, "Centres, m; (N, 3).")
      .def_property_readonly(
          "v", [](const Cell& c) { return ofState(c, &rve::CellState::v); },
          "Fluctuations of the velocities, m/s; (N, 3): on top of L x.")
      .def_property_readonly(
          "omega", [](const Cell& c) { return ofState(c, &rve::CellState::spin); },
          "Fluctuations of the angular velocities, rad/s; (N, 3).")
      .def_property_readonly(
          "f", [](const Cell& c) { return ofState(c, &rve::CellState::force); }, "By contacts, N; (N, 3).")
      .def_property_readonly(
          "torque", [](const Cell& c) { return ofState(c, &rve::CellState::torque); }, "By contacts, N m; (N, 3).");
}

}  // namespace

void bindCellState(py::class_<Cell>& type) {
  bindGrainsOf(type);
  type.def_property_readonly(
          "F", [](const Cell& c) { return arrayOf(c.now().state.F); }, "Deformation gradient; (3, 3).")
      .def_property_readonly("lattice", &latticeOf, "Periods as columns, m; (3, 3).")
      .def_property_readonly(
          "volume", [](const Cell& c) { return rve::volume(c.now()); }, "Now, m3.")
      .def_property_readonly(
          "stress", [](const Cell& c) { return arrayOf(rve::stress(c.now()).cauchy); },
          "Cauchy stress of Love and Weber, Pa; (3, 3).")
      .def_property_readonly(
          "nominal_stress", [](const Cell& c) { return arrayOf(rve::nominalStress(c.now())); },
          "First Piola-Kirchhoff stress P, Pa; (3, 3).")
      .def_property_readonly(
          "pressure", [](const Cell& c) { return rve::stress(c.now()).pressure; }, "Pa; of discs in their plane.")
      .def_property_readonly(
          "fabric", [](const Cell& c) { return arrayOf(rve::fabric(c.now())); }, "Mean of n n over contacts; (3, 3).")
      .def_property_readonly(
          "solid_fraction", [](const Cell& c) { return rve::solidFraction(c.now()); },
          "Fraction of the volume that grains fill; overlaps count twice.")
      .def_property_readonly("balance", &balanceOf,
                             "Largest force on a grain over the mean contact force, `unbalanced`; `mean_force` (N), "
                             "`coordination`, numbers of `contacts`, `rattlers`, `sliding` contacts, `bonds`.")
      .def_property_readonly("ledger", &ledgerOf,
                             "J since F = 1: `work` of the boundary, `friction`, `damping`, `bonds`; `stored` and "
                             "`kinetic` now.")
      .def_property_readonly(
          "springs", [](const Cell& c) { return dictOf(c.now().springs); }, "Constants of the contacts.")
      .def("contacts", &contactsOf,
           "Contacts that touch: grains `first` and `second`, `branch` from first to second (m), `force` on the first "
           "(N), whether it `slides`.")
      .def("save", &saved, "The state as bytes.")
      .def("load", &load, py::arg("state"),
           "Goes on from a state of this cell, to the same digits. What is of other grains or springs, or damaged, is "
           "refused.");
}

}  // namespace dovetail::python
