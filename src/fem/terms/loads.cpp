#include "dovetail/fem/terms/loads.hpp"

#include <algorithm>
#include <array>

#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"
#include "dovetail/core/parallel.hpp"
#include "dovetail/fem/model/model_mass.hpp"

namespace dovetail::fem {

namespace {

constexpr std::size_t nodeChunk = 4096;

void requireFiniteVector(const Vec3& value, const std::string& name) {
  if (!isFinite(value)) throw InputError("the vector is not finite", name, "give numbers");
}

/// Nodes of a model that is not known yet.
class NodeSet {
public:
  NodeSet(std::span<const int> nodes, const std::string& name) : nodes_(nodes.begin(), nodes.end()) {
    if (nodes.empty()) throw InputError("the node set is empty", name, "give at least one node");
    const auto [first, last] = std::ranges::minmax(nodes_);
    if (first < 0) throw InputError("node " + std::to_string(first) + " does not exist", name, "count from 0");
    last_ = static_cast<std::size_t>(last);
  }
  /// The set. @throws InputError if the model has too few nodes for it
  const std::vector<int>& of(std::size_t count, const std::string& name) const {
    if (last_ >= count)
      throw InputError("node " + std::to_string(last_) + " does not exist", name,
                       "the model has nodes 0 to " + std::to_string(count - 1));
    return nodes_;
  }

private:
  std::vector<int> nodes_;
  std::size_t last_;
};

/// Row sums of the mass matrix in use (of the consistent one in statics), kg: what a uniform field acts on.
class BodyMass {
public:
  BodyMass(const Nodes& nodes, const Instant& now, const std::string& name)
      : mass_(nodes.mass), body_(nodes.bodyMass), fraction_(now.mass != nullptr ? now.mass->fraction() : 1.0) {
    if (std::ranges::none_of(mass_, [](double mass) { return mass > 0.0; }))
      throw InputError("no node has a mass", name, "call addMass(model) before the first step");
  }
  double operator[](std::size_t n) const {
    return body_.empty() ? mass_[n] : mass_[n] + fraction_ * (body_[n] - mass_[n]);
  }

private:
  std::span<const double> mass_, body_;
  double fraction_;
};

void addDiagonal(linalg::BlockMatrix& matrix, int node, const Vec3& values) {
  const std::array<double, 9> block = {values.x, 0, 0, 0, values.y, 0, 0, 0, values.z};
  matrix.addBlock(node, node, block);
}

class Named : public Term {
public:
  explicit Named(std::string name) : name_(std::move(name)) {}
  std::string name() const override { return name_; }

private:
  std::string name_;
};

class Gravity : public Named {
public:
  Gravity(std::function<Vec3(double)> g, bool stores, std::string name)
      : Named(std::move(name)), g_(std::move(g)), stores_(stores) {}
  bool usesVelocity() const override { return false; }
  void addForces(const Nodes& nodes, const Instant& now, std::span<Vec3> f) override {
    const BodyMass mass(nodes, now, name());
    const Vec3 g = g_(now.t);
    parallelFor(nodes.X.size(), nodeChunk, [&](std::size_t begin, std::size_t end) {
      for (std::size_t n = begin; n < end; ++n) f[n] += mass[n] * g;
    });
  }
  bool hasEnergy() const override { return stores_; }
  double energy(const Nodes& nodes, const Instant& now) override {
    const BodyMass mass(nodes, now, name());
    const Vec3 g = g_(now.t);
    return parallelSum(nodes.X.size(), nodeChunk, [&](std::size_t begin, std::size_t end) {
      double sum = 0.0;
      for (std::size_t n = begin; n < end; ++n) sum -= mass[n] * dot(g, nodes.X[n] + nodes.u[n]);
      return sum;
    });
  }
  bool addConservingForces(const Nodes& nodes, std::span<const Vec3>, const Instant& now, std::span<Vec3> f) override {
    if (stores_) addForces(nodes, now, f);
    return stores_;
  }

private:
  std::function<Vec3(double)> g_;
  bool stores_;
};

class NodalForce : public Named {
public:
  NodalForce(std::span<const int> nodes, Vec3 force, Amplitude scale, std::string name)
      : Named(std::move(name)), nodes_(nodes, "nodalForce"), force_(force), scale_(std::move(scale)) {
    requireFiniteVector(force, "nodalForce");
  }
  bool usesVelocity() const override { return false; }
  void addForces(const Nodes&, const Instant& now, std::span<Vec3> f) override {
    const Vec3 force = scale_(now.t) * force_;
    for (const int n : nodes_.of(f.size(), name())) f[static_cast<std::size_t>(n)] += force;
  }
  bool hasEnergy() const override { return scale_.isConstant(); }
  double energy(const Nodes& nodes, const Instant& now) override {
    double sum = 0.0;
    for (const int n : nodes_.of(nodes.u.size(), name())) sum -= dot(force_, nodes.u[static_cast<std::size_t>(n)]);
    return scale_(now.t) * sum;
  }
  bool addConservingForces(const Nodes& nodes, std::span<const Vec3>, const Instant& now, std::span<Vec3> f) override {
    if (hasEnergy()) addForces(nodes, now, f);
    return hasEnergy();
  }

private:
  NodeSet nodes_;
  Vec3 force_;
  Amplitude scale_;
};

class MassDamping : public Named {
public:
  MassDamping(double alpha, std::string name) : Named(std::move(name)), alpha_(requireNonNegative(alpha, "alpha")) {}
  void addForces(const Nodes& nodes, const Instant& now, std::span<Vec3> f) override {
    if (now.mass == nullptr) return;
    momentum_.resize(f.size());
    now.mass->multiply(nodes.v, momentum_);
    parallelFor(f.size(), nodeChunk, [&](std::size_t begin, std::size_t end) {
      for (std::size_t n = begin; n < end; ++n) f[n] -= alpha_ * momentum_[n];
    });
  }
  void addDamping(const Nodes&, const Instant& now, linalg::BlockMatrix& C) override {
    if (now.mass != nullptr) now.mass->addTo(C, alpha_);
  }

private:
  double alpha_;
  std::vector<Vec3> momentum_;
};

/// −k times displacement or velocity of some nodes.
class Ground : public Named {
public:
  Ground(std::span<const int> nodes, Vec3 factor, std::string name)
      : Named(std::move(name)), nodes_(nodes, "ground"), factor_(factor) {
    for (int c = 0; c < 3; ++c) requireNonNegative(factor[c], "stiffness or damping to the ground");
  }

protected:
  void addTo(std::span<const Vec3> field, std::span<Vec3> f) const {
    for (const int node : nodes_.of(f.size(), name())) {
      const auto n = static_cast<std::size_t>(node);
      f[n] -= {factor_.x * field[n].x, factor_.y * field[n].y, factor_.z * field[n].z};
    }
  }
  void addTo(linalg::BlockMatrix& matrix, double fraction = 1.0) const {
    for (const int node : nodes_.of(matrix.nodes(), name())) addDiagonal(matrix, node, fraction * factor_);
  }
  double halfSquares(std::span<const Vec3> field) const {
    double sum = 0.0;
    for (const int node : nodes_.of(field.size(), name())) {
      const Vec3& a = field[static_cast<std::size_t>(node)];
      sum += 0.5 * (factor_.x * a.x * a.x + factor_.y * a.y * a.y + factor_.z * a.z * a.z);
    }
    return sum;
  }

private:
  NodeSet nodes_;
  Vec3 factor_;
};

class GroundSprings : public Ground {
public:
  using Ground::Ground;
  bool usesVelocity() const override { return false; }
  void addForces(const Nodes& nodes, const Instant&, std::span<Vec3> f) override { addTo(nodes.u, f); }
  void addTangent(const Nodes&, const Instant&, linalg::BlockMatrix& K) override { addTo(K); }
  bool hasEnergy() const override { return true; }
  double energy(const Nodes& nodes, const Instant&) override { return halfSquares(nodes.u); }
  bool addConservingForces(const Nodes& nodes, std::span<const Vec3> u0, const Instant&, std::span<Vec3> f) override {
    std::vector<Vec3> mean(u0.begin(), u0.end());
    for (std::size_t n = 0; n < mean.size(); ++n) mean[n] = 0.5 * (mean[n] + nodes.u[n]);
    addTo(mean, f);
    return true;
  }
  void addConservingTangent(const Nodes&, std::span<const Vec3>, const Instant&, linalg::BlockMatrix& K) override {
    addTo(K, 0.5);
  }
};

class GroundDashpots : public Ground {
public:
  using Ground::Ground;
  void addForces(const Nodes& nodes, const Instant& now, std::span<Vec3> f) override {
    if (now.mass != nullptr) addTo(nodes.v, f);
  }
  void addDamping(const Nodes&, const Instant& now, linalg::BlockMatrix& C) override {
    if (now.mass != nullptr) addTo(C);
  }
};

}  // namespace

std::shared_ptr<Term> gravity(Vec3 g, std::string name) {
  requireFiniteVector(g, "gravity");
  return std::make_shared<Gravity>([g](double) { return g; }, true, std::move(name));
}

std::shared_ptr<Term> gravity(std::function<Vec3(double)> g, std::string name) {
  if (!g) throw InputError("there is no function", "gravity", "give one, or a vector");
  return std::make_shared<Gravity>(std::move(g), false, std::move(name));
}

std::shared_ptr<Term> nodalForce(std::span<const int> nodes, Vec3 force, Amplitude scale, std::string name) {
  return std::make_shared<NodalForce>(nodes, force, std::move(scale), std::move(name));
}

std::shared_ptr<Term> massDamping(double alpha, std::string name) {
  return std::make_shared<MassDamping>(alpha, std::move(name));
}

std::shared_ptr<Term> groundSprings(std::span<const int> nodes, Vec3 stiffness, std::string name) {
  return std::make_shared<GroundSprings>(nodes, stiffness, std::move(name));
}

std::shared_ptr<Term> groundDashpots(std::span<const int> nodes, Vec3 damping, std::string name) {
  return std::make_shared<GroundDashpots>(nodes, damping, std::move(name));
}

}  // namespace dovetail::fem
