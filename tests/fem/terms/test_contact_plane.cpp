#include <gtest/gtest.h>

#include <sstream>

#include "dovetail/core/error.hpp"
#include "dovetail/fem/elements/solid.hpp"
#include "dovetail/fem/laws/material_probe.hpp"
#include "dovetail/fem/laws/point_laws.hpp"
#include "dovetail/fem/motion/dynamics.hpp"
#include "dovetail/fem/solve/statics.hpp"
#include "dovetail/fem/terms/contact_plane.hpp"
#include "dovetail/fem/terms/loads.hpp"
#include "term_checks.hpp"

namespace dovetail::fem {
namespace {

constexpr Instant now{0.7, 0.1};

SolidMesh box(ElementShape shape = ElementShape::hex8) { return boxOf(shape, {3, 2, 2}, {0, 0, 0}, {1.0, 0.8, 0.6}); }

/// A tilted plane that cuts about half of the points off.
Plane tilted() { return {{0.5, 0.4, 0.0}, {0.05, -0.03, 2.0}, {}}; }

ContactOptions options(double friction = 0.0) {
  ContactOptions o;
  o.penalty = 1e3;
  o.friction = friction;
  o.tangentialPenalty = 4e2;
  return o;
}

Model randomState(const SolidMesh& mesh, unsigned seed) {
  Model model = makeModel(mesh);
  setRandom(model.nodes.u, 0.03, seed);
  return model;
}

TEST(ContactPlane, UniformPenetrationGivesTheForcesOfAUniformPressure) {
  for (const ElementShape shape : spatialCellShapes) {
    const SolidMesh mesh = box(shape);
    Model model = makeModel(mesh);
    const auto faces = faceSet(mesh, "z-");
    const auto contact = makeContactPlane(mesh, faces, {{0, 0, 0}, {0, 0, 1}, {}}, options());
    EXPECT_EQ(largest(forcesOf(*contact, model.nodes, now)), 0.0);
    for (Vec3& u : model.nodes.u) u.z = -0.02;
    const auto f = forcesOf(*contact, model.nodes, now);
    const auto expected = forcesOf(*deadPressure(mesh, faces, 20.0), model.nodes, now);
    for (std::size_t n = 0; n < f.size(); ++n) EXPECT_LT(norm(f[n] - expected[n]), 1e-13) << name(shape);
    const auto report = contact->report(model.nodes, now);
    EXPECT_NEAR(report.force.z, 16.0, 1e-12);
    EXPECT_NEAR(report.area, 0.8, 1e-14);
    EXPECT_NEAR(report.deepest, 0.02, 1e-15);
    EXPECT_NEAR(report.largestPressure, 20.0, 1e-12);
  }
}

TEST(ContactPlane, ForceIsTheGradientOfTheEnergyAndHasItsTangent) {
  for (const ElementShape shape : spatialCellShapes) {
    const SolidMesh mesh = box(shape);
    Model model = randomState(mesh, 3);
    const auto contact = makeContactPlane(mesh, faceSet(mesh, "z-"), tilted(), options());
    EXPECT_TRUE(contact->isSymmetric());
    const auto report = contact->report(model.nodes, now);
    EXPECT_GT(report.area, 0.1 * 0.8);
    EXPECT_LT(report.area, 0.9 * 0.8);
    expectForceFromEnergy(*contact, model.nodes, now, 1e-6, 1e-7);
    expectTangents(*contact, model.nodes, now, 1e-6, 1e-7);
  }
}

TEST(ContactPlane, FrictionHasItsTangentWhereItSticksAndWhereItSlips) {
  const SolidMesh mesh = box(ElementShape::hex20);
  for (const double friction : {0.05, 0.4, 100.0}) {
    Model model = randomState(mesh, 5);
    const auto contact = makeContactPlane(mesh, faceSet(mesh, "z-"), tilted(), options(friction));
    EXPECT_FALSE(contact->isSymmetric());
    contact->commit(model.nodes, now);
    std::vector<Vec3> more(model.nodes.u.size());
    setRandom(more, 0.01, 6);
    for (std::size_t n = 0; n < more.size(); ++n) model.nodes.u[n] += more[n];
    expectTangents(*contact, model.nodes, now, 1e-6, 1e-7);
  }
}

TEST(ContactPlane, FrictionStopsAtItsLimitAndWhatItTakesIsBooked) {
  const SolidMesh mesh = box();
  Model model = makeModel(mesh);
  const auto contact = makeContactPlane(mesh, faceSet(mesh, "z-"), {{0, 0, 0}, {0, 0, 1}, {}}, options(0.3));
  for (Vec3& u : model.nodes.u) u.z = -0.02;
  EXPECT_EQ(contact->commit(model.nodes, now), 0.0);
  double work = 0.0, booked = 0.0, forceBefore = 0.0;
  const double start = contact->energy(model.nodes, now);
  for (int step = 0; step < 50; ++step) {
    for (Vec3& u : model.nodes.u) u.x += step < 30 ? 1e-3 : -1e-3;
    const double force = contact->report(model.nodes, now).force.x;
    work += 0.5 * (force + forceBefore) * (step < 30 ? 1e-3 : -1e-3);
    forceBefore = force;
    booked += contact->commit(model.nodes, now);
    if (step == 29) {
      EXPECT_NEAR(force, -0.3 * 16.0, 1e-12);
    }
    if (step == 5) {
      EXPECT_NEAR(force, -4e2 * 0.8 * 6e-3, 1e-12);
    }
  }
  EXPECT_GT(booked, 0.04);
  EXPECT_NEAR(work + booked + contact->energy(model.nodes, now) - start, 0.0, 1e-12);
}

TEST(ContactPlane, WorkOfAMovingPlaneIsBooked) {
  const SolidMesh mesh = box();
  Model model = makeModel(mesh);
  Plane plane{{0, 0, 0}, {0, 0, 1}, [](double t) { return Vec3{0, 0, 0.01 * t}; }};
  const auto contact = makeContactPlane(mesh, faceSet(mesh, "z-"), plane, options());
  EXPECT_EQ(contact->energy(model.nodes, {0.0, 0.0}), 0.0);
  double work = 0.0;
  for (int step = 1; step <= 10; ++step) {
    EXPECT_EQ(contact->commit(model.nodes, {0.1 * step, 0.1}), 0.0);
    work += contact->workOfMotion();
  }
  EXPECT_NEAR(contact->energy(model.nodes, {1.0, 0.1}), 0.5 * 1e3 * 1e-4 * 0.8, 1e-13);
  EXPECT_NEAR(work, contact->energy(model.nodes, {1.0, 0.1}), 1e-13);
}

TEST(ContactPlane, ItsPastIsTheStateInWhichItIsFirstUsed) {
  const SolidMesh mesh = box();
  Model model = makeModel(mesh);
  for (Vec3& u : model.nodes.u) u = {0.3, 0.1, 0.0};
  const Plane plane{{0, 0, 0}, {0, 0, 1}, [](double t) { return Vec3{0, 0, 0.01 * t}; }};
  const auto contact = makeContactPlane(mesh, faceSet(mesh, "z-"), plane, options(0.5));
  const Instant joined{2.0, 0.0};
  const double pressure = 1e3 * 0.02;
  EXPECT_NEAR(contact->energy(model.nodes, joined), 0.5 * pressure * 0.02 * 0.8, 1e-13);
  const Vec3 force = resultant(model.nodes, forcesOf(*contact, model.nodes, joined)).first;
  EXPECT_LT(norm(force - Vec3{0, 0, pressure * 0.8}), 1e-12);  // no friction yet
  EXPECT_EQ(contact->commit(model.nodes, joined), 0.0);
  EXPECT_EQ(contact->workOfMotion(), 0.0);
  EXPECT_EQ(contact->commit(model.nodes, {2.1, 0.1}), 0.0);
  EXPECT_NEAR(contact->workOfMotion(), 0.5 * (0.020 + 0.021) * 1e3 * 0.8 * 1e-3, 1e-13);
}

TEST(ContactPlane, PressingIsWorkAndNotDissipation) {
  const SolidMesh mesh = box();
  const Plane plane{{0, 0, 0}, {0, 0, 1}, [](double t) { return Vec3{0, 0, 0.01 * t}; }};
  Model model = makeModel(mesh);
  model.add(makeSolid(mesh, pointMaterial(StVenantKirchhoff{1e5, 0.0, 1e3})));
  model.add(makeContactPlane(mesh, faceSet(mesh, "z-"), plane, {.penalty = 1e7}));
  model.constraints.hold(nodeSet(mesh, "z+"));
  addMass(model);
  const StaticReport report = solveStatics(model, 1.0);
  EXPECT_EQ(report.dissipated, 0.0);
  EXPECT_GT(report.storedAfter, 0.0);
  EXPECT_NEAR(report.supportWork, report.storedAfter, 1e-2 * report.storedAfter);
  std::ostringstream text;
  text << report;
  for (const char* word : {"time reached", "factorisations", "work of supports", "dissipated", "residual"})
    EXPECT_NE(text.str().find(word), std::string::npos) << word << text.str();
  ExplicitIntegrator integrator(model, 1e-5, {.checkStep = false});
  integrator.run(100);
  std::vector<std::string> names;
  for (const auto& channel : integrator.ledger().channels()) names.push_back(channel.name);
  EXPECT_EQ(std::ranges::count(names, "motion of contact plane"), 1);
  EXPECT_EQ(std::ranges::count(names, "dissipated by contact plane"), 0);
}

TEST(ContactPlane, TheProposedPenaltyGivesWayByATenthOfALayer) {
  const SolidMesh mesh = boxOf(ElementShape::hex8, {2, 2, 4}, {}, {0.1, 0.1, 0.2});
  const auto material = pointMaterial(StVenantKirchhoff{1e6, 0.0, 1e3});
  const auto faces = faceSet(mesh, "z-");
  Model model = makeModel(mesh);
  model.add(makeSolid(mesh, material));
  const Plane plane{{0, 0, 0}, {0, 0, 1}, [](double t) { return Vec3{0, 0, 1e-6 * t}; }};
  const ContactPlane& contact = model.add(
      makeContactPlane(mesh, faces, plane, {.penalty = contactPenalty(mesh, faces, moduliAtRest(*material).confined)}));
  model.constraints.hold(nodeSet(mesh, "z+"), componentZ);
  model.constraints.hold(nodeSet(mesh, "x-"), componentX);
  model.constraints.hold(nodeSet(mesh, "y-"), componentY);
  solveStatics(model, 1.0);
  // Four layers and a tenth of one share a micrometre.
  EXPECT_NEAR(contact.report(model.nodes, {1.0, 0.0}).deepest, 1e-6 / 41.0, 1e-4 * 1e-6);
}

TEST(ContactPlane, MultipliersReplaceThePenetration) {
  const SolidMesh mesh = box();
  Model model = makeModel(mesh);
  ContactOptions o = options();
  o.augmented = true;
  o.gapTolerance = 1e-6;
  const auto contact = makeContactPlane(mesh, faceSet(mesh, "z-"), {{0, 0, 0}, {0, 0, 1}, {}}, o);
  // A rigid block on springs of 50 N/m under 16 N: equilibrium of springs, contact and load by hand.
  double uz = 0.0;
  int rounds = 0;
  do {
    for (int i = 0; i < 3; ++i) {
      for (Vec3& u : model.nodes.u) u.z = uz;
      uz -= (16.0 + 50.0 * uz - contact->report(model.nodes, now).force.z) / (50.0 + 1e3 * 0.8);
    }
    for (Vec3& u : model.nodes.u) u.z = uz;
    ++rounds;
  } while (contact->augment(model.nodes, now));
  EXPECT_GT(rounds, 2);
  EXPECT_LT(rounds, 10);
  EXPECT_LT(std::abs(uz), 1e-6);
  EXPECT_NEAR(contact->report(model.nodes, now).force.z, 16.0, 1e-3);
  EXPECT_NEAR(contact->energy(model.nodes, now), 0.0, 1e-4);
  contact->revert();
  EXPECT_EQ(contact->report(model.nodes, now).force.z > 1.0, false);
}

TEST(ContactPlane, ConservingForcesDoTheWorkThatIsStored) {
  const SolidMesh mesh = box();
  for (unsigned seed = 1; seed < 6; ++seed) {
    Model model = randomState(mesh, seed);
    const auto contact = makeContactPlane(mesh, faceSet(mesh, "z-"), tilted(), options());
    std::vector<Vec3> u0(model.nodes.u.size()), du = u0;
    setRandom(u0, 0.05, seed + 10);
    for (std::size_t n = 0; n < du.size(); ++n) du[n] = model.nodes.u[n] - u0[n];
    const auto force = [&] {
      std::vector<Vec3> f(u0.size());
      contact->addConservingForces(model.nodes, u0, now, f);
      return f;
    };
    Nodes before = model.nodes;
    before.u = u0;
    EXPECT_NEAR(productOf(force(), du), contact->energy(before, now) - contact->energy(model.nodes, now), 1e-14);
    linalg::BlockMatrix K = matrixFor(*contact, model.nodes);
    contact->addConservingTangent(model.nodes, u0, now, K);
    std::vector<Vec3> d(u0.size());
    setRandom(d, 1.0, seed);
    expectProduct(K, d, centralDifference(model.nodes.u, d, 1e-7, force), 1e-6);
  }
}

TEST(ContactPlane, StateGoesThroughACheckpoint) {
  const SolidMesh mesh = box();
  Model model = randomState(mesh, 8);
  const auto contact = makeContactPlane(mesh, faceSet(mesh, "z-"), tilted(), options(0.3)),
             other = makeContactPlane(mesh, faceSet(mesh, "z-"), tilted(), options(0.3));
  contact->commit(model.nodes, now);
  ByteWriter writer;
  contact->save(writer);
  ByteReader reader(writer.bytes());
  other->load(reader);
  for (Vec3& u : model.nodes.u) u.x += 0.01;
  const auto f = forcesOf(*contact, model.nodes, now), g = forcesOf(*other, model.nodes, now);
  for (std::size_t n = 0; n < f.size(); ++n) EXPECT_EQ(f[n], g[n]);
  EXPECT_EQ(contact->commit(model.nodes, now), other->commit(model.nodes, now));
  const auto smaller = makeContactPlane(mesh, faceSet(mesh, "x-"), tilted(), options(0.3));
  ByteReader again(writer.bytes());
  EXPECT_THROW(smaller->load(again), InputError);
}

TEST(ContactPlane, BadInputIsRefused) {
  const SolidMesh mesh = box();
  const auto faces = faceSet(mesh, "z-");
  EXPECT_THROW(makeContactPlane(mesh, faces, {{}, {}, {}}, options()), InputError);
  EXPECT_THROW(makeContactPlane(mesh, {}, tilted(), options()), InputError);
  EXPECT_THROW(makeContactPlane(mesh, faces, tilted(), {}), InputError);
  ContactOptions augmented = options();
  augmented.augmented = true;
  EXPECT_THROW(makeContactPlane(mesh, faces, tilted(), augmented), InputError);
  EXPECT_THROW(makeContactPlane(mesh, faces, tilted(), options(-0.1)), InputError);
}

}  // namespace
}  // namespace dovetail::fem
