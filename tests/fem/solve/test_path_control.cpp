#include <gtest/gtest.h>

#include "dovetail/core/error.hpp"
#include "dovetail/fem/solve/statics.hpp"
#include "dovetail/fem/terms/loads.hpp"
#include "solid_helpers.hpp"

namespace dovetail::fem {
namespace {

/// Ground – crack – node 0 – spring – node 1, along z. The crack carries x e^(1 − x) of its strength, x the opening
/// over that at the peak, and unloads towards the origin.
class CrackedBar : public Term {
public:
  static constexpr double strength = 1.0, peak = 1e-3, spring = 100.0;  // N, m, N/m

  std::string name() const override { return "cracked bar"; }
  void addForces(const Nodes& nodes, const Instant&, std::span<Vec3> f) override {
    const double crack = traction(nodes.u[0].z), pull = spring * (nodes.u[1].z - nodes.u[0].z);
    f[0].z += pull - crack;
    f[1].z -= pull;
  }
  void addPattern(linalg::MatrixPattern& pattern) const override { pattern.add(std::array{0, 1}); }
  void addTangent(const Nodes& nodes, const Instant&, linalg::BlockMatrix& K) override {
    const double w = nodes.u[0].z;
    const double x = w / peak;
    const double slope = w < past_ ? traction(w) / w : strength / peak * (1.0 - x) * std::exp(1.0 - x);
    const auto add = [&](int a, int b, double value) {
      K.addBlock(a, b, std::array{0., 0., 0., 0., 0., 0., 0., 0., value});
    };
    add(0, 0, spring + slope);
    add(0, 1, -spring);
    add(1, 0, -spring);
    add(1, 1, spring);
  }
  double commit(const Nodes& nodes, const Instant&) override {
    const double w = nodes.u[0].z, f = traction(w), spent = 0.5 * (lastForce_ * w - f * last_);
    past_ = std::max(past_, w);
    last_ = w;
    lastForce_ = f;
    dissipated += spent;
    return spent;
  }
  static double load(double w) { return strength * w / peak * std::exp(1.0 - w / peak); }
  double dissipated = 0.0;

private:
  double traction(double w) const { return w < past_ ? load(past_) * w / past_ : load(w); }
  double past_ = 0.0, last_ = 0.0, lastForce_ = 0.0;
};

struct Bar {
  Model model;
  CrackedBar* crack;
  Bar() {
    SolidMesh mesh;
    mesh.X = {{0.0, 0.0, 1.0}, {0.0, 0.0, 2.0}};
    model = makeModel(mesh);
    crack = &model.add(std::make_shared<CrackedBar>());
    model.add(nodalForce(std::array{1}, {0.0, 0.0, 1.0}, TimeFunction([](double t) { return t; })));
    model.constraints.hold(std::array{0, 1}, componentX | componentY);
  }
  double opening() const { return model.nodes.u[0].z; }
  double end() const { return model.nodes.u[1].z; }
};

/// The crack softens more steeply than the spring is stiff: its end goes back while the load falls.
void expectOnThePath(const Bar& bar, double t) {
  const double load = CrackedBar::load(bar.opening());
  EXPECT_NEAR(t, load, 1e-7);
  EXPECT_NEAR(bar.end(), bar.opening() + load / CrackedBar::spring, 1e-9);
}

TEST(PathControl, TheOpeningLeadsThroughASnapBack) {
  Bar bar;
  ArcLengthOptions options{.firstStep = 0.2};
  options.node = 0;
  options.component = 2;
  int steps = 0;
  followPath(bar.model, 2.0, options, [&](const Model&, const StaticStep& step) {
    expectOnThePath(bar, step.t);
    ++steps;
    return bar.opening() < 4e-3;
  });
  EXPECT_GE(bar.opening(), 4e-3);
  EXPECT_LT(bar.end(), 8e-3);  // 11e-3 at the peak
  EXPECT_LT(steps, 30);
}

TEST(PathControl, StepsDissipateWhatIsAskedFor) {
  constexpr double each = 1e-4;  // J; all of it is 2.7e-3
  Bar bar;
  ArcLengthOptions options{.firstStep = 0.15, .largestStep = 1e-3};
  options.dissipation = each;
  std::vector<double> spent{0.0};
  followPath(bar.model, 2.0, options, [&](const Model&, const StaticStep& step) {
    expectOnThePath(bar, step.t);
    spent.push_back(bar.crack->dissipated);
    return spent.back() < 2.2e-3;
  });
  std::size_t first = 1;
  while (spent[first] - spent[first - 1] < each) ++first;
  EXPECT_GE(spent.size() - first, 12u);
  for (std::size_t k = first + 1; k < spent.size(); ++k) EXPECT_NEAR(spent[k] - spent[k - 1], each, 1e-6 * each);
}

TEST(PathControl, WhatCannotControlIsRefused) {
  Bar bar;
  ArcLengthOptions options;
  options.node = 2;
  EXPECT_THROW(followPath(bar.model, 1.0, options), InputError);
  options.node = 0;
  options.component = 3;
  EXPECT_THROW(followPath(bar.model, 1.0, options), InputError);
  options.component = 0;  // held: it never moves
  EXPECT_THROW(followPath(bar.model, 1.0, options), NumericalError);
  options = {};
  options.dissipation = -1.0;
  EXPECT_THROW(followPath(bar.model, 1.0, options), InputError);
  options.dissipation = 1.0;
  bar.model.constraints.prescribe(std::array{1}, 2, [](double t) { return t; });
  EXPECT_THROW(followPath(bar.model, 1.0, options), InputError);
}

}  // namespace
}  // namespace dovetail::fem
