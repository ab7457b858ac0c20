#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "dovetail/core/error.hpp"
#include "dovetail/fem/mesh/cell_topology.hpp"
#include "dovetail/fem/mesh/element_locator.hpp"
#include "dovetail/fem/mesh/mesh_quality.hpp"
#include "dovetail/fem/mesh/shape.hpp"
#include "solid_helpers.hpp"
#include "term_checks.hpp"

namespace dovetail::fem {
namespace {

struct Motion {
  double offset;  // sizes of an element
  bool turned;
};
constexpr std::array<Motion, 5> motions = {{{0, false}, {0, true}, {1e3, false}, {1e3, true}, {1e6, true}}};

/// Twisted and waved, so that second-order cells are curved; corners and other nodes also moved at random. Plane cells
/// stay in their plane.
SolidMesh crooked(ElementShape shape, const Motion& motion, unsigned seed) {
  const bool plane = dimensionOf(shape) == 2;
  SolidMesh mesh = boxOf(shape, layered(shape, {3, 3, 3}), {}, {3, 3, 3});
  std::mt19937 random(seed);
  Eigen::Matrix3d R = Eigen::Matrix3d::Identity();
  if (motion.turned) {
    const Vec3 axis = plane ? Vec3{0, 0, 1} : normalized(randomVec3(random, 1.0));
    R = Eigen::AngleAxisd(2.0, Eigen::Vector3d(axis.x, axis.y, axis.z)).toRotationMatrix();
  }
  const Vec3 shift = motion.offset * Vec3{1.0, -0.7, 0.4};
  for (Vec3& X : mesh.X) {
    const Vec3 wave = 0.1 * Vec3{std::sin(1.9 * X.y + X.z), std::sin(2.1 * X.z + X.x), std::sin(1.7 * X.x - X.y)};
    Vec3 x = X + wave + randomVec3(random, 0.04);
    if (plane) x.z = X.z;
    const Eigen::Vector3d turned = R * Eigen::Vector3d(x.x, x.y, x.z);
    X = Vec3{turned[0], turned[1], turned[2]} + shift;
  }
  return mesh;
}

std::span<const int> nodesOfElement(const SolidMesh& mesh, int element) {
  const auto n = static_cast<std::size_t>(nodesOf(mesh.groups[0].shape));
  return std::span(mesh.groups[0].node).subspan(n * static_cast<std::size_t>(element), n);
}

Vec3 at(const SolidMesh& mesh, std::span<const int> nodes, std::span<const double> shape) {
  Vec3 x;
  for (std::size_t a = 0; a < nodes.size(); ++a) x += shape[a] * mesh.X[static_cast<std::size_t>(nodes[a])];
  return x;
}

Vec3 randomParent(ElementShape shape, std::mt19937& random) {
  std::uniform_real_distribution<double> d(0.0, 1.0);
  Vec3 xi;
  if (parentNodes(shape)[0].x < 0.0) {
    xi = randomVec3(random, 0.999);
    if (dimensionOf(shape) == 2) xi.z = 0.0;
    return xi;
  }
  do xi = {d(random), d(random), d(random)};
  while (xi.x + xi.y + xi.z > 0.999);
  return xi;
}

/// Distance that counts as none: round-off of the coordinates.
double roundOff(const Motion& motion) { return 1e-14 * (30.0 + motion.offset); }

TEST(ElementLocator, EveryInteriorPointHasOneOwner) {
  for (const ElementShape shape : allCellShapes)
    for (const Motion& motion : motions)
      for (unsigned seed = 1; seed <= 2; ++seed) {
        const SolidMesh mesh = crooked(shape, motion, seed);
        ASSERT_NO_THROW(validate(mesh)) << name(shape);
        const ElementLocator locator(mesh);
        std::vector<ElementLocator> alone;
        for (int e = 0; e < static_cast<int>(mesh.elementCount()); ++e) {
          const std::span<const int> nodes = nodesOfElement(mesh, e);
          alone.emplace_back(std::vector<ElementGroup>{{shape, {nodes.begin(), nodes.end()}}}, mesh.X);
        }
        std::mt19937 random(seed + 10);
        for (int trial = 0; trial < 300; ++trial) {
          const int e = trial % static_cast<int>(mesh.elementCount());
          const Vec3 xi = randomParent(shape, random);
          const Vec3 x = at(mesh, nodesOfElement(mesh, e), shapeRow(shape, xi));
          const auto place = locator.find(x);
          ASSERT_TRUE(place) << name(shape) << " " << motion.offset;
          EXPECT_EQ(place->element, e);
          EXPECT_LT(norm(place->xi - xi), 30.0 * roundOff(motion)) << name(shape) << " " << motion.offset;
          double sum = 0.0;
          for (const double value : place->shape) sum += value;
          EXPECT_NEAR(sum, 1.0, 1e-14);
          EXPECT_LT(norm(at(mesh, nodesOfElement(mesh, e), place->shape) - x), roundOff(motion));
          int owners = 0;
          for (const ElementLocator& one : alone) owners += one.find(x).has_value();
          EXPECT_EQ(owners, 1);
        }
      }
}

/// Points of a face, and outside of it along the normal by `distance`.
struct FacePoint {
  Vec3 x, normal;
};
FacePoint onFace(const SolidMesh& mesh, const Face& face, std::mt19937& random) {
  std::uniform_real_distribution<double> d(0.0, 1.0);
  const bool triangle = cornersOf(face.shape) == 3;
  double xi = d(random), eta = d(random);
  if (triangle && xi + eta > 1.0) xi = 1.0 - xi, eta = 1.0 - eta;
  if (!triangle) xi = 2.0 * xi - 1.0, eta = 2.0 * eta - 1.0;
  const std::span<const int> nodes(face.node.data(), static_cast<std::size_t>(nodesOf(face.shape)));
  const auto place = [&](double s, double t) { return at(mesh, nodes, shapeRow(face.shape, s, t)); };
  const double h = 1e-3;
  const Vec3 a = place(xi + h, eta) - place(xi - h, eta);
  const Vec3 b = dimensionOf(face.shape) == 2 ? Vec3{0, 0, 1} : place(xi, eta + h) - place(xi, eta - h);
  return {place(xi, eta), normalized(cross(a, b))};
}

TEST(ElementLocator, APointOnAFaceBelongsToTheElementOfLowestNumber) {
  for (const ElementShape shape : allCellShapes)
    for (const Motion& motion : motions) {
      const SolidMesh mesh = crooked(shape, motion, 3);
      const ElementLocator locator(mesh);
      std::map<std::vector<int>, int> owner;
      std::mt19937 random(4);
      for (std::size_t e = 0; e < mesh.elementCount(); ++e)
        for (std::size_t side = 0; side < localFacesOf(shape).size(); ++side) {
          const Face face = faceOf(mesh.groups[0], e, side);
          std::vector<int> key(face.node.begin(), face.node.begin() + nodesOf(face.shape));
          std::sort(key.begin(), key.end());
          const int lowest = owner.try_emplace(key, static_cast<int>(e)).first->second;
          const auto place = locator.find(onFace(mesh, face, random).x);
          ASSERT_TRUE(place) << name(shape) << " " << motion.offset;
          EXPECT_EQ(place->element, lowest) << name(shape) << " " << motion.offset;
        }
    }
}

TEST(ElementLocator, PointsOutsideAreOutside) {
  for (const ElementShape shape : allCellShapes)
    for (const Motion& motion : motions) {
      const SolidMesh mesh = crooked(shape, motion, 5);
      const ElementLocator locator(mesh);
      const double distance = 1e-7 * (1.0 + 0.1 * motion.offset);
      std::mt19937 random(6);
      for (const Face& face : boundaryFaces(mesh)) {
        const FacePoint point = onFace(mesh, face, random);
        if (motion.offset < 1e5) {
          EXPECT_FALSE(locator.find(point.x + distance * point.normal)) << name(shape) << " " << motion.offset;
          EXPECT_TRUE(locator.find(point.x - distance * point.normal)) << name(shape) << " " << motion.offset;
        }
        EXPECT_FALSE(locator.find(point.x + 0.02 * point.normal)) << name(shape);
        EXPECT_FALSE(locator.find(point.x + 1e4 * point.normal)) << name(shape);
      }
    }
}

double jacobian(const SolidMesh& mesh, const Vec3& xi) {
  const ElementShape shape = mesh.groups[0].shape;
  std::vector<double> value(mesh.X.size());
  std::vector<Vec3> gradient(mesh.X.size());
  shapeFunctions(shape, xi, value, gradient);
  std::array<Vec3, 3> J{};
  for (std::size_t a = 0; a < gradient.size(); ++a)
    for (int j = 0; j < 3; ++j) J[static_cast<std::size_t>(j)] += gradient[a][j] * mesh.X[a];
  return dot(J[0], cross(J[1], J[2]));
}

/// One brick with its nodes moved at random, and no fold that 9³ points show.
SolidMesh wildBrick(ElementShape shape, double amplitude, std::mt19937& random) {
  SolidMesh mesh;
  std::vector<int> all(static_cast<std::size_t>(nodesOf(shape)));
  std::iota(all.begin(), all.end(), 0);
  mesh.groups = {{shape, all}};
  bool folded = true;
  while (folded) {
    mesh.X.clear();
    for (const Vec3& xi : parentNodes(shape)) mesh.X.push_back(xi + randomVec3(random, amplitude));
    folded = false;
    for (int k = 0; k < 729 && !folded; ++k)
      folded = jacobian(mesh, 0.25 * Vec3{k % 9 - 4.0, k / 9 % 9 - 4.0, k / 81 - 4.0}) < 0.01;
  }
  return mesh;
}

/// Newton's method alone loses some of these points or finds them elsewhere.
TEST(ElementLocator, FindsPointsOfElementsThatAreHardToInvert) {
  struct Case {
    ElementShape shape;
    double amplitude;
  };
  std::mt19937 random(7);
  for (const auto& [shape, amplitude] :
       {Case{ElementShape::hex8, 1.1}, Case{ElementShape::hex20, 0.35}, Case{ElementShape::hex27, 0.25}})
    for (int cell = 0; cell < 100; ++cell) {
      const SolidMesh mesh = wildBrick(shape, amplitude, random);
      const ElementLocator locator(mesh);
      for (int trial = 0; trial < 100; ++trial) {
        const Vec3 x = at(mesh, mesh.groups[0].node, shapeRow(shape, randomParent(shape, random)));
        const auto place = locator.find(x);
        ASSERT_TRUE(place) << name(shape);
        EXPECT_LT(norm(at(mesh, mesh.groups[0].node, place->shape) - x), 1e-12);
      }
    }
}

TEST(ElementLocator, FindsPointsOfSlenderElements) {
  const SolidMesh mesh = boxOf(ElementShape::hex8, {40, 2, 1}, {1e3, 0, 0}, {1e3 + 4e-4, 2, 30});
  const ElementLocator locator(mesh);
  std::mt19937 random(8);
  for (int trial = 0; trial < 400; ++trial) {
    const int e = trial % 80;
    const Vec3 x = at(mesh, nodesOfElement(mesh, e), shapeRow(ElementShape::hex8, randomVec3(random, 0.99)));
    const auto place = locator.find(x);
    ASSERT_TRUE(place);
    EXPECT_EQ(place->element, e);
  }
}

TEST(ElementLocator, NumbersElementsThroughAllGroups) {
  SolidMesh mesh = boxOf(ElementShape::hex8, {2, 1, 1}, {}, {2, 1, 1});
  const SolidMesh tets = boxOf(ElementShape::tet4, {1, 1, 1}, {5, 0, 0}, {6, 1, 1});
  const int shift = static_cast<int>(mesh.X.size());
  mesh.X.insert(mesh.X.end(), tets.X.begin(), tets.X.end());
  mesh.groups.push_back(tets.groups[0]);
  for (int& node : mesh.groups[1].node) node += shift;
  const ElementLocator locator(mesh);
  EXPECT_EQ(locator.find({1.5, 0.5, 0.5})->element, 1);
  const auto place = locator.find({5.9, 0.2, 0.3});
  EXPECT_EQ(place->shape.size(), 4u);
  EXPECT_EQ(place->element, 2 + ElementLocator(tets).find({5.9, 0.2, 0.3})->element);
}

TEST(ElementLocator, FlatElementsAreNamed) {
  SolidMesh mesh = boxOf(ElementShape::hex8, {2, 1, 1}, {}, {2, 1, 1});
  for (Vec3& X : mesh.X)
    if (X.x > 0.5) X.z = 0.5;  // element 1 has no height
  try {
    ElementLocator(mesh).find({1.5, 0.4, 0.5});
    FAIL();
  } catch (const NumericalError& error) {
    EXPECT_NE(std::string(error.what()).find("element 1"), std::string::npos) << error.what();
    EXPECT_NE(std::string(error.what()).find("1.5, 0.4, 0.5"), std::string::npos) << error.what();
  }
}

TEST(ElementLocator, WhatCannotBeSearchedIsRefused) {
  SolidMesh mesh = boxOf(ElementShape::hex8, {1, 1, 1}, {}, {1, 1, 1});
  EXPECT_THROW(ElementLocator({}, mesh.X), InputError);
  EXPECT_THROW(ElementLocator(mesh.groups, std::span(mesh.X).first(4)), InputError);
  EXPECT_THROW(ElementLocator(mesh).find({NAN, 0, 0}), InputError);
  mesh.X[3].y = NAN;
  EXPECT_THROW(ElementLocator{mesh}, NumericalError);
  for (Vec3& X : mesh.X) X = {1, 2, 3};
  EXPECT_THROW(ElementLocator{mesh}, InputError);
}

TEST(ShapeRows, OfFacesAreThoseOfTheCellsThere) {
  std::mt19937 random(9);
  for (const ElementShape shape : allCellShapes) {
    const SolidMesh mesh = crooked(shape, {0, true}, 9);
    for (std::size_t side = 0; side < localFacesOf(shape).size(); ++side) {
      const Face& local = localFacesOf(shape)[side];
      const bool triangle = cornersOf(local.shape) == 3;
      const Vec3 r = randomVec3(random, triangle ? 0.2 : 1.0);
      const double xi = triangle ? 0.3 + r.x : r.x, eta = triangle ? 0.3 + r.y : r.y;
      const std::vector<double> row = shapeRow(local.shape, xi, eta);
      Vec3 parent;
      double sum = 0.0;
      for (std::size_t a = 0; a < row.size(); ++a) {
        parent += row[a] * parentNodes(shape)[static_cast<std::size_t>(local.node[a])];
        sum += row[a];
      }
      EXPECT_NEAR(sum, 1.0, 1e-14);
      const std::vector<double> whole = shapeRow(shape, parent);
      std::vector<double> spread(whole.size(), 0.0);
      for (std::size_t a = 0; a < row.size(); ++a) spread[static_cast<std::size_t>(local.node[a])] = row[a];
      for (std::size_t a = 0; a < whole.size(); ++a) EXPECT_NEAR(whole[a], spread[a], 1e-13) << name(shape) << side;
    }
  }
}

TEST(ElementLocator, PointsNearTheMeshHaveTheirPlaceInTheNearestElementAndNoneFartherThanTheReach) {
  for (const ElementShape shape : {ElementShape::hex8, ElementShape::tet4, ElementShape::hex20, ElementShape::tet10}) {
    const SolidMesh mesh = boxOf(shape, {3, 2, 2}, {}, {3, 2, 2});
    const ElementLocator locator(mesh);
    std::mt19937 random(5);
    for (int k = 0; k < 400; ++k) {
      const Vec3 x = Vec3{1.5, 1.0, 1.0} + 2.0 * randomVec3(random, 1.0);
      const Vec3 off{std::max({0.0, -x.x, x.x - 3}), std::max({0.0, -x.y, x.y - 2}), std::max({0.0, -x.z, x.z - 2})};
      const auto near = locator.findNear(x, 0.4), within = locator.find(x);
      ASSERT_EQ(near.has_value(), norm(off) < 0.4) << norm(off);
      if (!near) continue;
      EXPECT_LT(norm(at(mesh, nodesOfElement(mesh, near->element), near->shape) - x), 1e-12);
      if (within) {
        EXPECT_EQ(near->element, within->element);
        EXPECT_EQ(near->shape, within->shape);
        continue;
      }
      const Vec3 foot{std::clamp(x.x, 0.0, 3.0), std::clamp(x.y, 0.0, 2.0), std::clamp(x.z, 0.0, 2.0)};
      EXPECT_LT(norm(foot - x), norm(off) + 1e-12);
      double least = 1.0;  // the foot lies in that element
      const auto nodes = nodesOfElement(mesh, near->element);
      if (const auto there = locator.find(foot + 1e-9 * (Vec3{1.5, 1.0, 1.0} - foot)))
        least = shape == ElementShape::hex8 && norm(off) > 0.0 ? (there->element == near->element ? 0.0 : 1.0) : 0.0;
      EXPECT_EQ(least, 0.0) << nodes.size();
    }
    EXPECT_FALSE(locator.findNear({-0.1, 1, 1}, 0.0));
  }
}

}  // namespace
}  // namespace dovetail::fem
