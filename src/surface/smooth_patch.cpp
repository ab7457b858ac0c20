// One patch of a smooth surface: its points, and those closest to others.
#include <algorithm>
#include <cmath>

#include "dovetail/surface/smooth_surface.hpp"

namespace dovetail::surface {

namespace {

/// The outward step across each edge.
constexpr std::array<std::array<int, 2>, 4> outward{{{0, -1}, {1, 0}, {0, 1}, {-1, 0}}};

/// The uniform quadratic B-spline has its knots in the middles of the faces: left of the middle it takes the first
/// three of the four control points, from there on the last three.
std::array<double, 4> placed(const std::array<double, 3>& three, double t) {
  return t < 0.5 ? std::array<double, 4>{three[0], three[1], three[2], 0.0}
                 : std::array<double, 4>{0.0, three[0], three[1], three[2]};
}
double sinceKnot(double t) { return t < 0.5 ? t + 0.5 : t - 0.5; }
std::array<double, 4> spline(double t) {
  const double s = sinceKnot(t);
  return placed({0.5 * (1.0 - s) * (1.0 - s), 0.5 + s * (1.0 - s), 0.5 * s * s}, t);
}
std::array<double, 4> splineSlope(double t) {
  const double s = sinceKnot(t);
  return placed({s - 1.0, 1.0 - 2.0 * s, s}, t);
}
std::array<double, 4> splineCurvature(double t) { return placed({1.0, -2.0, 1.0}, t); }

struct PatchJet {
  Vec3 s, sXi, sEta, sXiXi, sXiEta, sEtaEta;
};

PatchJet evaluate(const SmoothSurface& surface, int face, double xi, double eta) {
  const auto b = spline(xi), db = splineSlope(xi), ddb = splineCurvature(xi);
  const auto c = spline(eta), dc = splineSlope(eta), ddc = splineCurvature(eta);
  PatchJet jet;
  for (int j = 0; j < 4; ++j) {
    Vec3 line, slope, curvature;
    for (int i = 0; i < 4; ++i) {
      const Vec3& point = surface.x[surface.control[face][i + 4 * j]];
      line += b[i] * point;
      slope += db[i] * point;
      curvature += ddb[i] * point;
    }
    jet.s += c[j] * line;
    jet.sXi += c[j] * slope;
    jet.sXiXi += c[j] * curvature;
    jet.sEta += dc[j] * line;
    jet.sXiEta += dc[j] * slope;
    jet.sEtaEta += ddc[j] * line;
  }
  return jet;
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

}  // namespace

std::array<double, 16> patchWeights(double xi, double eta) {
  const auto b = spline(xi), c = spline(eta);
  std::array<double, 16> weight{};
  for (int j = 0; j < 4; ++j)
    for (int i = 0; i < 4; ++i) weight[i + 4 * j] = b[i] * c[j];
  return weight;
}

PatchPoint closestPointOnPatch(const SmoothSurface& surface, int face, const Vec3& p, std::array<double, 2> start) {
  constexpr double roundOff = 1e-14;
  PatchPoint closest;
  closest.found = false;
  Foot foot{start, evaluate(surface, face, start[0], start[1])};
  for (int iteration = 0; iteration < 100 && !closest.found; ++iteration) {
    const std::array<double, 2> before = foot.parameter, next = newtonStep(foot.jet, p, before);
    if (largestChange(next, before) >= roundOff && !walk(surface, face, p, next, 2, foot))
      walk(surface, face, p, slopeStep(foot.jet, p, before), 60, foot);
    closest.found = largestChange(foot.parameter, before) < (iteration < 20 ? roundOff : 1e-9);
  }
  closest.parameter = foot.parameter;
  const auto [xi, eta] = closest.parameter;
  closest.weight = patchWeights(xi, eta);
  closest.point = foot.jet.s;
  closest.squaredDistance = squaredNorm(p - foot.jet.s);
  closest.edge = eta <= 0.0 ? 0 : xi >= 1.0 ? 1 : eta >= 1.0 ? 2 : xi <= 0.0 ? 3 : -1;
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

bool leavesThrough(const SmoothSurface& surface, int face, const PatchPoint& foot, const Vec3& p) {
  const PatchJet jet = evaluate(surface, face, foot.parameter[0], foot.parameter[1]);
  const Vec3 r = jet.s - p;
  const std::array<double, 2> slope{dot(r, jet.sXi), dot(r, jet.sEta)};
  const double along = outward[foot.edge][0] * slope[0] + outward[foot.edge][1] * slope[1];
  const double scale = norm(r) * (foot.edge % 2 == 1 ? norm(jet.sXi) : norm(jet.sEta));
  return along < -1e-12 * scale;
}

Vec3 patchNormal(const SmoothSurface& surface, int face, const PatchPoint& at) {
  const PatchJet jet = evaluate(surface, face, at.parameter[0], at.parameter[1]);
  return normalized(cross(jet.sXi, jet.sEta));
}

}  // namespace dovetail::surface
