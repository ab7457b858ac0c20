// Pressure on deformed faces (Schweizerhof & Ramm 1984).
#include <algorithm>

#include "dovetail/core/error.hpp"
#include "dovetail/fem/terms/loads.hpp"
#include "dovetail/linalg/block_matrix.hpp"
#include "mesh/faces.hpp"

namespace dovetail::fem {

namespace {

class FollowingPressure : public Term {
public:
  FollowingPressure(std::span<const Face> faces, double thickness, Amplitude p, bool potential, std::string name)
      : faces_(faces.begin(), faces.end()),
        thickness_(thickness),
        p_(std::move(p)),
        potential_(potential),
        name_(std::move(name)) {}
  FollowingPressure(std::span<const Face> faces, double thickness, std::function<double(const Vec3&, double)> field,
                    std::string name)
      : FollowingPressure(faces, thickness, 0.0, false, std::move(name)) {
    field_ = std::move(field);
  }
  std::string name() const override { return name_; }
  bool isSymmetric() const override { return potential_; }
  bool hasEnergy() const override { return potential_ && p_.isConstant(); }  // never of a field

  bool usesVelocity() const override { return false; }
  void addForces(const Nodes& nodes, const Instant& now, std::span<Vec3> f) override {
    const double p = p_(now.t);
    for (const Face& face : faces_) {
      const std::span<const int> corners = nodesOf(face);
      visitPoints(face.shape, [&](const FacePoint& point) {
        const Vec3 load = -pressureAt(p, face, point, nodes, now) * point.weight * areaAt(face, point, nodes);
        for (std::size_t a = 0; a < corners.size(); ++a) f[static_cast<std::size_t>(corners[a])] += point.N[a] * load;
      });
    }
  }

  /// p ⅓ ∫ x · da, p ½ ∫ x · da in a plane: up to a constant the volume behind the faces.
  double energy(const Nodes& nodes, const Instant& now) override {
    double sum = 0.0;
    for (const Face& face : faces_) {
      const std::span<const int> corners = nodesOf(face);
      visitPoints(face.shape, [&](const FacePoint& point) {
        sum += point.weight * dot(sumOf(point.N, corners, nodes), areaAt(face, point, nodes));
      });
    }
    return p_(now.t) * sum / dimensionOf(faces_[0].shape);
  }

  void addPattern(linalg::MatrixPattern& pattern) const override {
    for (const Face& face : faces_) pattern.add(nodesOf(face));
  }

  /// K_ab w = p ∫ N_a (∂N_b/∂ξ w × ∂x/∂η + ∂N_b/∂η ∂x/∂ξ × w).
  void addTangent(const Nodes& nodes, const Instant& now, linalg::BlockMatrix& K) override {
    const double p = p_(now.t);
    for (const Face& face : faces_) {
      const std::span<const int> corners = nodesOf(face);
      const std::size_t n = corners.size();
      matrix_.assign(9 * n * n, 0.0);
      visitPoints(face.shape, [&](const FacePoint& point) {
        const Vec3 alongXi = sumOf(point.byXi, corners, nodes), alongEta = alongEtaOf(face, point, nodes);
        const double at = pressureAt(p, face, point, nodes, now);
        for (std::size_t a = 0; a < n; ++a)
          for (std::size_t b = 0; b < n; ++b)
            addCross(a, b, n, at * point.weight * point.N[a] * (point.byEta[b] * alongXi - point.byXi[b] * alongEta));
      });
      K.add(corners, matrix_);
    }
  }

private:
  double pressureAt(double p, const Face& face, const FacePoint& point, const Nodes& nodes, const Instant& now) const {
    return field_ ? field_(interpolate(point.N, nodesOf(face), nodes.X), now.t) : p;
  }
  static Vec3 sumOf(std::span<const double> coefficient, std::span<const int> corners, const Nodes& nodes) {
    return interpolate(coefficient, corners, nodes.X) + interpolate(coefficient, corners, nodes.u);
  }
  Vec3 alongEtaOf(const Face& face, const FacePoint& point, const Nodes& nodes) const {
    return depthOf(face.shape, thickness_) + sumOf(point.byEta, nodesOf(face), nodes);
  }
  /// ∂x/∂ξ × ∂x/∂η.
  Vec3 areaAt(const Face& face, const FacePoint& point, const Nodes& nodes) const {
    return cross(sumOf(point.byXi, nodesOf(face), nodes), alongEtaOf(face, point, nodes));
  }
  /// Adds w ↦ r × w to block (a, b).
  void addCross(std::size_t a, std::size_t b, std::size_t n, const Vec3& r) {
    const std::size_t columns = 3 * n;
    double* const at = &matrix_[3 * a * columns + 3 * b];
    at[1] -= r.z;
    at[2] += r.y;
    at[columns] += r.z;
    at[columns + 2] -= r.x;
    at[2 * columns] -= r.y;
    at[2 * columns + 1] += r.x;
  }

  std::vector<Face> faces_;
  double thickness_;  // of lines, m
  Amplitude p_;
  std::function<double(const Vec3&, double)> field_;  // in its place
  bool potential_;
  std::string name_;
  std::vector<double> matrix_;
};

}  // namespace

std::shared_ptr<Term> followingPressure(const SolidMesh& mesh, std::span<const Face> faces, Amplitude p,
                                        std::span<const int> clamped, std::string name) {
  requireFaces(faces, mesh, "pressure");
  const std::vector<int> rim = rimNodes(faces);
  const bool potential = std::includes(clamped.begin(), clamped.end(), rim.begin(), rim.end());
  return std::make_shared<FollowingPressure>(faces, mesh.thickness, std::move(p), potential, std::move(name));
}

std::shared_ptr<Term> followingPressure(const SolidMesh& mesh, std::span<const Face> faces,
                                        std::function<double(const Vec3&, double)> p, std::string name) {
  requireFaces(faces, mesh, "pressure");
  if (!p) throw InputError("there is no function", "pressure", "give one, or a number");
  return std::make_shared<FollowingPressure>(faces, mesh.thickness, std::move(p), std::move(name));
}

}  // namespace dovetail::fem
