// Weights of nodes at points: sums, slopes, borders.
#include <gtest/gtest.h>

#include "dovetail/core/error.hpp"
#include "random_points.hpp"

namespace dovetail::mpm::test {
namespace {

TEST(Shapes, ReproduceLinearFieldsAndTheirSlopes) {
  Random random;
  for (const Shape shape : shapes)
    for (int k = 0; k < 500; ++k) {
      const double s = k == 0 ? 3.0 : random.within(-20.0, 20.0), half = random.within(0.05, 0.5);
      const LineWeights at = weightsAt(shape, s, half);
      double one = 0.0, place = 0.0, none = 0.0, slope = 0.0;
      for (std::size_t a = 0; a < mostInReach; ++a) {
        const double node = at.first + static_cast<double>(a);
        one += at.value[a], place += node * at.value[a], none += at.slope[a], slope += node * at.slope[a];
        EXPECT_GE(at.value[a], -1e-15) << name(shape) << " at " << s;
      }
      EXPECT_NEAR(one, 1.0, 1e-14) << name(shape);
      EXPECT_NEAR(place, s, 1e-13) << name(shape);
      EXPECT_NEAR(none, 0.0, 1e-14) << name(shape);
      EXPECT_NEAR(slope, 1.0, 1e-13) << name(shape);
    }
}

TEST(Shapes, SlopesAreDerivativesAndSecondMomentsAreConstant) {
  Random random;
  for (const Shape shape : shapes)
    for (int k = 0; k < 200; ++k) {
      const double s = random.within(0.0, 1.0), d = 1e-6;
      const LineWeights at = weightsAt(shape, s), up = weightsAt(shape, s + d), down = weightsAt(shape, s - d);
      double moment = 0.0;
      for (std::size_t a = 0; a < mostInReach; ++a) {
        moment += at.value[a] * std::pow(at.first + static_cast<double>(a) - s, 2);
        if (up.first == at.first && down.first == at.first) {
          EXPECT_NEAR((up.value[a] - down.value[a]) / (2.0 * d), at.slope[a], 1e-5) << name(shape) << " at " << s;
        }
      }
      if (secondMoment(shape) > 0.0) {
        EXPECT_NEAR(moment, secondMoment(shape), 1e-14) << name(shape);
      }
    }
}

/// Between borders on both sides of x and y (and z); fields that obey them: odd in held components about a held border,
/// and normal to a symmetry; even along that.
TEST(Grids, ReproduceFieldsUpToTheirBorders) {
  Random random;
  for (const bool plane : {true, false})
    for (const Shape shape : shapes) {
      GridOptions grid{.spacing = 0.125,
                       .shape = shape,
                       .plane = plane,
                       .borders = {{.axis = 0, .above = false, .place = 0.0},
                                   {.axis = 0, .above = true, .place = 1.0},
                                   {.axis = 1, .above = false, .place = 0.0, .kind = BorderKind::held}}};
      if (!plane) grid.borders.push_back({.axis = 2, .above = true, .place = 1.0});
      validate(grid);
      const MaterialPoints points = scattered(300, plane, random);
      const GridRows rows = rowsAt(grid, points.x, "points");
      std::vector<Vec3> constant(rows.nodes()), shear(rows.nodes());
      for (std::size_t n = 0; n < rows.nodes(); ++n) {
        EXPECT_TRUE(rows.X[n].x >= -1e-15 && rows.X[n].x <= 1.0 + 1e-15 && rows.X[n].y >= -1e-15);
        constant[n] = {1.0, 0.0, 0.0};
        shear[n] = {rows.X[n].y, 2.0 * rows.X[n].y, 0.0};  // at rest where it is held; u_x free of x
      }
      for (std::size_t p = 0; p < points.x.size(); ++p) {
        double sum = 0.0;
        Vec3 slopes;
        for (std::size_t a = 0; a < rows.perPoint; ++a)
          sum += rows.weight[rows.perPoint * p + a], slopes += rows.slope[rows.perPoint * p + a];
        EXPECT_NEAR(sum, 1.0, 1e-13);
        EXPECT_LE(norm(slopes), 1e-12);
        const Vec3& x = points.x[p];
        // A field with normal motion at a symmetry does not obey it: away from these.
        if (x.x > 0.25 && x.x < 0.75 && x.y > 0.25) {
          EXPECT_NEAR(valueAt(rows, p, constant).x, 1.0, 1e-13);
        }
        EXPECT_NEAR(valueAt(rows, p, shear).y, 2.0 * x.y, 1e-13);
      }
    }
}

TEST(Grids, FindNodesOfPointsFarFromEachOtherAndRefuseTooFar) {
  const GridOptions grid{.spacing = 0.5, .plane = false};
  std::vector<Vec3> x{{1e5, -2e4, 3e3}, {-1e5, 0.1, 0.2}, {1e5, -2e4, 3e3}};
  const GridRows rows = rowsAt(grid, x, "points");
  EXPECT_EQ(rows.cells(), 2U);
  EXPECT_EQ(rows.nodes(), 54U);
  EXPECT_EQ(rows.cell, (std::vector<int>{1, 0, 1}));
  for (std::size_t p = 0; p < x.size(); ++p) EXPECT_LE(norm(valueAt(rows, p, rows.X) - x[p]), 1e-11 * norm(x[p]));
  for (const double far : {1e6, 1e12, 1e300}) {
    x[1].x = -far;
    try {
      rowsAt(grid, x, "points");
      FAIL() << far;
    } catch (const NumericalError& error) {
      EXPECT_NE(std::string(error.what()).find(far < 1e9 ? "points 1 and 2" : "point 1"), std::string::npos);
    }
  }
}

TEST(Grids, RefuseBordersThatCannotBe) {
  const auto refusal = [](const GridOptions& grid) {
    try {
      validate(grid);
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_NE(refusal({}).find("spacing"), std::string::npos);
  EXPECT_NE(refusal({.spacing = 0.1, .borders = {{.place = 0.05}}}).find("between nodes"), std::string::npos);
  EXPECT_NE(refusal({.spacing = 0.1, .borders = {{.axis = 2}}}).find("plane"), std::string::npos);
  EXPECT_NE(refusal({.spacing = 0.1, .borders = {{}, {}}}).find("two"), std::string::npos);
  EXPECT_NE(refusal({.spacing = 0.1, .borders = {{}, {.above = true, .place = 0.1}}}).find("1 cells apart"),
            std::string::npos);
  const std::vector<Vec3> beyond{{0.0, -0.01, 0.0}};
  EXPECT_THROW(rowsAt({.spacing = 0.1, .borders = {{}}}, beyond, "points"), NumericalError);
}

}  // namespace
}  // namespace dovetail::mpm::test
