#include <gtest/gtest.h>

#include "dovetail/core/error.hpp"
#include "dovetail/fem/model/model.hpp"
#include "helpers.hpp"

namespace dovetail::fem {
namespace {

/// Springs of unit stiffness to the ground, with a mass for the first nodes.
class Ground : public Term {
public:
  explicit Ground(std::size_t massive) : massive_(massive) {}
  std::string name() const override { return "ground"; }
  void addForces(const Nodes& nodes, const Instant&, std::span<Vec3> f) override {
    for (std::size_t n = 0; n < f.size(); ++n) f[n] -= nodes.u[n];
  }
  bool hasEnergy() const override { return true; }
  double energy(const Nodes& nodes, const Instant&) override {
    double sum = 0.0;
    for (const Vec3& u : nodes.u) sum += 0.5 * squaredNorm(u);
    return sum;
  }
  void addMass(std::span<double> mass) const override {
    for (std::size_t n = 0; n < massive_; ++n) mass[n] += 2.0;
  }

private:
  std::size_t massive_;
};

SolidMesh fourPoints() {
  SolidMesh mesh;
  mesh.X = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  mesh.groups.push_back({ElementShape::tet4, {0, 1, 2, 3}});
  return mesh;
}

// Terms keep history: copies of a model would write to one.
static_assert(!std::is_copy_constructible_v<Model> && !std::is_copy_assignable_v<Model>);
static_assert(std::is_nothrow_move_constructible_v<Model> && std::is_nothrow_move_assignable_v<Model>);

TEST(Model, ForcesAndEnergiesAreSumsOverTheTerms) {
  Model model = makeModel(fourPoints());
  model.add(std::make_shared<Ground>(4));
  model.add(std::make_shared<Ground>(4));
  setRandom(model.nodes.u, 1.0, 4);
  setRandom(model.nodes.f, 1.0, 5);
  evaluateForces(model, {});
  double energy = 0.0;
  for (std::size_t n = 0; n < 4; ++n) {
    EXPECT_LT(norm(model.nodes.f[n] + 2.0 * model.nodes.u[n]), 1e-15);
    energy += squaredNorm(model.nodes.u[n]);
  }
  EXPECT_DOUBLE_EQ(storedEnergy(model, {}), energy);
}

TEST(Model, EveryNodeNeedsAMassUnlessItIsFixed) {
  Model model = makeModel(fourPoints());
  model.add(std::make_shared<Ground>(3));
  try {
    addMass(model);
    ADD_FAILURE() << "a node without mass was taken";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("node 3"), std::string::npos);
  }
  fix(model.nodes, std::array{3});
  addMass(model);
  addMass(model);
  EXPECT_EQ(model.nodes.mass[0], 2.0);
  EXPECT_EQ(model.nodes.mass[3], 0.0);
}

}  // namespace
}  // namespace dovetail::fem
