#include "view.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace dovetail::scene {

namespace {

/// Ends of values without the outermost 0.2 % on either side, where these stretch them to more than twice the length.
std::pair<double, double> endsOf(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const std::size_t few = values.size() / 500;
  const double low = values[few], high = values[values.size() - 1 - few];
  const bool stretched = values.back() - values.front() > 2.0 * (high - low);
  return stretched && values.size() > 50 ? std::pair{low, high} : std::pair{values.front(), values.back()};
}

constexpr double degree = std::numbers::pi / 180.0;

bool isFlat(const geometry::Box& box, int axis) {
  return box.upper[axis] - box.lower[axis] <= 1e-6 * norm(box.upper - box.lower);
}

}  // namespace

geometry::Box boxOf(const picture::Drawing& drawing) {
  geometry::Box box{{1e300, 1e300, 1e300}, {-1e300, -1e300, -1e300}};
  for (int c = 0; c < 3; ++c) {
    const auto take = [&](double low, double high) {
      box.lower[c] = std::min(box.lower[c], low);
      box.upper[c] = std::max(box.upper[c], high);
    };
    if (!drawing.balls.empty()) {
      std::vector<double> places;
      double radius = 0.0;
      for (const picture::Ball& ball : drawing.balls) {
        places.push_back(ball.centre[c]);
        radius = std::max(radius, ball.radius);
      }
      const auto [low, high] = endsOf(std::move(places));
      take(low - radius, high + radius);
    }
    for (const picture::Triangle& triangle : drawing.triangles)
      for (const Vec3& corner : triangle.corner) take(corner[c], corner[c]);
    for (const picture::Rod& rod : drawing.rods)
      take(std::min(rod.from[c], rod.to[c]) - rod.radius, std::max(rod.from[c], rod.to[c]) + rod.radius);
    if (box.lower[c] > box.upper[c]) box.lower[c] = -1.0, box.upper[c] = 1.0;
  }
  return box;
}

picture::Camera viewOf(const geometry::Box& box, const Vec3& given, std::optional<double> azimuth,
                       std::optional<double> elevation) {
  // Plane strain is looked at across its plane.
  const bool isPlane = isFlat(box, 2);
  const Vec3 up = isPlane && std::abs(normalized(given).z) > 0.9 ? Vec3{0, 1, 0} : given;
  if (isPlane && !azimuth && !elevation) azimuth = elevation = 0.0;
  const Vec3 z = normalized(up), size = box.upper - box.lower;
  // Horizontal directions: the one that azimuths count from, and the one to the right of it.
  Vec3 front = Vec3{0, -1, 0} + dot(Vec3{0, 1, 0}, z) * z;
  if (norm(front) < 0.1) front = Vec3{0, 0, 1} - z.z * z;
  front = normalized(front);
  const Vec3 side = cross(z, front);
  const auto along = [&](const Vec3& d) {
    return std::abs(d.x) * size.x + std::abs(d.y) * size.y + std::abs(d.z) * size.z;
  };
  const double deep = along(front), wide = along(side), high = along(z);
  const bool turned = wide < 0.8 * deep;
  const double shorter = std::min(deep, wide), longer = std::max(deep, wide);
  const double offset = shorter < 0.3 * longer || shorter < 0.3 * high ? 18.0 : 28.0;
  const double flat = 1.0 - std::min(1.0, high / std::max(1e-300, longer));
  const double a = degree * azimuth.value_or((turned ? 90.0 : 0.0) + offset),
               e = degree * elevation.value_or(12.0 + 18.0 * flat);
  const Vec3 ahead = std::cos(a) * front + std::sin(a) * side;
  picture::Camera camera;
  camera.back = std::cos(e) * ahead + std::sin(e) * z;
  camera.right = normalized(cross(z, ahead));
  camera.up = cross(camera.back, camera.right);
  camera.centre = 0.5 * (box.lower + box.upper);
  return camera;
}

bool isSeenFromItsEdge(const geometry::Box& box, const picture::Camera& camera) {
  for (int axis = 0; axis < 3; ++axis)
    if (isFlat(box, axis) && std::abs(camera.back[axis]) < 1e-3) return true;
  return false;
}

void Extent::add(const picture::Camera& camera, const Vec3& place, double radius) {
  const double x = dot(place - camera.centre, camera.right), y = dot(place - camera.centre, camera.up);
  left = std::min(left, x - radius);
  right = std::max(right, x + radius);
  below = std::min(below, y - radius);
  above = std::max(above, y + radius);
}

}  // namespace dovetail::scene
