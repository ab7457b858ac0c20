// Couplings of a scene.
#include <algorithm>
#include <set>

#include "dovetail/arlequin/handed_load.hpp"
#include "dovetail/arlequin/overlap_tie.hpp"
#include "dovetail/arlequin/weights.hpp"
#include "dovetail/core/finite.hpp"
#include "dovetail/fem/mesh/cell_topology.hpp"
#include "dovetail/surface/surface_contact.hpp"
#include "parts.hpp"
#include "warnings.hpp"

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
                       "give every face one coupling, by sets of the solid for example");
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
  surface::Skin skin = surface::makeSkin(mesh.X, faces);
  const bool alone = first == 0 && end == faces.size();
  if (contact.kernel.word == "advised" && surface::meetsPeriod(skin, built.run->grains.pairs.periodicity()))
    built.notes.push_back("Contacts on \"" + coupling.solid + "\" (" + contact.on +
                          ") have no kernel, as it goes on beyond a side of the periodic space.");
  else if (contact.kernel.word == "advised")
    surface::coarseGrain(skin, surface::advisedKernel(mesh));
  else if (contact.kernel.word.empty())
    surface::coarseGrain(skin, {{.width = contact.kernel.number}, cg::KernelCorrection::symmetric});
  return alone ? skin : surface::partOf(skin, first, end);
}

void add(Built& built, std::size_t solid, const Coupling& coupling, const SurfaceContact& contact, const Scene& scene) {
  dem::Model& grains = built.run->grains;
  if (contact.contact && !contact.contactMaterial.empty())
    throw InputError("these contacts have a law and a material", "", "leave contact or contact_material out");
  surface::Skin skin = skinOf(built, built.meshes[solid], coupling, contact, scene);
  skin.wall.material = contactRow(scene, contact.contactMaterial);
  grains.terms.add(surface::SurfaceContact(built.run->solid(solid), surface::Coupling(std::move(skin)),
                                           contact.contact ? makeLaws(*contact.contact) : grains.laws,
                                           "grains on " + coupling.solid + " (" + contact.on + ")"));
}

/// Takes out the grains beyond their border.
void leaveOut(Built& built, const fem::SolidMesh& mesh, const coupling::SolidSide& side,
              const std::vector<double>& weight, double leastShare) {
  const std::vector<int> beyond = arlequin::particlesBeyond(built.run->grains, mesh, side.nodes(), weight, leastShare);
  if (beyond.empty()) return;
  dem::removeParticles(built.run->grains, beyond);
  built.notes.push_back(std::to_string(beyond.size()) + " grains beyond the border of the particles in \"" + side.name +
                        "\" were left out.");
}

/// Initial stress of a solid under its loads and those of the grains.
void takeOver(Built& built, const fem::SolidMesh& mesh, coupling::SolidSide& side, const std::vector<double>& weight,
              double leastShare) {
  constexpr double tolerance = 1e-3;
  // A thousandth of the load is far below what a tie of elements cannot balance grain by grain anyway.
  double change = 0.0;
  const int rounds = arlequin::takeOver(built.run->grains, mesh, *side.model, weight,
                                        {.tolerance = tolerance, .leastShare = leastShare}, &change);
  double farthest = 0.0;
  for (const Vec3& u : side.nodes().u) farthest = std::max(farthest, norm(u));
  built.notes.push_back("\"" + side.name + "\" took over its grains in " + std::to_string(rounds) +
                        " rounds: its nodes moved by up to " + formatNumber(farthest) + " m." +
                        (change > tolerance
                             ? " What is handed over jumps by " + rounded(100.0 * change) +
                                   " % of the largest force on a node there, as grains pass the faces of elements."
                             : ""));
}

void add(Built& built, std::size_t solid, const Coupling&, const Overlap& overlap, const Scene&) {
  dem::Model& grains = built.run->grains;
  const fem::SolidMesh& mesh = built.meshes[solid];
  coupling::SolidSide& side = built.run->solid(solid);
  const std::vector<double> weight = overlapWeights(overlap, mesh);
  if (overlap.takeOver) takeOver(built, mesh, side, weight, overlap.floor);
  leaveOut(built, mesh, side, weight, overlap.floor);  // after that: the border moves with the mesh
  arlequin::CouplingOptions options;
  options.projection.width = overlap.kernel;
  options.penalty = overlap.penalty.number;
  options.leastShare = overlap.floor;
  if (overlap.multipliers) options.constraint = arlequin::ConstraintKind::multiplier;
  grains.terms.add(arlequin::makeOverlapTie(grains, mesh, weight, side, options));
}

}  // namespace

std::vector<double> overlapWeights(const Overlap& overlap, const fem::SolidMesh& mesh) {
  const double length = overlap.solidBorder - overlap.particleBorder;
  if (length == 0.0) throw InputError("the borders of an overlap are at one place", "", "give them some distance");
  std::vector<double> place;
  for (const Vec3& X : mesh.X) {
    const double share = (X[overlap.axis] - overlap.particleBorder) / length;
    place.push_back(share < -1e-9 ? arlequin::beyondOverlap : std::clamp(1.0 - share, 0.0, 1.0));
  }
  return arlequin::nodalWeights(
      place, {.profile = static_cast<arlequin::WeightProfile>(overlap.profile), .floor = overlap.floor});
}

void addCouplings(Built& built, const Scene& scene) {
  for (const Coupling& coupling : scene.couplings)
    atPlace(coupling.where, [&] {
      const std::size_t solid = solidNamed(coupling.solid, *built.run);
      std::visit([&](const auto& kind) { add(built, solid, coupling, kind, scene); }, coupling.kind);
    });
}

}  // namespace dovetail::scene
