#include "reach.hpp"

#include <cmath>

#include "build/extent.hpp"
#include "build/time_functions.hpp"
#include "dovetail/dem/model/walls.hpp"

namespace dovetail::scene {

namespace {

/// Farthest way of a path while the scene runs, m.
template <class Moved>
double wayOf(const Moved& moved, const Scene& scene) {
  constexpr int samples = 50;
  const auto path = pathOf(moved.velocity, moved.displacement, scene).displacement;
  double farthest = 0.0;
  for (int k = 0; k <= samples; ++k) farthest = std::max(farthest, norm(path(durationOf(scene) * k / samples)));
  return farthest;
}
template <class Moved>
double farthestOf(const std::vector<Moved>& all, const Scene& scene) {
  double farthest = 0.0;
  for (const Moved& one : all) farthest = std::max(farthest, wayOf(one, scene));
  return farthest;
}

/// Grains go far along those.
bool slides(const dem::Model& grains, const Vec3& gravity) {
  constexpr double slope = 1e-3;
  const double g = norm(gravity);
  for (const auto* term : std::as_const(grains).terms.all<dem::PrimitiveWallTerm>()) {
    const double down = g > 0.0 ? std::abs(dot(term->wall.axis, gravity)) / g : 1.0;
    const bool steep =
        term->wall.shape == dem::PrimitiveWall::Shape::plane ? down > slope && down < 1.0 - slope : down < 1.0 - slope;
    if (steep || !std::isfinite(g)) return true;
  }
  return false;
}

/// Ways that nobody knows, or that stages change.
bool movesUnforeseen(const Scene& scene) {
  return std::ranges::any_of(scene.stages, [](const Stage& one) { return one.changes.has_value(); }) ||
         std::ranges::any_of(scene.walls, [](const Wall& one) { return one.servo.has_value(); }) ||
         std::ranges::any_of(scene.drives,
                             [](const Drive& one) { return one.turn || norm(one.angularVelocity) > 0.0; });
}

/// Where grains are and enter, and where they fall from there.
std::vector<Extent> sourcesOf(const Built& built, const Scene& scene) {
  std::vector<Extent> all(1);
  all[0].add(built.run->grains.particles.x);
  for (const Insertion& one : scene.insertions) {
    all.emplace_back();
    all.back().add(one.region.lower);
    all.back().add(one.region.upper);
  }
  std::erase_if(all, [](const Extent& one) { return one.isEmpty(); });
  return all;
}

/// Of all that moves by itself.
double speedOf(const Built& built, const Scene& scene) {
  double fastest = 0.0;
  for (const Vec3& v : built.run->grains.particles.v) fastest = std::max(fastest, norm(v));
  for (const Insertion& one : scene.insertions) fastest = std::max(fastest, norm(one.velocity));
  for (const Solid& one : scene.solids) fastest = std::max(fastest, norm(one.velocity));
  return fastest;
}

double sizeOfWalls(const Built& built, const Scene& scene, const std::vector<Extent>& sources) {
  Extent all;
  for (const Wall& wall : scene.walls)
    if (const auto* const box = std::get_if<BoxWalls>(&wall.shape)) all.add(box->box.lower), all.add(box->box.upper);
  for (const Extent& one : sources) all.add(one.lower), all.add(one.upper);
  for (const auto* term : std::as_const(built.run->grains).terms.all<dem::MeshWallTerm>()) all.add(term->mesh.wall.x);
  return all.size();
}

void fall(Extent& source, const Scene& scene) {
  for (int k = 0; k < 3; ++k) {
    const bool repeats = scene.periodic && scene.periodic->axes[static_cast<std::size_t>(k)];
    if (scene.gravity[k] < 0.0 || repeats) source.lower[k] = -Extent::nowhere;
    if (scene.gravity[k] > 0.0 || repeats) source.upper[k] = Extent::nowhere;
  }
}

/// Whether all that moves does so steadily, and the grains never come to the solid.
bool passesBy(const Built& built, const Scene& scene, std::size_t solid) {
  const Solid& own = scene.solids[solid];
  const dem::Particles& p = built.run->grains.particles;
  if (norm(scene.gravity) > 0.0 || scene.periodic || !scene.walls.empty() || !scene.drives.empty() ||
      !scene.insertions.empty() || scene.solids.size() > 1 || own.state || !own.loads.empty() ||
      farthestOf(own.supports, scene) > 0.0 || p.size() == 0)
    return false;
  Extent grains, body;
  for (const Vec3& v : p.v)
    if (norm(v - p.v[0]) > 1e-9 * norm(p.v[0])) return false;
  grains.add(p.x);
  grains.widen(*std::ranges::max_element(p.radius));
  body.add(built.meshes[solid].X);
  const Vec3 velocity = p.v[0] - own.velocity;
  return norm(velocity) > 0.0 && !comesTo(grains, velocity, body, durationOf(scene));
}

}  // namespace

bool isBeyondReach(const Built& built, const Scene& scene, const geometry::Box& box) {
  std::vector<Extent> sources = sourcesOf(built, scene);
  if (movesUnforeseen(scene) || sources.empty() || slides(built.run->grains, scene.gravity)) return false;
  const double spread = sizeOfWalls(built, scene, sources) + speedOf(built, scene) * durationOf(scene) +
                        farthestOf(scene.walls, scene) + farthestOf(scene.drives, scene);
  for (Extent& source : sources) {
    source.widen(spread);
    fall(source, scene);
    if (meet({source.lower, source.upper}, box)) return false;
  }
  return true;
}

bool isOutOfReach(const Built& built, const Scene& scene, std::size_t solid) {
  if (!movesUnforeseen(scene) && passesBy(built, scene, solid)) return true;
  std::vector<Extent> sources = sourcesOf(built, scene);
  if (movesUnforeseen(scene) || sources.empty() || slides(built.run->grains, scene.gravity)) return false;
  Extent body;
  body.add(built.meshes[solid].X);
  const double spread = body.size() + sizeOfWalls(built, scene, sources) + speedOf(built, scene) * durationOf(scene) +
                        farthestOf(scene.walls, scene) + farthestOf(scene.drives, scene) +
                        farthestOf(scene.solids[solid].supports, scene);
  for (Extent& source : sources) {
    source.widen(spread);
    fall(source, scene);
    if (meet({source.lower, source.upper}, {body.lower, body.upper})) return false;
  }
  return true;
}

}  // namespace dovetail::scene
