#include "dovetail/picture/draw.hpp"

#include <numbers>
#include <numeric>

#include "dovetail/core/error.hpp"
#include "dovetail/core/parallel.hpp"
#include "raster.hpp"

namespace dovetail::picture {

namespace {

constexpr int bandRows = 48;

/// For each band of rows, the numbers of the items that reach into it, in their order.
class Bands {
public:
  explicit Bands(int height) : height_(height), items_(static_cast<std::size_t>((height + bandRows - 1) / bandRows)) {}
  void add(std::size_t item, double top, double bottom) {
    const double last = static_cast<double>(items_.size()) - 1.0;
    const double from = std::max(0.0, std::floor((top - 2.0) / bandRows)),
                 to = std::min(last, std::floor((bottom + 2.0) / bandRows));
    for (double band = from; band <= to; ++band)
      items_[static_cast<std::size_t>(band)].push_back(static_cast<std::uint32_t>(item));
  }
  std::size_t count() const { return items_.size(); }
  const std::vector<std::uint32_t>& of(std::size_t band) const { return items_[band]; }
  Rows rows(std::size_t band) const {
    const int top = static_cast<int>(band) * bandRows;
    return {top, std::min(height_, top + bandRows)};
  }

private:
  int height_;
  std::vector<std::vector<std::uint32_t>> items_;
};

struct Flat {
  std::array<Vec3, 3> corner;
  Vec3 normal;                    // right, up, to the viewer
  std::array<double, 3> heights;  // over the edges opposite to the corners, samples
};

class Painter {
public:
  Painter(const Drawing& drawing, const Camera& camera, int width, int height, const Look& look)
      : drawing_(drawing),
        project_(camera, width, height, look.samples),
        look_(look),
        width_(width),
        height_(height),
        samples_(width * look.samples, height * look.samples, look.background) {}

  Image image() {
    opaque();
    darken();
    veils();
    rods();
    return mean();
  }

private:
  void take(int x, int y, double depth, const Vec3& normal, Colour colour, const Paint& paint) {
    const std::size_t k = samples_.place(x, y);
    if (!(static_cast<float>(depth) > samples_.depth[k])) return;
    samples_.depth[k] = static_cast<float>(depth);
    samples_.colour[k] = lit(colour, 1.0 + paint.shading * (lightOn(normal) - 1.0));
    for (int c = 0; c < 3; ++c)
      samples_.normal[k][static_cast<std::size_t>(c)] = static_cast<signed char>(127.0 * normal[c]);
  }

  Flat flatOf(const Triangle& triangle) const {
    Flat flat;
    for (std::size_t k = 0; k < 3; ++k) flat.corner[k] = project_(triangle.corner[k]);
    const Vec3 a = flat.corner[1] - flat.corner[0], b = flat.corner[2] - flat.corner[0];
    Vec3 n = cross({a.x, -a.y, a.z}, {b.x, -b.y, b.z});
    const double area = std::abs(n.z), size = norm(n);
    flat.normal = size > 0.0 ? n * ((n.z < 0.0 ? -1.0 : 1.0) / size) : Vec3{0, 0, 1};
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3 e = flat.corner[(k + 2) % 3] - flat.corner[(k + 1) % 3];
      flat.heights[k] = area / std::max(1e-9, std::hypot(e.x, e.y));
    }
    return flat;
  }

  /// Colour of a point of a triangle.
  Colour colourAt(const Triangle& triangle, const Flat& flat, const std::array<double, 3>& w) const {
    const double value = w[0] * triangle.value[0] + w[1] * triangle.value[1] + w[2] * triangle.value[2];
    const Colour colour = colourOf(drawing_.paints[triangle.paint], value);
    for (std::size_t k = 0; k < 3; ++k)
      if ((triangle.edges >> k & 1) != 0 && w[(k + 2) % 3] * flat.heights[(k + 2) % 3] < 0.5 * look_.samples)
        return between(colour, {40, 40, 45}, look_.edgeDarkness);
    return colour;
  }

  bool isVeil(const Triangle& triangle) const { return drawing_.paints[triangle.paint].opacity < 1.0; }

  Bands bandsOfTriangles(const std::vector<std::uint32_t>& which) const {
    Bands bands(samples_.height);
    for (const std::uint32_t k : which) {
      const auto& corner = drawing_.triangles[k].corner;
      const auto [low, high] = std::minmax({project_(corner[0]).y, project_(corner[1]).y, project_(corner[2]).y});
      bands.add(k, low, high);
    }
    return bands;
  }

  void opaque() {
    Bands balls(samples_.height);
    for (std::size_t k = 0; k < drawing_.balls.size(); ++k) {
      const double y = project_(drawing_.balls[k].centre).y, r = project_.length(drawing_.balls[k].radius);
      balls.add(k, y - r, y + r);
    }
    std::vector<std::uint32_t> which;
    for (std::uint32_t k = 0; k < drawing_.triangles.size(); ++k)
      if (!isVeil(drawing_.triangles[k])) which.push_back(k);
    const Bands triangles = bandsOfTriangles(which);
    parallelTasks(balls.count(), [&](std::size_t band) {
      const Rows rows = balls.rows(band);
      for (const std::uint32_t k : balls.of(band)) {
        const Ball& ball = drawing_.balls[k];
        const Paint& paint = drawing_.paints[ball.paint];
        const Colour colour = colourOf(paint, ball.value);
        rasterBall(project_(ball.centre), project_.length(ball.radius), rows, samples_.width,
                   [&](int x, int y, double depth, const Vec3& n) { take(x, y, depth, n, colour, paint); });
      }
      for (const std::uint32_t k : triangles.of(band)) {
        const Triangle& triangle = drawing_.triangles[k];
        const Flat flat = flatOf(triangle);
        rasterTriangle(flat.corner, rows, samples_.width, [&](int x, int y, double depth, const auto& w) {
          take(x, y, depth, flat.normal, colourAt(triangle, flat, w), drawing_.paints[triangle.paint]);
        });
      }
    });
  }

  /// Fraction of the light of all directions that reaches a sample between its neighbours (after McGuire et al. 2011,
  /// the Alchemy screen-space ambient obscurance). @param turn  of the pattern of neighbours, rad
  double openness(int x, int y, double reach, double turn) const {
    const std::size_t here = samples_.place(x, y);
    if (samples_.depth[here] == Samples::nothing) return 1.0;
    const auto& packed = samples_.normal[here];
    const Vec3 n{packed[0] / 127.0, packed[1] / 127.0, packed[2] / 127.0};
    constexpr int count = 24;
    double shut = 0.0;
    for (int k = 0; k < count; ++k) {
      const double r = reach * std::sqrt((k + 0.5) / count),
                   angle = turn + k * std::numbers::pi * (3.0 - std::sqrt(5.0));
      const int qx = x + static_cast<int>(std::lround(r * std::cos(angle))),
                qy = y + static_cast<int>(std::lround(r * std::sin(angle)));
      if (qx < 0 || qy < 0 || qx >= samples_.width || qy >= samples_.height) continue;
      const float depth = samples_.depth[samples_.place(qx, qy)];
      if (depth == Samples::nothing) continue;
      const Vec3 v{static_cast<double>(qx - x), static_cast<double>(y - qy),
                   static_cast<double>(depth - samples_.depth[here])};
      const double far2 = squaredNorm(v) / (reach * reach), above = dot(v, n) - 0.03 * reach;
      if (above > 0.0 && far2 < 1.0) shut += above / norm(v) * (1.0 - far2);
    }
    return std::max(0.3, 1.0 - 2.6 * shut / count);
  }

  /// The middle sample of a pixel.
  std::pair<int, int> middleOf(int x, int y) const {
    return {look_.samples * x + look_.samples / 2, look_.samples * y + look_.samples / 2};
  }
  float depthAt(int x, int y) const {
    const auto [sx, sy] = middleOf(x, y);
    return samples_.depth[samples_.place(sx, sy)];
  }

  /// Neighbouring pixels look into 16 directions of their own; their mean, over what is as deep, has no pattern.
  double smoothed(const std::vector<float>& open, int x, int y, double reach) const {
    const float here = depthAt(x, y);
    double sum = 0.0, count = 0.0;
    for (int j = std::max(0, y - 1); j < std::min(height_, y + 3); ++j)
      for (int i = std::max(0, x - 1); i < std::min(width_, x + 3); ++i)
        if (std::abs(depthAt(i, j) - here) < 0.3 * reach) {
          sum += open[static_cast<std::size_t>(j) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(i)];
          count += 1.0;
        }
    return count > 0.0 ? sum / count : 1.0;
  }

  void darken() {
    const double reach = std::min(project_.length(look_.crevice), 60.0 * look_.samples);
    if (reach < 2.0) return;
    std::vector<float> open(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_));
    const auto forEachPixel = [&](auto&& act) {
      parallelFor(static_cast<std::size_t>(height_), 16, [&](std::size_t begin, std::size_t end) {
        for (int y = static_cast<int>(begin); y < static_cast<int>(end); ++y)
          for (int x = 0; x < width_; ++x) act(x, y);
      });
    };
    forEachPixel([&](int x, int y) {
      const auto [sx, sy] = middleOf(x, y);
      const double turn = 2.0 * std::numbers::pi * ((x & 3) * 4 + (y & 3)) / 16.0;
      open[static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x)] =
          static_cast<float>(openness(sx, sy, reach, turn));
    });
    const int s = look_.samples;
    forEachPixel([&](int x, int y) {
      const double light = smoothed(open, x, y, reach);
      for (int j = 0; light < 1.0 && j < s; ++j)
        for (int i = 0; i < s; ++i) {
          const std::size_t k = samples_.place(s * x + i, s * y + j);
          if (samples_.depth[k] != Samples::nothing) samples_.colour[k] = lit(samples_.colour[k], light);
        }
    });
  }

  void veils() {
    std::vector<std::uint32_t> which;
    std::vector<double> depth(drawing_.triangles.size());
    for (std::uint32_t k = 0; k < drawing_.triangles.size(); ++k)
      if (isVeil(drawing_.triangles[k])) {
        which.push_back(k);
        for (const Vec3& corner : drawing_.triangles[k].corner) depth[k] += project_(corner).z;
      }
    std::stable_sort(which.begin(), which.end(), [&](std::uint32_t a, std::uint32_t b) { return depth[a] < depth[b]; });
    const Bands bands = bandsOfTriangles(which);
    parallelTasks(bands.count(), [&](std::size_t band) {
      for (const std::uint32_t k : bands.of(band)) {
        const Triangle& triangle = drawing_.triangles[k];
        const Paint& paint = drawing_.paints[triangle.paint];
        const Flat flat = flatOf(triangle);
        const double light = 1.0 + paint.shading * (lightOn(flat.normal) - 1.0);
        rasterTriangle(flat.corner, bands.rows(band), samples_.width, [&](int x, int y, double z, const auto& w) {
          const std::size_t at = samples_.place(x, y);
          if (static_cast<float>(z) <= samples_.depth[at]) return;
          samples_.colour[at] = between(samples_.colour[at], lit(colourAt(triangle, flat, w), light), paint.opacity);
        });
      }
    });
  }

  void rods() {
    if (drawing_.rods.empty()) return;
    Bands bands(samples_.height);
    for (std::size_t k = 0; k < drawing_.rods.size(); ++k) {
      const Rod& rod = drawing_.rods[k];
      const auto [low, high] = std::minmax({project_(rod.from).y, project_(rod.to).y});
      bands.add(k, low - project_.length(rod.radius), high + project_.length(rod.radius));
    }
    std::fill(samples_.depth.begin(), samples_.depth.end(), Samples::nothing);
    parallelTasks(bands.count(), [&](std::size_t band) {
      for (const std::uint32_t k : bands.of(band)) {
        const Rod& rod = drawing_.rods[k];
        const Paint& paint = drawing_.paints[rod.paint];
        rasterRod(project_(rod.from), project_(rod.to), project_.length(rod.radius), bands.rows(band), samples_.width,
                  [&](int x, int y, double z, const Vec3& n) { take(x, y, z, n, colourOf(paint, rod.value), paint); });
      }
    });
  }

  Image mean() const {
    Image image(width_, height_, look_.background);
    const int s = look_.samples;
    parallelFor(static_cast<std::size_t>(height_), 16, [&](std::size_t begin, std::size_t end) {
      for (int y = static_cast<int>(begin); y < static_cast<int>(end); ++y)
        for (int x = 0; x < width_; ++x) {
          int sum[3] = {s * s / 2, s * s / 2, s * s / 2};
          for (int j = 0; j < s; ++j)
            for (int i = 0; i < s; ++i) {
              const Colour c = samples_.colour[samples_.place(s * x + i, s * y + j)];
              sum[0] += c.red, sum[1] += c.green, sum[2] += c.blue;
            }
          const auto channel = [&](int k) { return static_cast<std::uint8_t>(sum[k] / (s * s)); };
          image.at(x, y) = {channel(0), channel(1), channel(2)};
        }
    });
    return image;
  }

  const Drawing& drawing_;
  Projection project_;
  Look look_;
  int width_, height_;
  Samples samples_;
};

}  // namespace

Image draw(const Drawing& drawing, const Camera& camera, int width, int height, const Look& look) {
  if (width < 1 || height < 1 || look.samples < 1)
    throw InputError("the picture has no size", "picture", "give a positive one");
  return Painter(drawing, camera, width, height, look).image();
}

}  // namespace dovetail::picture
