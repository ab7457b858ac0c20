// Couplings of a scene.
#include <algorithm>
#include <set>

#include "dovetail/arlequin/arlequin_coupling.hpp"
#include "dovetail/arlequin/initial_equilibrium.hpp"
#include "dovetail/arlequin/weights.hpp"
#include "dovetail/core/finite.hpp"
#include "dovetail/fem/mesh/cell_topology.hpp"
#include "dovetail/mpm/face_contact.hpp"
#include "dovetail/mpm/point_contact.hpp"
#include "dovetail/surface/surface_contact.hpp"
#include "parts.hpp"
#include "warnings/warnings.hpp"

namespace dovetail::scene {

namespace {

void requireApart(const fem::SolidMesh& mesh, const std::string& set, const std::string& other) {
  const auto cornersOf = [](const fem::Face& face) {
    std::vector<int> node(face.node.begin(), face.node.begin() + fem::cornersOf(face.shape));
    std::sort(node.begin(), node.end());
    return node;
  };
  std::set<std::vector<int>> faces;
  for (const fem::Face& face : fem::faceSet(mesh, set)) faces.insert(cornersOf(face));
  for (const fem::Face& face : fem::faceSet(mesh, other))
    if (faces.contains(cornersOf(face)))
      throw InputError("\"" + set + "\" and \"" + other + "\", of two couplings of the solid, have faces in common", "",
                       "give every face one coupling, for example by sets of the solid");
}

cg::SurfaceKernel kernelOf(const SurfaceKernel& kernel, const fem::SolidMesh& mesh) {
  cg::SurfaceKernel found = kernel.width.word == "advised" ? surface::advisedKernel(mesh) : cg::SurfaceKernel{};
  if (kernel.width.word.empty()) found.kernel.width = kernel.width.number;
  found.kernel.shape = static_cast<cg::KernelShape>(kernel.shape);
  found.correction = static_cast<cg::KernelCorrection>(kernel.correction);
  return found;
}

/// In the plane, and of material points, facets have no kernel.
void requireBare(const SurfaceContact& contact, const char* what) {
  if (contact.spread || contact.smooth || contact.kernel.width.word.empty())
    throw InputError(std::string("faces ") + what + " are facets without a kernel", "",
                     "leave \"transfer\", \"surface\" and the number of \"kernel\" out");
}

/// The faces of all couplings of a solid with the same kernel, carried together, and those of one of them.
surface::Skin skinOf(Built& built, const fem::SolidMesh& mesh, const Coupling& coupling, const SurfaceContact& contact,
                     const Scene& scene) {
  std::vector<fem::Face> faces;
  std::size_t first = 0, end = 0;
  for (const Coupling& one : scene.couplings) {
    const auto* const other = std::get_if<SurfaceContact>(&one.kind);
    if (!other || one.solid != coupling.solid) continue;
    if (other != &contact) requireApart(mesh, contact.on, other->on);
    if (!(other->kernel == contact.kernel)) continue;
    const std::vector<fem::Face>& own = fem::faceSet(mesh, other->on);
    if (other == &contact) first = faces.size(), end = first + own.size();
    faces.insert(faces.end(), own.begin(), own.end());
  }
  const bool alone = first == 0 && end == faces.size(), plane = fem::dimensionOf(mesh) == 2;
  surface::Skin skin = plane ? surface::makeStrips(mesh.X, faces, mesh.thickness) : surface::makeSkin(mesh.X, faces);
  if (plane) return alone ? skin : surface::partOf(skin, first, end);
  if (contact.spread) return alone ? skin : surface::partOf(skin, first, end);
  if (contact.kernel.width.word == "advised" && surface::meetsPeriod(skin, built.run->grains.pairs.periodicity()))
    built.notes.push_back("Contacts on \"" + coupling.solid + "\" (" + contact.on +
                          ") have no kernel, as the surface continues across a periodic boundary.");
  else if (contact.kernel.width.word != "none")
    surface::coarseGrain(skin, kernelOf(contact.kernel, mesh));
  else if (contact.smooth)
    surface::splitAtSharpEdges(skin);
  return alone ? skin : surface::partOf(skin, first, end);
}

/// @throws InputError for parts of the coupling that exclude each other
void requireConsistent(const SurfaceContact& contact) {
  if (contact.spread && contact.smooth)
    throw InputError("a smooth surface distributes its loads by its own weights", "",
                     "take \"transfer\": \"adjoint\" or \"surface\": \"flat\"");
  if (contact.smooth && contact.edges != 0)
    throw InputError("a smooth surface has no edges of facets", "",
                     "take \"edges\": \"projected\" or \"surface\": \"flat\"");
  if (contact.spread && contact.kernel.correction != 0)
    throw InputError("a spread load has no correction of its kernel, and \"symmetric\" is the default", "",
                     "write \"kernel_correction\": \"none\" beside \"transfer\": \"spread\"");
  if (contact.contact && !contact.contactMaterial.empty())
    throw InputError("these contacts have both a law and a contact material", "",
                     "leave contact or contact_material out");
}

/// The kernel of a spread load ends where its set does.
void requireAlone(const Built& built, const fem::SolidMesh& mesh, const Coupling& coupling,
                  const SurfaceContact& contact, const Scene& scene) {
  if (!contact.spread) return;
  const auto onSurface = std::ranges::count_if(scene.couplings, [&](const Coupling& one) {
    return one.solid == coupling.solid && std::holds_alternative<SurfaceContact>(one.kind);
  });
  if (onSurface > 1)
    throw InputError("a spread load does not reach into the faces of another coupling of \"" + coupling.solid + "\"",
                     "", "name one set for both, or take \"transfer\": \"adjoint\"");
  const surface::Skin skin = surface::makeSkin(mesh.X, fem::faceSet(mesh, contact.on));
  if (contact.kernel.width.word != "none" && surface::meetsPeriod(skin, built.run->grains.pairs.periodicity()))
    throw InputError("a spread load has no kernel on a surface that continues across a periodic boundary", "",
                     "write \"kernel\": \"none\"");
}

surface::SurfaceCoupler couplingOn(surface::Skin skin, const SurfaceContact& contact, const fem::SolidMesh& mesh) {
  if (contact.smooth) return surface::SurfaceCoupler(surface::makeSmoothSurface(skin));
  surface::SurfaceCoupler coupling(std::move(skin), {.edges = static_cast<dem::EdgeRule>(contact.edges)});
  if (contact.spread)
    coupling.spreadLoad(
        surface::SpreadLoad(kernelOf(contact.kernel, mesh), mesh.X, coupling.skin(), fem::faceSet(mesh, contact.on)));
  return coupling;
}

void add(Built& built, std::size_t solid, const Coupling& coupling, const SurfaceContact& contact, const Scene& scene) {
  dem::Model& grains = built.run->grains;
  requireConsistent(contact);
  if (fem::dimensionOf(built.meshes[solid]) == 2) requireBare(contact, "of plane strain");
  requireAlone(built, built.meshes[solid], coupling, contact, scene);
  surface::Skin skin = skinOf(built, built.meshes[solid], coupling, contact, scene);
  skin.wall.material = contactRow(scene, contact.contactMaterial);
  surface::SurfaceCoupler exchange = couplingOn(std::move(skin), contact, built.meshes[solid]);
  exchange.bookWallWork(contact.spread);
  grains.terms.add(surface::SurfaceContact(built.run->solid(solid), std::move(exchange),
                                           contact.contact ? makeLaws(*contact.contact) : grains.laws,
                                           "grains on " + coupling.solid + " (" + contact.on + ")"));
}

/// Takes out the grains beyond their border.
void leaveOut(Built& built, const fem::SolidMesh& mesh, const coupling::SolidSide& side,
              const std::vector<double>& weight, double leastWeight) {
  const std::vector<int> beyond = arlequin::particlesBeyond(built.run->grains, mesh, side.nodes(), weight, leastWeight);
  if (beyond.empty()) return;
  dem::removeParticles(built.run->grains, beyond);
  built.notes.push_back(std::to_string(beyond.size()) + " grains beyond the particle border in \"" + side.name +
                        "\" were removed.");
}

/// Initial stress of a solid under its loads and those of the grains.
void initialEquilibrium(Built& built, const fem::SolidMesh& mesh, coupling::SolidSide& side,
                        const std::vector<double>& weight, double leastWeight) {
  constexpr double tolerance = 1e-3;
  // A thousandth of the load is far below what a tie of elements cannot balance grain by grain anyway.
  double change = 0.0;
  const int rounds = arlequin::initialEquilibrium(built.run->grains, mesh, *side.model, weight,
                                                  {.tolerance = tolerance, .leastWeight = leastWeight}, &change);
  double farthest = 0.0;
  for (const Vec3& u : side.nodes().u) farthest = std::max(farthest, norm(u));
  built.notes.push_back("\"" + side.name + "\" reached its initial equilibrium with the grains in " +
                        std::to_string(rounds) + " rounds: its nodes moved by up to " + formatNumber(farthest) + " m." +
                        (change > tolerance
                             ? " The load of the grains changes by " + rounded(100.0 * change) +
                                   " % of the largest nodal force between rounds, as grains cross faces of elements."
                             : ""));
}

arlequin::CouplingOptions optionsOf(const Overlap& overlap) {
  return {.form = static_cast<arlequin::GapForm>(overlap.gap),
          .projection = {.width = overlap.kernel,
                         .kernel = static_cast<cg::KernelShape>(overlap.kernelShape),
                         .normaliseKernels = overlap.normalised,
                         .perElement = overlap.perElement,
                         .reachOut = overlap.reachOut,
                         .kernelCells = overlap.perElement ? 1 : 0},
          .constraint = static_cast<arlequin::ConstraintKind>(overlap.constraint),
          .penalty = overlap.penalty.number,
          .consistentDashpot = overlap.consistentDashpot,
          .dashpotLags = overlap.staggered,
          .absorberRate = overlap.absorber,
          .leastWeight = std::max(overlap.floor, 1e-12)};
}

/// @throws InputError for parts of the overlap that exclude each other
void requireConsistent(const Overlap& overlap, const coupling::SolidSide& side, const Scene& scene) {
  const auto kind = static_cast<arlequin::ConstraintKind>(overlap.constraint);
  const bool damps = kind == arlequin::ConstraintKind::dashpot;
  const bool implicit = side.stepping == coupling::Stepping::implicitSteps;
  const auto require = [](bool good, const char* what, const char* remedy) {
    if (!good) throw InputError(what, "", remedy);
  };
  for (std::size_t k = 0; overlap.particleBox && scene.periodic && k < 3; ++k) {
    const int axis = static_cast<int>(k);
    const geometry::Box &space = scene.periodic->box, &box = *overlap.particleBox;
    const bool below = box.lower[axis] <= space.lower[axis], above = box.upper[axis] >= space.upper[axis];
    require(!scene.periodic->axes[k] || below == above, "particle_box goes across one side of the period",
            "let it span the period, or end within it");
  }
  require(scene.steps.lag == 0, "\"lag\" applies to surface couplings only", "leave steps.lag or the overlap out");
  require(!overlap.reachOut || overlap.absorber == 0.0, "the absorber cannot be used with kernels that reach outside",
          "leave kernel_reach or absorber out");
  require(!damps || overlap.penalty.word.empty(), "a dashpot has no automatic penalty", "give penalty a number");
  require(damps || !overlap.staggered, "the order \"staggered\" needs a dashpot",
          "take \"constraint\": \"dashpot\" or leave order out");
  require(implicit || !overlap.staggered, "the order \"staggered\" needs an implicit solid",
          "give the solid \"stepping\": \"implicit\" or leave order out");
  require(!overlap.staggered || scene.steps.stepsPerMacroStep == 1,
          "the order \"staggered\" needs one step of the grains per macro step",
          "take \"per_macro_step\": 1 or leave order out");
  require(!overlap.reachOut || overlap.gap != 0, "kernels that reach outside need the gap at nodes",
          "take \"gap\": \"nodal\" or leave kernel_reach out");
  require(!implicit || overlap.absorber == 0.0, "the absorber works with explicit solids only",
          "give the solid \"stepping\": \"explicit\" or leave absorber out");
}

void add(Built& built, std::size_t solid, const Coupling&, const Overlap& overlap, const Scene& scene) {
  dem::Model& grains = built.run->grains;
  const fem::SolidMesh& mesh = built.meshes[solid];
  coupling::SolidSide& side = built.run->solid(solid);
  requireConsistent(overlap, side, scene);
  const arlequin::CouplingOptions options = optionsOf(overlap);
  const std::vector<double> weight = overlapWeights(overlap, mesh);
  if (overlap.initialEquilibrium) initialEquilibrium(built, mesh, side, weight, options.leastWeight);
  leaveOut(built, mesh, side, weight, options.leastWeight);  // after that: the border moves with the mesh
  grains.terms.add(arlequin::makeArlequinCoupling(grains, mesh, weight, side, options));
}

std::shared_ptr<const mpm::PointSolid> pointsIn(const coupling::SolidSide& side) {
  for (const auto& term : side.model->terms)
    if (auto body = std::dynamic_pointer_cast<const mpm::PointSolid>(term)) return body;
  return nullptr;
}

void requireAlone(const Coupling& coupling, const Scene& scene) {
  const auto same = [&](const Coupling& one) { return one.solid == coupling.solid; };
  if (std::ranges::count_if(scene.couplings, same) > 1)
    throw InputError("the points of \"" + coupling.solid + "\" have two couplings", "", "leave one of them out");
}

void add(Built& built, std::size_t number, const Coupling& coupling, const PointSpheres& spheres, const Scene& scene) {
  requireAlone(coupling, scene);
  coupling::SolidSide& side = built.run->solid(number);
  const auto& [filling, grid] = std::get<PointMesh>(scene.solids[number].mesh);
  mpm::addSpheres(built.run->grains, side, pointsIn(side),
                  {.radius = spheres.radius.value_or(0.5 * grid.spacing / filling.perAxis),
                   .material = contactRow(scene, spheres.contactMaterial)});
}

/// On the faces of a body of points.
void addOnFaces(Built& built, std::size_t number, const Coupling& coupling, const SurfaceContact& contact,
                const Scene& scene) {
  requireAlone(coupling, scene);
  requireBare(contact, "of material points");
  const PointFaces& faces = built.faces.at(coupling.solid);
  coupling::SolidSide& side = built.run->solid(number);
  built.run->grains.terms.add(mpm::FaceContact(side, pointsIn(side), faces.set, fem::faceSet(faces.mesh, contact.on),
                                               contact.contact ? makeLaws(*contact.contact) : built.run->grains.laws,
                                               faces.mesh.thickness, contactRow(scene, contact.contactMaterial),
                                               {.edges = static_cast<dem::EdgeRule>(contact.edges)},
                                               "grains on " + coupling.solid + " (" + contact.on + ")"));
}

/// Overlaps need elements, and meshes have no points.
void requireFit(const Coupling& coupling, const Solid& solid) {
  if (isOfPoints(solid) && std::holds_alternative<Overlap>(coupling.kind))
    throw InputError("\"" + solid.name + "\" is made of material points", "",
                     "write \"type\": \"points\", or \"surface\" for a body that keeps its faces");
  if (!isOfPoints(solid) && std::holds_alternative<PointSpheres>(coupling.kind))
    throw InputError("\"" + solid.name + "\" has a mesh", "", "write \"type\": \"surface\", or \"overlap\"");
}

}  // namespace

void addCouplings(Built& built, const Scene& scene) {
  for (const Coupling& coupling : scene.couplings)
    atPlace(coupling.where, [&] {
      const std::size_t solid = solidNamed(coupling.solid, *built.run);
      requireFit(coupling, scene.solids[solid]);
      const auto* const contact = std::get_if<SurfaceContact>(&coupling.kind);
      if (contact && isOfPoints(scene.solids[solid])) return addOnFaces(built, solid, coupling, *contact, scene);
      std::visit([&](const auto& kind) { add(built, solid, coupling, kind, scene); }, coupling.kind);
    });
}

}  // namespace dovetail::scene
