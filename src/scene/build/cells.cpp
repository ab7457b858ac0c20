// Cells of grains of a scene.
#include <algorithm>
#include <set>

#include "convert/grain_sources.hpp"
#include "dealt_cells.hpp"
#include "dovetail/core/finite.hpp"
#include "dovetail/core/parallel.hpp"
#include "dovetail/fem/elements/solid.hpp"
#include "dovetail/rve/operators.hpp"
#include "dovetail/rve/packing.hpp"
#include "dovetail/rve/rve_archive.hpp"
#include "keys/advice.hpp"
#include "parts.hpp"
#include "sizes.hpp"
#include "warnings/warnings.hpp"

namespace dovetail::scene {

namespace {

rve::Springs springsOf(const CellLinearContact& law, double friction) {
  if (law.modulus.has_value() == law.stiffness.has_value())
    throw InputError(
        law.modulus ? "both a modulus and a stiffness are given" : "neither a modulus nor a stiffness is given", "",
        "give one of them");
  return {.modulus = law.modulus.value_or(0.0),
          .stiffness = law.stiffness.value_or(0.0),
          .tangential = law.stiffnessRatio,
          .friction = friction,
          .rolling = law.rolling,
          .rollingLimit = law.rollingFriction};
}
rve::Springs springsOf(const CellHertzContact& law, double friction) {
  return rve::hertzMindlin(law.youngsModulus / (2.0 * (1.0 + law.poissonRatio)), law.poissonRatio, friction);
}
rve::Springs springsOf(const CellContact& contact) {
  return atPlace(contact.where, [&] {
    return std::visit([&](const auto& law) { return springsOf(law, contact.friction); }, contact.law);
  });
}

rve::CloudOptions cloudOf(const DiscCells& cells) { return {.shape = rve::Shape::disc, .thickness = cells.thickness}; }
rve::CloudOptions cloudOf(const SphereCells&) { return {.shape = rve::Shape::sphere}; }

rve::Rve pressed(rve::Rve cell, const CellPreparation& cells) {
  for (const CellPressing& to : cells.prepare)
    atPlace(to.where, [&] {
      rve::compress(cell, {.pressure = {to.pressure, to.pressure, to.pressure},
                           .friction = to.friction.value_or(cells.contact.friction),
                           .tolerance = cells.tolerance,
                           .rest = {.tolerance = restOfCells}});
    });
  return cell;
}

rve::Rve randomCell(const RandomCells& cells, rve::CloudOptions cloud, std::size_t number) {
  cloud.count = static_cast<int>(cells.count);
  cloud.sizes = sizesOf(cells.radius);
  cloud.density = cells.density;
  cloud.seed = static_cast<std::uint64_t>(cells.seed) + number;
  return rve::randomCell(cloud, springsOf(cells.contact));
}

template <class Kind>
std::vector<rve::Rve> make(const Kind& cells) {
  requireMemory(static_cast<double>(cells.count * cells.number), "grains of cells", bytesOfGrain,
                "take fewer cells, or fewer grains");
  std::vector<rve::Rve> made(static_cast<std::size_t>(cells.number));
  parallelTasks(made.size(), [&](std::size_t k) { made[k] = pressed(randomCell(cells, cloudOf(cells), k), cells); });
  return made;
}

/// The density that all have.
double densityIn(const grain_io::GrainFile& grains, const std::string& file) {
  const auto [least, most] = std::ranges::minmax(grains.density);
  if (most - least > 1e-6 * most)
    throw InputError("the grains have densities from " + formatNumber(least) + " to " + formatNumber(most) + " kg/m3",
                     file, "cut cells out of a packing of one density");
  return most;
}

/// Spheres with their centres in the box, which becomes the cell.
rve::Grains grainsIn(const geometry::Box& box, const grain_io::GrainFile& grains, const std::string& file) {
  rve::Grains inside{.shape = rve::Shape::sphere, .density = densityIn(grains, file)};
  for (std::size_t i = 0; i < grains.position.size(); ++i) {
    Vec3 x = grains.position[i];
    bool within = true;
    for (int k = 0; k < 3; ++k) {
      if (grains.box && grains.periodic && (*grains.periodic)[static_cast<std::size_t>(k)]) {
        const double length = grains.box->upper[k] - grains.box->lower[k];
        if (box.upper[k] - box.lower[k] > length * (1.0 + 1e-9))
          throw InputError("the box is longer than the period of the packing, " + formatNumber(length) + " m", file,
                           "make it as long as the period, or shorter");
        x[k] -= length * std::floor((x[k] - box.lower[k]) / length);
      }
      within = within && x[k] >= box.lower[k] && x[k] < box.upper[k];
    }
    if (!within) continue;
    inside.centre.push_back(x - box.lower);
    inside.radius.push_back(grains.radius[i]);
  }
  constexpr std::size_t fewest = 4;
  if (inside.centre.size() < fewest)
    throw InputError("the box from " + placeText(box.lower) + " to " + placeText(box.upper) + " holds " +
                         std::to_string(inside.centre.size()) + " of the " + std::to_string(grains.position.size()) +
                         " grains",
                     file, "move the box into the packing, or make it larger");
  return inside;
}

std::vector<rve::Rve> make(const CutCells& cells) {
  const grain_io::GrainFile grains = grainsFrom(cells.file, {.density = cells.density});
  if (grains.density.empty())
    throw InputError("the file has no densities of the grains", cells.file, "give a \"density\"");
  std::vector<rve::Rve> made(static_cast<std::size_t>(cells.number));
  parallelTasks(made.size(), [&](std::size_t k) {
    const Vec3 shift = static_cast<double>(k) * cells.step;
    const geometry::Box box{cells.box.lower + shift, cells.box.upper + shift};
    const Vec3 edge = box.upper - box.lower;
    const geometry::Lattice lattice{{Vec3{edge.x, 0, 0}, Vec3{0, edge.y, 0}, Vec3{0, 0, edge.z}}, {true, true, true}};
    made[k] = pressed(rve::relaxedCell(grainsIn(box, grains, cells.file), lattice, springsOf(cells.contact)), cells);
  });
  return made;
}
std::vector<rve::Rve> make(const CellFile& from) {
  std::vector<rve::Rve> cells = rve::readSamples(from.file);
  if (cells.empty()) throw InputError("the file has no cells", from.file, "give one that dovetail cell has written");
  return cells;
}

const std::vector<rve::Rve>& banked(const Built& built, const std::string& name) {
  std::vector<std::string> names;
  for (const auto& [known, cells] : built.cells) names.push_back(known);
  const auto found = built.cells.find(name);
  if (found == built.cells.end())
    throw InputError("there are no cells \"" + name + "\"", "",
                     names.empty() ? "describe them in \"cells\" of the scene" : adviceFor(name, names));
  return found->second;
}

}  // namespace

std::vector<rve::Rve> makeCells(const Cells& cells) {
  return atPlace(cells.where,
                 [&] { return std::visit([](const auto& grains) { return make(grains); }, cells.grains); });
}

void addCells(Built& built, const Scene& scene) {
  std::set<std::string> used;
  for (const Solid& solid : scene.solids)
    for (const SolidMaterial* const material : materialsOf(solid))
      if (const auto* const law = std::get_if<GrainCells>(&material->law)) used.insert(law->cells);
  for (const Cells& cells : scene.cells) {
    const auto [place, isNew] = built.cells.try_emplace(cells.name);
    if (!isNew)
      throw InputError("two cells are named \"" + cells.name + "\"", cells.where, "give them different names");
    if (used.contains(cells.name))
      place->second = makeCells(cells);
    else
      built.notes.push_back("WARNING: No solid has the cells \"" + cells.name +
                            "\", which were not made: leave them out, or name them in a material.");
  }
}

std::shared_ptr<fem::PointField> fieldOf(const GrainCells& law, const Built& built, const CellPlaces& places) {
  DealtCells dealt{banked(built, law.cells), {}};
  if (law.deal == GrainCells::Deal::byDepth) dealt = pressedByDepth(dealt.cells, places);
  if (places.loadSteps)
    return hierarchical::cellField(
        std::move(dealt.cells),
        hierarchical::QuasiStaticCells{
            .path = {.inertialNumber = law.inertialNumber, .rest = {.tolerance = restOfCells}},
            .unbalanced = restOfCells,
            .tangent = static_cast<hierarchical::Operator>(law.tangent)},
        std::move(dealt.deal));
  return hierarchical::cellField(std::move(dealt.cells),
                                 hierarchical::DynamicCells{.strainPerStep = law.strainPerStep, .damping = law.damping},
                                 std::move(dealt.deal));
}

void requireDimension(const GrainCells& law, int dimension, fem::Formulation formulation, const Built& built) {
  if (banked(built, law.cells).front().shape == rve::Shape::sphere) return;
  const std::string of = "the cells \"" + law.cells + "\" are discs, which deform in their plane only";
  if (dimension != 2) throw InputError(of, "", "take a mesh of quad4 or quad8, points of plane strain, or spheres");
  if (formulation == fem::Formulation::meanDilatation)
    throw InputError(of, "formulation", "write \"standard\", or \"reduced\" with quad8");
}

bool takesLoadStepsAlone(const Scene& scene) {
  return std::ranges::all_of(scene.stages,
                             [](const Stage& stage) { return std::holds_alternative<Statics>(stage.kind); });
}

void requireCellStages(const Solid& solid, const Scene& scene) {
  if (hasStatics(scene) && isOfPoints(solid))
    throw InputError("load steps of cells at material points are not there", "",
                     "let the body come to rest in a run or a relaxation");
  if (hasStatics(scene) && !takesLoadStepsAlone(scene))
    throw InputError("cells of grains rest in load steps, and follow the solid in other stages", "",
                     "take load steps alone, or none: a run with slow loads is a test too");
  if (solid.implicitSteps)
    throw InputError("cells of grains answer too coarsely for implicit steps", "stepping",
                     "leave it out, or take load steps");
}

namespace {

/// Of cells at the start, mean, Pa.
double pressureOf(const Solid& solid, const Built& built) {
  for (const SolidMaterial* const material : materialsOf(solid))
    if (const auto* const law = std::get_if<GrainCells>(&material->law))
      return rve::stress(banked(built, law->cells).front()).pressure;
  return 0.0;
}

/// @throws InputError naming the node that the stress of the cells pushes most, if next to nothing holds it; of
/// material points it is a note
void requireHeld(const coupling::SolidSide& side, const Solid& solid, double pressure,
                 std::vector<std::string>& notes) {
  constexpr double most = 0.5;
  const fem::Nodes& nodes = side.nodes();
  std::vector<Vec3> all(nodes.X.size()), inner(all.size());
  for (const auto& term : side.model->terms) {
    term->addForces(nodes, {.t = side.model->t}, all);
    if (term->isBody()) term->addForces(nodes, {.t = side.model->t}, inner);
  }
  const fem::DofMap& dofs = side.mass->dofs();
  std::vector<double> free(dofs.size());  // with what ties pass on
  dofs.reduce(all, free);
  double largest = 0.0, worst = 0.0;
  std::size_t at = 0;
  for (const Vec3& f : inner) largest = std::max({largest, std::abs(f.x), std::abs(f.y), std::abs(f.z)});
  for (std::size_t q = 0; q < free.size(); ++q) {
    const auto dof = static_cast<std::size_t>(dofs.freeDofs()[q]);
    if (dofs.role(dof) == fem::Role::free && std::abs(free[q]) > worst) worst = std::abs(free[q]), at = dof / 3;
  }
  if (worst <= most * largest) return;
  const Vec3& X = nodes.X[at];
  const std::string what = "the cells of \"" + solid.name + "\" start under a pressure of " + rounded(pressure) +
                           " Pa, which nothing holds ",
                    place = "(" + formatNumber(X.x) + ", " + formatNumber(X.y) + ", " + formatNumber(X.z) + ")";
  if (isOfPoints(solid)) {
    notes.push_back("WARNING: In " + solid.where + " " + what + "near " + place +
                    ", where the body starts to move. To let it rest, end it at borders of \"grid\" or walls, and "
                    "deal cells of little pressure \"by depth\".");
    return;
  }
  throw InputError(
      what + "at node " + std::to_string(at) + " " + place, solid.where,
      solid.regions.empty()
          ? "give each of its faces without a support a load {\"type\": \"pressure\", \"pressure\": \"" +
                rounded(1e-3 * pressure) + " kPa\"}"
          : "let all its regions have cells of one pressure (elements of other laws start without stress), "
            "and each of its faces a support or a load of that pressure");
}

}  // namespace

void requireHeldCells(Built& built, const Scene& scene) {
  for (std::size_t s = 0; s < scene.solids.size(); ++s) {
    const Solid& solid = scene.solids[s];
    const double pressure = pressureOf(solid, built);
    const bool mayMeetWalls = isOfPoints(solid) && std::ranges::any_of(scene.couplings, [&](const Coupling& one) {
                                return one.solid == solid.name;
                              });
    if (pressure > 0.0 && !solid.state && !mayMeetWalls)
      requireHeld(std::as_const(*built.run).solid(s), solid, pressure, built.notes);
  }
}

double confinedModulus(const GrainCells& law, const Built& built) {
  return rve::voigtTangent(banked(built, law.cells).front())(0, 0);
}

}  // namespace dovetail::scene
