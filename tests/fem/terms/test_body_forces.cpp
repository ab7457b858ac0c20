#include <gtest/gtest.h>

#include "dovetail/core/error.hpp"
#include "dovetail/fem/solve/statics.hpp"
#include "dynamics_helpers.hpp"
#include "term_checks.hpp"

namespace dovetail::fem {
namespace {

constexpr Vec3 g{1.0, -2.0, -9.81};
/// In the plane of plane cells.
Vec3 weightOf(ElementShape shape) { return dimensionOf(shape) == 2 ? Vec3{1.0, -9.81, 0.0} : g; }
constexpr double stepLength = 0.02 * crossing;
constexpr int steps = 10;

/// One brick, or its tetrahedra.
SolidMesh oneCell(ElementShape shape) { return boxOf(shape, {1, 1, 1}, {}, {0.1, 0.1, 0.1}); }

/// Runs a model from rest or at v0 with every integrator and fraction of the consistent mass, and calls check(model,
/// what, ledger residual).
template <class Make, class Check>
void withEveryIntegrator(Make&& make, Check&& check) {
  for (const double fraction : {0.0, 0.3, 1.0}) {
    const std::string suffix = ", mass share " + std::to_string(fraction);
    Model model = make();
    ExplicitIntegrator integrator(model, stepLength, {.massFraction = fraction});
    integrator.run(steps);
    check(model, "central differences" + suffix, integrator.ledger());
    for (const Scheme& scheme : {newmark(), hht(-0.1), generalisedAlpha(0.5), energyMomentum()}) {
      Model other = make();
      ImplicitOptions options;
      options.scheme = scheme;
      options.massFraction = fraction;
      options.relativeTolerance = 1e-13;
      ImplicitIntegrator implicit(other, stepLength, options);
      implicit.run(steps);
      check(other, scheme.name + suffix, implicit.ledger());
    }
  }
}

TEST(BodyForces, FreeBodiesOfEveryShapeFallWithoutStress) {
  for (const ElementShape shape : allCellShapes) {
    const Vec3 pull = weightOf(shape);
    withEveryIntegrator(
        [&] {
          Model model = smallBody(oneCell(shape));
          model.add(gravity(pull));
          return model;
        },
        [&](Model& model, const std::string& what, const EnergyLedger& ledger) {
          const double t = model.t;
          double weight = 0.0;
          for (const double mass : model.nodes.mass) weight += mass * norm(pull);
          for (std::size_t n = 0; n < model.nodes.u.size(); ++n) {
            EXPECT_LT(norm(model.nodes.v[n] - t * pull), 1e-12 * t * norm(pull)) << name(shape) << ' ' << what;
            EXPECT_LT(norm(model.nodes.u[n] - 0.5 * t * t * pull), 1e-12 * t * t * norm(pull))
                << name(shape) << ' ' << what;
          }
          EXPECT_LT(largest(forcesOf(*model.terms[0], model.nodes, {})), 1e-11 * weight) << name(shape) << ' ' << what;
          EXPECT_LT(std::abs(ledger.residual()), 1e-14 * weight * 0.1) << name(shape) << ' ' << what;
        });
  }
}

TEST(BodyForces, MassDampingSlowsEveryNodeAlike) {
  const double alpha = 50.0;
  for (const ElementShape shape : allCellShapes) {
    const Vec3 pull = weightOf(shape);
    withEveryIntegrator(
        [&] {
          Model model = smallBody(oneCell(shape));
          for (Vec3& v : model.nodes.v) v = pull;
          model.add(massDamping(alpha));
          return model;
        },
        [&](Model& model, const std::string& what, const EnergyLedger&) {
          const Vec3 slowed = std::exp(-alpha * model.t) * pull;
          for (const Vec3& v : model.nodes.v) {
            EXPECT_LT(norm(v - model.nodes.v[0]), 1e-12 * norm(pull)) << name(shape) << ' ' << what;
            EXPECT_LT(norm(v - slowed), 1e-3 * norm(pull - slowed)) << name(shape) << ' ' << what;
          }
        });
  }
}

TEST(BodyForces, MassDampingIsTheMassMatrixTimesItsRate) {
  Model model = smallBody(smallMesh(ElementShape::hex20));
  setRandom(model.nodes.v, 1.0, 3);
  const DofMap dofs(model.constraints, model.nodes);
  const ModelMass mass(model, dofs, 0.4);
  const auto damping = massDamping(3.0);
  const Instant now{0.0, 0.1, &mass};
  std::vector<Vec3> Mv(model.nodes.v.size()), Cv(Mv.size());
  mass.multiply(model.nodes.v, Mv);
  linalg::BlockMatrix C = zeroTangent(model);
  C.setZero();
  damping->addDamping(model.nodes, now, C);
  C.multiply(model.nodes.v, Cv);
  const std::vector<Vec3> f = forcesOf(*damping, model.nodes, now);
  for (std::size_t n = 0; n < f.size(); ++n) {
    EXPECT_LT(norm(f[n] + 3.0 * Mv[n]), 1e-15);
    EXPECT_LT(norm(f[n] + Cv[n]), 1e-14);
  }
}

/// Mean of the tips under weights up and down: the strains' second order drops out.
double hangingTip(ElementShape shape, double weightless) {
  const SolidMesh mesh = oneCell(shape);
  double tip = 0.0;
  for (const double sign : {1.0, -1.0}) {
    Model model = makeModel(mesh);
    model.add(makeSolid(mesh, std::make_shared<PlainNeoHookean>(0.0, 0.5e6)));
    addMass(model);
    for (const auto& [side, component] :
         {std::pair("x-", componentX), std::pair("y-", componentY), std::pair("z+", componentZ)})
      model.constraints.hold(nodeSet(mesh, side), component);
    model.add(gravity(Vec3{0, 0, -sign * weightless}));
    solveStatics(model, 1.0, {.newton = {.relativeTolerance = 1e-12}, .firstStep = 1.0});
    tip += 0.5 * sign * model.nodes.u[static_cast<std::size_t>(nodeSet(mesh, "z-")[0])].z;
  }
  return tip;
}

TEST(BodyForces, ColumnsOfOneCellHangToTheExactTip) {
  const double weight = 1.0, exact = -1000.0 * weight * 0.1 * 0.1 / (2.0 * 1e6);  // −ρ g h² / 2E at a strain of 1e-4
  for (const ElementShape shape : {ElementShape::hex8, ElementShape::hex20, ElementShape::hex27, ElementShape::tet10})
    EXPECT_NEAR(hangingTip(shape, weight), exact, 1e-6 * std::abs(exact)) << name(shape);
}

TEST(BodyForces, WeightWithoutMassIsRefused) {
  const SolidMesh mesh = smallMesh();
  Model model = makeModel(mesh);
  model.add(makeSolid(mesh, std::make_shared<PlainNeoHookean>(1e6, 1e6)));
  model.add(gravity(g));
  model.constraints.hold(nodeSet(mesh, "x-"));
  try {
    solveStatics(model, 1.0);
    ADD_FAILURE() << "a body without mass has no weight";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("addMass"), std::string::npos) << error.what();
  }
  addMass(model);
  EXPECT_NO_THROW(solveStatics(model, 1.0));
}

TEST(BodyForces, DampingHasNoSayInStatics) {
  const SolidMesh mesh = smallMesh();
  const auto end = [&](bool damped) {
    Model model = smallBody(mesh);
    model.constraints.hold(nodeSet(mesh, "x-"));
    model.add(gravity(g));
    if (damped) {
      setRandom(model.nodes.v, 1.0, 3);  // as a run in time leaves them
      model.add(massDamping(20.0));
      model.add(groundDashpots(nodeSet(mesh, "x+"), {5, 5, 5}));
    }
    solveStatics(model, 1.0);
    return std::move(model.nodes.u);
  };
  EXPECT_EQ(end(true), end(false));
}

}  // namespace
}  // namespace dovetail::fem
