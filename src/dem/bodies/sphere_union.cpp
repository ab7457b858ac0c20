// Integrals over the union of spheres: exact in slices, Gauss–Legendre across them.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "dovetail/core/quadrature.hpp"
#include "volume_moments.hpp"

namespace dovetail::dem {

namespace {

struct Disc {
  double x, y, r;
};

/// ∫ (1, x, y, x², xy, y²) dA.
using PlaneMoments = std::array<double, 6>;

/// ∫ cosᵐθ sinⁿθ dθ, antiderivatives at an angle.
struct ArcPowers {
  double c1, c2, c3, c4, c1s1, c2s1, c3s1, c1s2, c2s2;

  explicit ArcPowers(double t) {
    const double s = std::sin(t), c = std::cos(t);
    c1 = s;
    c2 = 0.5 * (t + s * c);
    c3 = s - s * s * s / 3.0;
    c4 = 0.25 * (s * c * c * c + 3.0 * c2);
    c1s1 = 0.5 * s * s;
    c2s1 = -c * c * c / 3.0;
    c3s1 = -0.25 * c * c * c * c;
    c1s2 = s * s * s / 3.0;
    c2s2 = c2 - c4;
  }
};

/// Green's theorem, ∫ xᵃ yᵇ dA = ∮ xᵃ⁺¹/(a + 1) yᵇ dy, at one end of an arc of a disc.
PlaneMoments arcEnd(const Disc& d, double angle) {
  const ArcPowers p(angle);
  const double x = d.x, y = d.y, r = d.r;
  const double xdy = r * (x * p.c1 + r * p.c2);
  const double x2dy = r * (x * x * p.c1 + 2.0 * x * r * p.c2 + r * r * p.c3);
  const double x3dy = r * (x * x * x * p.c1 + 3.0 * x * x * r * p.c2 + 3.0 * x * r * r * p.c3 + r * r * r * p.c4);
  const double xsdy = r * (x * p.c1s1 + r * p.c2s1);  // s = sin, the part of y that varies over r
  const double x2sdy = r * (x * x * p.c1s1 + 2.0 * x * r * p.c2s1 + r * r * p.c3s1);
  const double xs2dy = r * (x * p.c1s2 + r * p.c2s2);
  return {xdy,
          0.5 * x2dy,
          y * xdy + r * xsdy,
          x3dy / 3.0,
          0.5 * (y * x2dy + r * x2sdy),
          y * y * xdy + 2.0 * y * r * xsdy + r * r * xs2dy};
}

/// The angles of disc i that other discs cover, as intervals within [0, 2π], sorted; false if all of it is covered.
bool coveredAngles(const std::vector<Disc>& discs, std::size_t i, std::vector<std::pair<double, double>>& covered) {
  constexpr double turn = 2.0 * std::numbers::pi;
  covered.clear();
  const Disc& a = discs[i];
  for (std::size_t j = 0; j < discs.size(); ++j) {
    if (j == i) continue;
    const Disc& b = discs[j];
    const double dx = b.x - a.x, dy = b.y - a.y, distance = std::hypot(dx, dy);
    if (distance >= a.r + b.r || distance + b.r < a.r) continue;
    if (distance + a.r <= b.r) {
      if (distance + b.r == a.r && j > i) continue;  // the same disc twice: the first one counts
      return false;
    }
    const double cosine = (a.r * a.r + distance * distance - b.r * b.r) / (2.0 * distance * a.r);
    const double half = std::acos(std::clamp(cosine, -1.0, 1.0));
    double begin = std::atan2(dy, dx) - half;
    if (begin < 0.0) begin += turn;
    const double end = begin + 2.0 * half;
    covered.emplace_back(begin, std::min(end, turn));
    if (end > turn) covered.emplace_back(0.0, end - turn);
  }
  std::sort(covered.begin(), covered.end());
  return true;
}

PlaneMoments unionOfDiscs(const std::vector<Disc>& discs) {
  constexpr double turn = 2.0 * std::numbers::pi;
  PlaneMoments sum{};
  std::vector<std::pair<double, double>> covered;
  for (std::size_t i = 0; i < discs.size(); ++i) {
    if (!coveredAngles(discs, i, covered)) continue;
    covered.emplace_back(turn, turn);
    double free = 0.0;
    for (const auto& [begin, end] : covered) {
      if (begin > free) {
        const PlaneMoments to = arcEnd(discs[i], begin), from = arcEnd(discs[i], free);
        for (std::size_t k = 0; k < 6; ++k) sum[k] += to[k] - from[k];
      }
      free = std::max(free, end);
    }
  }
  return sum;
}

/// Heights at which the arcs of the slices change in kind, those that the union hides left out.
class Events {
public:
  Events(std::span<const Vec3> centre, std::span<const double> radius) : centre_(centre), radius_(radius) {
    for (std::size_t i = 0; i < centre.size(); ++i) {
      for (const double side : {-1.0, 1.0}) add(centre[i] + Vec3{0.0, 0.0, side * radius[i]}, i, i, i);
      for (std::size_t j = i + 1; j < centre.size(); ++j)
        if (meet(i, j)) addCircle(i, j);
    }
    std::sort(heights.begin(), heights.end());
  }
  std::vector<double> heights;

private:
  bool meet(std::size_t i, std::size_t j) const {
    const double d = norm(centre_[i] - centre_[j]);
    return d > 0.0 && d < radius_[i] + radius_[j] && d > std::abs(radius_[i] - radius_[j]);
  }

  void add(const Vec3& p, std::size_t i, std::size_t j, std::size_t k) {
    for (std::size_t s = 0; s < centre_.size(); ++s)
      if (s != i && s != j && s != k && norm(p - centre_[s]) < (1.0 - 1e-9) * radius_[s]) return;
    heights.push_back(p.z);
  }

  /// Top and bottom of the circle that two spheres share, and its points on third spheres.
  void addCircle(std::size_t i, std::size_t j) {
    const Vec3 d = centre_[j] - centre_[i];
    const double length = norm(d);
    const Vec3 n = d / length;
    const double along = 0.5 * (length + (radius_[i] - radius_[j]) * (radius_[i] + radius_[j]) / length);
    const double circle2 = (radius_[i] - along) * (radius_[i] + along);
    if (!(circle2 > 0.0)) return;
    const Vec3 middle = centre_[i] + along * n;
    const double tilt = std::hypot(n.x, n.y);
    if (tilt > 0.0) {
      const Vec3 up{-n.z * n.x / tilt, -n.z * n.y / tilt, tilt};
      for (const double side : {-1.0, 1.0}) add(middle + side * std::sqrt(circle2) * up, i, j, j);
    } else {
      heights.push_back(middle.z);  // the whole circle lies in one slice
    }
    for (std::size_t k = j + 1; k < centre_.size(); ++k)
      if (meet(i, k) && meet(j, k)) addPoints(i, j, k, middle, n, circle2);
  }

  void addPoints(std::size_t i, std::size_t j, std::size_t k, const Vec3& middle, const Vec3& n, double circle2) {
    const Vec3 toThird = centre_[k] - middle;
    const double off = dot(toThird, n);
    const Vec3 within = toThird - off * n;
    const double distance = norm(within);
    if (!(distance > 0.0)) return;
    const double slice2 = radius_[k] * radius_[k] - off * off;
    const double along = 0.5 * (distance + (circle2 - slice2) / distance);
    const double half2 = circle2 - along * along;
    if (!(half2 >= 0.0)) return;
    const Vec3 e = within / distance, across = cross(n, e);
    for (const double side : {-1.0, 1.0}) add(middle + along * e + (side * std::sqrt(half2)) * across, i, j, k);
  }

  std::span<const Vec3> centre_;
  std::span<const double> radius_;
};

void addSlice(std::span<const Vec3> centre, std::span<const double> radius, double z, double weight,
              std::vector<Disc>& discs, VolumeMoments& sum) {
  discs.clear();
  for (std::size_t i = 0; i < centre.size(); ++i) {
    const double h = z - centre[i].z, r2 = (radius[i] - h) * (radius[i] + h);
    if (r2 > 0.0) discs.push_back({centre[i].x, centre[i].y, std::sqrt(r2)});
  }
  PlaneMoments m = unionOfDiscs(discs);
  for (double& value : m) value *= weight;
  sum.volume += m[0];
  sum.first += Eigen::Vector3d(m[1], m[2], z * m[0]);
  Eigen::Matrix3d second;
  second << m[3], m[4], z * m[1], m[4], m[5], z * m[2], z * m[1], z * m[2], z * z * m[0];
  sum.second += second;
}

}  // namespace

VolumeMoments unionMoments(std::span<const Vec3> centre, std::span<const double> radius) {
  static const auto rule = gaussLegendre(48);
  const Events events(centre, radius);
  VolumeMoments sum;
  std::vector<Disc> discs;
  integrateBetween(events.heights, rule,
                   [&](double z, double weight) { addSlice(centre, radius, z, weight, discs, sum); });
  return sum;
}

}  // namespace dovetail::dem
