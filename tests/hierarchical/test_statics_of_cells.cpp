#include <gtest/gtest.h>

#include <algorithm>

#include "solids_of_cells.hpp"

namespace dovetail::hierarchical {
namespace {

using fem::ElementShape;

TEST(StaticsOfCells, PointsOfAnElementAreStandAloneCellsToTheLastBit) {
  for (const ElementShape shape : {ElementShape::quad4, ElementShape::quad8}) {
    const auto formulation = shape == ElementShape::quad8 ? fem::Formulation::reduced : fem::Formulation::standard;
    Biaxial body({1, 1}, cellField(oneCell()), shape, 2e-4, formulation);
    std::vector<fem::Solid::Sample> samples;
    fem::solveStatics(body.model, 1.0, roughly(), [&](const fem::Model&, const fem::StaticStep&) {
      samples.push_back(body.sample());
      return true;
    });
    ASSERT_GE(samples.size(), 2u);
    double side = 0.0, height = 0.0;
    for (std::size_t p = 0; p < 4; ++p) {
      rve::Rve cell = threeCells()[0];
      for (const fem::Solid::Sample& sample : samples) {
        rve::followPath(cell, matrixAt(sample.F, p), {.rest = {.tolerance = 1e-6}});
        EXPECT_EQ(matrixAt(sample.P, p), rve::nominalStress(cell));
      }
      side += 0.25 * samples.back().P[9 * p];
      height += 0.25 * samples.back().F[9 * p + 4];
    }
    EXPECT_NEAR(height, 0.999, 1e-12);
    EXPECT_NEAR(side, -1e5 * height, 5.0);
  }
}

TEST(StaticsOfCells, ThreadsDoNotChangeADigit) {
  const auto motion = [](int threads) {
    return onThreads(threads, [] {
      Biaxial body({2, 2}, cellField(threeCells()));
      fem::solveStatics(body.model, 0.5, roughly());
      return std::pair(body.model.nodes.u, body.sample().P);
    });
  };
  const auto one = motion(1);
  EXPECT_EQ(one, motion(2));
  EXPECT_EQ(one, motion(3));
}

TEST(StaticsOfCells, APatchOfEqualCellsIsHomogeneous) {
  for (const ElementShape shape : {ElementShape::quad4, ElementShape::quad8}) {
    fem::SolidMesh mesh = fem::boxOf(shape, {2, 2, 1}, {}, {0.2, 0.2, 0.1});
    for (Vec3& X : mesh.X) X += Vec3{0.1 * X.y * (0.2 - X.y), 0.4 * X.x * (0.2 - X.x) * (0.3 + X.y), 0.0};
    fem::Model model = fem::makeModel(mesh);
    const auto solid = fem::makeSolid(mesh, cellField(oneCell(), QuasiStaticCells{.unbalanced = 1e-9}));
    model.add(solid);
    const Eigen::Matrix3d H = rve::plane(1.0004, 2e-4, -1e-4, 0.9993) - Eigen::Matrix3d::Identity();
    const auto affine = [&](int node, int component) {
      const Vec3& X = mesh.X[static_cast<std::size_t>(node)];
      return H(component, 0) * X.x + H(component, 1) * X.y;
    };
    std::vector<int> border;
    for (const char* side : {"x-", "x+", "y-", "y+"})
      border.insert(border.end(), fem::nodeSet(mesh, side).begin(), fem::nodeSet(mesh, side).end());
    std::ranges::sort(border);
    border.erase(std::unique(border.begin(), border.end()), border.end());
    for (const int node : border)
      for (int c = 0; c < 2; ++c)
        model.constraints.prescribe(std::array{node}, c, [&, node, c](double t) { return t * affine(node, c); });
    fem::solveStatics(model, 1.0, roughly(1e-8, 1.0));
    const auto sample = solid->sample(model.nodes, {1.0, 0.0});
    const Eigen::Matrix3d P = matrixAt(sample.P, 0);
    for (std::size_t p = 0; p < sample.volume.size(); ++p)
      EXPECT_LT((matrixAt(sample.P, p) - P).norm(), 1e-6 * P.norm());
    int inside = 0;
    for (int node = 0; node < static_cast<int>(mesh.X.size()); ++node) {
      if (std::ranges::binary_search(border, node)) continue;
      ++inside;
      for (int c = 0; c < 2; ++c) EXPECT_NEAR(model.nodes.u[static_cast<std::size_t>(node)][c], affine(node, c), 1e-10);
    }
    EXPECT_GT(inside, 0);
  }
}

TEST(StaticsOfCells, EnergyIsBalancedAcrossTheScales) {
  const auto residual = [](double step, double inertialNumber) {
    Biaxial body({1, 1}, cellField(oneCell(), QuasiStaticCells{.path = {.inertialNumber = inertialNumber}}));
    // The side stays straight: no load balances the shear stress that the cell has at the start.
    const std::vector<int>& side = fem::nodeSet(body.mesh, "x+");
    body.model.constraints.ties.push_back({side[1], 0, {{side[0], 0, 1.0}}, 0.0, {}});
    const fem::StaticReport report = fem::solveStatics(body.model, 1.0, roughly(1e-6, step));
    EXPECT_GT(report.dissipated, 0.0);
    return std::abs(report.energyResidual()) / (std::abs(report.supportWork) + std::abs(report.loadWork));
  };
  // Work of the solid is summed between states of rest, that of the cells along their paths: the pace parts them.
  const double slow = residual(0.5, 1e-4);
  EXPECT_LT(slow, 1e-3);
  EXPECT_LT(slow, 0.4 * residual(1.0, 1e-4));
  EXPECT_LT(slow, 0.4 * residual(0.5, 1e-3));
}

TEST(StaticsOfCells, ArcLengthGoesToTheSameEquilibrium) {
  const auto pressed = [](bool byArcs) {
    const fem::SolidMesh mesh = fem::boxOf(ElementShape::quad4, {1, 1, 1}, {}, {0.1, 0.2, 0.1});
    fem::Model model = fem::makeModel(mesh);
    const auto solid = fem::makeSolid(mesh, cellField(oneCell()));
    model.add(solid);
    model.add(fem::followingPressure(mesh, fem::faceSet(mesh, "x+"), 1e5));
    model.add(fem::followingPressure(mesh, fem::faceSet(mesh, "y+"), [](double t) { return 1e5 * (1.0 + 0.2 * t); }));
    model.constraints.hold(fem::nodeSet(mesh, "x-"), fem::componentX);
    model.constraints.hold(fem::nodeSet(mesh, "y-"), fem::componentY);
    const fem::NewtonOptions newton = roughly(1e-6).newton;
    if (byArcs)
      fem::followPath(model, 1.0, {.newton = newton, .firstStep = 0.25});
    else
      fem::solveStatics(model, 1.0, {.newton = newton, .firstStep = 0.25});
    EXPECT_EQ(model.t, 1.0);
    return model.nodes.u;
  };
  const std::vector<Vec3> steps = pressed(false), arcs = pressed(true);
  for (std::size_t n = 0; n < steps.size(); ++n) EXPECT_LT(norm(arcs[n] - steps[n]), 0.02 * norm(steps[3]));
  EXPECT_LT(steps[3].y, -1e-4);
}

TEST(StaticsOfCells, RunsGoOnFromBytesWithTheSameDigits) {
  Biaxial whole({1, 2}, cellField(threeCells())), restarted({1, 2}, cellField(threeCells()));
  fem::solveStatics(whole.model, 0.5, roughly());
  ByteWriter archive;
  fem::save(whole.model, archive);
  ByteReader bytes(archive.bytes());
  fem::load(restarted.model, bytes);
  fem::solveStatics(whole.model, 1.0, roughly());
  fem::solveStatics(restarted.model, 1.0, roughly());
  EXPECT_EQ(whole.model.nodes.u, restarted.model.nodes.u);
  EXPECT_EQ(whole.sample().P, restarted.sample().P);
}

TEST(StaticsOfCells, TheNetworkConvergesFasterThanUniformStrainToTheSame) {
  const auto run = [](const QuasiStaticCells& settings, double reuse) {
    Biaxial body({1, 2}, cellField(threeCells(), settings));
    fem::StaticOptions options = roughly(1e-5);
    options.newton.reuseContraction = reuse;
    const fem::StaticReport report = fem::solveStatics(body.model, 1.0, options);
    EXPECT_EQ(report.cuts, 0);
    return std::tuple(report.iterations, report.factorisations, body.sample().P);
  };
  const auto [few, renewed, P] = run({}, 0.0);
  const auto [more, renewedToo, Q] = run({.tangent = Operator::voigtTangent}, 0.0);
  const auto [some, frozen, R] = run({}, 0.5);
  EXPECT_GT(more, few);
  EXPECT_LT(frozen, renewed);
  for (std::size_t p = 0; p < 8; ++p) {
    EXPECT_LT((matrixAt(Q, p) - matrixAt(P, p)).norm(), 1e-3 * matrixAt(P, p).norm());
    EXPECT_LT((matrixAt(R, p) - matrixAt(P, p)).norm(), 1e-3 * matrixAt(P, p).norm());
  }
}

TEST(StaticsOfCells, EveryOperatorLeadsToTheSame) {
  const auto run = [](Operator tangent) {
    Biaxial body({1, 1}, cellField(threeCells(), QuasiStaticCells{.tangent = tangent}));
    const fem::StaticReport report = fem::solveStatics(body.model, 1.0, roughly(1e-5));
    EXPECT_EQ(report.cuts, 0);
    return std::pair(report.iterations, body.sample().P);
  };
  const auto [iterations, P] = run(Operator::elasticTangent);
  for (const Operator other :
       {Operator::frictionalTangent, Operator::elasticProbe, Operator::numericalTangent, Operator::averagedTangent}) {
    const auto [count, Q] = run(other);
    for (std::size_t p = 0; p < 4; ++p)
      EXPECT_LT((matrixAt(Q, p) - matrixAt(P, p)).norm(), 1e-3 * matrixAt(P, p).norm());
    EXPECT_LE(count, other == Operator::frictionalTangent ? 2 * iterations : iterations);
  }
}

TEST(StaticsOfCells, FrozenMeansFreezeWherePointsSoftenAndGoToBytes) {
  const auto field = [] { return cellField(oneCell(), QuasiStaticCells{.tangent = Operator::averagedTangent}); };
  Asked cell(field());
  const auto at = [](int step) { return rve::plane(1.0 + 3e-3 * step, 0.0, 0.0, 1.0 - 3e-3 * step); };
  rve::AveragedTangent expected;
  int steps = 0;
  while (!expected.frozen && ++steps < 40) {
    const rve::Tangent tangent = cell.tangentAt(at(steps));
    cell.field().commit();
    expected.next(at(steps), matrixAt(cell.P, 0), [&] { return tangent; });
  }
  ASSERT_TRUE(expected.frozen);
  EXPECT_GT(expected.count, 1);
  EXPECT_EQ(cell.tangentAt(at(steps)), expected.mean);
  EXPECT_EQ(cell.tangentAt(at(steps + 1)), expected.mean);
  ByteWriter bytes;
  cell.field().save(bytes);
  Asked again(field());
  ByteReader reader(bytes.bytes());
  again.field().load(reader);
  EXPECT_EQ(again.tangentAt(at(steps + 1)), expected.mean);
}

TEST(StaticsOfCells, WhatStagnatesIsNeverAccepted) {
  // Cells that are hardly at rest cannot be balanced to this.
  Biaxial body({1, 1},
               cellField(threeCells(), QuasiStaticCells{.path = {.rest = {.tolerance = 1e-2}}, .unbalanced = 1e-2}));
  fem::StaticOptions options = roughly(1e-12);
  options.newton.maxIterations = 6;
  options.smallestStep = 0.1;
  double accepted = 0.0;
  try {
    fem::solveStatics(body.model, 1.0, options, [&](const fem::Model& model, const fem::StaticStep&) {
      accepted = model.t;
      return true;
    });
    ADD_FAILURE();
  } catch (const NumericalError& error) {
    EXPECT_NE(std::string(error.what()).find("out of balance after 6 iterations"), std::string::npos) << error.what();
  }
  EXPECT_EQ(body.model.t, accepted);
}

std::pair<std::unique_ptr<Biaxial>, fem::StaticOptions> pastThePeak(int motionIterations) {
  auto body = std::make_unique<Biaxial>(std::array{1, 1}, cellField(oneCell()), ElementShape::quad4, 2e-4);
  fem::addMass(body->model);
  fem::StaticOptions options = roughly(1e-4, 1.0);
  options.newton.maxIterations = 6;
  options.smallestStep = 1.0;
  options.motionIterations = motionIterations;
  return {std::move(body), options};
}

TEST(StaticsOfCells, PastThePeakNodesMoveToRestWhereIterationsFail) {
  auto [stopped, none] = pastThePeak(0);
  EXPECT_THROW(fem::solveStatics(stopped->model, 16.0, none), NumericalError);
  auto [body, some] = pastThePeak(4000);
  const fem::StaticReport report = fem::solveStatics(body->model, 16.0, some);
  EXPECT_EQ(body->model.t, 16.0);
  EXPECT_GT(report.motions, 0);
  EXPECT_LT(report.motions, 16);
  int moved = 0;
  for (const fem::StaticStep& step : report.steps) {
    EXPECT_LE(step.residual, step.tolerance);
    moved += step.byMotion;
  }
  EXPECT_EQ(moved, report.motions);
  EXPECT_LT(std::abs(report.energyResidual()), 0.05 * std::abs(report.supportWork));
}

TEST(StaticsOfCells, MotionsThatDoNotEndLeaveTheLastEquilibrium) {
  const auto stoppedAt = [](int motionIterations) {
    auto [body, options] = pastThePeak(motionIterations);
    EXPECT_THROW(fem::solveStatics(body->model, 16.0, options), NumericalError);
    EXPECT_GT(body->model.t, 0.0);
    EXPECT_LT(body->model.t, 16.0);
    ByteWriter archive;
    fem::save(body->model, archive);
    return archive.bytes();
  };
  EXPECT_EQ(stoppedAt(0), stoppedAt(20));
}

TEST(StaticsOfCells, APointWithoutAnAnswerIsNamed) {
  Biaxial body({1, 2}, cellField(oneCell()), ElementShape::quad4, 0.04);
  fem::StaticOptions options = roughly(1e-5, 1.0);
  options.smallestStep = 0.5;
  try {
    fem::solveStatics(body.model, 1.0, options);
    ADD_FAILURE();
  } catch (const NumericalError& error) {
    const std::string text = error.what();
    EXPECT_NE(text.find("element"), std::string::npos) << text;
    EXPECT_NE(text.find("at most 0.05"), std::string::npos) << text;
  }
  EXPECT_EQ(body.model.t, 0.0);
}

TEST(StaticsOfCells, FormulationsThatAskOtherwiseAreRefused) {
  const fem::SolidMesh bricks = fem::boxOf(ElementShape::hex8, {1, 1, 1}, {}, {1, 1, 1});
  EXPECT_THROW(fem::makeSolid(bricks, cellField(oneCell()), {.formulation = fem::Formulation::enhanced}), InputError);
  Biaxial body({1, 1}, cellField(oneCell()), ElementShape::quad4, 2e-4, fem::Formulation::meanDilatation);
  fem::setRandomDisplacement(body.model.nodes, 1e-5, 1);
  try {
    fem::evaluateForces(body.model, {});
    ADD_FAILURE();
  } catch (const NumericalError& error) {
    EXPECT_NE(std::string(error.what()).find("meanDilatation"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace dovetail::hierarchical
