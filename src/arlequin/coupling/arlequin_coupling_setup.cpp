// How an overlap tie is made.
#include <algorithm>
#include <cmath>
#include <string>

#include "arlequin_coupling_impl.hpp"
#include "dovetail/arlequin/weights.hpp"
#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"
#include "dovetail/dem/bodies/body_term.hpp"
#include "dovetail/fem/elements/solid.hpp"
#include "overlap/overlap_locator.hpp"

namespace dovetail::arlequin {

namespace {

constexpr double roundOff = 1e-9;

void requireWeights(const fem::SolidMesh& mesh, const fem::Model& solid, std::span<const double> weight) {
  std::vector<double> levelled(weight.begin(), weight.end());
  levelMidNodes(mesh, levelled);
  for (std::size_t n = 0; n < levelled.size(); ++n)
    if (!(std::abs(levelled[n] - weight[n]) <= roundOff))
      throw InputError("the weight of node " + std::to_string(n) + " is not the mean of the corners about it",
                       "overlap", "call levelMidNodes for the weights of second-order meshes");
  for (const auto& term : solid.terms) {
    const auto* const elements = dynamic_cast<const fem::Solid*>(term.get());
    if (elements == nullptr) continue;
    const std::span<const double> ofSolid = elements->fraction();
    for (std::size_t e = 0; e < elements->size(); ++e)
      for (const int n : cellOf(mesh, elements->number(e)).node) {
        const auto at = static_cast<std::size_t>(n);
        if (!(std::abs((ofSolid.empty() ? 1.0 : ofSolid[at]) - (1.0 - weight[at])) <= roundOff))
          throw InputError("the weight of the solid at node " + std::to_string(n) + " is " +
                               formatNumber(ofSolid.empty() ? 1.0 : ofSolid[at]) + ", the particles' weight there " +
                               formatNumber(weight[at]),
                           "overlap", "make the elements with SolidOptions::fraction = solidWeights(weights)");
      }
  }
}

/// The mesh is the solid's: the same nodes at the same places.
void requireOwnMesh(const fem::SolidMesh& mesh, const fem::Nodes& nodes, const std::string& solid) {
  for (std::size_t n = 0; n < std::max(mesh.X.size(), nodes.X.size()); ++n)
    if (n >= mesh.X.size() || n >= nodes.X.size() || mesh.X[n] != nodes.X[n])
      throw InputError("node " + std::to_string(n) + " of the mesh is not that of the solid \"" + solid + "\"",
                       "overlap", "give the mesh that the solid was made of");
}

/// Particles of another overlap keep their weight.
void leaveOthers(Overlap& overlap, const dem::Particles& particles) {
  Overlap own = overlap;
  own.particle.clear(), own.place.clear(), own.x.clear(), own.weight.clear();
  for (std::size_t k = 0; k < overlap.size(); ++k) {
    if (particles.weightOf(static_cast<std::size_t>(overlap.particle[k])) != 1.0) continue;
    addMember(own, overlap.particle[k], overlap.place[k], overlap.x[k], overlap.weight[k]);
  }
  overlap = std::move(own);
}

/// Rows of wide kernels meet so many others that factors grow with the square of their number.
void requireNarrowKernels(const Overlap& overlap, const fem::SolidMesh& mesh, const CouplingOptions& options) {
  constexpr double widest = 2.5 * (1.0 + 1e-9);  // element sizes
  constexpr std::size_t fewRows = 4000;
  const bool solves = options.constraint == ConstraintKind::multiplier ||
                      (options.constraint == ConstraintKind::penalty && options.form == GapForm::atParticles);
  if (!solves || options.projection.width == 0.0) return;
  std::vector<char> isRow(mesh.X.size(), 0);
  double size = 0.0;
  for (const int e : overlap.elements) {
    size += elementSize(mesh, e) / static_cast<double>(overlap.elements.size());
    for (const int n : cellOf(mesh, e).corner()) isRow[static_cast<std::size_t>(n)] = 1;
  }
  const auto rows = static_cast<std::size_t>(std::ranges::count(isRow, 1));
  if (rows > fewRows && options.projection.width > widest * size)
    throw InputError(std::to_string(rows) +
                         " coupled nodes are too many for kernels wider than 2.5 elements: each of " +
                         "them would couple to thousands of others",
                     "overlap", "take kernels of up to " + formatNumber(2.5 * size) + " m, or a coarser mesh");
}

void requireMembers(const Overlap& overlap, const dem::Model& m, double leastWeight) {
  std::size_t few = 0;
  std::int64_t first = -1;
  for (std::size_t k = 0; k < overlap.size(); ++k) {
    const auto i = static_cast<std::size_t>(overlap.particle[k]);
    if (m.particles.isMember(i))
      throw InputError("particle " + std::to_string(m.particles.id[i]) +
                           " in the overlap is a member of a clump, which cannot be weighted",
                       "overlap", "keep clumps out of the overlap");
    if (overlap.weight[k] >= leastWeight * (1.0 - 1e-6)) continue;
    if (few++ == 0) first = m.particles.id[i];
  }
  if (few > 0)
    throw InputError(std::to_string(few) + " particles have a weight below " + formatNumber(leastWeight) +
                         ", the first is " + std::to_string(first),
                     "overlap", "remove those that particlesBeyond lists, or lower leastWeight to the weights' floor");
}

}  // namespace

std::unique_ptr<ArlequinCoupling> makeArlequinCoupling(dem::Model& grains, const fem::SolidMesh& mesh,
                                                       std::vector<double> nodalWeight, coupling::SolidSide& side,
                                                       const CouplingOptions& options) {
  requireNonNegative(options.penalty, "penalty");
  requireNonNegative(options.absorberRate, "absorber");
  requirePositive(options.leastWeight, "least weight");
  if (options.projection.width > 0.0 && grains.pairs.periodicity().any())
    throw InputError("kernels do not act across periodic boundaries", "overlap", "take width 0 in periodic space");
  if (options.dashpotLags &&
      (options.constraint != ConstraintKind::dashpot || side.stepping != coupling::Stepping::implicitSteps))
    throw InputError("only dashpots on implicit solids lag", "overlap",
                     "take ConstraintKind::dashpot and Stepping::implicitSteps, or no lag");
  if (options.projection.kernelCells < 0)
    throw InputError("kernelCells is " + std::to_string(options.projection.kernelCells), "ProjectionOptions",
                     "give 0 (as many as they need) or more");
  requireOwnMesh(mesh, side.nodes(), side.name);
  std::unique_ptr<ArlequinCoupling> tie(new ArlequinCoupling(side));
  ArlequinCoupling::Impl& s = *tie->impl_;
  const double reach = options.projection.reachOut ? options.projection.width : 0.0;
  s.overlap = locateOverlap(grains.particles, mesh, side.nodes(), nodalWeight, reach, grains.pairs.periodicity());
  requireWidth(s.overlap, mesh);
  requireNarrowKernels(s.overlap, mesh, options);
  leaveOthers(s.overlap, grains.particles);
  if (s.overlap.size() == 0)
    throw InputError("all its particles belong to another overlap", "overlap", "give each solid particles of its own");
  requireWeights(mesh, *side.model, nodalWeight);
  requireMembers(s.overlap, grains, options.leastWeight);
  s.setting = {mesh, options, std::move(nodalWeight), penaltyOfElements(mesh, *side.model, options), 0.0};
  s.setting.bulkDensity = bulkDensityOf(s.overlap, mesh, grains.particles);
  double mass = 0.0;
  std::vector<double> weight = grains.particles.weight;
  weight.resize(grains.particles.size(), 1.0);
  for (std::size_t k = 0; k < s.overlap.size(); ++k) {
    const auto i = static_cast<std::size_t>(s.overlap.particle[k]);
    weight[i] = s.overlap.weight[k];
    mass += grains.particles.mass[i];
    s.meanRadius += grains.particles.mass[i] * grains.particles.radius[i];
    s.largestRadius = std::max(s.largestRadius, grains.particles.radius[i]);
    s.overlap.x[k] -= s.atMember(k, side.nodes().u);
  }
  s.meanRadius /= mass;
  grains.particles.weight = std::move(weight);
  s.number(grains.particles);
  s.findNear(grains);
  return tie;
}

std::vector<int> particlesBeyond(const dem::Model& grains, const fem::SolidMesh& mesh, const fem::Nodes& nodes,
                                 std::span<const double> nodalWeight, double leastWeight) {
  const std::vector<Vec3> position = positionsOf(nodes.X, nodes.u);
  const OverlapLocator locator(mesh, position, nodalWeight, grains.pairs.periodicity());  // as the tie finds them
  std::vector<int> beyond;
  for (std::size_t i = 0; i < grains.particles.size(); ++i)
    if (locator.find(grains.particles.x[i], grains.particles.radius[i]).weight < leastWeight * (1.0 - 1e-6))
      beyond.push_back(static_cast<int>(i));
  return beyond;
}

}  // namespace dovetail::arlequin
