// Grains that nothing keeps from falling.
#include <cmath>

#include "build/extent.hpp"
#include "build/sizes.hpp"
#include "dovetail/dem/model/loads.hpp"
#include "dovetail/dem/model/walls.hpp"
#include "warnings.hpp"

namespace dovetail::scene {

namespace {

/// Whether walls stop all that fall: planes below, and hulls around.
bool stopAll(const dem::Model& grains, const Vec3& down) {
  constexpr double slope = 1e-9;
  using Shape = dem::PrimitiveWall::Shape;
  for (const auto* term : std::as_const(grains).terms.all<dem::PrimitiveWallTerm>()) {
    const dem::PrimitiveWall& wall = term->wall;
    const double along = dot(wall.axis, down);
    if (wall.shape == Shape::plane ? along < -slope : wall.shape == Shape::sphere || std::abs(along) < 1.0 - slope)
      return true;
  }
  return false;
}

/// Shadows that parts cast against the fall, in axes whose last one points down.
class Shadows {
public:
  explicit Shadows(const Vec3& down) : down_(down), first_(anyNormalTo(down)), second_(cross(down, first_)) {}
  void add(const std::vector<Vec3>& places) {
    Extent one;
    for (const Vec3& x : places) one.add(turned(x));
    if (!one.isEmpty()) shadows_.push_back(one);
  }
  bool isEmpty() const { return shadows_.empty(); }
  /// Whether a sphere is above one of them, or beside it.
  bool holds(const Vec3& x, double radius) const { return holds(turned(x), radius, radius); }
  /// The same of a box, as if it were as wide as it is long.
  bool holds(const geometry::Box& box, double radius) const {
    Extent region;
    for (int corner = 0; corner < 8; ++corner)
      region.add(turned({corner & 1 ? box.upper.x : box.lower.x, corner & 2 ? box.upper.y : box.lower.y,
                         corner & 4 ? box.upper.z : box.lower.z}));
    const Vec3 middle = 0.5 * (region.lower + region.upper);
    return holds({middle.x, middle.y, region.lower.z}, radius + 0.5 * region.size(), radius);
  }

private:
  bool holds(const Vec3& at, double radius, double below) const {
    for (const Extent& one : shadows_)
      if (at.x > one.lower.x - radius && at.x < one.upper.x + radius && at.y > one.lower.y - radius &&
          at.y < one.upper.y + radius && at.z < one.upper.z + below)
        return true;
    return false;
  }
  static Vec3 anyNormalTo(const Vec3& direction) {
    const Vec3 other = std::abs(direction.x) < 0.9 ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
    return normalized(cross(direction, other));
  }
  Vec3 turned(const Vec3& x) const { return {dot(x, first_), dot(x, second_), dot(x, down_)}; }
  Vec3 down_, first_, second_;
  std::vector<Extent> shadows_;
};

Shadows shadowsIn(const Built& built, const Scene& scene, const Vec3& down) {
  const dem::Model& grains = built.run->grains;
  Shadows shadows(down);
  for (const auto* term : std::as_const(grains).terms.all<dem::MeshWallTerm>()) shadows.add(term->mesh.wall.x);
  for (std::size_t s = 0; s < scene.solids.size(); ++s)
    if (std::ranges::any_of(scene.couplings, [&](const Coupling& one) { return one.solid == scene.solids[s].name; }))
      shadows.add(built.meshes[s].X);
  for (const auto* drive : std::as_const(grains).terms.all<dem::DriveTerm>())
    for (const std::int64_t id : drive->ids())
      if (const int i = dem::find(grains.particles, id); i >= 0)
        shadows.add({grains.particles.x[static_cast<std::size_t>(i)]});
  return shadows;
}

/// The open side of a box that gravity pulls to, as " (walls.0 is open at z+)".
std::string openSide(const Scene& scene, const Vec3& down) {
  for (std::size_t w = 0; w < scene.walls.size(); ++w)
    if (const auto* const box = std::get_if<BoxWalls>(&scene.walls[w].shape))
      for (const std::string& side : box->open)
        if ((side[1] == '+' ? 1.0 : -1.0) * down[side[0] - 'x'] > 0.5)
          return " (walls." + std::to_string(w) + " is open at " + side + ")";
  return "";
}

/// Walls or solids are there, and gravity pulls away from them.
void lookForEscapes(const Scene& scene, const Vec3& down, Lines& lines) {
  const auto isMet = [&](const Solid& solid) {
    return std::ranges::any_of(scene.couplings, [&](const Coupling& one) { return one.solid == solid.name; });
  };
  if (!std::ranges::all_of(scene.solids, isMet)) return;  // told of already
  if (scene.periodic || (scene.walls.empty() && scene.couplings.empty()) || !scene.outlets.empty() ||
      !scene.drives.empty())
    return;
  lines.push_back("Gravity pulls all grains away from the walls and solids, and nothing stops them" +
                  openSide(scene, down) +
                  ": reverse gravity, close the side, or give the scene a floor, an outlet or a domain.");
}

}  // namespace

void lookForFalling(const Built& built, const Scene& scene, Lines& lines) {
  const auto relaxes = [](const Stage& stage) { return std::holds_alternative<Relax>(stage.kind); };
  const double g = norm(scene.gravity);
  const dem::Model& grains = built.run->grains;
  const dem::Particles& p = grains.particles;
  if (g == 0.0 || (scene.domain && scene.domain->removes)) return;
  const Vec3 down = 1.0 / g * scene.gravity;
  if (stopAll(grains, down)) return;
  const Shadows shadows = shadowsIn(built, scene, down);
  const bool holdTogether = !scene.bonds.empty() || (grains.laws && std::isinf(grains.laws->reach()));
  if (!shadows.isEmpty() && (holdTogether || scene.periodic)) return;
  std::size_t count = 0;
  for (std::size_t i = 0; i < p.size(); ++i) count += shadows.holds(p.x[i], p.radius[i]) ? 0 : 1;
  const bool entering = std::ranges::any_of(
      scene.insertions, [&](const Insertion& one) { return shadows.holds(one.region, enteringOf(one).largest); });
  if (entering || (count == 0 && scene.insertions.empty())) return;
  if (count > 0 && std::ranges::any_of(scene.stages, relaxes))
    lines.push_back(std::to_string(count) + " of " + std::to_string(p.size()) +
                    " grains have nothing below them and fall without end, so that a stage that relaxes cannot reach "
                    "rest: add a wall or a solid below, or run for a time.");
  else if (count == p.size())
    lookForEscapes(scene, down, lines);
}

}  // namespace dovetail::scene
