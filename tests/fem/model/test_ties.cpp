#include <gtest/gtest.h>

#include "dovetail/core/error.hpp"
#include "dovetail/fem/model/ties.hpp"
#include "dovetail/fem/terms/loads.hpp"
#include "solid_helpers.hpp"

namespace dovetail::fem {
namespace {

const Eigen::Matrix3d someGradient{{1.1, 0.05, -0.02}, {0.03, 0.92, 0.04}, {-0.06, 0.01, 1.07}};

std::array<double, 9> rowMajor(const Eigen::Matrix3d& F) {
  return {F(0, 0), F(0, 1), F(0, 2), F(1, 0), F(1, 1), F(1, 2), F(2, 0), F(2, 1), F(2, 2)};
}

Eigen::Matrix3d plainStress(const Eigen::Matrix3d& F, double lambda, double mu) {
  const Eigen::Matrix3d T = F.inverse().transpose();
  return mu * (F - T) + lambda * std::log(F.determinant()) * T;
}

/// Newton's method on the free components; returns the last residual over the first.
double solveDense(Model& model, const DofMap& map, double t, int iterations) {
  map.apply(t, model.nodes.u);
  const auto n = static_cast<Eigen::Index>(map.size());
  Eigen::MatrixXd T(static_cast<Eigen::Index>(3 * model.nodes.u.size()), n);
  for (Eigen::Index i = 0; i < n; ++i) {
    std::vector<double> dq(map.size(), 0.0);
    std::vector<Vec3> u(model.nodes.u.size());
    dq[static_cast<std::size_t>(i)] = 1.0;
    map.addIncrement(dq, u);
    T.col(i) = flat(u);
  }
  double first = 0.0, last = 0.0;
  for (int k = 0; k <= iterations; ++k) {
    evaluateForces(model, {t, 0.0});
    std::vector<double> r(map.size());
    map.reduce(model.nodes.f, r);
    const Eigen::Map<Eigen::VectorXd> residual(r.data(), n);
    last = residual.norm();
    if (k == 0) first = last;
    if (k == iterations) break;
    const Eigen::MatrixXd K = dense(tangentOf(*model.terms[0], model.nodes));
    const Eigen::VectorXd step = (T.transpose() * K * T).ldlt().solve(residual);
    map.addIncrement({step.data(), map.size()}, model.nodes.u);
  }
  return last / first;
}

TEST(PeriodicTies, AUniformCellHasUniformStress) {
  for (const ElementShape shape : {ElementShape::hex8, ElementShape::hex20, ElementShape::tet4}) {
    const SolidMesh mesh = boxOf(shape, {2, 2, 1}, {0.1, 0.2, 0.3}, {1.0, 1.2, 1.0});
    Model model = makeModel(mesh);
    Solid& solid = model.add(makeSolid(mesh, std::make_shared<PlainNeoHookean>(2e6, 1e6)));
    const PeriodicTies cell = periodicTies(mesh, [](double t) {
      return rowMajor(Eigen::Matrix3d::Identity() + t * (someGradient - Eigen::Matrix3d::Identity()));
    });
    model.constraints.ties = cell.ties;
    model.constraints.hold(std::array{cell.corner});
    EXPECT_EQ(mesh.X[static_cast<std::size_t>(cell.corner)], (Vec3{0.1, 0.2, 0.3}));
    EXPECT_NEAR(cell.volume, 0.63, 1e-15);
    const DofMap map(model.constraints, model.nodes);
    for (int k = 1; k < 4; ++k) EXPECT_LT(solveDense(model, map, 0.25 * k, 8), 1e-9);
    EXPECT_LT(solveDense(model, map, 1.0, 8), 1e-9);
    const Eigen::Matrix3d P = plainStress(someGradient, 2e6, 1e6);
    const Solid::Sample sample = solid.sample(model.nodes, {});
    for (std::size_t q = 0; q < sample.volume.size(); ++q)
      for (std::size_t k = 0; k < 9; ++k) {
        EXPECT_NEAR(sample.F[9 * q + k], rowMajor(someGradient)[k], 1e-12) << name(shape);
        EXPECT_NEAR(sample.P[9 * q + k], rowMajor(P)[k], 1e-6) << name(shape);
      }
    const auto average = averageFirstStress(model.nodes, model.nodes.f, cell.volume);
    for (std::size_t k = 0; k < 9; ++k) EXPECT_NEAR(average[k], rowMajor(P)[k], 1e-6) << name(shape);
  }
}

TEST(PeriodicTies, MeansOfAMixedCellAreTheMacroscopicOnes) {
  SolidMesh mesh = boxOf(ElementShape::hex8, {3, 3, 3}, {}, {1.0, 1.0, 1.0});
  Model model = makeModel(mesh);
  mesh.elementSets["core"] = {13};
  std::vector<int> others;
  for (int e = 0; e < 27; ++e)
    if (e != 13) others.push_back(e);
  mesh.elementSets["matrix"] = others;
  const auto soft = makeSolid(mesh, std::make_shared<PlainNeoHookean>(2e6, 1e6), {.elementSet = "matrix"}),
             hard = makeSolid(mesh, std::make_shared<PlainNeoHookean>(2e7, 1e7), {.elementSet = "core"});
  class Both : public Term {
  public:
    Both(Term& a, Term& b) : a_(a), b_(b) {}
    std::string name() const override { return "both"; }
    void addForces(const Nodes& nodes, const Instant& now, std::span<Vec3> f) override {
      a_.addForces(nodes, now, f);
      b_.addForces(nodes, now, f);
    }
    void addPattern(linalg::MatrixPattern& c) const override {
      a_.addPattern(c);
      b_.addPattern(c);
    }
    void addTangent(const Nodes& nodes, const Instant& now, linalg::BlockMatrix& K) override {
      a_.addTangent(nodes, now, K);
      b_.addTangent(nodes, now, K);
    }

  private:
    Term &a_, &b_;
  };
  model.add(std::make_shared<Both>(*soft, *hard));
  const PeriodicTies cell = periodicTies(mesh, [](double) { return rowMajor(someGradient); });
  model.constraints.ties = cell.ties;
  model.constraints.hold(std::array{cell.corner});
  EXPECT_LT(solveDense(model, DofMap(model.constraints, model.nodes), 1.0, 10), 1e-10);
  const auto average = averageFirstStress(model.nodes, model.nodes.f, 1.0);
  std::array<double, 9> P{}, F{};
  for (const auto& solid : {soft, hard}) {
    const Solid::Sample sample = solid->sample(model.nodes, {});
    for (std::size_t q = 0; q < sample.volume.size(); ++q)
      for (std::size_t k = 0; k < 9; ++k) {
        P[k] += sample.volume[q] * sample.P[9 * q + k];
        F[k] += sample.volume[q] * sample.F[9 * q + k];
      }
  }
  for (std::size_t k = 0; k < 9; ++k) {
    EXPECT_NEAR(F[k], rowMajor(someGradient)[k], 1e-13);
    EXPECT_NEAR(P[k], average[k], 1e-7);
  }
}

TEST(PeriodicTies, FacesThatDoNotMatchAreRefused) {
  const auto unit = [](double) { return rowMajor(Eigen::Matrix3d::Identity()); };
  SolidMesh mesh = boxOf(ElementShape::hex8, {2, 2, 2}, {}, {1.0, 1.0, 1.0});
  const int node = nodeSet(mesh, "x+")[4];
  mesh.X[static_cast<std::size_t>(node)].y += 1e-3;
  try {
    periodicTies(mesh, unit);
    ADD_FAILURE() << "faces that do not match were tied";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("node " + std::to_string(node)), std::string::npos) << error.what();
  }
  EXPECT_NO_THROW(periodicTies(mesh, unit, {true, true, true}, 1e-2));
  EXPECT_NO_THROW(periodicTies(mesh, unit, {false, true, true}));
  EXPECT_THROW(periodicTies(mesh, {}), InputError);
}

TEST(PeriodicTies, CellsOfAnySizeAreTied) {
  const auto unit = [](double) { return rowMajor(Eigen::Matrix3d::Identity()); };
  for (const double size : {1e-9, 1e-6, 1.0, 1e3}) {
    SolidMesh mesh = boxOf(ElementShape::hex8, {3, 2, 2}, {}, {size, size, size});
    std::mt19937 random(3);
    for (Vec3& X : mesh.X) X += randomVec3(random, 1e-8 * size);  // as a file of eight digits leaves them
    const PeriodicTies cell = periodicTies(mesh, unit);
    EXPECT_EQ(cell.ties.size(), 3 * (mesh.X.size() - 3u * 2u * 2u)) << size;
    EXPECT_EQ(cell.corner, 0) << size;
  }
}

/// Two boxes one on the other, with separate nodes between.
struct Stack {
  SolidMesh mesh;
  std::vector<int> slaves;
  std::vector<Face> masters;
};

Stack stackOf(ElementShape below, int cellsBelow, ElementShape above, int cellsAbove) {
  Stack stack;
  stack.mesh = boxOf(below, {cellsBelow, cellsBelow, 2}, {0, 0, 0}, {1.0, 1.0, 0.5});
  stack.masters = faceSet(stack.mesh, "z+");
  const SolidMesh upper = boxOf(above, {cellsAbove, cellsAbove, 2}, {0, 0, 0.5}, {1.0, 1.0, 1.0});
  const int shift = static_cast<int>(stack.mesh.X.size());
  stack.mesh.X.insert(stack.mesh.X.end(), upper.X.begin(), upper.X.end());
  for (ElementGroup group : upper.groups) {
    for (int& n : group.node) n += shift;
    stack.mesh.groups.push_back(std::move(group));
  }
  for (const int n : nodeSet(upper, "z-")) stack.slaves.push_back(n + shift);
  const auto shifted = [&](std::vector<Face> faces) {
    for (Face& face : faces)
      for (int& n : face.node)
        if (n >= 0) n += shift;
    return faces;
  };
  stack.mesh.faceSets["z+"] = shifted(faceSet(upper, "z+"));
  for (const char* side : {"x-", "x+", "y-", "y+"})
    for (const Face& face : shifted(faceSet(upper, side))) stack.mesh.faceSets[side].push_back(face);
  return stack;
}

/// Largest residual of u = (F − 1) X under the tractions of its uniform stress, over stress times the area of a master
/// face.
double patchResidual(const Stack& stack, int cellsBelow) {
  Model model = makeModel(stack.mesh);
  model.add(makeSolid(stack.mesh, std::make_shared<PlainNeoHookean>(2e6, 1e6)));
  const Eigen::Matrix3d P = plainStress(someGradient, 2e6, 1e6);
  const std::pair<const char*, Eigen::Vector3d> sides[] = {{"x-", {-1, 0, 0}}, {"x+", {1, 0, 0}},  {"y-", {0, -1, 0}},
                                                           {"y+", {0, 1, 0}},  {"z-", {0, 0, -1}}, {"z+", {0, 0, 1}}};
  for (const auto& [side, normal] : sides) {
    const Eigen::Vector3d t = P * normal;
    model.add(deadTraction(stack.mesh, faceSet(stack.mesh, side), Vec3{t[0], t[1], t[2]}));
  }
  model.constraints.ties = tieInterface(stack.mesh, stack.slaves, stack.masters, 1e-9);
  const DofMap map(model.constraints, model.nodes);
  setAffine(model.nodes, someGradient);
  std::vector<Vec3> u = model.nodes.u;
  map.apply(0.0, u);
  for (std::size_t n = 0; n < u.size(); ++n) EXPECT_LT(norm(u[n] - model.nodes.u[n]), 1e-14);
  evaluateForces(model, {});
  std::vector<double> r(map.size());
  map.reduce(model.nodes.f, r);
  double most = 0.0;
  for (const double value : r) most = std::max(most, std::abs(value));
  return most * cellsBelow * cellsBelow / P.norm();
}

TEST(TiedInterface, APatchIsInEquilibriumIfTheSlavesDivideTheMasters) {
  EXPECT_LT(patchResidual(stackOf(ElementShape::hex8, 2, ElementShape::hex8, 4), 2), 1e-12);
  EXPECT_LT(patchResidual(stackOf(ElementShape::hex8, 3, ElementShape::hex8, 3), 3), 1e-12);
  EXPECT_LT(patchResidual(stackOf(ElementShape::tet4, 2, ElementShape::tet4, 4), 2), 1e-12);
  EXPECT_LT(patchResidual(stackOf(ElementShape::hex27, 1, ElementShape::hex27, 3), 1), 1e-12);
}

TEST(TiedInterface, APatchIsNearlyInEquilibriumOtherwise) {
  const double coarse = patchResidual(stackOf(ElementShape::hex8, 2, ElementShape::hex8, 3), 2),
               fine = patchResidual(stackOf(ElementShape::hex8, 2, ElementShape::hex8, 7), 2);
  RecordProperty("coarse", std::to_string(coarse));
  RecordProperty("fine", std::to_string(fine));
  EXPECT_GT(coarse, 1e-6);
  EXPECT_LT(coarse, 0.2);
  EXPECT_LT(fine, 0.3 * coarse);
}

TEST(TiedInterface, ForceAndMomentArriveAtTheMasters) {
  const Stack stack = stackOf(ElementShape::hex8, 2, ElementShape::tet10, 3);
  for (const Tie& tie : tieInterface(stack.mesh, stack.slaves, stack.masters, 1e-9)) {
    double sum = 0.0;
    Vec3 place;
    for (const Tie::Master& m : tie.masters) {
      sum += m.factor;
      place += m.factor * stack.mesh.X[static_cast<std::size_t>(m.node)];
    }
    EXPECT_NEAR(sum, 1.0, 1e-14);
    EXPECT_LT(norm(place - stack.mesh.X[static_cast<std::size_t>(tie.node)]), 1e-13);
  }
}

TEST(TiedInterface, SlavesOffTheFacesAreRefusedByNumber) {
  Stack stack = stackOf(ElementShape::hex8, 2, ElementShape::hex8, 3);
  stack.mesh.X[static_cast<std::size_t>(stack.slaves[5])].z += 1e-3;
  try {
    tieInterface(stack.mesh, stack.slaves, stack.masters, 1e-4);
    ADD_FAILURE() << "a slave off the faces was tied";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("node " + std::to_string(stack.slaves[5])), std::string::npos);
  }
  EXPECT_NO_THROW(tieInterface(stack.mesh, stack.slaves, stack.masters, 1e-2));
  EXPECT_THROW(tieInterface(stack.mesh, std::array{stack.masters[0].node[0]}, stack.masters, 1e-2), InputError);
  EXPECT_THROW(tieInterface(stack.mesh, std::array{99999}, stack.masters, 1e-2), InputError);
}

/// What ties a slave to one face alone, if it is near enough; and how far it lies from it.
double tieTo(const SolidMesh& mesh, int slave, const Face& face, std::vector<Tie>& ties) {
  try {
    ties = tieInterface(mesh, std::array{slave}, std::array{face}, 0.3);
  } catch (const InputError&) {
    return INFINITY;
  }
  Vec3 foot;
  for (const auto& master : ties[0].masters) foot += master.factor * mesh.X[static_cast<std::size_t>(master.node)];
  return norm(foot - mesh.X[static_cast<std::size_t>(slave)]);
}

TEST(TiedInterface, TheNearestOfManyFacesIsFound) {
  std::mt19937 random(6);
  for (const ElementShape shape :
       {ElementShape::hex8, ElementShape::hex20, ElementShape::hex27, ElementShape::tet4, ElementShape::tet10}) {
    SolidMesh mesh = boxOf(shape, {5, 4, 1}, {}, {5, 4, 1});
    for (Vec3& X : mesh.X) X += Vec3{0, 0, 0.2 * std::sin(1.3 * X.x + X.y)} + randomVec3(random, 0.03);
    const std::vector<Face> masters = faceSet(mesh, "z+");
    std::vector<int> slaves;
    for (int k = 0; k < 60; ++k) {
      const Vec3 x = Vec3{2.5, 2.0, 1.0} + 0.98 * randomVec3(random, 1.0);
      slaves.push_back(static_cast<int>(mesh.X.size()));
      mesh.X.push_back(
          {2.5 + 2.4 * (x.x - 2.5), 2.0 + 1.9 * (x.y - 2.0), 1.0 + 0.2 * std::sin(2.0 * x.x) * (x.z - 1.0)});
    }
    int tied = 0;
    for (const int slave : slaves) {
      std::vector<Tie> best, one;
      double least = INFINITY;
      for (const Face& face : masters)
        if (const double distance = tieTo(mesh, slave, face, one); distance < least) least = distance, best = one;
      if (!(least < 0.29)) continue;
      ++tied;
      const std::vector<Tie> found = tieInterface(mesh, std::array{slave}, masters, 0.3);
      ASSERT_EQ(found.size(), best.size());
      for (std::size_t c = 0; c < 3; ++c) {
        ASSERT_EQ(found[c].masters.size(), best[c].masters.size()) << name(shape);
        for (std::size_t a = 0; a < best[c].masters.size(); ++a) {
          EXPECT_EQ(found[c].masters[a].node, best[c].masters[a].node) << name(shape);
          EXPECT_EQ(found[c].masters[a].factor, best[c].masters[a].factor) << name(shape);
        }
      }
    }
    EXPECT_GT(tied, 20) << name(shape);
  }
}

}  // namespace
}  // namespace dovetail::fem
