#include <algorithm>
#include <cmath>

#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"
#include "dovetail/fem/model/ties.hpp"
#include "dovetail/geometry/hierarchical_grid.hpp"
#include "mesh/faces.hpp"

namespace dovetail::fem {

namespace {

/// Faces sorted by their boxes.
class FaceSearch {
public:
  /// @param margin  that boxes are grown by, m, > 0
  FaceSearch(const SolidMesh& mesh, std::span<const Face> faces, double margin) {
    std::vector<Vec3> centre;
    std::vector<double> radius;
    for (const Face& face : faces) {
      const geometry::Box& box = boxes_.emplace_back(boxOfFace(mesh, face, margin));
      centre.push_back(0.5 * (box.lower + box.upper));
      radius.push_back((0.5 + 1e-9) * norm(box.upper - box.lower));
    }
    grid_.build(centre, radius);
  }

  /// Numbers of the faces whose box holds x, ascending.
  std::vector<int> at(const Vec3& x) const {
    std::vector<int> found = grid_.query({x, x});
    std::erase_if(found, [&](int face) { return !contains(boxes_[static_cast<std::size_t>(face)], x); });
    return found;
  }

private:
  static geometry::Box boxOfFace(const SolidMesh& mesh, const Face& face, double margin) {
    const std::span<const int> nodes = nodesOf(face);
    geometry::Box box{mesh.X[static_cast<std::size_t>(nodes[0])], mesh.X[static_cast<std::size_t>(nodes[0])]};
    for (const int n : nodes)
      for (int c = 0; c < 3; ++c) {
        box.lower[c] = std::min(box.lower[c], mesh.X[static_cast<std::size_t>(n)][c]);
        box.upper[c] = std::max(box.upper[c], mesh.X[static_cast<std::size_t>(n)][c]);
      }
    // Curved faces bulge out of the box of their nodes by less than its diagonal.
    const bool second = nodes.size() > static_cast<std::size_t>(cornersOf(face.shape));
    return geometry::expanded(box, margin + (second ? 0.25 * norm(box.upper - box.lower) : 0.0));
  }

  static bool contains(const geometry::Box& box, const Vec3& x) {
    return x.x >= box.lower.x && x.y >= box.lower.y && x.z >= box.lower.z && x.x <= box.upper.x && x.y <= box.upper.y &&
           x.z <= box.upper.z;
  }

  std::vector<geometry::Box> boxes_;
  geometry::HierarchicalGrid grid_;
};

struct Projected {
  double distance;
  std::array<double, 9> N;
};

/// Puts (ξ, η) back into the face.
void clampTo(FaceShape shape, double& xi, double& eta) {
  if (cornersOf(shape) != 3) {
    xi = std::clamp(xi, -1.0, 1.0);
    eta = std::clamp(eta, -1.0, 1.0);
    return;
  }
  xi = std::max(xi, 0.0);
  eta = std::max(eta, 0.0);
  const double excess = xi + eta - 1.0;
  if (excess > 0.0) {
    xi = std::clamp(xi - 0.5 * excess, 0.0, 1.0);
    eta = 1.0 - xi;
  }
}

/// The point of the face closest to x, by Gauss–Newton steps that stay within the face.
Projected project(const SolidMesh& mesh, const Face& face, const Vec3& x) {
  const std::span<const int> nodes = nodesOf(face);
  const bool triangle = cornersOf(face.shape) == 3;
  double xi = triangle ? 1.0 / 3.0 : 0.0, eta = xi;
  Projected result{};
  std::array<double, 9> byXi{}, byEta{};
  const std::size_t n = nodes.size();
  for (int step = 0; step < 50; ++step) {
    detail::faceFunctions(face.shape, xi, eta, std::span(result.N).first(n), std::span(byXi).first(n),
                          std::span(byEta).first(n));
    const Vec3 gap = x - interpolate(std::span(result.N).first(n), nodes, mesh.X);
    const Vec3 a = interpolate(std::span(byXi).first(n), nodes, mesh.X),
               b = depthOf(face.shape, 1.0) + interpolate(std::span(byEta).first(n), nodes, mesh.X);
    result.distance = norm(gap);
    const double aa = dot(a, a), ab = dot(a, b), bb = dot(b, b), ag = dot(a, gap), bg = dot(b, gap),
                 det = aa * bb - ab * ab;
    const double oldXi = xi, oldEta = eta;
    xi += (bb * ag - ab * bg) / det;
    eta += (aa * bg - ab * ag) / det;
    clampTo(face.shape, xi, eta);
    if (std::abs(xi - oldXi) + std::abs(eta - oldEta) < 1e-14) break;
  }
  return result;
}

}  // namespace

std::vector<Tie> tieInterface(const SolidMesh& mesh, std::span<const int> slaves, std::span<const Face> masters,
                              double tolerance) {
  requirePositive(tolerance, "tolerance of tied interfaces");
  requireFaces(masters, mesh, "tie");
  requireFinite(mesh.X, "node", "position", "tie");
  std::vector<char> isMaster(mesh.X.size(), 0);
  for (const Face& face : masters)
    for (const int n : nodesOf(face)) isMaster[static_cast<std::size_t>(n)] = 1;
  const FaceSearch search(mesh, masters, tolerance);
  std::vector<Tie> ties;
  for (const int slave : slaves) {
    const std::string label = "node " + std::to_string(slave);
    const auto where = [&] {
      const Vec3& X = mesh.X[static_cast<std::size_t>(slave)];
      return label + " at (" + formatNumber(X.x) + ", " + formatNumber(X.y) + ", " + formatNumber(X.z) + ") m";
    };
    if (slave < 0 || static_cast<std::size_t>(slave) >= mesh.X.size())
      throw InputError(label + " does not exist", "tie", "use nodes of the mesh");
    if (isMaster[static_cast<std::size_t>(slave)])
      throw InputError(where() + " belongs to a master face", "tie", "leave it out of the slaves");
    Projected best{INFINITY, {}};
    const Face* nearest = nullptr;
    for (const int i : search.at(mesh.X[static_cast<std::size_t>(slave)])) {
      const Face& face = masters[static_cast<std::size_t>(i)];
      const Projected found = project(mesh, face, mesh.X[static_cast<std::size_t>(slave)]);
      if (found.distance < best.distance) best = found, nearest = &face;
    }
    if (!(best.distance <= tolerance))
      throw InputError(where() + " lies farther than " + formatNumber(tolerance) + " m from the master faces", "tie",
                       "leave it out, or give a larger tolerance");
    for (int c = 0; c < dimensionOf(mesh); ++c) {
      Tie tie{slave, c, {}, 0.0, {}};
      for (std::size_t a = 0; a < nodesOf(*nearest).size(); ++a)
        if (best.N[a] != 0.0) tie.masters.push_back({nearest->node[a], c, best.N[a]});
      ties.push_back(std::move(tie));
    }
  }
  return ties;
}

}  // namespace dovetail::fem
