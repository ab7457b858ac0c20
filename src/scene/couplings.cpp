// Couplings of a scene.
#include <algorithm>

#include "dovetail/arlequin/handed_load.hpp"
#include "dovetail/arlequin/overlap_tie.hpp"
#include "dovetail/arlequin/weights.hpp"
#include "dovetail/core/finite.hpp"
#include "dovetail/surface/surface_contact.hpp"
#include "parts.hpp"
#include "warnings.hpp"

namespace dovetail::scene {

namespace {

void add(Built& built, std::size_t solid, const Coupling& coupling, const SurfaceContact& contact, const Scene& scene) {
  dem::Model& grains = built.run->grains;
  const fem::SolidMesh& mesh = built.meshes[solid];
  if (contact.contact && !contact.contactMaterial.empty())
    throw InputError("these contacts have a law and a material", "", "leave contact or contact_material out");
  surface::Skin skin = surface::makeSkin(mesh.X, fem::faceSet(mesh, contact.on));
  skin.wall.material = contactRow(scene, contact.contactMaterial);
  if (contact.kernel.word == "advised")
    surface::coarseGrain(skin, surface::advisedKernel(mesh));
  else if (contact.kernel.word.empty())
    surface::coarseGrain(skin, {{.width = contact.kernel.number}, cg::KernelCorrection::symmetric});
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
