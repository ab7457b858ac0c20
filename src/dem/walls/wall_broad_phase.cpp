#include "wall_broad_phase.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "dovetail/core/finite.hpp"
#include "dovetail/core/parallel.hpp"
#include "dovetail/geometry/triangle.hpp"

namespace dovetail::dem {

namespace {

constexpr std::size_t chunkSize = 4096;
constexpr double infinite = std::numeric_limits<double>::infinity();

struct RadiusRange {
  double smallest = infinite, largest = 0.0;
  RadiusRange& operator+=(const RadiusRange& other) {
    smallest = std::min(smallest, other.smallest);
    largest = std::max(largest, other.largest);
    return *this;
  }
};

RadiusRange rangeOf(const std::vector<double>& radius) {
  return RadiusRange{} += parallelSum(radius.size(), chunkSize, [&](std::size_t begin, std::size_t end) {
           RadiusRange range;
           for (std::size_t i = begin; i < end; ++i) range += {radius[i], radius[i]};
           return range;
         });
}

geometry::Box boxOf(const std::vector<Vec3>& x, double reach) {
  geometry::Box box{x[0], x[0]};
  for (const Vec3& at : x)
    for (int k = 0; k < 3; ++k) {
      box.lower[k] = std::min(box.lower[k], at[k]);
      box.upper[k] = std::max(box.upper[k], at[k]);
    }
  return geometry::expanded(box, reach);
}

/// The box around a wall in cells, of which those are marked where a centre may be within reach of a facet.
class Cells {
public:
  Cells(const TriangulatedWall& wall, double reach, std::size_t particles) : box_(boxOf(wall.x, reach)) {
    lay(reach, std::clamp<std::size_t>(particles / 4, 1, std::size_t{1} << 18));
    for (const geometry::Facet& facet : wall.facets) mark(wall, facet, reach);
  }

  const geometry::Box& box() const { return box_; }
  bool marked(const Vec3& x) const { return marked_[index(cellOf(x))] != 0; }

private:
  using Cell = std::array<std::size_t, 3>;

  /// Cells about as large as the reach, or larger if there would be more than `most`.
  void lay(double reach, std::size_t most) {
    const Vec3 size = box_.upper - box_.lower;
    for (edge_ = reach;; edge_ *= 1.5) {
      double cells = 1.0;
      for (int k = 0; k < 3; ++k) cells *= std::max(1.0, std::ceil(size[k] / edge_));
      if (cells <= static_cast<double>(most)) break;
    }
    for (int k = 0; k < 3; ++k)
      count_[static_cast<std::size_t>(k)] = static_cast<std::size_t>(std::max(1.0, std::ceil(size[k] / edge_)));
    marked_.assign(count_[0] * count_[1] * count_[2], 0);
  }

  std::size_t index(const Cell& c) const { return (c[2] * count_[1] + c[1]) * count_[0] + c[0]; }
  Cell cellOf(const Vec3& x) const {
    Cell cell{};
    for (int k = 0; k < 3; ++k) {
      const auto axis = static_cast<std::size_t>(k);
      cell[axis] = std::min(static_cast<std::size_t>(std::max(0.0, (x[k] - box_.lower[k]) / edge_)), count_[axis] - 1);
    }
    return cell;
  }

  void mark(const TriangulatedWall& wall, const geometry::Facet& facet, double reach) {
    const auto corner = [&](std::size_t k) -> const Vec3& { return wall.x[static_cast<std::size_t>(facet[k])]; };
    const geometry::Box near = geometry::expanded(geometry::boundingBox(corner(0), corner(1), corner(2)), reach);
    const Cell first = cellOf(near.lower), last = cellOf(near.upper);
    const std::size_t covered = (last[0] - first[0] + 1) * (last[1] - first[1] + 1) * (last[2] - first[2] + 1);
    const double clear = (reach + 0.5 * std::sqrt(3.0) * edge_) * (1.0 + 1e-9);
    for (std::size_t z = first[2]; z <= last[2]; ++z)
      for (std::size_t y = first[1]; y <= last[1]; ++y)
        for (std::size_t x = first[0]; x <= last[0]; ++x) {
          char& mine = marked_[index({x, y, z})];
          if (mine) continue;
          const auto middle = [](std::size_t i) { return static_cast<double>(i) + 0.5; };
          const Vec3 centre = box_.lower + edge_ * Vec3{middle(x), middle(y), middle(z)};
          mine =
              covered <= 8 ||
              squaredNorm(centre - geometry::closestPointOnTriangle(centre, corner(0), corner(1), corner(2)).point) <=
                  clear * clear;
        }
  }

  geometry::Box box_;
  double edge_ = 0.0;
  std::array<std::size_t, 3> count_{};
  std::vector<char> marked_;
};

/// Calls visit(image, x of the image) for all images in the box.
template <class Visit>
void forEachImage(const Vec3& x, const geometry::Box& box, const Vec3& period, Visit&& visit) {
  Image first{}, last{};
  for (int k = 0; k < 3; ++k) {
    if (period[k] > 0.0) {
      const auto axis = static_cast<std::size_t>(k);
      first[axis] = static_cast<int>(std::ceil((box.lower[k] - x[k]) / period[k]));
      last[axis] = static_cast<int>(std::floor((box.upper[k] - x[k]) / period[k]));
    } else if (!(x[k] >= box.lower[k] && x[k] <= box.upper[k])) {
      return;
    }
  }
  for (Image i = first; i[0] <= last[0]; ++i[0])
    for (i[1] = first[1]; i[1] <= last[1]; ++i[1])
      for (i[2] = first[2]; i[2] <= last[2]; ++i[2]) visit(i, x + shiftOf(i, period));
}

void append(NearWall& all, const NearWall& part) {
  all.particle.insert(all.particle.end(), part.particle.begin(), part.particle.end());
  all.image.insert(all.image.end(), part.image.begin(), part.image.end());
  all.x.insert(all.x.end(), part.x.begin(), part.x.end());
  all.radius.insert(all.radius.end(), part.radius.begin(), part.radius.end());
}

}  // namespace

NearWall nearWall(const Particles& particles, const TriangulatedWall& wall, double margin, const Vec3& period) {
  NearWall all;
  if (particles.size() == 0) return all;
  const RadiusRange range = rangeOf(particles.radius);
  all.smallestRadius = range.smallest;
  if (wall.facets.empty()) return all;
  const bool repeats = squaredNorm(period) > 0.0;
  const Cells cells(wall, range.largest + margin, particles.size());
  std::vector<NearWall> parts((particles.size() + chunkSize - 1) / chunkSize);
  std::vector<char> finite(parts.size(), 1);
  parallelFor(particles.size(), chunkSize, [&](std::size_t begin, std::size_t end) {
    NearWall& part = parts[begin / chunkSize];
    for (std::size_t i = begin; i < end; ++i) {
      if (!isFinite(particles.x[i])) finite[begin / chunkSize] = 0;
      if (!finite[begin / chunkSize]) break;
      forEachImage(particles.x[i], cells.box(), period, [&](const Image& image, const Vec3& x) {
        if (!cells.marked(x)) return;
        part.particle.push_back(static_cast<int>(i));
        part.x.push_back(x);
        part.radius.push_back(particles.radius[i]);
        if (repeats) part.image.push_back(image);
      });
    }
  });
  if (std::find(finite.begin(), finite.end(), 0) != finite.end())
    requireFinite(particles.x, "particle", "position", "contact search with a wall");
  for (const NearWall& part : parts) append(all, part);
  return all;
}

}  // namespace dovetail::dem
