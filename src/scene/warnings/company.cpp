// Parts of a scene that are not where the others are.
#include <cmath>

#include "build/extent.hpp"
#include "build/sizes.hpp"
#include "build/time_functions.hpp"
#include "dovetail/core/finite.hpp"
#include "dovetail/dem/model/walls.hpp"
#include "reach.hpp"
#include "warnings.hpp"

namespace dovetail::scene {

namespace {

// ---- probes

std::size_t nearestOf(const std::vector<Vec3>& places, const Vec3& at) {
  const auto nearer = [&](const Vec3& a, const Vec3& b) { return squaredNorm(a - at) < squaredNorm(b - at); };
  return static_cast<std::size_t>(std::ranges::min_element(places, nearer) - places.begin());
}

/// Longest way from a node to another one of its elements, m.
double spacingAt(const fem::SolidMesh& mesh, std::size_t node) {
  double longest = 0.0;
  for (const fem::ElementGroup& group : mesh.groups) {
    const auto corners = static_cast<std::size_t>(fem::nodesOf(group.shape));
    for (std::size_t e = 0; e < group.size(); ++e) {
      const std::span<const int> own(group.node.data() + corners * e, corners);
      if (std::ranges::find(own, static_cast<int>(node)) == own.end()) continue;
      for (const int other : own)
        longest = std::max(longest, norm(mesh.X[static_cast<std::size_t>(other)] - mesh.X[node]));
    }
  }
  return longest;
}

void reportFar(const Probe& probe, const std::string& what, const Vec3& at, const Vec3& place, double near,
               Lines& lines) {
  if (norm(place - at) > near)
    lines.push_back("The probe " + quoted(probe.name) + " follows the nearest " + what + ", which is " +
                    rounded(norm(place - at)) + " m from its place, at " + placeText(place) +
                    ": give it a place where there is one.");
}

void lookAtProbes(const Built& built, const Scene& scene, Lines& lines) {
  const dem::Particles& p = built.run->grains.particles;
  for (const Probe& probe : scene.output.probes) {
    if (const auto* const grain = std::get_if<GrainProbe>(&probe.of); grain && p.size() > 0) {
      const std::size_t i = nearestOf(p.x, grain->at);
      reportFar(probe, "grain", grain->at, p.x[i], 4.0 * p.radius[i], lines);
    }
    const auto* const node = std::get_if<NodeProbe>(&probe.of);
    for (std::size_t s = 0; node && s < scene.solids.size(); ++s) {
      if (scene.solids[s].name != node->solid) continue;
      const fem::SolidMesh& mesh = built.meshes[s];
      const std::size_t n = nearestOf(mesh.X, node->at);
      const auto* const points = std::get_if<PointMesh>(&scene.solids[s].mesh);
      reportFar(probe, points ? "point" : "node", node->at, mesh.X[n],
                points ? points->grid.spacing : spacingAt(mesh, n), lines);
    }
  }
}

// ---- insertions, outlets, domain

/// Of places for the centres of the smallest spheres, those before all walls and in the domain.
double fractionWithin(const dem::Model& grains, const Insertion& insertion) {
  constexpr int each = 9;
  const std::size_t walls = std::as_const(grains).terms.all<dem::PrimitiveWallTerm>().size();
  const double r = enteringOf(insertion).smallest;
  const Vec3 lower = insertion.region.lower + Vec3{r, r, r}, edges = insertion.region.upper - Vec3{r, r, r} - lower;
  int within = 0;
  for (int k = 0; k < each * each * each; ++k) {
    const auto along = [&](int axis, int n) { return lower[axis] + std::max(0.0, edges[axis]) * n / (each - 1); };
    const Vec3 x{along(0, k % each), along(1, k / each % each), along(2, k / (each * each))};
    bool isIn = !grains.domain || holds(grains.domain->box, x);
    for (std::size_t w = 0; isIn && w < walls; ++w) {
      const dem::PrimitiveWall& wall = dem::primitiveWall(grains, w);
      isIn = dem::distanceTo(wall, wall.point + grains.pairs.periodicity().minimumImage(x - wall.point)).distance > 0.0;
    }
    within += isIn ? 1 : 0;
  }
  return static_cast<double>(within) / (each * each * each);
}

/// Whether all of a box lies behind one plane.
bool isBehindWall(const dem::Model& grains, const geometry::Box& box) {
  const std::size_t walls = std::as_const(grains).terms.all<dem::PrimitiveWallTerm>().size();
  for (std::size_t w = 0; w < walls; ++w) {
    const dem::PrimitiveWall& wall = dem::primitiveWall(grains, w);
    bool behind = wall.shape == dem::PrimitiveWall::Shape::plane;
    for (int corner = 0; behind && corner < 8; ++corner) {
      const Vec3 x{corner & 1 ? box.upper.x : box.lower.x, corner & 2 ? box.upper.y : box.lower.y,
                   corner & 4 ? box.upper.z : box.lower.z};
      behind = dem::distanceTo(wall, x).distance <= 0.0;
    }
    if (behind) return true;
  }
  return false;
}

bool anyMoves(const Scene& scene) {
  if (std::ranges::any_of(scene.stages, [](const Stage& one) { return one.changes && !one.changes->walls.empty(); }))
    return true;
  return std::ranges::any_of(scene.walls, [](const Wall& one) {
    return one.servo || one.turn || !isConstant(one.displacement.value_or(one.velocity)) ||
           norm(constantOf(one.velocity)) > 0.0;
  });
}

/// Where grains are to come to be counted or taken.
void lookAtRegion(const Built& built, const Scene& scene, const std::string& whose, const geometry::Box& region,
                  Lines& lines) {
  const std::string begin = "The region of " + whose;
  if (built.run->grains.particles.size() == 0 && scene.insertions.empty())
    lines.push_back(begin + " stays empty, as the scene has no grains: add grains, or leave the region out.");
  else if (isBeyondReach(built, scene, region))
    lines.push_back(begin + " is out of reach of all grains: move it, or check its unit.");
  else if (!anyMoves(scene) && isBehindWall(built.run->grains, region))
    lines.push_back(begin +
                    " lies behind a wall, out of reach of grains: move it inside, or leave a side of walls open.");
}

void lookAtStreams(const Built& built, const Scene& scene, Lines& lines) {
  for (std::size_t k = 0; k < scene.insertions.size(); ++k) {
    const double within = fractionWithin(built.run->grains, scene.insertions[k]);
    const std::string name = "The region of " + item("insertions", k);
    if (within < 0.5)
      lines.push_back(name + (within == 0.0 ? " is" : " is " + percent(1.0 - within)) +
                      " behind walls or outside of the domain, where no grains can be inserted: move it inside.");
    for (std::size_t o = 0; o < scene.outlets.size(); ++o)
      if (meet(scene.insertions[k].region, scene.outlets[o].region))
        lines.push_back(name + " overlaps that of " + item("outlets", o) +
                        ", where inserted grains are removed at once: move them apart.");
  }
  for (std::size_t o = 0; o < scene.outlets.size(); ++o)
    lookAtRegion(built, scene, item("outlets", o), scene.outlets[o].region, lines);
  for (const Probe& probe : scene.output.probes)
    if (const auto* const region = std::get_if<RegionProbe>(&probe.of); region && region->solid.empty())
      lookAtRegion(built, scene, "the probe " + quoted(probe.name), region->box, lines);
  const std::vector<Vec3>& x = built.run->grains.particles.x;
  for (std::size_t o = 0; o < scene.outlets.size(); ++o) {
    const auto count = std::ranges::count_if(x, [&](const Vec3& at) { return holds(scene.outlets[o].region, at); });
    if (count > 0)
      lines.push_back(std::to_string(count) + " grains lie in the region of " + item("outlets", o) +
                      " at the start and are removed at once: leave them out, or move the region.");
  }
}

// ---- solids

void lookAtCouplings(const Built& built, const Scene& scene, Lines& lines) {
  const dem::Particles& particles = built.run->grains.particles;
  const bool anyGrains = countOfGrains(particles) > 0 || !scene.insertions.empty();
  for (const Coupling& coupling : scene.couplings) {
    if (std::holds_alternative<PointSpheres>(coupling.kind)) continue;
    const bool onSurface = std::holds_alternative<SurfaceContact>(coupling.kind);  // which points of others meet too
    if (!anyGrains && !(onSurface && particles.size() > 0))
      lines.push_back("The scene has no grains, so that the coupling of " + quoted(coupling.solid) +
                      " does nothing: give it particles or insertions, or leave the coupling out.");
    if (!onSurface) continue;
    for (std::size_t s = 0; s < scene.solids.size(); ++s)
      if (scene.solids[s].name == coupling.solid && isOutOfReach(built, scene, s))
        lines.push_back(
            "No grains can reach " + quoted(coupling.solid) +
            ", so that its surface coupling does nothing: move the grains or the solid, or leave the coupling out.");
  }
}

// ---- paths

void lookAtPaths(const Scene& scene, Lines& lines) {
  const auto jumpOf = [&](const auto& one) { return pathOf(one.velocity, one.displacement, scene).displacement(0.0); };
  const std::string begins = ", as its displacement is not 0 at t = 0: let it start at 0, such as \"0.1*min(t, 1)\"";
  for (std::size_t w = 0; w < scene.walls.size(); ++w) {
    const Wall& wall = scene.walls[w];
    if (const Vec3 jump = jumpOf(wall); norm(jump) > 0.0 && !isConstant(*wall.displacement))
      lines.push_back(item("walls", w) + " starts displaced by " + placeText(jump) + begins +
                      ", or give the wall its displaced position.");
    if (wall.turn && functionOf(wall.turn->angle, scene)(0.0) != 0.0)
      lines.push_back(item("walls", w) +
                      " starts turned, as the angle of its turn is not 0 at t = 0: let it start at 0, or give the wall "
                      "its turned position.");
  }
  for (std::size_t d = 0; d < scene.drives.size(); ++d)
    if (const Vec3 jump = jumpOf(scene.drives[d]); norm(jump) > 0.0)
      lines.push_back("The grains of " + item("drives", d) + " lie " + placeText(jump) + " from their path" + begins +
                      "; they move along it from their own positions.");
  for (std::size_t d = 0; d < scene.drives.size(); ++d)
    if (const auto& turn = scene.drives[d].turn; turn && functionOf(turn->angle, scene)(0.0) != 0.0)
      lines.push_back("The angle of the turn of " + item("drives", d) +
                      " is not 0 at t = 0; its grains turn on from their own positions: let it start at 0.");
}

}  // namespace

void lookAtCompany(const Built& built, const Scene& scene, Lines& lines) {
  lookAtProbes(built, scene, lines);
  lookAtStreams(built, scene, lines);
  lookAtCouplings(built, scene, lines);
  lookAtPaths(scene, lines);
}

}  // namespace dovetail::scene
