// Markers on faces of material points, and terms that act on them.
#include <gtest/gtest.h>

#include <cmath>

#include "dovetail/core/error.hpp"
#include "dovetail/fem/mesh/mesh_places.hpp"
#include "dovetail/fem/motion/dynamics.hpp"
#include "dovetail/fem/terms/loads.hpp"
#include "dovetail/linalg/block_matrix.hpp"
#include "dovetail/mpm/fill.hpp"
#include "dovetail/mpm/markers.hpp"
#include "random_points.hpp"

namespace dovetail::mpm::test {
namespace {

constexpr double spacing = 0.25;

struct Case {
  Shape shape = Shape::quadratic;
  bool plane = true;
  bool borders = false;
};

std::vector<Case> allCases() {
  std::vector<Case> cases;
  for (const Shape shape : shapes)
    for (const bool plane : {true, false})
      for (const bool borders : {true, false}) cases.push_back({shape, plane, borders});
  return cases;
}

GridOptions gridOf(const Case& c) {
  GridOptions grid{.spacing = spacing, .shape = c.shape, .plane = c.plane};
  if (c.borders) grid.borders = {{.axis = 0}, {.axis = 1, .kind = BorderKind::held}};
  return grid;
}

struct Body {
  std::shared_ptr<PointSolid> points;
  fem::Model model;
  fem::SolidMesh faces;
  std::size_t set = 0;

  const Markers& markers() const { return points->markers(set); }
};

/// A box of points that are shaken off the places of a lattice.
Body bodyOf(const Case& c, Random& random) {
  const GridOptions grid = gridOf(c);
  const geometry::Box box{{}, {1.0, 1.0, c.plane ? 1.0 : 0.5}};
  MaterialPoints filled = fillBox(grid, box, 2);
  for (Vec3& x : filled.x) x += random.vector(0.1 * spacing, c.plane);
  Body body{makePoints(filled, elastic(), {.grid = grid}), {}, facesOfBox(grid, box, 2)};
  body.set = body.points->addMarkers(body.faces.X);
  body.model = makeModel(body.points);
  return body;
}

std::vector<Vec3> anyValues(std::size_t count, double size, bool plane, Random& random) {
  std::vector<Vec3> values(count);
  for (Vec3& value : values) value = random.vector(size, plane);
  return values;
}

TEST(Markers, AreInTheMemoryOfTheirPoints) {
  Random random;
  const Body body = bodyOf({}, random);
  const std::size_t before = body.points->memory();
  const Markers& more = body.points->markers(body.points->addMarkers(body.faces.X));
  const std::size_t arrays = sizeof(Vec3) * more.X.size() + sizeof(NodeImage) * more.images.size() +
                             sizeof(int) * (more.map.offsets.size() + more.map.column.size()) +
                             sizeof(double) * more.map.weight.size();
  EXPECT_GE(body.points->memory(), before + arrays);
}

/// Linear fields of the nodes, here those that borders let be.
TEST(Markers, ReproduceLinearFields) {
  for (const Case& c : allCases()) {
    if (c.borders && c.shape == Shape::linear) continue;  // held borders are no part of linear fields between nodes
    Random random;
    const Body body = bodyOf(c, random);
    const Vec3 b = random.vector(1.0, c.plane), x = random.vector(1.0, c.plane), y = random.vector(1.0, c.plane);
    const auto field = [&](const Vec3& X) {
      if (c.borders) return Vec3{X.x * X.y * 0.0, X.y * b.y, X.y * b.z};
      return b + X.x * x + X.y * y;
    };
    std::vector<Vec3> nodal;
    for (const Vec3& X : body.model.nodes.X) nodal.push_back(field(X));
    const std::vector<Vec3> values = valuesAt(body.markers(), nodal);
    for (std::size_t m = 0; m < values.size(); ++m)
      EXPECT_LE(norm(values[m] - field(body.markers().X[m])), 1e-13) << name(c.shape) << c.plane << c.borders;
    cg::requireRowsSumToOne(body.markers().map, 1e-13);
  }
}

/// The power of forces at markers is that of their loads on the nodes; without borders the moments are the same too.
TEST(Markers, AreAdjoint) {
  for (const Case& c : allCases()) {
    Random random;
    const Body body = bodyOf(c, random);
    const std::vector<Vec3> force = anyValues(body.faces.X.size(), 1.0, c.plane, random),
                            nodal = anyValues(body.model.nodes.X.size(), 1.0, c.plane, random);
    std::vector<Vec3> load(nodal.size());
    addTransposed(body.markers(), force, load);
    const std::vector<Vec3> values = valuesAt(body.markers(), nodal);
    double there = 0.0, back = 0.0;
    Vec3 moment;
    for (std::size_t m = 0; m < force.size(); ++m) {
      there += dot(force[m], values[m]);
      moment += cross(body.markers().X[m] + values[m], force[m]);
    }
    for (std::size_t n = 0; n < load.size(); ++n) {
      back += dot(load[n], nodal[n]);
      moment -= cross(body.model.nodes.X[n] + nodal[n], load[n]);
    }
    EXPECT_NEAR(there, back, 1e-12 * (1.0 + std::abs(there)));
    if (!c.borders) {
      EXPECT_LE(norm(moment), 1e-11);
    }
  }
}

/// Corners of a body without stiffness that is sheared and turned stay where its points have them: at renewals exactly,
/// in the long run as far as its flow stays affine.
TEST(Markers, GoWithTheBody) {
  const Case c;
  const GridOptions grid = gridOf(c);
  const auto points =
      makePoints(fillBox(grid, {{}, {1.0, 1.0, 1.0}}, 2), elastic(1e-9), {.grid = grid, .transfer = Transfer::apic});
  const std::vector<Vec3> corners{{0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, {0.5, 1.0, 0.0}};
  const std::size_t set = points->addMarkers(corners);
  fem::Model model = makeModel(points);
  for (std::size_t n = 0; n < model.nodes.X.size(); ++n)
    model.nodes.v[n] = {1.0 + 0.3 * model.nodes.X[n].y, 0.5 - 0.4 * model.nodes.X[n].x, 0.0};
  const auto now = [&] {
    std::vector<Vec3> x = valuesAt(points->markers(set), model.nodes.u);
    for (std::size_t m = 0; m < x.size(); ++m) x[m] += points->markers(set).X[m];
    return x;
  };
  fem::ExplicitIntegrator run(model, 0.01);
  run.run(100);
  EXPECT_GT(points->renewals(), 5);
  const std::vector<Vec3> before = now(), x = points->places(model.nodes);
  points->renewNodes(model.nodes, model.t);
  for (std::size_t m = 0; m < corners.size(); ++m) EXPECT_LE(norm(now()[m] - before[m]), 1e-14);
  const auto at = [&](std::size_t i, std::size_t j) { return x[8 * j + i]; };
  const std::vector<Vec3> expected{2.0 * at(0, 0) - 0.5 * (at(1, 0) + at(0, 1)),
                                   2.0 * at(7, 0) - 0.5 * (at(6, 0) + at(7, 1)),
                                   0.75 * (at(3, 7) + at(4, 7)) - 0.25 * (at(3, 6) + at(4, 6))};
  for (std::size_t m = 0; m < corners.size(); ++m) EXPECT_LE(norm(before[m] - expected[m]), 2e-3 * spacing);
  EXPECT_THROW(points->addMarkers(corners), InputError);
}

/// A following pressure on the whole skin has the potential p V.
TEST(Markers, CarryTermsWithTheirPotential) {
  for (const bool plane : {true, false})
    for (const bool borders : {false, true}) {
      Random random;
      Body body = bodyOf({.plane = plane, .borders = borders}, random);
      const auto term =
          onMarkers(body.points, body.set, fem::followingPressure(body.faces, fem::faceSet(body.faces, "skin"), 1e3));
      ASSERT_TRUE(term->hasEnergy());
      fem::Nodes& nodes = body.model.nodes;
      nodes.u = anyValues(nodes.X.size(), 0.02, plane, random);
      const std::vector<Vec3> way = anyValues(nodes.X.size(), 1.0, plane, random), u = nodes.u;
      const auto moved = [&](double by) {
        for (std::size_t n = 0; n < u.size(); ++n) nodes.u[n] = u[n] + by * way[n];
      };
      const auto forces = [&] {
        std::vector<Vec3> f(u.size());
        term->addForces(nodes, {}, f);
        return f;
      };
      const auto along = [&](std::span<const Vec3> f) {
        double sum = 0.0;
        for (std::size_t n = 0; n < f.size(); ++n) sum += dot(f[n], way[n]);
        return sum;
      };
      linalg::MatrixPattern pattern(nodes.X.size());
      term->addPattern(pattern);
      linalg::BlockMatrix K(std::move(pattern));
      term->addTangent(nodes, {}, K);
      std::vector<Vec3> product(u.size());
      K.multiply(way, product);
      const double power = along(forces()), curvature = along(product);
      constexpr double step = 1e-5;
      moved(step);
      const double above = term->energy(nodes, {}), powerAbove = along(forces());
      moved(-step);
      const double below = term->energy(nodes, {}), powerBelow = along(forces());
      EXPECT_NEAR(power, (below - above) / (2.0 * step), 1e-6 * std::abs(power));
      EXPECT_NEAR(curvature, (powerBelow - powerAbove) / (2.0 * step), 1e-6 * std::abs(curvature));
    }
}

TEST(Markers, LieOnFaces) {
  Random random;
  const Body body = bodyOf({}, random);
  const std::vector<Vec3> far{{0.5, 1.5, 0.0}};
  EXPECT_THROW(body.points->addMarkers(far), InputError);
  EXPECT_THROW(body.points->markers(7), InputError);
  EXPECT_THROW(onMarkers(body.points, body.set, nullptr), InputError);
}

}  // namespace
}  // namespace dovetail::mpm::test
