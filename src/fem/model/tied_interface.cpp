#include <algorithm>
#include <cmath>

#include "../mesh/faces.hpp"
#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"
#include "dovetail/fem/model/ties.hpp"

namespace dovetail::fem {

namespace {

struct FaceBox {
  Vec3 lower, upper;
};

FaceBox boxOfFace(const SolidMesh& mesh, const Face& face, double margin) {
  const std::span<const int> nodes = nodesOf(face);
  FaceBox box{mesh.X[static_cast<std::size_t>(nodes[0])], mesh.X[static_cast<std::size_t>(nodes[0])]};
  for (const int n : nodes)
    for (int c = 0; c < 3; ++c) {
      box.lower[c] = std::min(box.lower[c], mesh.X[static_cast<std::size_t>(n)][c]);
      box.upper[c] = std::max(box.upper[c], mesh.X[static_cast<std::size_t>(n)][c]);
    }
  // Curved faces bulge out of the box of their nodes by less than its diagonal.
  const double reach = margin + (nodes.size() > 4 ? 0.25 * norm(box.upper - box.lower) : 0.0);
  box.lower -= {reach, reach, reach};
  box.upper += {reach, reach, reach};
  return box;
}

bool contains(const FaceBox& box, const Vec3& x) {
  return x.x >= box.lower.x && x.y >= box.lower.y && x.z >= box.lower.z && x.x <= box.upper.x && x.y <= box.upper.y &&
         x.z <= box.upper.z;
}

struct Projected {
  double distance;
  std::array<double, 9> N;
};

/// Puts (ξ, η) back into the face.
void clampTo(FaceShape shape, double& xi, double& eta) {
  if (cornersOf(shape) == 4) {
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
               b = interpolate(std::span(byEta).first(n), nodes, mesh.X);
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
  requireFaces(masters, mesh.X.size(), "tieInterface");
  std::vector<FaceBox> boxes;
  std::vector<char> isMaster(mesh.X.size(), 0);
  for (const Face& face : masters) {
    boxes.push_back(boxOfFace(mesh, face, tolerance));
    for (const int n : nodesOf(face)) isMaster[static_cast<std::size_t>(n)] = 1;
  }
  std::vector<Tie> ties;
  for (const int slave : slaves) {
    const std::string label = "node " + std::to_string(slave);
    if (slave < 0 || static_cast<std::size_t>(slave) >= mesh.X.size())
      throw InputError(label + " does not exist", "tieInterface", "use nodes of the mesh");
    if (isMaster[static_cast<std::size_t>(slave)])
      throw InputError(label + " belongs to a master face", "tieInterface", "leave it out of the slaves");
    Projected best{INFINITY, {}};
    const Face* nearest = nullptr;
    for (std::size_t i = 0; i < masters.size(); ++i) {
      if (!contains(boxes[i], mesh.X[static_cast<std::size_t>(slave)])) continue;
      const Projected found = project(mesh, masters[i], mesh.X[static_cast<std::size_t>(slave)]);
      if (found.distance < best.distance) best = found, nearest = &masters[i];
    }
    if (!(best.distance <= tolerance))
      throw InputError(label + " lies farther than " + formatNumber(tolerance) + " m from the master faces",
                       "tieInterface", "leave it out, or give a larger tolerance");
    for (int c = 0; c < 3; ++c) {
      Tie tie{slave, c, {}, 0.0, {}};
      for (std::size_t a = 0; a < nodesOf(*nearest).size(); ++a)
        if (best.N[a] != 0.0) tie.masters.push_back({nearest->node[a], c, best.N[a]});
      ties.push_back(std::move(tie));
    }
  }
  return ties;
}

}  // namespace dovetail::fem
