// One patch of a smooth surface: its points, and those closest to others.
#include <algorithm>
#include <cmath>

#include "dovetail/surface/smooth_surface.hpp"
#include "packed.hpp"

namespace dovetail::surface {

namespace {

/// The outward step across each edge.
constexpr std::array<std::array<int, 2>, 4> outward{{{0, -1}, {1, 0}, {0, 1}, {-1, 0}}};

/// The uniform quadratic B-spline has its knots in the middles of the faces: left of the middle it takes the first
/// three of the four control points, from there on the last three.
struct Spline {
  std::size_t first;
  std::array<double, 3> value, slope, curvature;

  explicit Spline(double t) : first(t < 0.5 ? 0 : 1) {
    const double s = t < 0.5 ? t + 0.5 : t - 0.5;
    value = {0.5 * (1.0 - s) * (1.0 - s), 0.5 + s * (1.0 - s), 0.5 * s * s};
    slope = {s - 1.0, 1.0 - 2.0 * s, s};
    curvature = {1.0, -2.0, 1.0};
  }
};

struct PatchJet {
  Vec3 s, sXi, sEta, sXiXi, sXiEta, sEtaEta;
};

PatchJet evaluate(const SmoothSurface& surface, int face, double xi, double eta) {
  const Spline b(xi), c(eta);
  const auto& control = surface.control[static_cast<std::size_t>(face)];
  Packed s{}, sXi{}, sEta{}, sXiXi{}, sXiEta{}, sEtaEta{};
  for (std::size_t j = 0; j < 3; ++j) {
    Packed line{}, slope{}, curvature{};
    for (std::size_t i = 0; i < 3; ++i) {
      const Packed point = packed(surface.x[static_cast<std::size_t>(control[b.first + i + 4 * (c.first + j)])]);
      line += b.value[i] * point;
      slope += b.slope[i] * point;
      curvature += b.curvature[i] * point;
    }
    s += c.value[j] * line;
    sXi += c.value[j] * slope;
    sXiXi += c.value[j] * curvature;
    sEta += c.slope[j] * line;
    sXiEta += c.slope[j] * slope;
    sEtaEta += c.curvature[j] * line;
  }
  return {unpacked(s), unpacked(sXi), unpacked(sEta), unpacked(sXiXi), unpacked(sXiEta), unpacked(sEtaEta)};
}

/// One projected Newton step for min ½|s(ξ) − p|² on [0, 1]²: where it leads.
std::array<double, 2> newtonStep(const PatchJet& jet, const Vec3& p, std::array<double, 2> parameter) {
  const Vec3 r = jet.s - p;
  std::array<double, 2> gradient{dot(r, jet.sXi), dot(r, jet.sEta)};
  const double flatA = squaredNorm(jet.sXi), flatD = squaredNorm(jet.sEta);
  double a = flatA + dot(r, jet.sXiXi), d = flatD + dot(r, jet.sEtaEta);
  double b = dot(jet.sXi, jet.sEta) + dot(r, jet.sXiEta);
  std::array<bool, 2> held{};
  for (int k = 0; k < 2; ++k)
    held[k] = (parameter[k] <= 0.0 && gradient[k] > 0.0) || (parameter[k] >= 1.0 && gradient[k] < 0.0);
  std::array<double, 2> change{};
  if (!held[0] && !held[1]) {
    if (a <= 0.0 || d <= 0.0 || a * d - b * b <= 0.0) {  // not convex here: Gauss–Newton
      a = flatA;
      d = flatD;
      b = dot(jet.sXi, jet.sEta);
    }
    const double determinant = a * d - b * b;
    change = {-(d * gradient[0] - b * gradient[1]) / determinant, -(a * gradient[1] - b * gradient[0]) / determinant};
  } else if (!held[0]) {
    change[0] = -gradient[0] / (a > 0.0 ? a : flatA);
  } else if (!held[1]) {
    change[1] = -gradient[1] / (d > 0.0 ? d : flatD);
  }
  for (int k = 0; k < 2; ++k) parameter[k] = std::clamp(parameter[k] + change[k], 0.0, 1.0);
  return parameter;
}

/// The same along the slope alone, which leads nearer from wherever it is not at rest.
std::array<double, 2> slopeStep(const PatchJet& jet, const Vec3& p, std::array<double, 2> parameter) {
  const Vec3 r = jet.s - p;
  return {std::clamp(parameter[0] - dot(r, jet.sXi) / squaredNorm(jet.sXi), 0.0, 1.0),
          std::clamp(parameter[1] - dot(r, jet.sEta) / squaredNorm(jet.sEta), 0.0, 1.0)};
}

double largestChange(const std::array<double, 2>& a, const std::array<double, 2>& b) {
  return std::max(std::abs(a[0] - b[0]), std::abs(a[1] - b[1]));
}

/// Where a search stands.
struct Foot {
  std::array<double, 2> parameter;
  PatchJet jet;
};

/// Goes to `next`, or by halves of the way there until p is no farther; of the shortest ways round-off decides.
/// @return false, and stays, if none of so many is nearer
bool walk(const SmoothSurface& surface, int face, const Vec3& p, std::array<double, 2> next, int halves, Foot& foot) {
  constexpr double shortest = 1e-8;
  const double before = squaredNorm(p - foot.jet.s);
  for (int k = 0; k <= halves; ++k) {
    const PatchJet jet = evaluate(surface, face, next[0], next[1]);
    if (squaredNorm(p - jet.s) <= before || largestChange(next, foot.parameter) < shortest) {
      foot = {next, jet};
      return true;
    }
    for (std::size_t c = 0; c < 2; ++c) next[c] = 0.5 * (next[c] + foot.parameter[c]);
  }
  return false;
}

/// From `foot` to the closest point. @return false if the search has not come to rest
bool descend(const SmoothSurface& surface, int face, const Vec3& p, Foot& foot) {
  constexpr double roundOff = 1e-14;
  for (int iteration = 0; iteration < 100; ++iteration) {
    const std::array<double, 2> before = foot.parameter, next = newtonStep(foot.jet, p, before);
    if (largestChange(next, before) >= roundOff && !walk(surface, face, p, next, 2, foot))
      walk(surface, face, p, slopeStep(foot.jet, p, before), 60, foot);
    if (largestChange(foot.parameter, before) < (iteration < 20 ? roundOff : 1e-9)) return true;
  }
  return false;
}

PatchPoint pointAt(const Foot& foot) {
  const auto [xi, eta] = foot.parameter;
  PatchPoint at;
  at.parameter = foot.parameter;
  at.weight = patchWeights(xi, eta);
  at.point = foot.jet.s;
  at.tangent = {foot.jet.sXi, foot.jet.sEta};
  at.edge = eta <= 0.0 ? 0 : xi >= 1.0 ? 1 : eta >= 1.0 ? 2 : xi <= 0.0 ? 3 : -1;
  return at;
}

}  // namespace

std::array<double, 16> patchWeights(double xi, double eta) {
  const Spline b(xi), c(eta);
  std::array<double, 16> weight{};
  for (std::size_t j = 0; j < 3; ++j)
    for (std::size_t i = 0; i < 3; ++i) weight[b.first + i + 4 * (c.first + j)] = b.value[i] * c.value[j];
  return weight;
}

PatchPoint pointOnPatch(const SmoothSurface& surface, int face, std::array<double, 2> parameter) {
  return pointAt({parameter, evaluate(surface, face, parameter[0], parameter[1])});
}

PatchPoint closestPointOnPatch(const SmoothSurface& surface, int face, const Vec3& p, std::array<double, 2> start) {
  bool found = false;
  Foot foot;
  withVectors([&] {
    foot = {start, evaluate(surface, face, start[0], start[1])};
    found = descend(surface, face, p, foot);
  });
  PatchPoint closest = pointAt(foot);
  closest.squaredDistance = squaredNorm(p - foot.jet.s);
  closest.found = found;
  return closest;
}

std::array<double, 2> roughlyClosest(const SmoothSurface& surface, int face, const Vec3& p) {
  std::array<double, 2> best{0.5, 0.5};
  double least = squaredNorm(p - evaluate(surface, face, 0.5, 0.5).s);
  for (double xi : {1.0 / 6.0, 0.5, 5.0 / 6.0})
    for (double eta : {1.0 / 6.0, 0.5, 5.0 / 6.0})
      if (const double d2 = squaredNorm(p - evaluate(surface, face, xi, eta).s); d2 < least) {
        least = d2;
        best = {xi, eta};
      }
  return best;
}

bool leavesThrough(const PatchPoint& foot, const Vec3& p) {
  const Vec3 r = foot.point - p;
  const std::array<double, 2> slope{dot(r, foot.tangent[0]), dot(r, foot.tangent[1])};
  const double along = outward[foot.edge][0] * slope[0] + outward[foot.edge][1] * slope[1];
  const double scale = norm(r) * norm(foot.tangent[foot.edge % 2 == 1 ? 0 : 1]);
  return along < -1e-12 * scale;
}

}  // namespace dovetail::surface
