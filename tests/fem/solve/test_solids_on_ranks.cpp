// Solids whose elements are dealt to the ranks of MPI. All ranks run the tests; the first one tells.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "dovetail/core/archive.hpp"
#include "dovetail/core/error.hpp"
#include "dovetail/core/team.hpp"
#include "dovetail/fem/laws/plasticity.hpp"
#include "dovetail/fem/motion/dynamics.hpp"
#include "dovetail/fem/solve/modes.hpp"
#include "dovetail/fem/terms/contact_plane.hpp"
#include "dovetail/fem/terms/loads.hpp"
#include "dovetail/linalg/block_matrix.hpp"
#include "dovetail/ranks/team_of_ranks.hpp"
#include "pressed_box.hpp"

namespace dovetail::fem {
namespace {

std::shared_ptr<const PointMaterial> rubber() { return pointMaterial(neoHookean(1e6, 0.3, 1000.0)); }
std::shared_ptr<const PointMaterial> metal() {
  return pointMaterial(J2Plasticity{1e6, 0.3, 1000.0, linearYield(2e4, 1e4)});
}
std::shared_ptr<const PointMaterial> sand() {
  return pointMaterial(DruckerPrager{.youngsModulus = 1e6,
                                     .poissonRatio = 0.3,
                                     .density = 1000.0,
                                     .cohesion = 2e4,
                                     .frictionAngle = 0.5,
                                     .dilatancyAngle = 0.1});
}

Solid& solidOf(Model& model) { return dynamic_cast<Solid&>(*model.terms[0]); }

/// The same box here and on ranks.
struct Pair {
  Model here, shared;
  explicit Pair(const std::shared_ptr<const PointMaterial>& material, int n = 5,
                ElementShape shape = ElementShape::hex8, Formulation formulation = Formulation::standard)
      : here(pressed(n, material, shape, formulation)), shared(pressed(n, material, shape, formulation, true)) {}
  void bend() {
    for (Model* model : {&here, &shared})
      for (std::size_t n = 0; n < model->nodes.X.size(); ++n) {
        const Vec3& X = model->nodes.X[n];
        model->nodes.u[n] = 0.02 * Vec3{std::sin(3.0 * X.z), std::cos(2.0 * X.x), std::sin(X.x + X.y)};
      }
  }
  void addMasses() {
    for (Model* model : {&here, &shared}) addMass(*model);
  }
};

double apart(std::span<const Vec3> a, std::span<const Vec3> b) {
  double difference = 0.0, size = 0.0;
  for (std::size_t n = 0; n < a.size(); ++n) {
    difference = std::max(difference, norm(a[n] - b[n]));
    size = std::max(size, norm(a[n]));
  }
  return difference / size;
}

/// Of their tangents with a vector.
double productsApart(Pair& pair) {
  std::vector<Vec3> x(pair.here.nodes.X.size()), y(x.size()), z(x.size());
  for (std::size_t n = 0; n < x.size(); ++n) x[n] = {std::sin(7.0 * double(n)), std::cos(3.0 * double(n)), 1.0};
  linalg::BlockMatrix whole = zeroTangent(pair.here), part = zeroTangent(pair.shared);
  addTangents(pair.here, {}, whole);
  addTangents(pair.shared, {}, part);
  whole.multiply(x, y);
  part.multiply(x, z);
  return apart(y, z);
}

TEST(SolidsOnRanks, EquilibriaAreThoseOfOneProcess) {
  struct Case {
    const char* name;
    std::shared_ptr<const PointMaterial> material;
    ElementShape shape = ElementShape::hex8;
    Formulation formulation = Formulation::standard;
  };
  const Case cases[] = {{"neo-Hookean", rubber()},
                        {"tet10", rubber(), ElementShape::tet10},
                        {"enhanced", rubber(), ElementShape::hex8, Formulation::enhanced},
                        {"nearly incompressible", pointMaterial(neoHookean(1e6, 0.499, 1000.0)), ElementShape::hex8,
                         Formulation::meanDilatation},
                        {"J2", metal(), ElementShape::hex8, Formulation::meanDilatation},
                        {"Drucker-Prager", sand()}};
  const bool few = team().size() > 2;  // many on few cores wait for each other
  for (const Case& one : few ? std::span(cases).last(1) : std::span(cases)) {
    SCOPED_TRACE(one.name);
    Pair pair(one.material, 5, one.shape, one.formulation);
    Model byOne = pressed(5, one.material, one.shape, one.formulation);
    const StaticReport direct = solve(pair.here, linalg::LinearMethod::direct), alone = solve(byOne, byMultigrid),
                       report = solve(pair.shared, byMultigrid);
    EXPECT_EQ(report.solver, "multigrid");
    // Linear systems are solved as loosely as Newton's method allows, by other levels.
    EXPECT_LE(std::abs(report.iterations - alone.iterations), static_cast<std::int64_t>(report.steps.size()));
    EXPECT_EQ(report.cuts, alone.cuts);
    EXPECT_LT(apart(pair.here.nodes.u, pair.shared.nodes.u), 1e-8);
    EXPECT_NEAR(report.dissipated, direct.dissipated, 1e-7 * report.storedAfter);
    EXPECT_NEAR(report.storedAfter, direct.storedAfter, 1e-7 * report.storedAfter);
    EXPECT_NEAR(report.supportWork, direct.supportWork, 1e-7 * report.storedAfter);
  }
}

TEST(SolidsOnRanks, MatricesAreSumsOfTheirParts) {
  Pair pair(rubber());
  pair.bend();
  const linalg::BlockMatrix whole = zeroTangent(pair.here), part = zeroTangent(pair.shared);
  EXPECT_EQ(part.isPart(), team().size() > 1);
  if (team().size() > 1) {
    EXPECT_LT(part.columns().size(), whole.columns().size());
  }
  EXPECT_LT(productsApart(pair), 1e-13);
}

TEST(SolidsOnRanks, WhatElementsSayIsThatOfOneProcess) {
  for (const auto& material : {rubber(), metal()}) {
    Pair pair(material);
    pair.bend();
    pair.addMasses();
    Solid &here = solidOf(pair.here), &shared = solidOf(pair.shared);
    const Nodes& nodes = pair.here.nodes;
    std::vector<Vec3> f(nodes.X.size()), g(f.size());
    const double energy = here.addForcesAndEnergy(nodes, {}, f);
    EXPECT_NEAR(shared.addForcesAndEnergy(nodes, {}, g), energy, 1e-13 * energy);
    EXPECT_LT(apart(f, g), 1e-13);
    for (std::size_t n = 0; n < nodes.mass.size(); ++n)
      EXPECT_NEAR(pair.shared.nodes.mass[n], nodes.mass[n], 1e-13 * nodes.mass[n]);
    EXPECT_EQ(shared.size(), here.size());
    EXPECT_EQ(shared.elementEnergies(nodes, {}), here.elementEnergies(nodes, {}));
    const Solid::Sample a = here.sample(nodes, {}), b = shared.sample(nodes, {});
    EXPECT_EQ(a.element, b.element);
    EXPECT_EQ(a.X, b.X);
    EXPECT_EQ(a.F, b.F);
    EXPECT_EQ(a.P, b.P);
    EXPECT_EQ(a.energy, b.energy);
    EXPECT_EQ(here.stableStep(nodes)->dt, shared.stableStep(nodes)->dt);
    EXPECT_EQ(here.stableStep(nodes)->element, shared.stableStep(nodes)->element);
    const double lost = here.commit(nodes, {});
    EXPECT_NEAR(shared.commit(nodes, {}), lost, 1e-13 * std::abs(lost));
    EXPECT_EQ(here.sample(nodes, {}).history, shared.sample(nodes, {}).history);
  }
}

TEST(SolidsOnRanks, ImplicitStepsAreThoseOfOneProcess) {
  for (const auto& [conserves, massFraction] : {std::pair{false, 0.0}, std::pair{true, 0.0}, std::pair{false, 1.0}}) {
    SCOPED_TRACE(testing::Message() << conserves << ", consistent mass " << massFraction);
    Pair pair(rubber());
    pair.addMasses();
    const auto run = [scheme = conserves ? energyMomentum() : newmark(), fraction = massFraction](
                         Model& model, linalg::LinearMethod method) {
      ImplicitOptions options{.massFraction = fraction, .linear = {.method = method}};
      options.scheme = scheme;
      ImplicitIntegrator integrator(model, 5e-3, options);
      integrator.run(5);
      return integrator.report();
    };
    const DynamicsReport one = run(pair.here, linalg::LinearMethod::direct), all = run(pair.shared, byMultigrid);
    EXPECT_LT(apart(pair.here.nodes.u, pair.shared.nodes.u), 1e-7);
    EXPECT_LT(apart(pair.here.nodes.v, pair.shared.nodes.v), 1e-6);
    EXPECT_EQ(all.steps, one.steps);
  }
}

TEST(SolidsOnRanks, OtherTermsAreThereOnce) {
  Pair pair(rubber());
  const Vec3 corner{10.0, -20.0, 5.0};
  for (Model* model : {&pair.here, &pair.shared}) {
    const SolidMesh mesh = boxOf(ElementShape::hex8, {5, 5, 5}, corner, corner + Vec3{1.0, 1.0, 1.0});
    model->add(followingPressure(mesh, faceSet(mesh, "x+"), 2e4));
    model->add(gravity({0.0, 0.0, -9.81}));
    model->add(groundSprings(nodeSet(mesh, "y-"), {1e3, 2e3, 3e3}));
    const auto& side = faceSet(mesh, "x-");
    model->add(makeContactPlane(mesh, side, {corner, {1.0, 0.0, 0.0}},
                                {.penalty = contactPenalty(mesh, side, 1.3e6), .friction = 0.3}));
    addMass(*model);
  }
  solve(pair.here, linalg::LinearMethod::direct);
  solve(pair.shared, byMultigrid);
  EXPECT_LT(apart(pair.here.nodes.u, pair.shared.nodes.u), 1e-8);
}

TEST(SolidsOnRanks, StatesAreThoseOfOneProcess) {
  struct Case {
    std::shared_ptr<const PointMaterial> material;
    Formulation formulation;
  };
  for (const Case& one : {Case{metal(), Formulation::standard}, Case{metal(), Formulation::enhanced}}) {
    SCOPED_TRACE(name(one.formulation));
    Pair pair(one.material, 5, ElementShape::hex8, one.formulation),
        other(one.material, 5, ElementShape::hex8, one.formulation);
    pair.bend();
    for (Model* model : {&pair.here, &pair.shared}) {
      std::vector<Vec3> f(model->nodes.X.size());
      model->terms[0]->addForces(model->nodes, {}, f);
      model->terms[0]->commit(model->nodes, {});
    }
    ByteWriter here, shared;
    pair.here.terms[0]->save(here);
    pair.shared.terms[0]->save(shared);
    EXPECT_EQ(here.bytes().size(), shared.bytes().size());
    if (one.formulation == Formulation::standard) {
      EXPECT_TRUE(here.bytes() == shared.bytes());
    }
    ByteReader reader(here.bytes()), back(shared.bytes());
    other.shared.terms[0]->load(reader);
    other.here.terms[0]->load(back);
    EXPECT_TRUE(reader.atEnd() && back.atEnd());
    const auto historyOf = [&](Model& model) { return solidOf(model).sample(pair.here.nodes, {}).history; };
    EXPECT_EQ(historyOf(pair.here), historyOf(other.shared));
    EXPECT_EQ(historyOf(pair.shared), historyOf(other.here));
  }
}

TEST(SolidsOnRanks, ImplicitStepsGoOnOnOtherRanks) {
  Pair pair(rubber());
  pair.addMasses();
  const ImplicitOptions options{.massFraction = 0.0, .linear = {.method = byMultigrid}};
  Model whole = pressed(5, rubber());
  addMass(whole);
  ImplicitIntegrator all(whole, 5e-3, options), one(pair.here, 5e-3, options), many(pair.shared, 5e-3, options);
  all.run(6);
  one.run(3);
  ByteWriter state;
  one.save(state);
  ByteReader reader(state.bytes());
  many.load(reader);
  many.run(3);
  EXPECT_LT(apart(whole.nodes.u, pair.shared.nodes.u), 1e-7);
  ByteWriter back;
  many.save(back);
  ByteReader again(back.bytes());
  one.load(again);
  EXPECT_EQ(pair.here.nodes.u, pair.shared.nodes.u);
}

/// What is thrown, on all ranks alike.
template <class Kind, class Act>
std::string thrown(Act&& act) {
  try {
    act();
  } catch (const Kind& error) {
    return error.what();
  }
  return "";
}

TEST(SolidsOnRanks, WhatFailsOnOneFailsOnAll) {
  Pair pair(rubber());
  pair.shared.nodes.u[0] = {0.0, 0.0, 5.0};  // turns the first element inside out
  const std::string said = thrown<NumericalError>(
      [&] { pair.shared.terms[0]->requireValid(pair.shared.nodes, "now", Scrutiny::inversion); });
  EXPECT_NE(said.find("element 0"), std::string::npos) << said;
  if (team().size() > 1) {
    EXPECT_NE(said.find("rank "), std::string::npos) << said;
  }
}

TEST(SolidsOnRanks, WhatCannotBeSharedIsRefused) {
  if (team().size() == 1) return;
  Pair direct(rubber());
  EXPECT_NE(thrown<InputError>([&] { solve(direct.shared, linalg::LinearMethod::direct); }).find("multigrid"),
            std::string::npos);
  Pair tied(rubber());
  tied.shared.constraints.ties.push_back({100, 0, {{101, 0, 0.5}, {102, 1, 0.5}}, 0.0, {}});
  EXPECT_NE(thrown<InputError>([&] { solve(tied.shared, byMultigrid); }).find("tied"), std::string::npos);
  Pair modes(rubber());
  modes.addMasses();
  EXPECT_NE(thrown<InputError>([&] { modesOf(modes.shared, {}); }).find("one process"), std::string::npos);
}

/// They are whole on each rank, beside those that are shared.
TEST(SolidsOnRanks, FewElementsStayTogether) {
  Pair pair(metal());
  SolidMesh mesh = boxOf(ElementShape::hex8, {5, 5, 5}, {10.0, -20.0, 5.0}, {11.0, -19.0, 6.0});
  mesh.elementSets["inlay"] = {62};
  for (Model* model : {&pair.here, &pair.shared})
    model->add(makeSolid(mesh, sand(), {.elementSet = "inlay", .name = "inlay", .onRanks = model == &pair.shared}));
  EXPECT_FALSE(pair.shared.terms.back()->isShared());
  EXPECT_LT(productsApart(pair), 1e-13);
  solve(pair.here, linalg::LinearMethod::direct);
  solve(pair.shared, byMultigrid);
  EXPECT_LT(apart(pair.here, pair.shared), 1e-8);
}

}  // namespace
}  // namespace dovetail::fem

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  dovetail::ranks::formTeam();
  auto& listeners = testing::UnitTest::GetInstance()->listeners();
  if (dovetail::team().rank() > 0) delete listeners.Release(listeners.default_result_printer());
  return RUN_ALL_TESTS();
}
