#include "cell_plan.hpp"

#include <algorithm>
#include <set>

#include "dovetail/core/error.hpp"
#include "dovetail/core/nearest.hpp"
#include "dovetail/io/names.hpp"
#include "dovetail/scene/files.hpp"

namespace dovetail::program {

using scene::Fields;
namespace unit = scene::unit;

void describe(Fields& f, SecantPlan& v) {
  f.number({"least", "smallest strain"}, v.least, scene::between(0.0, 0.1, true));
  f.number({"most", "largest strain"}, v.most, scene::between(0.0, 0.5, true));
  f.integer({"outputs", "strains, in equal ratios"}, v.outputs, 2, 1000);
}
void describe(Fields& f, CellTest& v) {
  static constexpr const char* kinds[] = {"isotropic", "oedometer", "biaxial", "triaxial", "shear"};
  static constexpr const char* axes[] = {"x", "y", "z"};
  f.where(v.where);
  f.text({"name", "of its files"}, v.name, true);
  f.choice({"do",
            "compression all round; along an axis without strain across; along an axis in the plane x, y, the sides "
            "keeping their pressure (discs, spheres without strain along z); the same of spheres, both sides keeping "
            "it; shear along x of planes that keep their pressure along y"},
           v.kind, kinds);
  f.text({"cells", "name of the cells; the only ones if not given"}, v.cells, false);
  f.choice({"axis", "that is shortened"}, v.axis, axes);
  f.flag({"constant_volume", "in place of constant pressure (undrained)"}, v.constantVolume);
  f.number({"pressure", "all round, before the test; that of the preparation if not given"}, v.pressure,
           scene::positive(unit::pressure));
  f.number({"strain", "at the end: of the axis, or -ln of the volume ratio, logarithmic; or the shear"}, v.strain,
           scene::between(0.0, 10.0, true));
  f.number({"back_to", "strain to which the test goes back from there"}, v.backTo, scene::between(0.0, 10.0));
  f.integer({"outputs", "rows of the curves, in equal strains"}, v.outputs, 4, 100000);
  f.number(
      {"rest", "unbalanced over mean contact force to which cells rest at every output; none: they stay in motion"},
      v.rest, scene::between(0.0, 0.1, true));
  f.number({"inertial_number", "of the strain rate"}, v.inertialNumber, scene::between(0.0, 0.01, true));
}

namespace {

void describePlan(Fields& f, CellPlan& v) {
  f.includes({"include", "other files, whose keys come first"});
  f.text({"title", "for reports"}, v.title, false);
  f.parameters({"let", "parameters of expressions in this file"}, v.parameters);
  f.list({"cells", "cells of grains, as in scenes"}, v.cells, true);
  f.object({"secants", "moduli K and G of finite strains, from rest to rest"}, v.secants);
  f.list({"drive", "tests of the cells; none: cells are only made and described"}, v.tests);
}

std::vector<std::string> namesOf(const CellPlan& plan) {
  std::vector<std::string> names;
  for (const scene::Cells& cells : plan.cells) names.push_back(cells.name);
  return names;
}

void check(const CellPlan& plan, const CellTest& test) {
  io::requirePlainName(test.name, test.where);
  const std::vector<std::string> names = namesOf(plan);
  if (test.cells.empty() && names.size() > 1)
    throw InputError("the test \"" + test.name + "\" has no cells", test.where, "name them: \"cells\": \"…\"");
  if (!test.cells.empty() && std::ranges::find(names, test.cells) == names.end())
    throw InputError("there are no cells \"" + test.cells + "\"", test.where, adviceFor(test.cells, names));
  if (test.backTo && *test.backTo >= test.strain)
    throw InputError("the test goes back to a larger strain", test.where, "write one below \"strain\"");
  if (test.kind == TestKind::isotropic && test.constantVolume)
    throw InputError("nothing changes at constant volume", test.where, "leave constant_volume out, or shear the cells");
  if (test.kind == TestKind::oedometer && test.constantVolume)
    throw InputError("an oedometer changes the volume", test.where, "leave constant_volume out");
}

}  // namespace

namespace {

/// Of a file's, they are known when it is read.
std::optional<rve::Shape> shapeOf(const scene::Cells& cells) {
  if (std::holds_alternative<scene::CellFile>(cells.grains)) return {};
  return std::holds_alternative<scene::DiscCells>(cells.grains) ? rve::Shape::disc : rve::Shape::sphere;
}

}  // namespace

const scene::Cells& CellPlan::cellsOf(const CellTest& test) const {
  if (test.cells.empty()) return cells.front();
  return *std::ranges::find(cells, test.cells, &scene::Cells::name);
}

CellPlan readCellPlan(const std::string& file, const std::vector<std::string>& settings) {
  CellPlan plan;
  scene::readFields(scene::textOfFile(file), settings, [&](Fields& f) {
    plan = {};
    describePlan(f, plan);
  });
  if (plan.secants && !(plan.secants->least < plan.secants->most))
    throw InputError("the smallest strain of the secants is not below the largest", file, "write least < most");
  std::set<std::string> names;
  for (const scene::Cells& cells : plan.cells) {
    io::requirePlainName(cells.name, cells.where);
    if (!names.insert(cells.name).second)
      throw InputError("two cells are named \"" + cells.name + "\"", cells.where, "give them different names");
  }
  names.clear();
  for (const CellTest& test : plan.tests) {
    check(plan, test);
    if (const std::optional<rve::Shape> shape = shapeOf(plan.cellsOf(test))) driveOf(test, *shape, 1.0);
    if (!names.insert(test.name).second)
      throw InputError("there are two tests \"" + test.name + "\"", test.where, "give them other names");
  }
  return plan;
}

rve::Drive driveOf(const CellTest& test, rve::Shape shape, double pressure) {
  const std::optional<double> kept = test.constantVolume ? std::nullopt : std::optional(pressure);
  try {
    switch (test.kind) {
      case TestKind::isotropic:
        return rve::isotropicCompression(shape);
      case TestKind::oedometer:
        return rve::oedometer(shape, test.axis);
      case TestKind::biaxial:
        return rve::biaxial(shape, test.axis, kept);
      case TestKind::shear:
        return rve::simpleShear(kept);
      case TestKind::triaxial:
        break;
    }
    if (shape == rve::Shape::disc)
      throw InputError("discs have no triaxial test", "", "write \"do\": \"biaxial\", or take spheres");
    return rve::triaxial(test.axis, kept);
  } catch (const InputError& error) {
    throw InputError("the test \"" + test.name + "\": " + error.what(), test.where, "");
  }
}

std::string textOfCells(scene::Cells cells) {
  return scene::textOf([&](Fields& f) { describe(f, cells); });
}

std::string cellReference() {
  return scene::referenceText("cell", [](Fields& f) {
    CellPlan plan;
    describePlan(f, plan);
  });
}

std::string cellSchema() {
  return scene::schemaText("cell", [](Fields& f) {
    CellPlan plan;
    describePlan(f, plan);
  });
}

}  // namespace dovetail::program
