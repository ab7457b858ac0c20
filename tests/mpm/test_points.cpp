// Material points on a grid: momenta there and back, forces, energies, stable steps.
#include <gtest/gtest.h>

#include <cmath>

#include "dovetail/core/error.hpp"
#include "dovetail/fem/elements/solid.hpp"
#include "dovetail/fem/mesh/mesh_shapes.hpp"
#include "dovetail/fem/motion/dynamics.hpp"
#include "dovetail/fem/motion/stable_step.hpp"
#include "dovetail/fem/solve/statics.hpp"
#include "dovetail/fem/terms/loads.hpp"
#include "dovetail/linalg/block_matrix.hpp"
#include "random_points.hpp"

namespace dovetail::mpm::test {
namespace {

PointOptions optionsOf(Shape shape, bool plane, Transfer transfer = Transfer::flip) {
  return {.grid = {.spacing = plane ? 0.13 : 0.3, .shape = shape, .plane = plane}, .transfer = transfer};
}

/// Displacements that strain and turn, of nodes that borders let go.
void move(fem::Model& model, double size, Random& random, bool plane) {
  for (std::size_t n = 0; n < model.nodes.u.size(); ++n) {
    model.nodes.u[n] = random.vector(size, plane);
    for (int c = 0; c < 3; ++c)
      if (model.nodes.fixed[n] >> c & 1) model.nodes.u[n][c] = 0.0;
  }
}

TEST(MaterialPoints, GiveTheirMomentaToTheGridAndTakeThemBack) {
  Random random;
  for (const bool plane : {true, false})
    for (const Shape shape : shapes)
      for (const Transfer transfer : {Transfer::flip, Transfer::apic}) {
        if (transfer == Transfer::apic && secondMoment(shape) == 0.0) continue;
        const MaterialPoints points = scattered(200, plane, random);
        const auto solid = makePoints(points, elastic(), optionsOf(shape, plane, transfer));
        fem::Model model = makeModel(solid);
        fem::addMass(model);
        Vec3 momentum, turning;
        double mass = 0.0, scale = 0.0;
        for (std::size_t p = 0; p < points.x.size(); ++p) {
          const double m = solid->masses()[p];
          mass += m, momentum += m * points.v[p], turning += m * cross(points.x[p], points.v[p]);
          scale += m * norm(points.v[p]);
        }
        double onNodes = 0.0;
        for (const double m : model.nodes.mass) onNodes += m;
        EXPECT_NEAR(onNodes, mass, 1e-13 * mass);
        EXPECT_LE(norm(fem::momentum(model.nodes) - momentum), 1e-13 * scale);
        EXPECT_LE(norm(fem::angularMomentum(model.nodes) - turning), 1e-13 * scale) << name(shape);
        EXPECT_GE(solid->beyondNodes(), 0.0);
        // The nodes travel, and the grid is laid out anew: momentum stays, of APIC angular momentum too.
        for (int k = 0; k < 3; ++k) {
          move(model, 0.04, random, plane);
          if (k > 0)
            for (Vec3& v : model.nodes.v) v += random.vector(0.5, plane);
          const Vec3 before = fem::momentum(model.nodes), turningBefore = fem::angularMomentum(model.nodes);
          solid->requireValid(model.nodes, "now", fem::Scrutiny::inversion);  // finds F
          const double taken = solid->renewNodes(model.nodes, 0.1 * k);
          EXPECT_LE(norm(fem::momentum(model.nodes) - before), 1e-13 * scale) << name(shape);
          if (transfer == Transfer::apic) {
            EXPECT_LE(norm(fem::angularMomentum(model.nodes) - turningBefore), 1e-13 * scale) << name(shape);
          }
          EXPECT_GE(taken, -1e-12 * scale);
        }
      }
}

TEST(MaterialPoints, LoseByFlipWhatTheNodesGainedBeyondThePoints) {
  Random random;
  const MaterialPoints points = scattered(150, true, random);
  const auto solid = makePoints(points, elastic(), optionsOf(Shape::quadratic, true));
  fem::Model model = makeModel(solid);
  std::vector<Vec3> change(model.nodes.v.size());
  for (std::size_t n = 0; n < change.size(); ++n) model.nodes.v[n] += change[n] = random.vector(1.0, true);
  double loss = 0.0;
  for (std::size_t n = 0; n < change.size(); ++n) loss += 0.5 * model.nodes.mass[n] * squaredNorm(change[n]);
  for (std::size_t p = 0; p < points.x.size(); ++p)
    loss -= 0.5 * solid->masses()[p] * squaredNorm(valueAt(solid->rows(), p, change));
  EXPECT_GT(loss, 0.0);
  solid->requireValid(model.nodes, "now", fem::Scrutiny::inversion);
  EXPECT_NEAR(solid->renewNodes(model.nodes, 0.0), loss, 1e-12 * loss);
}

TEST(MaterialPoints, ForcesAreDerivativesOfTheEnergyAndTangentsOfForces) {
  Random random;
  for (const bool plane : {true, false})
    for (const Shape shape : {Shape::quadratic, Shape::cubic, Shape::gimp}) {
      PointOptions options = optionsOf(shape, plane);
      options.grid.spacing = plane ? 0.2 : 0.4;
      options.grid.borders = {{.axis = 0, .place = 0.0, .kind = BorderKind::held}, {.axis = 1, .place = 0.0}};
      const auto solid = makePoints(scattered(60, plane, random), elastic(), options);
      fem::Model model = makeModel(solid);
      model.add(gravity(solid, {1.0, -9.81, plane ? 0.0 : 2.0}));
      for (int round = 0; round < 2; ++round) {  // the second with points that are deformed
        move(model, 0.01, random, plane);
        std::vector<Vec3> way(model.nodes.u.size());
        for (Vec3& w : way) w = random.vector(1.0, plane);
        const std::vector<Vec3> u = model.nodes.u;
        const auto at = [&](double step) {
          for (std::size_t n = 0; n < u.size(); ++n) model.nodes.u[n] = u[n] + step * way[n];
          return fem::storedEnergy(model, {});
        };
        const double d = 1e-5, slope = (at(d) - at(-d)) / (2.0 * d);
        std::vector<Vec3> forward(u.size()), backward(u.size()), force(u.size());
        at(d), solid->addForces(model.nodes, {}, forward);
        at(-d), solid->addForces(model.nodes, {}, backward);
        at(0.0);
        for (const auto& term : model.terms) term->addForces(model.nodes, {}, force);
        double power = 0.0, size = 0.0;
        for (std::size_t n = 0; n < u.size(); ++n) power += dot(force[n], way[n]), size += norm(force[n]);
        EXPECT_NEAR(power, -slope, 1e-6 * size) << name(shape);
        linalg::BlockMatrix K = fem::zeroTangent(model);
        solid->addTangent(model.nodes, {}, K);
        std::vector<Vec3> pull(u.size());
        K.multiply(way, pull);
        for (std::size_t n = 0; n < u.size(); ++n)
          EXPECT_LE(norm(pull[n] + 1.0 / (2.0 * d) * (forward[n] - backward[n])), 1e-4 * size) << name(shape);
        solid->commit(model.nodes, {});
        solid->renewNodes(model.nodes, 0.0);
      }
    }
}

TEST(MaterialPoints, AreFreeOfForcesWhenTurned) {
  for (const bool plane : {true, false}) {
    const auto solid = makePoints(block({0.2, 0.3, 0.1}, {0.5, 0.5, 0.5}, plane ? 0.0625 : 0.125, plane), elastic(),
                                  optionsOf(Shape::quadratic, plane));
    fem::Model model = makeModel(solid);
    // 90° in steps of 5°, renewed between them.
    for (int step = 0; step < 18; ++step) {
      const double c = std::cos(M_PI / 36.0), s = std::sin(M_PI / 36.0);
      for (std::size_t n = 0; n < model.nodes.u.size(); ++n) {
        const Vec3& X = model.nodes.X[n];
        model.nodes.u[n] = Vec3{c * X.x - s * X.y, s * X.x + c * X.y, X.z} - X;
      }
      std::vector<Vec3> f(model.nodes.u.size());
      solid->addForces(model.nodes, {}, f);
      for (const Vec3& own : f) EXPECT_LE(norm(own), 1e-7);
      solid->commit(model.nodes, {});
      solid->renewNodes(model.nodes, 0.0);
    }
    const std::span<const double> F = solid->answers().F();
    for (std::size_t p = 0; p < solid->masses().size(); ++p)
      EXPECT_LE(std::abs(F[9 * p]) + std::abs(F[9 * p + 1] + 1.0) + std::abs(F[9 * p + 3] - 1.0), 1e-12);
  }
}

TEST(MaterialPoints, HaveAStepThatIsStable) {
  Random random;
  for (const bool plane : {true, false})
    for (const Shape shape : {Shape::gimp, Shape::quadratic, Shape::cubic}) {
      const auto solid = makePoints(scattered(plane ? 150 : 400, plane, random), elastic(), optionsOf(shape, plane));
      fem::Model model = makeModel(solid);
      fem::addMass(model);
      const double bound = fem::stableStep(model).dt, exact = fem::assembledStableStep(model);
      EXPECT_LE(bound, exact) << name(shape);
      EXPECT_GE(bound, 0.2 * exact) << name(shape);
      EXPECT_NE(fem::stableStep(model).owner.find("point"), std::string::npos);
    }
}

/// Beside quad8 with the same material; the error falls with the square of the spacing.
TEST(MaterialPoints, SettleUnderTheirWeightAsElementsDo) {
  const fem::SolidMesh mesh = fem::boxOf(fem::ElementShape::quad8, {8, 16, 1}, {}, {0.5, 1.0, 1.0});
  fem::Model elements = fem::makeModel(mesh);
  elements.add(fem::makeSolid(mesh, fem::pointMaterial(fem::neoHookean(1e6, 0.3, density))));
  elements.add(fem::gravity({0.0, -9.81, 0.0}));
  elements.constraints.hold(fem::nodeSet(mesh, "x-"), fem::componentX);
  elements.constraints.hold(fem::nodeSet(mesh, "y-"), fem::componentY);
  fem::addMass(elements);
  const double energy = [&] {
    fem::solveStatics(elements, 1.0, {.firstStep = 1.0});
    return elements.terms[0]->energy(elements.nodes, {.t = 1.0});
  }();
  std::vector<double> error;
  for (const int n : {4, 8, 16}) {
    const double h = 1.0 / n;
    const auto points = makePoints(block({}, {0.5, 1.0, 0.0}, 0.5 * h, true), elastic(),
                                   {.grid = {.spacing = h, .borders = {{.axis = 0}, {.axis = 1}}}});
    fem::Model model = makeModel(points);
    model.add(gravity(points, {0.0, -9.81, 0.0}));
    fem::addMass(model);
    fem::solveStatics(model, 1.0, {.firstStep = 1.0});
    error.push_back(points->energy(model.nodes, {.t = 1.0}) / energy - 1.0);
  }
  for (std::size_t k = 0; k + 1 < error.size(); ++k) EXPECT_GT(std::log2(std::abs(error[k] / error[k + 1])), 1.6);
}

TEST(MaterialPoints, RefuseWhatCannotBe) {
  const MaterialPoints good = block({}, {0.5, 0.5, 0.0}, 0.05, true);
  const auto refuses = [&](const MaterialPoints& points, const PointOptions& options) {
    EXPECT_THROW(makePoints(points, elastic(), options), InputError);
  };
  const PointOptions options = optionsOf(Shape::quadratic, true);
  refuses({}, options);
  MaterialPoints bad = good;
  bad.volume[3] = 0.0;
  refuses(bad, options);
  bad = good, bad.volume.pop_back();
  refuses(bad, options);
  bad = good, bad.x[2].z = 0.1;
  refuses(bad, options);
  PointOptions wrong = options;
  wrong.renewal = 0.7;
  refuses(good, wrong);
  refuses(good, optionsOf(Shape::gimp, true, Transfer::apic));
  fem::Model model = makeModel(makePoints(good, elastic(), options));
  fem::addMass(model);
  EXPECT_THROW(fem::ImplicitIntegrator(model, 1e-3, {.massFraction = 1.0}), InputError);
  EXPECT_THROW(makePoints(good, nullptr, options), InputError);
}

/// A block on a floor, damped for 2 s while its grid is renewed; mean of the heights that its points have lost.
double settled(double perCell, Shape shape, double t, bool plane = true) {
  const double distance = 0.0625, spacing = perCell * distance;
  const MaterialPoints at = block({}, {0.375, 0.75, 0.375}, distance, plane);
  const auto points = makePoints(
      at, elastic(5e4),
      {.grid =
           {.spacing = spacing, .shape = shape, .plane = plane, .borders = {{.axis = 1}}, .gimpHalf = 0.5 / perCell},
       .renewal = 0.1});
  fem::Model model = makeModel(points);
  model.add(gravity(points, {0.0, -9.81, 0.0}));
  model.add(fem::massDamping(15.0));
  fem::addMass(model);
  fem::ExplicitIntegrator run(model, 0.7 * fem::stableStep(model).dt, {.energyEvery = 0});
  run.runUntil(t);
  double sum = 0.0;
  for (std::size_t p = 0; p < at.x.size(); ++p) sum += at.x[p].y - points->places(model.nodes)[p].y;
  return sum / static_cast<double>(at.x.size());
}

TEST(MaterialPoints, StandStillWhereThereAreEnoughInACell) {
  for (const Shape shape : {Shape::quadratic, Shape::cubic, Shape::gimp})
    for (const double perCell : {shape == Shape::cubic ? 1.8 : 1.5, 2.0, 3.0})
      EXPECT_NEAR(settled(perCell, shape, 2.0) / settled(perCell, shape, 1.6), 1.0, 1e-3) << name(shape) << perCell;
}

TEST(MaterialPoints, AreCountedInCells) {
  const auto count = [](double spacing, bool plane, const Vec3& origin, std::vector<GridBorder> borders = {}) {
    const GridOptions grid{.spacing = spacing, .plane = plane, .origin = origin, .borders = std::move(borders)};
    return pointsPerCell(grid, block({}, {1.0, 1.0, 1.0}, 0.125, plane).x);
  };
  EXPECT_DOUBLE_EQ(count(0.125, true, {}), 1.0);
  EXPECT_DOUBLE_EQ(count(0.125, true, {0.03, 0.04, 0.0}), 1.0);
  EXPECT_DOUBLE_EQ(count(0.25, true, {0.07, -0.04, 0.0}), 4.0);
  EXPECT_DOUBLE_EQ(count(0.25, false, {0.07, -0.04, 0.11}), 8.0);
  EXPECT_DOUBLE_EQ(count(0.5, true, {}, {{.axis = 0}, {.axis = 1, .above = true, .place = 1.0}}), 16.0);
  EXPECT_DOUBLE_EQ(count(4.0, true, {}), 64.0);
  for (const double perCell : {1.0, 1.2}) {
    try {
      settled(perCell, Shape::quadratic, 2.0);
      FAIL() << perCell;
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find("points in a cell"), std::string::npos) << error.what();
      EXPECT_NE(std::string(error.what()).find("a grid with a spacing of about 0.08"), std::string::npos)
          << error.what();
    }
  }
  EXPECT_THROW(settled(1.0, Shape::quadratic, 2.0, false), InputError);
}

}  // namespace
}  // namespace dovetail::mpm::test
