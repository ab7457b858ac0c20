// Solids of a scene.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <set>

#include "changes.hpp"
#include "dovetail/arlequin/overlap.hpp"
#include "dovetail/core/team.hpp"
#include "dovetail/fem/elements/solid.hpp"
#include "dovetail/fem/laws/materials.hpp"
#include "dovetail/fem/laws/point_laws.hpp"
#include "dovetail/fem/mesh/mesh_places.hpp"
#include "dovetail/fem/mesh/mesh_shapes.hpp"
#include "dovetail/fem/terms/gradient_energy.hpp"
#include "dovetail/fem/terms/loads.hpp"
#include "dovetail/hierarchical/farm.hpp"
#include "dovetail/io/names.hpp"
#include "dovetail/linalg/multigrid.hpp"
#include "from_state.hpp"
#include "keys/advice.hpp"
#include "parts.hpp"

namespace dovetail::scene {

namespace {

fem::SolidMesh meshOf(const BoxMesh& box) {
  requireMemory(1.0 * box.cells[0] * box.cells[1] * box.cells[2], "cells", BytesPer::cell, "take fewer");
  const auto shape = std::find_if(fem::allCellShapes.begin(), fem::allCellShapes.end(),
                                  [&](fem::ElementShape one) { return box.shape == fem::name(one); });
  fem::SolidMesh mesh = fem::boxOf(*shape, box.cells, box.box.lower, box.box.upper);
  return box.hole ? fem::withHole(mesh, fem::inBox(box.hole->lower, box.hole->upper)) : mesh;
}
fem::SolidMesh meshOf(const MeshFile& from, std::vector<std::string>& notes) {
  auto [mesh, told] = readMesh(from.file);
  const std::string name = std::filesystem::path(from.file).filename().string();
  for (const std::string& note : told) notes.push_back(name + ": " + note);
  for (Vec3& X : mesh.X) X = from.scale * X;
  if (!mesh.faceSets.contains("skin")) mesh.faceSets["skin"] = fem::boundaryFaces(mesh);
  return mesh;
}

/// Of the source of a solid.
fem::SolidMesh meshOf(const Solid& solid, std::vector<std::string>& notes) {
  if (const auto* const file = std::get_if<MeshFile>(&solid.mesh)) return meshOf(*file, notes);
  if (const auto* const box = std::get_if<BoxMesh>(&solid.mesh)) return meshOf(*box);
  return meshOf(std::get<TetrahedraMesh>(solid.mesh), notes);
}

/// A set of these elements, which may have another name if the mesh uses that.
std::string setOf(fem::SolidMesh& mesh, std::string name, const std::vector<int>& elements) {
  while (mesh.elementSets.try_emplace(name, elements).first->second != elements) name += " elements";
  return name;
}

fem::Formulation formulationOf(const std::string& word) {
  if (word == "mean-dilatation") return fem::Formulation::meanDilatation;
  if (word == "enhanced") return fem::Formulation::enhanced;
  if (word == "assumed-stress") return fem::Formulation::assumedStress;
  return word == "reduced" ? fem::Formulation::reduced : fem::Formulation::standard;
}

/// Answers of cells are known to a millionth, and their tangent is that before they slip.
const fem::NewtonOptions newtonOfCells{
    .relativeTolerance = 1e-4, .lineSearch = false, .reuseContraction = 0.5, .mixing = 5};

/// The coupling that is an overlap with the solid; null: none.
const Coupling* overlapWith(const Solid& solid, const Scene& scene) {
  const Coupling* found = nullptr;
  for (const Coupling& coupling : scene.couplings) {
    const auto* const overlap = std::get_if<Overlap>(&coupling.kind);
    if (!overlap || coupling.solid != solid.name) continue;
    if (found)
      throw InputError("\"" + solid.name + "\" has two overlaps", coupling.where, "give every solid one at most");
    found = &coupling;
    atPlace(coupling.where, [&] { requireBorders(*overlap); });
  }
  return found;
}

/// Of the quadrature, m.
std::vector<Vec3> quadraturePoints(const fem::SolidMesh& mesh, const fem::SolidOptions& options) {
  const auto anyLaw = fem::pointMaterial(fem::StVenantKirchhoff{1.0, 0.0, 1.0});
  return fem::makeSolid(mesh, anyLaw, options)->sample(fem::makeModel(mesh).nodes, {}).X;
}

std::shared_ptr<fem::Solid> makeElements(const fem::SolidMesh& mesh, const SolidMaterial& material,
                                         const fem::SolidOptions& options, const Built& built, const Vec3& gravity,
                                         bool loadSteps) {
  if (const auto* const cells = std::get_if<GrainCells>(&material.law)) {
    requireDimension(*cells, fem::dimensionOf(mesh), options.formulation, built);
    const CellPlaces places{mesh.X, [&] { return quadraturePoints(mesh, options); }, gravity, loadSteps};
    return fem::makeSolid(mesh, fieldOf(*cells, built, places), options);
  }
  return fem::makeSolid(mesh, makeMaterial(material), options);
}

/// Unknowns from which ranks share a solid unasked.
constexpr std::size_t worthSharing = 200'000;

/// Whether ranks share the elements: of a solid that multigrid is asked to solve, or is large.
bool isShared(const Solid& solid, const fem::SolidMesh& mesh, const Built& built, const Scene& scene) {
  const bool several = built.onRanks && (hierarchical::ranksOfFarm() > 1 || team().size() > 1);
  if (!several || (!solid.implicitSteps && !hasStatics(scene))) return false;
  const bool anyCells = std::ranges::any_of(scene.solids, [](const Solid& one) {
    return std::ranges::any_of(materialsOf(one), [](const auto* material) { return hasCells(*material); });
  });
  if (anyCells) return false;  // ranks share those
  const bool followsOrFinds = std::ranges::any_of(scene.stages, [](const Stage& stage) {
    const auto* const statics = std::get_if<Statics>(&stage.kind);
    return std::holds_alternative<FindModes>(stage.kind) || (statics && statics->arcLength);
  });
  const auto method = static_cast<linalg::LinearMethod>(solid.linearSolver);
  if (method == linalg::LinearMethod::automatic)
    return !followsOrFinds && solid.ties.empty() && !solid.gradient && 3 * mesh.X.size() >= worthSharing;
  if (method != linalg::LinearMethod::multigrid) return false;
  const auto refuse = [](const char* what, const char* remedy) { throw InputError(what, "linear_solver", remedy); };
  if (followsOrFinds) refuse("modes and paths of equilibria are not found by ranks together", "start one process");
  if (!solid.ties.empty()) refuse("ranks share no elements of meshes that are tied", "start one process");
  return true;
}

void addElements(fem::Model& model, fem::SolidMesh& mesh, const Solid& solid, const Overlap* overlap,
                 const Built& built, const Scene& scene) {
  const Vec3 gravity = solid.gravity ? scene.gravity : Vec3{};
  const bool loadSteps = takesLoadStepsAlone(scene);
  fem::SolidOptions options{.formulation = formulationOf(solid.formulation), .name = "elements"};
  if (overlap) options.fraction = arlequin::solidWeights(overlapWeights(*overlap, mesh));
  options.onRanks = isShared(solid, mesh, built, scene);
  if (options.onRanks) hierarchical::formTeam();
  const std::vector<std::size_t> material = materialByElement(solid, mesh);
  const std::vector<const SolidMaterial*> materials = materialsOf(solid);
  int first = 0;
  std::set<std::size_t> used;
  for (const fem::ElementGroup& group : mesh.groups) {
    const int end = first + static_cast<int>(group.size());
    for (std::size_t m = 0; m < materials.size(); ++m) {
      std::vector<int> elements;
      for (int e = first; e < end; ++e)
        if (material[static_cast<std::size_t>(e)] == m) elements.push_back(e);
      if (elements.empty()) continue;
      used.insert(m);
      std::string name = m > 0 ? solid.regions[m - 1].elements : "elements";
      if (mesh.groups.size() > 1) name = m > 0 ? name + " " + fem::name(group.shape) : fem::name(group.shape);
      options.name = name;
      if (elements.size() < mesh.elementCount()) options.elementSet = options.name = setOf(mesh, name, elements);
      model.add(makeElements(mesh, *materials[m], options, built, gravity, loadSteps));
    }
    first = end;
  }
  if (!used.contains(0))
    throw InputError("all elements of \"" + solid.name + "\" are in regions, and none has its material", "",
                     "leave the largest region out, and give the solid its material");
}

/// How many elements each rank has; empty unless ranks share them.
std::string onRanks(const fem::Model& model) {
  std::vector<std::size_t> elements;
  for (const auto& term : model.terms)
    if (const auto* const solid = dynamic_cast<const fem::Solid*>(term.get()); solid && solid->isShared()) {
      const std::vector<std::size_t> more = solid->sizesOnRanks();
      elements.resize(more.size(), 0);
      for (std::size_t rank = 0; rank < more.size(); ++rank) elements[rank] += more[rank];
    }
  std::string text;
  for (const std::size_t count : elements) text += (text.empty() ? "" : ", ") + std::to_string(count);
  return text;
}

/// The energy of the gradient of F in all elements.
void addGradient(fem::Model& model, const fem::SolidMesh& mesh, const Solid& solid, const Overlap* overlap) {
  const bool allPoints = solid.formulation != "reduced" && std::ranges::any_of(mesh.groups, [](const auto& group) {
                           return group.shape == fem::ElementShape::quad8;
                         });
  if (allPoints)
    throw InputError("the gradient of quad8 is taken at 2 x 2 points, the elements have 3 x 3", "gradient",
                     "write \"formulation\": \"reduced\"");
  fem::GradientOptions options{.modulus = solid.gradient->modulus};
  if (overlap) options.fraction = arlequin::solidWeights(overlapWeights(*overlap, mesh));
  model.add(fem::gradientEnergy(mesh, options));
}

/// Whether the weights of the elements rest on nodes otherwise than lumped masses do.
bool weighUnevenly(const fem::Nodes& nodes) {
  double all = 0.0, apart = 0.0;
  for (std::size_t n = 0; n < nodes.bodyMass.size(); ++n) {
    all += nodes.mass[n];
    apart += std::abs(nodes.bodyMass[n] - nodes.mass[n]);
  }
  return apart > 1e-2 * all;
}

/// Lumped masses of these shapes cannot both fall alike and weigh as the elements do.
std::string unevenWeight(const Solid& solid, const fem::SolidMesh& mesh) {
  std::string shapes;
  for (const fem::ElementGroup& group : mesh.groups)
    shapes += (shapes.empty() ? std::string() : ", ") + fem::name(group.shape);
  return "WARNING: \"" + solid.name + "\" (" + shapes +
         ") has lumped masses: gravity deforms it wrongly near its supports, by tens of per cent if the mesh is "
         "coarse. Write \"consistent_mass\": 1" +
         (solid.implicitSteps ? "." : ", or \"stepping\": \"implicit\".");
}

bool hasGrains(const Scene& scene) {
  return !scene.particles.empty() || !scene.clumps.empty() || !scene.insertions.empty();
}

void addPoints(Built& built, const Solid& solid, const Scene& scene) {
  coupling::SolidOptions options{.name = solid.name};
  options.stepping = solid.implicitSteps ? coupling::Stepping::implicitSteps : coupling::Stepping::explicitSteps;
  options.implicitOptions.linear.method = static_cast<linalg::LinearMethod>(solid.linearSolver);
  if (hasCells(solid.material)) requireCellStages(solid, scene);
  built.run->addSolid(makePoints(solid, scene, built), options);
}

void requireSolver(const Solid& solid, const Scene& scene) {
  if (solid.linearSolver != 0 && !solid.implicitSteps && !hasStatics(scene))
    throw InputError("explicit steps solve no linear systems", "linear_solver",
                     "leave it out, or give \"stepping\": \"implicit\"");
  if (static_cast<linalg::LinearMethod>(solid.linearSolver) == linalg::LinearMethod::multigrid)
    linalg::Multigrid::require("linear_solver");
}

void add(Built& built, const Solid& solid, const Scene& scene) {
  io::requirePlainName(solid.name, "name");
  if (solid.name.size() > 100)
    throw InputError("the name '" + solid.name.substr(0, 20) + "…' is too long for files", "name",
                     "use 100 letters at most");
  const bool meetsGrains = std::any_of(scene.couplings.begin(), scene.couplings.end(),
                                       [&](const Coupling& coupling) { return coupling.solid == solid.name; });
  if (!meetsGrains && hasGrains(scene))
    built.notes.push_back("WARNING: \"" + solid.name +
                          "\" has no coupling, so that grains pass through it: give it one, or leave it out.");
  requireSolver(solid, scene);
  if (isOfPoints(solid)) return addPoints(built, solid, scene);
  const Coupling* const coupling = overlapWith(solid, scene);
  const Overlap* const overlap = coupling ? &std::get<Overlap>(coupling->kind) : nullptr;
  const bool anyCells = std::ranges::any_of(materialsOf(solid), [](const auto* one) { return hasCells(*one); });
  if (overlap && anyCells)
    throw InputError("the cells of \"" + solid.name + "\" start under pressure, and an overlap bears none", "",
                     "let grains act on its surface, or give the solid another law");
  built.meshes.push_back(meshOf(solid, built.notes));
  addSets(built.meshes.back(), solid);
  fem::SolidMesh& mesh = built.meshes.back();
  if (coupling) atPlace(coupling->where, [&] { overlapPlaces(*overlap, mesh.X); });
  auto model = std::make_unique<fem::Model>(fem::makeModel(mesh));
  addElements(*model, mesh, solid, overlap, built, scene);
  if (const std::string elements = onRanks(*model); !elements.empty())
    built.notes.push_back("Solid \"" + solid.name + "\" is on " + std::to_string(team().size()) +
                          " ranks: " + elements + " elements.");
  if (solid.gradient) addGradient(*model, mesh, solid, overlap);
  if (solid.gravity && changesGravity(scene))
    model->add(fem::gravity([now = built.changing.gravity](double) { return *now; }));
  else if (solid.gravity && norm(scene.gravity) > 0.0)
    model->add(fem::gravity(scene.gravity));
  if (solid.state)
    takeSolid(*model, solid, built.notes);
  else
    for (Vec3& v : model->nodes.v) v = solid.velocity;
  addBoundaries(*model, mesh, solid, scene, built);
  const double fraction = solid.massFraction.value_or(solid.implicitSteps ? 1.0 : 0.0);
  coupling::SolidOptions options{.name = solid.name};
  options.implicitOptions.linear.method = static_cast<linalg::LinearMethod>(solid.linearSolver);
  if (anyCells) {
    requireCellStages(solid, scene);
    options.newton = newtonOfCells;
    options.motionIterations = 20000;
  }
  options.stepping = solid.implicitSteps ? coupling::Stepping::implicitSteps : coupling::Stepping::explicitSteps;
  options.massFraction = fraction;
  const coupling::SolidSide& side = built.run->addSolid(std::move(model), options);
  const bool rests = meetsGrains || !solid.supports.empty();  // what flies falls alike with lumped masses
  if (rests && fraction < 1.0 && solid.gravity && norm(scene.gravity) > 0.0 && weighUnevenly(side.nodes()))
    built.notes.push_back(unevenWeight(solid, mesh));
}

}  // namespace

std::size_t solidNamed(const std::string& name, const coupling::CoupledRun& run) {
  std::vector<std::string> names;
  for (std::size_t s = 0; s < run.solids(); ++s) names.push_back(run.solid(s).name);
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end())
    throw InputError("there is no solid \"" + name + "\"", "",
                     names.empty() ? "add it to solids" : adviceFor(name, names));
  return static_cast<std::size_t>(found - names.begin());
}

void addSolids(Built& built, const Scene& scene) {
  built.meshes.reserve(scene.solids.size());
  for (const Solid& solid : scene.solids) atPlace(solid.where, [&] { add(built, solid, scene); });
}

}  // namespace dovetail::scene
