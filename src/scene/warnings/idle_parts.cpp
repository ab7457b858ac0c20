// Parts of a scene that do nothing, and places that do not go with periods, other parts or themselves.
#include <cmath>

#include "build/extent.hpp"
#include "build/time_functions.hpp"
#include "dovetail/arlequin/coupling_options.hpp"
#include "dovetail/core/finite.hpp"
#include "dovetail/dem/model/walls.hpp"
#include "dovetail/surface/skin.hpp"
#include "run/cell_fields.hpp"
#include "warnings.hpp"

namespace dovetail::scene {

namespace {

void lookAtIdleRanks(const Built& built, Lines& lines) {
  const int ranks = hierarchical::ranksOfFarm();
  if (ranks == 1) return;
  for (std::size_t s = 0; s < built.run->solids(); ++s)
    if (!farmsOf(*built.run->solid(s).model).empty()) return;
  lines.push_back(
      std::to_string(ranks) +
      " ranks were started, but no solid has cells of grains, or elements that they share, and one does all: start the "
      "program alone, with threads.");
}

// ---- walls

double radiusOf(const Built& built, const Scene& scene, std::size_t w) {
  if (const auto* const cylinder = std::get_if<Cylinder>(&scene.walls[w].shape)) return cylinder->radius;
  if (const auto* const sphere = std::get_if<SphereWall>(&scene.walls[w].shape)) return sphere->radius;
  Extent all;
  const auto meshes = std::as_const(built.run->grains).terms.all<dem::MeshWallTerm>();
  for (std::size_t m = built.walls[w].firstMesh; m < built.walls[w].endMesh; ++m) all.add(meshes[m]->mesh.wall.x);
  return 0.5 * all.size();
}

void lookAtTurn(const Built& built, const Scene& scene, std::size_t w, Lines& lines) {
  constexpr double fast = 100.0;  // m/s
  constexpr int samples = 50;
  const TimeValue& angle = scene.walls[w].turn->angle;
  const Travel travel = travelOf(angle, scene);
  double fastest = 0.0;
  for (int k = 0; k <= samples; ++k)
    fastest = std::max(fastest, std::abs(travel.velocity(durationOf(scene) * k / samples)));
  if (const double rim = fastest * radiusOf(built, scene, w); rim > fast)
    lines.push_back(item("walls", w) + ".turn reaches " + rounded(fastest) + " rad/s, with the rim at " + rounded(rim) +
                    " m/s: write \"(" + angle.expression + ")*pi/180\" if degrees are meant, or turn more slowly.");
}

void lookAtIdleWalls(const Built& built, const Scene& scene, Lines& lines) {
  for (std::size_t w = 0; w < scene.walls.size(); ++w) {
    if (const auto* const box = std::get_if<BoxWalls>(&scene.walls[w].shape); box && box->open.size() == 6)
      lines.push_back(item("walls", w) +
                      " is a box with all six sides open, and does nothing: leave it out, or name "
                      "fewer sides in \"open\".");
    if (scene.walls[w].turn && !isConstant(scene.walls[w].turn->angle)) lookAtTurn(built, scene, w, lines);
  }
}

/// Faster than machines move what is not thrown. A jump, such as a lid's that opens, is one piece of the path alone.
template <class Moved>
void lookAtSpeeds(const std::string& list, const std::vector<Moved>& all, double fast, const Scene& scene,
                  Lines& lines) {
  constexpr int samples = 50;
  const double piece = durationOf(scene) / samples;
  for (std::size_t k = 0; k < all.size(); ++k) {
    if (all[k].displacement && usesPlace(*all[k].displacement)) continue;
    const auto place = pathOf(all[k].velocity, all[k].displacement, scene).displacement;
    double fastest = 0.0, before = 0.0;
    for (int n = 0; n < samples; ++n) {
      const double speed = norm(place((n + 1) * piece) - place(n * piece)) / piece;
      fastest = std::max(fastest, std::min(before, speed));
      before = speed;
    }
    constexpr double absurd = 1e4;  // m/s; the time of the run is at fault then
    if (fastest > fast && fastest < absurd)
      lines.push_back(item(list, k) + " moves at up to " + rounded(fastest) + " m/s: write \"" + rounded(fastest) +
                      " mm/s\" if that is meant, or move it more slowly.");
  }
}

constexpr double machine = 30.0, lid = 90.0;  // lids are thrown open; m/s

/// What stages move.
void lookAtSpeedsOf(const Changes& changes, const std::string& of, const Scene& scene, Lines& lines) {
  std::vector<WallMotion> walls;
  for (const WallChange& one : changes.walls) {
    walls.emplace_back().velocity = one.velocity.value_or(TimeVector{});
    walls.back().displacement = one.displacement;
  }
  std::vector<Support> supports;
  for (const SupportChange& one : changes.supports) supports.push_back(one.support);
  lookAtSpeeds(of + "walls", walls, lid, scene, lines);
  lookAtSpeeds(of + "supports", supports, machine, scene, lines);
  lookAtSpeeds(of + "planes", changes.planes, machine, scene, lines);
}

// ---- couplings

bool isBefore(const Extent& grains, const geometry::Facet& facet, const std::vector<Vec3>& x) {
  const auto corner = [&](int k) { return x[static_cast<std::size_t>(facet[static_cast<std::size_t>(k)])]; };
  const Vec3 normal = cross(corner(1) - corner(0), corner(2) - corner(0));
  Vec3 farthest;  // corner of the grains along the normal
  for (int k = 0; k < 3; ++k) farthest[k] = normal[k] > 0.0 ? grains.upper[k] : grains.lower[k];
  return dot(normal, farthest - corner(0)) > 0.0;
}

bool moves(const Solid& solid) {
  const auto moved = [](const Support& one) {
    return one.turn || !isConstant(one.displacement.value_or(one.velocity));
  };
  return norm(solid.velocity) > 0.0 || solid.state || std::ranges::any_of(solid.supports, moved);
}

/// Grains within a body are told elsewhere.
bool within(const Extent& grains, const std::vector<Vec3>& x) {
  Extent body;
  body.add(x);
  for (int k = 0; k < 3; ++k)
    if (grains.lower[k] < body.lower[k] || grains.upper[k] > body.upper[k]) return false;
  return true;
}

void lookAtFaces(const Built& built, const Scene& scene, Lines& lines) {
  Extent grains;
  grains.add(built.run->grains.particles.x);
  for (const Insertion& one : scene.insertions) grains.add(one.region.lower), grains.add(one.region.upper);
  if (grains.isEmpty() || scene.periodic) return;
  for (std::size_t k = 0; k < scene.couplings.size(); ++k) {
    const Coupling& coupling = scene.couplings[k];
    const auto* const contact = std::get_if<SurfaceContact>(&coupling.kind);
    for (std::size_t s = 0; contact && s < scene.solids.size(); ++s) {
      if (scene.solids[s].name != coupling.solid) continue;
      const fem::SolidMesh& mesh = facesOf(built, scene, s);
      if (fem::dimensionOf(mesh) == 2) continue;
      if (moves(scene.solids[s]) || within(grains, mesh.X)) continue;
      const surface::Skin skin = surface::makeSkin(mesh.X, fem::faceSet(mesh, contact->on));
      const auto isMet = [&](const geometry::Facet& facet) { return isBefore(grains, facet, skin.wall.x); };
      if (std::ranges::none_of(skin.wall.facets, isMet))
        lines.push_back("All grains are behind the faces " + quoted(contact->on) + " of " + quoted(coupling.solid) +
                        ", which " + item("couplings", k) +
                        " acts on: name the faces on the side of the grains, or \"skin\" for all.");
    }
  }
}

void reportIdle(bool idle, const std::string& key, const char* why, Lines& lines) {
  if (idle) lines.push_back(key + " does nothing, as " + why + ": leave it out.");
}

/// Keys that another one makes idle.
void lookAtOptions(const Scene& scene, Lines& lines) {
  for (std::size_t k = 0; k < scene.couplings.size(); ++k) {
    const std::string of = item("couplings", k) + ".";
    if (const auto* const overlap = std::get_if<Overlap>(&scene.couplings[k].kind)) {
      const auto kind = static_cast<arlequin::ConstraintKind>(overlap->constraint);
      const Overlap usual;
      reportIdle(overlap->consistentDashpot && kind != arlequin::ConstraintKind::dashpot, of + "dashpot_matrix",
                 "there is no dashpot", lines);
      reportIdle(overlap->penalty.word.empty() && kind == arlequin::ConstraintKind::multiplier, of + "penalty",
                 "multipliers hold the gap", lines);
      reportIdle(overlap->solidBox && overlap->axis != usual.axis, of + "axis", "the overlap lies between boxes",
                 lines);
      const bool shaped = overlap->kernelShape != usual.kernelShape || overlap->normalised != usual.normalised;
      reportIdle(overlap->kernel == 0.0 && shaped, of + "kernel_shape or kernel_normalised", "there is no kernel",
                 lines);
    } else if (const auto* const contact = std::get_if<SurfaceContact>(&scene.couplings[k].kind);
               contact && contact->kernel.width.word == "none") {
      const SurfaceKernel usual;
      reportIdle(contact->kernel.shape != usual.shape, of + "kernel_shape", "there is no kernel", lines);
      reportIdle(contact->spread, of + "transfer", "there is no kernel that spreads a load", lines);
    }
  }
  reportIdle(scene.steps.lag != 0 && scene.couplings.empty(), "steps.lag", "no solid has a coupling", lines);
}

// ---- clumps

/// Marks the spheres that hang together with the first one.
void gather(const std::vector<Sphere>& spheres, std::size_t from, std::vector<char>& joined) {
  joined[from] = 1;
  for (std::size_t k = 0; k < spheres.size(); ++k) {
    const double reach = (1.0 + 1e-9) * (spheres[from].radius + spheres[k].radius);
    if (!joined[k] && norm(spheres[from].at - spheres[k].at) <= reach) gather(spheres, k, joined);
  }
}

void lookAtClumps(const Scene& scene, Lines& lines) {
  for (std::size_t c = 0; c < scene.clumps.size(); ++c) {
    const std::vector<Sphere>& spheres = scene.clumps[c].spheres;
    const std::string of = item("clumps", c) + ".spheres.";
    std::vector<char> joined(spheres.size(), 0);
    gather(spheres, 0, joined);
    if (const auto apart = std::ranges::find(joined, 0); apart != joined.end())
      lines.push_back(of + std::to_string(apart - joined.begin()) +
                      " does not touch the others, so that the clump is in pieces that move as one: move it to them, "
                      "or make clumps of the pieces.");
    for (std::size_t j = 0; j < spheres.size(); ++j)
      for (std::size_t i = 0; i < j; ++i)
        if (norm(spheres[i].at - spheres[j].at) == 0.0 && spheres[i].radius == spheres[j].radius)
          lines.push_back(of + std::to_string(i) + " and " + of + std::to_string(j) +
                          " are the same sphere, whose contacts count twice: leave one of them out.");
  }
}

// ---- periods

void lookAtWidths(const std::string& whose, const std::vector<Vec3>& x, const Periodic& space, Lines& lines) {
  Extent body;
  body.add(x);
  for (int k = 0; k < 3; ++k) {
    const double width = body.upper[k] - body.lower[k], period = space.box.upper[k] - space.box.lower[k];
    if (space.axes[static_cast<std::size_t>(k)] && width > (1.0 + 1e-6) * period)
      lines.push_back(whose + " is " + rounded(width) + " m wide along " + "xyz"[k] + ", where the period is " +
                      rounded(period) +
                      " m, and overlaps its periodic images: make it narrower, or the period longer.");
  }
}

/// Whether a wall may push along an axis.
bool pushesAlong(const dem::PrimitiveWall& wall, int axis) {
  constexpr double slope = 1e-9;
  using Shape = dem::PrimitiveWall::Shape;
  const double along = std::abs(wall.axis[axis]);
  return wall.shape == Shape::plane ? along > slope : wall.shape == Shape::sphere || along < 1.0 - slope;
}
/// Whether weight presses on a wall, which rubs then.
bool isPressed(const dem::PrimitiveWall& wall, const Vec3& gravity) {
  using Shape = dem::PrimitiveWall::Shape;
  if (wall.shape == Shape::plane) return dot(wall.axis, gravity) < 0.0;
  return wall.shape == Shape::sphere || norm(cross(wall.axis, gravity)) > 0.0;
}
bool anyHolds(const dem::Model& grains, const Vec3& gravity, int axis) {
  const auto walls = grains.terms.all<dem::PrimitiveWallTerm>();
  return !grains.terms.all<dem::MeshWallTerm>().empty() || std::ranges::any_of(walls, [&](const auto* term) {
    return pushesAlong(term->wall, axis) || isPressed(term->wall, gravity);
  });
}

void lookAtPull(const dem::Model& grains, const Scene& scene, Lines& lines) {
  if (!scene.drives.empty() || !scene.couplings.empty() || !scene.outlets.empty()) return;
  for (int k = 0; k < 3; ++k)
    if (scene.periodic->axes[static_cast<std::size_t>(k)] && scene.gravity[k] != 0.0 &&
        !anyHolds(grains, scene.gravity, k))
      lines.push_back("Gravity acts along " + std::string(1, "xyz"[k]) +
                      ", which is periodic, and no wall, solid or drive holds the grains, so that they accelerate "
                      "without end: add something that holds them, or leave that component of gravity out.");
}

void lookAtPeriods(const Built& built, const Scene& scene, Lines& lines) {
  const Periodic& space = *scene.periodic;
  for (int k = 0; k < 3 && scene.domain; ++k)
    if (const geometry::Box& box = scene.domain->box;
        space.axes[static_cast<std::size_t>(k)] &&
        (box.lower[k] > space.box.lower[k] || box.upper[k] < space.box.upper[k]))
      lines.push_back("domain.box does not span the period along " + std::string(1, "xyz"[k]) +
                      ", where no grain can leave, so that it has no effect there: make it span the period.");
  for (std::size_t s = 0; s < scene.solids.size(); ++s)
    lookAtWidths("The solid " + quoted(scene.solids[s].name), built.meshes[s].X, space, lines);
  const auto meshes = std::as_const(built.run->grains).terms.all<dem::MeshWallTerm>();
  for (std::size_t w = 0; w < built.walls.size(); ++w)
    for (std::size_t m = built.walls[w].firstMesh; m < built.walls[w].endMesh; ++m)
      lookAtWidths("The surface of " + item("walls", w), meshes[m]->mesh.wall.x, space, lines);
  lookAtPull(std::as_const(built.run->grains), scene, lines);
}

// ---- bonds and solids

void lookAtGaps(const Built& built, const Scene& scene, Lines& lines) {
  double largest = 0.0;
  for (const double radius : built.run->grains.particles.radius) largest = std::max(largest, radius);
  for (std::size_t k = 0; k < scene.bonds.size(); ++k)
    if (scene.bonds[k].gap > 2.0 * largest)
      lines.push_back(item("bonds", k) + ".gap is " + rounded(scene.bonds[k].gap) +
                      " m, larger than a grain, so that bonds pass through other grains: write about " +
                      rounded(0.1 * largest) + " m to bond neighbours.");
}

}  // namespace

void lookForIdleParts(const Built& built, const Scene& scene, Lines& lines) {
  lookAtIdleRanks(built, lines);
  lookAtIdleWalls(built, scene, lines);
  lookAtSpeeds("walls", scene.walls, lid, scene, lines);
  lookAtSpeeds("drives", scene.drives, machine, scene, lines);
  for (std::size_t s = 0; s < scene.solids.size(); ++s) {
    lookAtSpeeds(item("solids", s) + ".supports", scene.solids[s].supports, machine, scene, lines);
    lookAtSpeeds(item("solids", s) + ".planes", scene.solids[s].planes, machine, scene, lines);
  }
  for (std::size_t k = 0; k < scene.stages.size(); ++k)
    if (const auto& changes = scene.stages[k].changes)
      lookAtSpeedsOf(*changes, item("stages", k) + ".changes.", scene, lines);
  lookAtFaces(built, scene, lines);
  lookAtOptions(scene, lines);
  lookAtClumps(scene, lines);
  if (scene.periodic) lookAtPeriods(built, scene, lines);
  lookAtGaps(built, scene, lines);
}

}  // namespace dovetail::scene
