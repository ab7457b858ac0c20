// Loads on the reference faces.
#include <cmath>
#include <map>

#include "dovetail/core/error.hpp"
#include "dovetail/fem/terms/loads.hpp"
#include "mesh/faces.hpp"

namespace dovetail::fem {

namespace {

/// Fixed forces on some nodes times a function of time.
class DeadLoad : public Term {
public:
  DeadLoad(const std::map<int, Vec3>& forces, Amplitude scale, std::string name)
      : forces_(forces.begin(), forces.end()), scale_(std::move(scale)), name_(std::move(name)) {}
  std::string name() const override { return name_; }
  bool usesVelocity() const override { return false; }
  void addForces(const Nodes&, const Instant& now, std::span<Vec3> f) override {
    const double scale = scale_(now.t);
    for (const auto& [n, force] : forces_) f[static_cast<std::size_t>(n)] += scale * force;
  }
  bool hasEnergy() const override { return scale_.isConstant(); }
  double energy(const Nodes& nodes, const Instant& now) override {
    double sum = 0.0;
    for (const auto& [n, force] : forces_) sum -= dot(force, nodes.u[static_cast<std::size_t>(n)]);
    return scale_(now.t) * sum;
  }
  bool addConservingForces(const Nodes& nodes, std::span<const Vec3>, const Instant& now, std::span<Vec3> f) override {
    if (hasEnergy()) addForces(nodes, now, f);
    return hasEnergy();
  }

private:
  std::vector<std::pair<int, Vec3>> forces_;
  Amplitude scale_;
  std::string name_;
};

/// Calls visit(face, point, weight ∂X/∂ξ × ∂X/∂η) for all points of all faces.
template <class Visit>
void integrateFaces(const SolidMesh& mesh, std::span<const Face> faces, Visit&& visit) {
  for (const Face& face : faces)
    visitPoints(face.shape,
                [&](const FacePoint& point) { visit(face, point, point.weight * areaAt(mesh, face, point)); });
}

/// Σ N forceOn(vector of area) by nodes.
template <class ForceOn>
std::map<int, Vec3> nodalForces(const SolidMesh& mesh, std::span<const Face> faces, ForceOn&& forceOn) {
  std::map<int, Vec3> forces;
  integrateFaces(mesh, faces, [&](const Face& face, const FacePoint& point, const Vec3& area) {
    const Vec3 force = forceOn(area);
    for (std::size_t a = 0; a < point.N.size(); ++a) forces[face.node[a]] += point.N[a] * force;
  });
  return forces;
}

/// A traction that depends on place, normal and time.
class TractionField : public Term {
public:
  using Traction = std::function<Vec3(const Vec3& X, const Vec3& normal, double t)>;
  TractionField(const SolidMesh& mesh, std::span<const Face> faces, Traction traction, std::string name)
      : traction_(std::move(traction)), name_(std::move(name)) {
    integrateFaces(mesh, faces, [&](const Face& face, const FacePoint& point, const Vec3& area) {
      const std::span<const int> corners = nodesOf(face);
      points_.push_back({interpolate(point.N, corners, mesh.X), normalized(area), {}});
      for (std::size_t a = 0; a < corners.size(); ++a)
        points_.back().fractions.emplace_back(corners[a], point.N[a] * norm(area));
    });
  }
  std::string name() const override { return name_; }
  bool usesVelocity() const override { return false; }
  void addForces(const Nodes&, const Instant& now, std::span<Vec3> f) override {
    for (const Point& point : points_) {
      const Vec3 traction = traction_(point.X, point.normal, now.t);
      for (const auto& [n, area] : point.fractions) f[static_cast<std::size_t>(n)] += area * traction;
    }
  }

private:
  struct Point {
    Vec3 X, normal;
    std::vector<std::pair<int, double>> fractions;  // node, N dA in m²
  };
  std::vector<Point> points_;
  Traction traction_;
  std::string name_;
};

}  // namespace

std::shared_ptr<Term> deadPressure(const SolidMesh& mesh, std::span<const Face> faces, Amplitude p, std::string name) {
  requireFaces(faces, mesh, "pressure");
  const auto forces = nodalForces(mesh, faces, [](const Vec3& area) { return -area; });
  return std::make_shared<DeadLoad>(forces, std::move(p), std::move(name));
}

std::shared_ptr<Term> deadTraction(const SolidMesh& mesh, std::span<const Face> faces, Vec3 traction, Amplitude scale,
                                   std::string name) {
  requireFaces(faces, mesh, "traction");
  if (!isFinite(traction)) throw InputError("the traction is not finite", "traction", "give numbers");
  const auto forces = nodalForces(mesh, faces, [&](const Vec3& area) { return norm(area) * traction; });
  return std::make_shared<DeadLoad>(forces, std::move(scale), std::move(name));
}

std::shared_ptr<Term> deadTraction(const SolidMesh& mesh, std::span<const Face> faces,
                                   std::function<Vec3(const Vec3&, double)> traction, std::string name) {
  requireFaces(faces, mesh, "traction");
  if (!traction) throw InputError("there is no function", "traction", "give one, or a vector");
  return std::make_shared<TractionField>(
      mesh, faces, [of = std::move(traction)](const Vec3& X, const Vec3&, double t) { return of(X, t); },
      std::move(name));
}

std::shared_ptr<Term> deadPressure(const SolidMesh& mesh, std::span<const Face> faces,
                                   std::function<double(const Vec3&, double)> p, std::string name) {
  requireFaces(faces, mesh, "pressure");
  if (!p) throw InputError("there is no function", "pressure", "give one, or a number");
  return std::make_shared<TractionField>(
      mesh, faces, [of = std::move(p)](const Vec3& X, const Vec3& normal, double t) { return -of(X, t) * normal; },
      std::move(name));
}

}  // namespace dovetail::fem
