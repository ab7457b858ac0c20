#include "dovetail/fem/mesh/mesh_shapes.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"

namespace dovetail::fem {

namespace {

/// Sides of the parameter box by their new names; "" drops the set.
void renameSides(SolidMesh& mesh, const std::map<std::string, std::string>& names) {
  for (const auto& [from, to] : names) {
    auto nodes = mesh.nodeSets.extract(from);
    auto faces = mesh.faceSets.extract(from);
    if (to.empty()) continue;
    nodes.key() = to;
    faces.key() = to;
    mesh.nodeSets.insert(std::move(nodes));
    mesh.faceSets.insert(std::move(faces));
  }
}

/// Nodes that lie inside after joining leave the node set "skin".
void dropInnerNodes(SolidMesh& mesh) {
  std::vector<char> outside(mesh.X.size(), 0);
  for (const Face& face : mesh.faceSets["skin"])
    for (int a = 0; a < nodesOf(face.shape); ++a)
      outside[static_cast<std::size_t>(face.node[static_cast<std::size_t>(a)])] = 1;
  std::erase_if(mesh.nodeSets["skin"], [&](int node) { return !outside[static_cast<std::size_t>(node)]; });
}

/// All nodes of a set that lie above (x, y).
void addLine(SolidMesh& mesh, const std::string& name, const std::string& side, double x, double y, double tolerance) {
  std::vector<int> found;
  for (const int n : nodeSet(mesh, side)) {
    const Vec3& X = mesh.X[static_cast<std::size_t>(n)];
    if (std::hypot(X.x - x, X.y - y) <= tolerance) found.push_back(n);
  }
  if (!found.empty()) mesh.nodeSets[name] = found;
}

/// A map of (0, 1) taken at the ends of n equal cells and linear within them: mid nodes stay in the middle, without
/// which elements of second order do not hold quadratic fields.
template <class Map>
double cellwise(Map&& map, double s, int n) {
  const double cell = std::min(std::floor(s * n + 1e-9), n - 1.0), fraction = s * n - cell;
  return (1.0 - fraction) * map(cell / n) + fraction * map((cell + 1.0) / n);
}

/// The core of the O-grid under (x, y) in (−1, 1)²: a square whose sides bulge towards the circle, which keeps the
/// angles at its corners well below 180° inside and outside.
Vec3 coreMap(double half, double x, double y) {
  constexpr double bulge = 0.4;
  return {half * x * (1.0 - bulge + bulge * std::sqrt(2.0 - y * y)),
          half * y * (1.0 - bulge + bulge * std::sqrt(2.0 - x * x)), 0.0};
}

/// The block of the O-grid around `turn` quarter turns from x; s along the circle in (−1, 1), t outward in (0, 1).
Vec3 blockMap(double half, double radius, int turn, double s, double t) {
  const double angle = s * std::numbers::pi / 4.0;
  Vec3 p = (1.0 - t) * coreMap(half, 1.0, s) + t * radius * Vec3{std::cos(angle), std::sin(angle), 0.0};
  for (int k = 0; k < turn; ++k) p = {-p.y, p.x, 0.0};
  return p;
}

}  // namespace

SolidMesh mappedBox(ElementShape shape, std::array<int, 3> cells, Vec3 lower, Vec3 upper,
                    const std::function<Vec3(const Vec3&)>& map) {
  SolidMesh mesh = boxOf(shape, cells, lower, upper);
  for (Vec3& X : mesh.X) X = map(X);
  validate(mesh);
  return mesh;
}

SolidMesh cylinderSector(ElementShape shape, std::array<int, 3> cells, double innerRadius, double outerRadius,
                         double angle, double length) {
  requirePositive(innerRadius, "inner radius");
  requirePositive(length, "length");
  const double full = 2.0 * std::numbers::pi;
  if (!(outerRadius > innerRadius) || !std::isfinite(outerRadius))
    throw InputError("the outer radius is " + formatNumber(outerRadius) + " m", "cylinderSector",
                     "give one above " + formatNumber(innerRadius) + " m, the inner one");
  if (!(angle > 0.0 && angle <= full * (1.0 + 1e-12)))
    throw InputError("the angle is " + formatNumber(angle), "cylinderSector", "give one above 0 and up to 2 pi");
  const bool closed = angle >= full * (1.0 - 1e-12);
  if (closed && cells[1] < 3)
    throw InputError("a full ring has " + std::to_string(cells[1]) + " cells around", "cylinderSector",
                     "give 3 or more");
  SolidMesh mesh = mappedBox(shape, cells, {innerRadius, 0.0, 0.0}, {outerRadius, angle, length}, [](const Vec3& p) {
    return Vec3{p.x * std::cos(p.y), p.x * std::sin(p.y), p.z};
  });
  renameSides(mesh, {{"x-", "inner"}, {"x+", "outer"}, {"y-", closed ? "" : "start"}, {"y+", closed ? "" : "end"}});
  if (!closed) return mesh;
  SolidMesh ring = joinMeshes({&mesh, 1}, 1e-9 * innerRadius);
  dropInnerNodes(ring);
  return ring;
}

SolidMesh roundBar(ElementShape shape, std::array<int, 3> cells, double radius, double length) {
  requirePositive(radius, "radius");
  requirePositive(length, "length");
  if (shape == ElementShape::tet4 || shape == ElementShape::tet10)
    throw InputError(std::string("an O-grid of ") + name(shape) + " elements does not fit together", "roundBar",
                     "take bricks, or mesh the surface with tetrahedra");
  const double half = 0.5 * radius / std::numbers::sqrt2 * 1.1;
  const auto [n, m, layers] = cells;
  std::vector<SolidMesh> parts;
  parts.push_back(mappedBox(shape, {n, n, layers}, {-1.0, -1.0, 0.0}, {1.0, 1.0, length}, [&](const Vec3& p) {
    return coreMap(half, p.x, p.y) + Vec3{0.0, 0.0, p.z};
  }));
  renameSides(parts[0], {{"x-", ""}, {"x+", ""}, {"y-", ""}, {"y+", ""}});
  for (int turn = 0; turn < 4; ++turn) {
    parts.push_back(mappedBox(shape, {m, n, layers}, {0.0, -1.0, 0.0}, {1.0, 1.0, length}, [&](const Vec3& p) {
      return blockMap(half, radius, turn, p.y, p.x) + Vec3{0.0, 0.0, p.z};
    }));
    renameSides(parts.back(), {{"x-", ""}, {"x+", "side"}, {"y-", ""}, {"y+", ""}});
  }
  SolidMesh mesh = joinMeshes(parts, 1e-9 * radius);
  dropInnerNodes(mesh);
  return mesh;
}

SolidMesh cookMembrane(ElementShape shape, std::array<int, 2> cells, double thickness) {
  requirePositive(thickness, "thickness");
  constexpr double width = 0.048, root = 0.044, rise = 0.044, end = 0.016;
  SolidMesh mesh = mappedBox(shape, {cells[0], cells[1], 1}, {}, {1.0, 1.0, thickness}, [&](const Vec3& p) {
    return Vec3{width * p.x, rise * p.x + p.y * (root + (end - root) * p.x), p.z};
  });
  renameSides(mesh, {{"x-", "clamped"}, {"x+", "loaded"}});
  addLine(mesh, "tip", "loaded", width, rise + end, 1e-9 * width);
  return mesh;
}

SolidMesh arcClampedBeam(ElementShape shape, std::array<int, 3> cells, const ArcBeam& beam) {
  requirePositive(beam.height, "height of the beam");
  requirePositive(beam.thickness, "thickness of the beam");
  if (!(beam.radius > 0.5 * beam.height) || !std::isfinite(beam.radius))
    throw InputError("the cylinder's radius is " + formatNumber(beam.radius) + " m", "arcClampedBeam",
                     "give more than half the beam's height");
  if (!(beam.end > beam.centre.x + beam.radius) || !std::isfinite(beam.end))
    throw InputError("the beam ends at x = " + formatNumber(beam.end) + " m, inside the cylinder", "arcClampedBeam",
                     "give more than " + formatNumber(beam.centre.x + beam.radius) + " m");
  if (!(beam.grading >= 1.0 && beam.grading <= 1e6) || !(beam.sideGrading >= 0.0 && beam.sideGrading <= 0.9))
    throw InputError("a grading is out of range", "arcClampedBeam", "give 1 to 1e6 along and 0 to 0.9 across");
  const double growth = std::log(beam.grading);
  const auto along = [&](double s) { return growth > 0.0 ? std::expm1(growth * s) / std::expm1(growth) : s; };
  const auto across = [&](double s) {
    const double sine = 0.5 - 0.5 * std::cos(std::numbers::pi * s);
    return s + beam.sideGrading * (sine - s);
  };
  SolidMesh mesh = mappedBox(shape, cells, {}, {1.0, 1.0, beam.thickness}, [&](const Vec3& p) {
    const double y = beam.height * (cellwise(across, p.y, cells[1]) - 0.5);
    const double root = beam.centre.x + std::sqrt(beam.radius * beam.radius - y * y);
    return Vec3{root + cellwise(along, p.x, cells[0]) * (beam.end - root), beam.centre.y + y, beam.centre.z + p.z};
  });
  renameSides(mesh, {{"x-", "clamped"}});
  addLine(mesh, "tip", "x+", beam.end, beam.centre.y, 1e-9 * beam.height);
  return mesh;
}

}  // namespace dovetail::fem
