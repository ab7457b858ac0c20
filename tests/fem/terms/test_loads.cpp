#include <gtest/gtest.h>

#include "dovetail/core/error.hpp"
#include "dovetail/fem/model/model_mass.hpp"
#include "dovetail/fem/terms/loads.hpp"
#include "term_checks.hpp"

namespace dovetail::fem {
namespace {

constexpr Vec3 lower{0.1, -0.2, 0.3}, upper{1.0, 0.9, 1.0};
constexpr Instant now{0.7, 0.1};

SolidMesh box(ElementShape shape) { return boxOf(shape, layered(shape, {2, 3, 2}), lower, upper); }

Model randomState(const SolidMesh& mesh, unsigned seed, double amplitude = 0.1) {
  Model model = makeModel(mesh);
  setRandomDisplacement(model.nodes, amplitude, seed);
  setRandom(model.nodes.v, 1.0, seed + 1);
  for (std::size_t n = 0; n < model.nodes.mass.size(); ++n) model.nodes.mass[n] = 1.0 + 0.1 * static_cast<double>(n);
  return model;
}

TEST(Loads, GravityIsTheWeightAndHasAPotential) {
  Model model = randomState(box(ElementShape::hex8), 3);
  const Vec3 g{1.0, -2.0, -9.81};
  Term& term = model.add(gravity(g));
  double mass = 0.0;
  for (const double m : model.nodes.mass) mass += m;
  const auto f = forcesOf(term, model.nodes, now);
  EXPECT_LT(norm(resultant(model.nodes, f).first - mass * g), 1e-10);
  expectForceFromEnergy(term, model.nodes, now, 1e-8);
  const auto shaken = gravity([=](double t) { return t * g; });
  EXPECT_FALSE(shaken->hasEnergy());
  EXPECT_LT(norm(forcesOf(*shaken, model.nodes, now)[4] - 0.7 * f[4]), 1e-13);
}

TEST(Loads, PressureOnTheWholeSkinHasNoResultant) {
  for (const ElementShape shape : allCellShapes) {
    const SolidMesh mesh = box(shape);
    Model model = randomState(mesh, 5, 0.05);
    const auto pressure = followingPressure(mesh, faceSet(mesh, "skin"), 2e3);
    const auto [force, moment] = resultant(model.nodes, forcesOf(*pressure, model.nodes, now));
    EXPECT_LT(norm(force), 1e-10) << name(shape);
    EXPECT_LT(norm(moment), 1e-10) << name(shape);
    for (Vec3& u : model.nodes.u) u = {};
    const auto [deadForce, deadMoment] =
        resultant(model.nodes, forcesOf(*deadPressure(mesh, faceSet(mesh, "skin"), 2e3), model.nodes, now));
    EXPECT_LT(norm(deadForce), 1e-10) << name(shape);
    EXPECT_LT(norm(deadMoment), 1e-10) << name(shape);
  }
}

/// A field that is the same everywhere is the number; its tangent is the derivative anywhere; what it does on flat
/// reference faces is its integral there.
TEST(Loads, PressuresMayDependOnThePlace) {
  const auto field = [](const Vec3& X, double t) { return 3.0 + X.x - 2.0 * X.y * X.z + t; };
  for (const ElementShape shape : spatialCellShapes) {
    const SolidMesh mesh = box(shape);
    Model model = randomState(mesh, 5, 0.05);
    const std::vector<Face>& faces = faceSet(mesh, "skin");
    const auto follows = followingPressure(mesh, faces, field);
    EXPECT_FALSE(follows->hasEnergy() || follows->isSymmetric());
    expectTangents(*follows, model.nodes, now, 1e-7);
    const auto same = [](const Vec3&, double) { return 7.0; };
    const auto expectSame = [&](Term& a, Term& b) {
      const std::vector<Vec3> f = forcesOf(a, model.nodes, now), g = forcesOf(b, model.nodes, now);
      for (std::size_t n = 0; n < f.size(); ++n) EXPECT_LT(norm(f[n] - g[n]), 1e-12) << name(shape);
    };
    expectSame(*followingPressure(mesh, faces, same), *followingPressure(mesh, faces, 7.0));
    expectSame(*deadPressure(mesh, faces, same), *deadPressure(mesh, faces, 7.0));
    for (Vec3& u : model.nodes.u) u = {};
    expectSame(*follows, *deadPressure(mesh, faces, field));
    // ∮ −p n dA = −∫ ∇p dV
    double volume = 1.0;
    Vec3 centre;
    for (int c = 0; c < 3; ++c) {
      const auto [least, most] = std::ranges::minmax(mesh.X, {}, [c](const Vec3& X) { return X[c]; });
      volume *= most[c] - least[c];
      centre[c] = 0.5 * (most[c] + least[c]);
    }
    const Vec3 force = resultant(model.nodes, forcesOf(*follows, model.nodes, now)).first;
    EXPECT_LT(norm(force - volume * Vec3{-1.0, 2.0 * centre.z, 2.0 * centre.y}), 1e-12) << name(shape);
  }
}

TEST(Loads, PressureOnOneSideIsPressureTimesArea) {
  const double area = 0.9 * 1.1;
  for (const ElementShape shape : spatialCellShapes) {
    const SolidMesh mesh = box(shape);
    Model model = makeModel(mesh);
    const auto faces = faceSet(mesh, "z+");
    const Vec3 middle{0.55, 0.35, 1.0}, expected{0, 0, -3.0 * area};
    for (const auto& load :
         {followingPressure(mesh, faces, 3.0), deadPressure(mesh, faces, 3.0),
          deadTraction(mesh, faces, {0, 0, -1.0}, 3.0), deadTraction(mesh, faces, [](const Vec3&, double) {
            return Vec3{0, 0, -3.0};
          })}) {
      const auto [force, moment] = resultant(model.nodes, forcesOf(*load, model.nodes, now));
      EXPECT_LT(norm(force - expected), 1e-13) << name(shape) << load->name();
      EXPECT_LT(norm(moment - cross(middle, expected)), 1e-13) << name(shape);
    }
  }
}

TEST(Loads, TractionsFollowTheirFieldInPlaceAndTime) {
  for (const ElementShape shape : spatialCellShapes) {
    const SolidMesh mesh = box(shape);
    Model model = randomState(mesh, 7);
    const auto load = deadTraction(mesh, faceSet(mesh, "x+"), [](const Vec3& X, double t) {
      return Vec3{t * X.y, X.z, 0.0};
    });
    const Vec3 force = resultant(model.nodes, forcesOf(*load, model.nodes, now)).first;
    EXPECT_NEAR(force.x, 0.7 * 0.5 * (0.81 - 0.04) * 0.7, 1e-14) << name(shape);
    EXPECT_NEAR(force.y, 0.5 * (1.0 - 0.09) * 1.1, 1e-14) << name(shape);
  }
}

TEST(Loads, FollowingPressureHasItsExactTangentForEveryShapeOfFace) {
  for (const ElementShape shape : allCellShapes) {
    const SolidMesh mesh = box(shape);
    Model model = randomState(mesh, 9);
    const auto pressure = followingPressure(mesh, faceSet(mesh, "y-"), [](double t) { return 10.0 * t; });
    EXPECT_FALSE(pressure->isSymmetric());
    EXPECT_FALSE(pressure->hasEnergy());
    expectTangents(*pressure, model.nodes, now, 1e-9);
  }
}

TEST(Loads, PressureOnAClosedSkinIsTheGradientOfPressureTimesVolume) {
  for (const ElementShape shape : allCellShapes) {
    const SolidMesh mesh = box(shape);
    Model model = makeModel(mesh);
    const auto pressure = followingPressure(mesh, faceSet(mesh, "skin"), 10.0);
    EXPECT_TRUE(pressure->isSymmetric());
    EXPECT_NEAR(pressure->energy(model.nodes, now), 10.0 * 0.9 * 1.1 * 0.7, 1e-13) << name(shape);
    setRandomDisplacement(model.nodes, 0.1, 11);
    expectForceFromEnergy(*pressure, model.nodes, now, 1e-9);
    expectTangents(*pressure, model.nodes, now, 1e-9);
  }
}

TEST(Loads, PressureWithAClampedRimHasAPotentialAndASymmetricTangent) {
  const SolidMesh mesh = box(ElementShape::hex8);
  std::vector<int> rim;
  for (const int n : nodeSet(mesh, "z+"))
    for (const char* side : {"x-", "x+", "y-", "y+"})
      if (std::ranges::binary_search(nodeSet(mesh, side), n)) rim.push_back(n);
  rim.erase(std::unique(rim.begin(), rim.end()), rim.end());
  Model model = randomState(mesh, 13);
  for (const int n : rim) model.nodes.u[static_cast<std::size_t>(n)] = {};
  const auto pressure = followingPressure(mesh, faceSet(mesh, "z+"), 10.0, rim);
  ASSERT_TRUE(pressure->isSymmetric());
  linalg::BlockMatrix K = matrixFor(*pressure, model.nodes);
  K.setZero();
  pressure->addTangent(model.nodes, now, K);
  std::vector<Vec3> a(model.nodes.u.size()), b = a, Ka = a, Kb = a;
  setRandom(a, 1.0, 1);
  setRandom(b, 1.0, 2);
  for (const int n : rim) a[static_cast<std::size_t>(n)] = b[static_cast<std::size_t>(n)] = {};
  K.multiply(a, Ka);
  K.multiply(b, Kb);
  EXPECT_NEAR(productOf(Ka, b), productOf(Kb, a), 1e-13);
  EXPECT_GT(std::abs(productOf(Ka, b)), 1e-3);
  EXPECT_NEAR(productOf(forcesOf(*pressure, model.nodes, now), a),
              -centralDifference(model.nodes.u, a, 1e-5, [&] { return pressure->energy(model.nodes, now); }), 1e-8);
  rim.pop_back();
  EXPECT_FALSE(followingPressure(mesh, faceSet(mesh, "z+"), 10.0, rim)->isSymmetric());
}

TEST(Loads, WorkOfPressureIsPressureTimesTheChangeOfVolume) {
  const SolidMesh mesh = box(ElementShape::hex20);
  Model model = makeModel(mesh);
  const auto pressure = followingPressure(mesh, faceSet(mesh, "skin"), 10.0);
  setAffine(model.nodes, Eigen::Matrix3d{{1.2, 0.1, 0.0}, {-0.3, 0.9, 0.2}, {0.1, 0.0, 1.1}}, {1.0, 2.0, 3.0});
  const double J = Eigen::Matrix3d{{1.2, 0.1, 0.0}, {-0.3, 0.9, 0.2}, {0.1, 0.0, 1.1}}.determinant();
  EXPECT_NEAR(pressure->energy(model.nodes, now), 10.0 * J * 0.9 * 1.1 * 0.7, 1e-12);
}

TEST(Loads, ConstantLoadsStoreEnergyAndVaryingOnesDoNot) {
  const SolidMesh mesh = box(ElementShape::hex8);
  Model model = randomState(mesh, 15);
  for (const auto& load :
       {nodalForce(nodeSet(mesh, "x+"), {1, 2, 3}), deadPressure(mesh, faceSet(mesh, "x+"), 4.0),
        deadTraction(mesh, faceSet(mesh, "x+"), {1, 2, 3}), groundSprings(nodeSet(mesh, "x-"), {1, 2, 3})}) {
    expectForceFromEnergy(*load, model.nodes, now, 1e-9);
    expectTangents(*load, model.nodes, now, 1e-9);
  }
  const auto varying = nodalForce(nodeSet(mesh, "x+"), {1, 2, 3}, ramp(2.0, 4.0));
  EXPECT_FALSE(varying->hasEnergy());
  const auto node = static_cast<std::size_t>(nodeSet(mesh, "x+")[0]);
  EXPECT_LT(norm(forcesOf(*varying, model.nodes, now)[node] - 1.4 * Vec3{1, 2, 3}), 1e-14);
}

TEST(Loads, ConservingForcesDoTheWorkThatIsStored) {
  const SolidMesh mesh = box(ElementShape::hex8);
  Model model = randomState(mesh, 17);
  std::vector<Vec3> u0(model.nodes.u.size());
  setRandom(u0, 0.2, 19);
  for (const auto& load : {nodalForce(nodeSet(mesh, "x+"), {1, 2, 3}), deadPressure(mesh, faceSet(mesh, "x+"), 4.0),
                           gravity(Vec3{1, 2, 3}), groundSprings(nodeSet(mesh, "x-"), {1, 2, 3})}) {
    std::vector<Vec3> f(u0.size()), du = model.nodes.u;
    ASSERT_TRUE(load->addConservingForces(model.nodes, u0, now, f));
    for (std::size_t n = 0; n < du.size(); ++n) du[n] -= u0[n];
    const double after = load->energy(model.nodes, now);
    Nodes before = model.nodes;
    before.u = u0;
    EXPECT_NEAR(productOf(f, du), load->energy(before, now) - after, 1e-11) << load->name();
  }
}

TEST(Loads, DampingOpposesTheVelocity) {
  const SolidMesh mesh = box(ElementShape::hex8);
  Model model = randomState(mesh, 21);
  const DofMap dofs(model.constraints, model.nodes);
  const ModelMass mass(model, dofs, 0.0);
  const Instant moving{now.t, now.dt, &mass};
  for (const auto& load : {massDamping(3.0), groundDashpots(nodeSet(mesh, "x-"), {1, 2, 3})}) {
    expectTangents(*load, model.nodes, moving, 1e-9);
    EXPECT_LT(productOf(forcesOf(*load, model.nodes, moving), model.nodes.v), 0.0);
    EXPECT_FALSE(load->hasEnergy());
  }
}

TEST(Loads, NodesThatTheModelDoesNotHaveAreRefusedAtTheFirstUse) {
  const SolidMesh mesh = box(ElementShape::hex8);
  Model model = randomState(mesh, 25);
  const DofMap dofs(model.constraints, model.nodes);
  const ModelMass mass(model, dofs, 0.0);
  const Instant moving{now.t, now.dt, &mass};
  const int count = static_cast<int>(mesh.X.size());
  const std::array nodes = {0, count, 1};
  const auto expectRefusal = [&](auto&& use) {
    try {
      use();
      ADD_FAILURE() << "a node beyond the mesh was taken";
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find("node " + std::to_string(count) + " "), std::string::npos)
          << error.what();
    }
  };
  for (const auto& load :
       {nodalForce(nodes, {1, 2, 3}), groundSprings(nodes, {1, 2, 3}), groundDashpots(nodes, {1, 2, 3})}) {
    std::vector<Vec3> f(mesh.X.size());
    expectRefusal([&] { load->addForces(model.nodes, moving, f); });
    EXPECT_EQ(f, std::vector<Vec3>(f.size()));
    if (load->hasEnergy()) expectRefusal([&] { load->energy(model.nodes, moving); });
    linalg::BlockMatrix K = matrixFor(*load, model.nodes);
    if (load->name() == "ground springs") expectRefusal([&] { load->addTangent(model.nodes, moving, K); });
    if (load->name() == "ground dashpots") expectRefusal([&] { load->addDamping(model.nodes, moving, K); });
  }
}

TEST(Loads, BadInputIsRefused) {
  const SolidMesh mesh = box(ElementShape::hex8);
  EXPECT_THROW(deadPressure(mesh, {}, 1.0), InputError);
  Face face = faceSet(mesh, "x+")[0];
  face.node[2] = 1000;
  EXPECT_THROW(followingPressure(mesh, std::array{face}, 1.0), InputError);
  EXPECT_THROW(nodalForce({}, {}), InputError);
  EXPECT_THROW(nodalForce(std::array{-1}, {}), InputError);
  EXPECT_THROW(massDamping(-1.0), InputError);
  EXPECT_THROW(groundSprings(std::array{1}, {-1, 0, 0}), InputError);
  EXPECT_THROW(gravity(std::function<Vec3(double)>{}), InputError);
}

}  // namespace
}  // namespace dovetail::fem
