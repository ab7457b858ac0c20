// Samples of a drawing: what is nearest to the viewer at each.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "dovetail/picture/draw.hpp"

namespace dovetail::picture {

/// Rows [top, bottom) of samples. Depth grows towards the viewer and is in samples, as x and y are.
struct Samples {
  static constexpr float nothing = -std::numeric_limits<float>::infinity();
  int width = 0, height = 0;
  std::vector<float> depth;
  std::vector<Colour> colour;
  std::vector<std::array<signed char, 3>> normal;  ///< times 127: to the right, up, to the viewer

  Samples(int w, int h, Colour background)
      : width(w), height(h), depth(size(), nothing), colour(size(), background), normal(size()) {}
  std::size_t size() const { return static_cast<std::size_t>(width) * static_cast<std::size_t>(height); }
  std::size_t place(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
  }
};

/// Places in samples: x to the right, y downwards, z towards the viewer.
class Projection {
public:
  Projection(const Camera& camera, int width, int height, int samples)
      : camera_(camera),
        scale_(samples / camera.metresPerPixel),
        x_(0.5 * width * samples),
        y_(0.5 * height * samples) {}
  Vec3 operator()(const Vec3& place) const {
    const Vec3 d = place - camera_.centre;
    return {x_ + scale_ * dot(d, camera_.right), y_ - scale_ * dot(d, camera_.up), scale_ * dot(d, camera_.back)};
  }
  double length(double metres) const { return scale_ * metres; }

private:
  Camera camera_;
  double scale_, x_, y_;
};

/// Light from the left above and a little from the right. @param n  unit normal: right, up, to the viewer
inline double lightOn(const Vec3& n) {
  constexpr Vec3 key{-0.413, 0.597, 0.688}, fill{0.8, 0.1, 0.592};
  return 0.58 + 0.44 * std::max(0.0, dot(n, key)) + 0.1 * std::max(0.0, dot(n, fill));
}

inline Colour lit(Colour colour, double light) {
  const auto channel = [&](std::uint8_t v) { return static_cast<std::uint8_t>(std::min(255.0, v * light + 0.5)); };
  return {channel(colour.red), channel(colour.green), channel(colour.blue)};
}

inline Colour colourOf(const Paint& paint, double value) {
  const double place = std::clamp(value, 0.0, 1.0) * static_cast<double>(paint.colours.size());
  return paint.colours[std::min(static_cast<std::size_t>(place), paint.colours.size() - 1)];
}

/// Rows that a band may write to.
struct Rows {
  int top, bottom;
};

/// Calls act(x, y, depth, normal) for the samples of a ball in some rows; for its middle alone where it is smaller.
template <class Act>
void rasterBall(const Vec3& at, double radius, Rows rows, int width, Act&& act) {
  if (radius < 0.6) {
    const int x = static_cast<int>(std::floor(at.x)), y = static_cast<int>(std::floor(at.y));
    if (x >= 0 && x < width && y >= rows.top && y < rows.bottom) act(x, y, at.z, Vec3{0.0, 0.0, 1.0});
    return;
  }
  const int first = std::max(rows.top, static_cast<int>(std::ceil(std::max(at.y - radius, -1.0) - 0.5)));
  const int last = std::min<int>(rows.bottom - 1, static_cast<int>(std::floor(std::min(at.y + radius, 1e9) - 0.5)));
  for (int y = first; y <= last; ++y) {
    const double dy = y + 0.5 - at.y, half2 = radius * radius - dy * dy;
    if (half2 < 0.0) continue;
    const double half = std::sqrt(half2);
    const int left = std::max(0, static_cast<int>(std::ceil(std::max(at.x - half, -1.0) - 0.5)));
    const int right = std::min(width - 1, static_cast<int>(std::floor(std::min(at.x + half, 1e9) - 0.5)));
    for (int x = left; x <= right; ++x) {
      const double dx = x + 0.5 - at.x, dz = std::sqrt(std::max(0.0, half2 - dx * dx));
      act(x, y, at.z + dz, Vec3{dx / radius, -dy / radius, dz / radius});
    }
  }
}

/// Calls act(x, y, depth, weights of the corners) for the samples inside.
template <class Act>
void rasterTriangle(const std::array<Vec3, 3>& p, Rows rows, int width, Act&& act) {
  const double area = (p[1].x - p[0].x) * (p[2].y - p[0].y) - (p[2].x - p[0].x) * (p[1].y - p[0].y);
  if (!(std::abs(area) > 1e-9)) return;
  const auto [low, high] = std::minmax({p[0].y, p[1].y, p[2].y});
  const auto [near, far] = std::minmax({p[0].x, p[1].x, p[2].x});
  const int first = std::max(rows.top, static_cast<int>(std::floor(std::max(low, -1.0) - 0.5)));
  const int last = std::min(rows.bottom - 1, static_cast<int>(std::ceil(std::min(high, 1e9) - 0.5)));
  const int left = std::max(0, static_cast<int>(std::floor(std::max(near, -1.0) - 0.5)));
  const int right = std::min(width - 1, static_cast<int>(std::ceil(std::min(far, 1e9) - 0.5)));
  for (int y = first; y <= last; ++y)
    for (int x = left; x <= right; ++x) {
      const double px = x + 0.5, py = y + 0.5;
      const auto weight = [&](const Vec3& a, const Vec3& b) {
        return ((b.x - px) * (a.y - py) - (a.x - px) * (b.y - py)) / -area;
      };
      const std::array<double, 3> w{weight(p[1], p[2]), weight(p[2], p[0]), weight(p[0], p[1])};
      if (w[0] < 0.0 || w[1] < 0.0 || w[2] < 0.0) continue;
      act(x, y, w[0] * p[0].z + w[1] * p[1].z + w[2] * p[2].z, w);
    }
}

/// Calls act(x, y, depth, normal) for the samples of a round rod.
template <class Act>
void rasterRod(const Vec3& from, const Vec3& to, double radius, Rows rows, int width, Act&& act) {
  radius = std::max(radius, 0.7);
  const double dx = to.x - from.x, dy = to.y - from.y, length2 = dx * dx + dy * dy;
  const int first = std::max(rows.top, static_cast<int>(std::floor(std::max(std::min(from.y, to.y) - radius, -1.0))));
  const int last =
      std::min(rows.bottom - 1, static_cast<int>(std::ceil(std::min(std::max(from.y, to.y) + radius, 1e9))));
  const int left = std::max(0, static_cast<int>(std::floor(std::max(std::min(from.x, to.x) - radius, -1.0))));
  const int right = std::min(width - 1, static_cast<int>(std::ceil(std::min(std::max(from.x, to.x) + radius, 1e9))));
  for (int y = first; y <= last; ++y)
    for (int x = left; x <= right; ++x) {
      const double px = x + 0.5 - from.x, py = y + 0.5 - from.y;
      const double t = length2 > 0.0 ? std::clamp((px * dx + py * dy) / length2, 0.0, 1.0) : 0.0;
      const double ex = px - t * dx, ey = py - t * dy, up2 = radius * radius - ex * ex - ey * ey;
      if (up2 < 0.0) continue;
      const double dz = std::sqrt(up2);
      act(x, y, from.z + t * (to.z - from.z) + dz, Vec3{ex / radius, -ey / radius, dz / radius});
    }
}

}  // namespace dovetail::picture
