#include "shown_walls.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "build/parts.hpp"
#include "build/time_functions.hpp"
#include "dovetail/core/quaternion.hpp"

namespace dovetail::scene {

namespace {

using picture::Triangle;

/// How a wall has moved.
struct Motion {
  Vec3 shift, about;
  Quaternion turn;
  Vec3 operator()(const Vec3& x) const { return about + shift + rotate(turn, x - about); }
};

class Walls {
public:
  Walls(const Scene& scene, const Instant& instant, const geometry::Box& box, const Vec3& back,
        const WallPaints& paints)
      : scene_(scene), instant_(instant), back_(back), paints_(paints) {
    const Vec3 size = box.upper - box.lower;
    const double longest = std::max({size.x, size.y, size.z});
    box_ = geometry::expanded(box, 0.04 * longest);
    wide_ = geometry::expanded(box, 0.3 * longest);
  }

  std::vector<Triangle> triangles;

  void add(std::size_t number) {
    const Wall& wall = scene_.walls[number];
    if (const io::FrameContent* const frame = instant_.find("wall_" + std::to_string(number))) return addFrame(*frame);
    std::visit([&](const auto& shape) { addShape(wall, shape); }, wall.shape);
  }

private:
  Motion motionOf(const Wall& wall, const Vec3& about) const {
    const double t = instant_.time, speed = norm(wall.angularVelocity);
    Vec3 rotation = t * wall.angularVelocity;
    if (wall.turn) rotation = travelOf(wall.turn->angle, scene_).displacement(t) * normalized(wall.turn->axis);
    const bool turns = wall.turn || speed > 0.0;
    return {pathOf(wall.velocity, wall.displacement, scene_).displacement(t), about,
            turns ? fromRotationVector(rotation) : Quaternion{}};
  }

  void addFrame(const io::FrameContent& frame) {
    for (std::size_t k = 0; k + 3 <= frame.cellPoint.size(); k += 3)
      addClear(frame.position[frame.cellPoint[k]], frame.position[frame.cellPoint[k + 1]],
               frame.position[frame.cellPoint[k + 2]]);
  }
  void addClear(const Vec3& a, const Vec3& b, const Vec3& c) { addPolygon({a, b, c}, wide_, paints_.clear); }

  /// What of a polygon lies in a box.
  void addPolygon(std::vector<Vec3> corners, const geometry::Box& box, std::uint8_t paint) {
    for (int axis = 0; axis < 3; ++axis)
      for (const double sign : {1.0, -1.0}) {
        const double at = sign > 0.0 ? box.upper[axis] : box.lower[axis];
        std::vector<Vec3> kept;
        for (std::size_t k = 0; k < corners.size(); ++k) {
          const Vec3 &a = corners[k], &b = corners[(k + 1) % corners.size()];
          const double from = sign * (a[axis] - at), to = sign * (b[axis] - at);
          if (from <= 0.0) kept.push_back(a);
          if ((from > 0.0) != (to > 0.0)) kept.push_back(a + from / (from - to) * (b - a));
        }
        corners = std::move(kept);
      }
    for (std::size_t k = 2; k < corners.size(); ++k)
      triangles.push_back({{corners[0], corners[k - 1], corners[k]}, {}, paint, 0});
  }

  /// A piece of a wall that looks along `normal`, towards the grains.
  void addPiece(const std::vector<Vec3>& corners, const Vec3& normal) { addPiece(corners, normal, box_); }
  void addPiece(const std::vector<Vec3>& corners, const Vec3& normal, const geometry::Box& box) {
    if (dot(normal, back_) > 1e-9 * norm(normal)) addPolygon(corners, box, paints_.solid);
  }

  /// Drums are drawn all round where they are not much larger than what is in them.
  geometry::Box boxOf(const Cylinder& cylinder, const Vec3& axis, const Vec3& point) const {
    if (!cylinder.inside) return wide_;
    const Vec3 size = box_.upper - box_.lower;
    geometry::Box box = box_;
    if (2.0 * cylinder.radius > 1.8 * std::max({size.x, size.y, size.z})) return box;
    for (int c = 0; c < 3; ++c) {
      if (std::abs(axis[c]) > 0.5) continue;
      box.lower[c] = std::min(box.lower[c], point[c] - cylinder.radius);
      box.upper[c] = std::max(box.upper[c], point[c] + cylinder.radius);
    }
    return box;
  }

  double reach() const { return norm(box_.upper - box_.lower); }
  Vec3 middle() const { return 0.5 * (box_.lower + box_.upper); }
  static std::pair<Vec3, Vec3> across(const Vec3& n) {
    const Vec3 other = std::abs(n.x) < 0.6 ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
    const Vec3 a = normalized(cross(n, other));
    return {a, cross(n, a)};
  }

  void addShape(const Wall& wall, const Plane& plane) {
    const Motion motion = motionOf(wall, plane.point);
    const Vec3 n = normalized(rotate(motion.turn, plane.normal)), point = motion(plane.point);
    const Vec3 centre = middle() - dot(middle() - point, n) * n;
    const auto [a, b] = across(n);
    const double r = reach();
    addPiece({centre + r * (a + b), centre + r * (b - a), centre - r * (a + b), centre + r * (a - b)}, n);
  }

  void addShape(const Wall& wall, const BoxWalls& walls) {
    const Motion motion = motionOf(wall, walls.box.lower);
    for (int axis = 0; axis < 3; ++axis)
      for (const bool upper : {false, true}) {
        const std::string name = std::string(1, "xyz"[axis]) + (upper ? "+" : "-");
        if (std::find(walls.open.begin(), walls.open.end(), name) != walls.open.end()) continue;
        const int first = (axis + 1) % 3, second = (axis + 2) % 3;
        std::vector<Vec3> corners(4, upper ? walls.box.upper : walls.box.lower);
        for (std::size_t k = 0; k < 4; ++k) {
          corners[k][first] = k == 0 || k == 3 ? walls.box.lower[first] : walls.box.upper[first];
          corners[k][second] = k < 2 ? walls.box.lower[second] : walls.box.upper[second];
        }
        for (Vec3& corner : corners) corner = motion(corner);
        Vec3 normal;
        normal[axis] = upper ? -1.0 : 1.0;
        addPiece(corners, normal);
      }
  }

  void addShape(const Wall& wall, const Cylinder& cylinder) {
    const Motion motion = motionOf(wall, cylinder.point);
    const Vec3 axis = normalized(rotate(motion.turn, cylinder.axis)), point = motion(cylinder.point);
    const Vec3 centre = point + dot(middle() - point, axis) * axis;
    const auto [a, b] = across(axis);
    constexpr int sides = 96;
    const auto radial = [&, a = a, b = b](double k) {
      const double angle = 2.0 * std::numbers::pi * k / sides;
      return std::cos(angle) * a + std::sin(angle) * b;
    };
    // Rollers end with what they touch.
    const Vec3 size = box_.upper - box_.lower;
    const double along = std::abs(axis.x) * size.x + std::abs(axis.y) * size.y + std::abs(axis.z) * size.z;
    const Vec3 half = (cylinder.inside ? reach() : 0.5 * along) * axis;
    const geometry::Box box = boxOf(cylinder, axis, point);
    for (int k = 0; k < sides; ++k) {
      const Vec3 p = centre + cylinder.radius * radial(k), q = centre + cylinder.radius * radial(k + 1);
      addPiece({p - half, q - half, q + half, p + half}, (cylinder.inside ? -1.0 : 1.0) * radial(k + 0.5), box);
    }
  }

  void addShape(const Wall& wall, const SphereWall& sphere) {
    const Vec3 centre = motionOf(wall, sphere.centre)(sphere.centre);
    constexpr int rings = 32, sides = 64;
    const auto at = [](int ring, int side) {
      const double theta = std::numbers::pi * ring / rings, phi = 2.0 * std::numbers::pi * side / sides;
      return Vec3{std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
    };
    for (int ring = 0; ring < rings; ++ring)
      for (int side = 0; side < sides; ++side) {
        const std::vector<Vec3> n{at(ring, side), at(ring + 1, side), at(ring + 1, side + 1), at(ring, side + 1)};
        std::vector<Vec3> corners;
        for (const Vec3& direction : n) corners.push_back(centre + sphere.radius * direction);
        addPiece(corners, (sphere.inside ? -1.0 : 1.0) * (n[0] + n[2]), sphere.inside ? box_ : wide_);
      }
  }

  void addShape(const Wall& wall, const SurfaceFile& surface) {
    const geometry::TriangleMesh mesh = readTriangles(surface.file).mesh;
    std::vector<Vec3> x;
    for (const Vec3& vertex : mesh.x) x.push_back(surface.scale * vertex + surface.shift);
    Vec3 sum;
    double area = 0.0;
    for (const auto& f : mesh.facets) {
      const Vec3 &a = x[f[0]], &b = x[f[1]], &c = x[f[2]];
      const double size = 0.5 * norm(cross(b - a, c - a));
      area += size;
      sum += size / 3.0 * (a + b + c);
    }
    const Motion motion = motionOf(wall, surface.point.value_or(area > 0.0 ? sum / area : Vec3{}));
    for (const auto& f : mesh.facets) addClear(motion(x[f[0]]), motion(x[f[1]]), motion(x[f[2]]));
  }

  const Scene& scene_;
  const Instant& instant_;
  geometry::Box box_, wide_;
  Vec3 back_;
  WallPaints paints_;
};

}  // namespace

std::vector<Triangle> wallsOf(const Scene& scene, const Instant& instant, const geometry::Box& box, const Vec3& back,
                              const WallPaints& paints) {
  Walls walls(scene, instant, box, back, paints);
  for (std::size_t k = 0; k < scene.walls.size(); ++k) walls.add(k);
  return std::move(walls.triangles);
}

}  // namespace dovetail::scene
