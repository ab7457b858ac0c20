#include "dovetail/fem/terms/gradient_energy.hpp"

#include <cmath>
#include <numbers>

#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"
#include "dovetail/core/parallel.hpp"
#include "gradient_matrix.hpp"
#include "solve/newton_tools.hpp"

namespace dovetail::fem {

namespace {

class GradientEnergy final : public Term {
public:
  GradientEnergy(linalg::NodeMatrix A, std::string name) : A_(std::move(A)), name_(std::move(name)) {}
  std::string name() const override { return name_; }
  bool usesVelocity() const override { return false; }
  bool actsWithin() const override { return true; }
  bool hasEnergy() const override { return true; }

  void addForces(const Nodes& nodes, const Instant&, std::span<Vec3> f) override { addPull(nodes.u, f); }
  double addForcesAndEnergy(const Nodes& nodes, const Instant&, std::span<Vec3> f) override {
    addPull(nodes.u, f);
    return 0.5 * detail::innerProduct(nodes.u, pull_);
  }
  double energy(const Nodes& nodes, const Instant&) override {
    findPull(nodes.u);
    return 0.5 * detail::innerProduct(nodes.u, pull_);
  }
  void addPattern(linalg::MatrixPattern& pattern) const override { pattern.add(A_); }
  void addTangent(const Nodes&, const Instant&, linalg::BlockMatrix& K) override { addTo(K, 1.0); }
  void addStiffness(const Nodes&, const Instant&, std::span<double> k) override {
    for (std::size_t n = 0; n < k.size(); ++n)
      for (int place = A_.offsets()[n]; place < A_.offsets()[n + 1]; ++place)
        k[n] += std::abs(A_.values()[static_cast<std::size_t>(place)]);
  }

  /// At the mean of both states: the energy is quadratic.
  bool addConservingForces(const Nodes& nodes, std::span<const Vec3> u0, const Instant&, std::span<Vec3> f) override {
    std::vector<Vec3> mean(u0.begin(), u0.end());
    for (std::size_t n = 0; n < mean.size(); ++n) mean[n] = 0.5 * (mean[n] + nodes.u[n]);
    addPull(mean, f);
    return true;
  }
  void addConservingTangent(const Nodes&, std::span<const Vec3>, const Instant&, linalg::BlockMatrix& K) override {
    addTo(K, 0.5);
  }

private:
  void findPull(std::span<const Vec3> u) {
    if (u.size() != A_.nodes())
      throw InputError("there are " + std::to_string(u.size()) + " nodes for a mesh of " + std::to_string(A_.nodes()),
                       name_, "make the model and the term of the same mesh");
    pull_.resize(u.size());
    A_.multiply(u, pull_);
  }
  void addPull(std::span<const Vec3> u, std::span<Vec3> f) {
    findPull(u);
    for (std::size_t n = 0; n < f.size(); ++n) f[n] -= pull_[n];
  }
  void addTo(linalg::BlockMatrix& K, double factor) const {
    for (std::size_t n = 0; n < A_.nodes(); ++n) {
      if (!K.takes(static_cast<int>(n))) continue;
      auto place = static_cast<std::size_t>(K.offsets()[n]);
      for (auto own = static_cast<std::size_t>(A_.offsets()[n]); own < static_cast<std::size_t>(A_.offsets()[n + 1]);
           ++own, ++place) {
        while (K.columns()[place] != A_.columns()[own]) ++place;
        for (std::size_t c = 0; c < 3; ++c) K.values()[9 * place + 4 * c] += factor * A_.values()[own];
      }
    }
  }

  linalg::NodeMatrix A_;
  std::string name_;
  std::vector<Vec3> pull_;  // A u
};

}  // namespace

std::shared_ptr<Term> gradientEnergy(const SolidMesh& mesh, const GradientOptions& options) {
  requirePositive(options.modulus, "modulus of the gradient");
  validate(mesh);
  detail::requireFraction(options.fraction, mesh.X.size());
  const detail::SolidCells cells = detail::cellsOf(mesh, {}, options.fraction);
  if (cells.shape != ElementShape::quad4 && cells.shape != ElementShape::quad8 && cells.shape != ElementShape::hex8)
    throw InputError(std::string("there is no energy of gradients for ") + name(cells.shape), options.name,
                     "take a mesh of quad4, quad8 or hex8");
  return std::make_shared<GradientEnergy>(detail::gradientMatrix(cells, options.modulus), options.name);
}

double bandWidth(double modulus, double softening, double shear) {
  requirePositive(modulus, "modulus of the gradient");
  requirePositive(softening, "softening");
  requirePositive(shear, "shear modulus");
  return 2.0 * std::sqrt(modulus / softening) * (std::numbers::pi - std::atan(std::sqrt(softening / shear)));
}

}  // namespace dovetail::fem
