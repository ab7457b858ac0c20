#include <gtest/gtest.h>

#include <cmath>

#include "picture/cell_faces.hpp"
#include "picture/quantities.hpp"
#include "picture/view.hpp"

namespace dovetail::scene {
namespace {

/// Two unit cubes side by side along x, as hexahedra or each as six tetrahedra.
io::FrameContent cubes(bool asTetrahedra) {
  io::FrameContent frame;
  for (int z = 0; z < 2; ++z)
    for (int y = 0; y < 2; ++y)
      for (int x = 0; x < 3; ++x) frame.position.push_back({1.0 * x, 1.0 * y, 1.0 * z});
  const auto add = [&](const std::vector<std::size_t>& points, int type) {
    frame.cellPoint.insert(frame.cellPoint.end(), points.begin(), points.end());
    frame.cellEnd.push_back(frame.cellPoint.size());
    frame.cellType.push_back(type);
    ++frame.cells;
  };
  for (std::size_t x = 0; x < 2; ++x) {
    const std::vector<std::size_t> p{x, x + 1, x + 4, x + 3, x + 6, x + 7, x + 10, x + 9};
    if (!asTetrahedra) add(p, 12);
    const std::vector<std::vector<std::size_t>> parts{{0, 1, 2, 6}, {0, 2, 3, 6}, {0, 3, 7, 6},
                                                      {0, 7, 4, 6}, {0, 4, 5, 6}, {0, 5, 1, 6}};
    for (const auto& part : parts)
      if (asTetrahedra) add({p[part[0]], p[part[1]], p[part[2]], p[part[3]]}, 10);
  }
  return frame;
}

double areaOf(const std::vector<picture::Triangle>& triangles) {
  double area = 0.0;
  for (const auto& t : triangles) area += 0.5 * norm(cross(t.corner[1] - t.corner[0], t.corner[2] - t.corner[0]));
  return area;
}

/// Length of lines, those that two triangles share twice.
double linesOf(const std::vector<picture::Triangle>& triangles) {
  double length = 0.0;
  for (const auto& t : triangles)
    for (std::size_t k = 0; k < 3; ++k)
      if ((t.edges >> k & 1) != 0) length += norm(t.corner[(k + 1) % 3] - t.corner[k]);
  return length;
}

TEST(Pictures, TheSurfaceOfASolidHasItsAreaAndTheLinesOfItsCells) {
  for (const bool asTetrahedra : {false, true}) {
    const io::FrameContent frame = cubes(asTetrahedra);
    const auto surface = surfaceOf(frame, frame.position, {}, 0, {});
    EXPECT_NEAR(areaOf(surface), 10.0, 1e-12);
    if (!asTetrahedra) {
      EXPECT_NEAR(linesOf(surface), 2.0 * 20.0, 1e-12);
    }
  }
}

TEST(Pictures, ASectionClosesWhatIsLeft) {
  for (const bool asTetrahedra : {false, true})
    for (const double sign : {1.0, -1.0}) {
      const io::FrameContent frame = cubes(asTetrahedra);
      const Cut cut{1, 0.3, sign};
      std::vector<float> value;
      for (const Vec3& x : frame.position) value.push_back(static_cast<float>(2.0 * x.x + x.y - x.z));
      const auto surface = surfaceOf(frame, frame.position, value, 0, cut);
      const double left = sign > 0.0 ? 0.3 : 0.7;
      // Two long sides, of which one is the section; bottom and top; the ends.
      EXPECT_NEAR(areaOf(surface), 2.0 + 2.0 + 4.0 * left + 2.0 * left, 1e-12);
      for (const auto& t : surface)
        for (std::size_t k = 0; k < 3; ++k) {
          EXPECT_LE(cut.height(t.corner[k]), 1e-12);
          const Vec3& x = t.corner[k];
          EXPECT_NEAR(t.value[k], 2.0 * x.x + x.y - x.z, 1e-5);  // linear fields stay so
        }
      if (!asTetrahedra) {
        std::vector<picture::Triangle> section;
        for (const auto& t : surface)
          if (std::abs(t.corner[0].y - 0.3) + std::abs(t.corner[1].y - 0.3) + std::abs(t.corner[2].y - 0.3) < 1e-12)
            section.push_back(t);
        EXPECT_NEAR(areaOf(section), 2.0, 1e-12);
        EXPECT_NEAR(linesOf(section), 8.0, 1e-12);  // around each cell, none of its tetrahedra
      }
    }
}

TEST(Pictures, ASectionThroughAPlaneOfNodesIsThatOfTheFacesThere) {
  for (const double sign : {1.0, -1.0}) {
    io::FrameContent frame = cubes(false);
    for (std::size_t k = 0; k < frame.position.size(); ++k)  // nodes that have moved a little to either side
      frame.position[k].x += k % 2 == 0 ? 1e-7 : -2e-7;
    const Cut cut{0, 1.0, sign, 1e-6};
    const auto surface = surfaceOf(frame, frame.position, {}, 0, cut);
    EXPECT_NEAR(areaOf(surface), 6.0, 1e-5);  // one cube is left, and closed
    std::vector<picture::Triangle> section;
    for (const auto& t : surface)
      if (cut.height(t.corner[0]) == 0.0 && cut.height(t.corner[1]) == 0.0 && cut.height(t.corner[2]) == 0.0 &&
          areaOf({t}) > 1e-3)
        section.push_back(t);
    EXPECT_NEAR(areaOf(section), 1.0, 1e-5);
    EXPECT_NEAR(linesOf(section), 4.0, 1e-5);  // around the face
  }
}

TEST(Pictures, APlaneIsNotSeenFromItsEdge) {
  const geometry::Box plane{{0, 0, 0}, {2, 1, 0}};
  EXPECT_FALSE(isSeenFromItsEdge(plane, viewOf(plane, {0, 0, 1}, {}, {})));
  EXPECT_FALSE(isSeenFromItsEdge(plane, viewOf(plane, {0, 0, 1}, 30.0, 0.0)));
  EXPECT_TRUE(isSeenFromItsEdge(plane, viewOf(plane, {0, 0, 1}, 90.0, 0.0)));
  EXPECT_FALSE(isSeenFromItsEdge({{0, 0, -0.1}, {2, 1, 0.1}}, viewOf(plane, {0, 0, 1}, 90.0, 0.0)));
}

TEST(Pictures, ValuesOfCellsAreAveragedAtPoints) {
  const io::FrameContent frame = cubes(false);
  const std::vector<double> mean = atPoints(frame, {1.0, 3.0});
  EXPECT_EQ(mean[0], 1.0);
  EXPECT_EQ(mean[1], 2.0);
  EXPECT_EQ(mean[2], 3.0);
}

TEST(Pictures, TheCameraIsRightHandedAndGravityPointsDown) {
  const geometry::Box box{{0, 0, 0}, {3, 1, 1}};
  for (const Vec3& up : {Vec3{0, 0, 1}, Vec3{0, 9.81, 0}, Vec3{1, 0, 0}, Vec3{-0.4, 0, 0.9}, Vec3{0, -2, 1}}) {
    const picture::Camera camera = viewOf(box, up, {}, {});
    EXPECT_NEAR(norm(cross(camera.right, camera.up) - camera.back), 0.0, 1e-12);
    EXPECT_NEAR(dot(camera.right, up), 0.0, 1e-12);
    EXPECT_GT(dot(camera.up, up), 0.0);
    EXPECT_GT(dot(camera.back, up), 0.0);  // from above
  }
  const picture::Camera front = viewOf(box, {0, 0, 1}, 0.0, 0.0), side = viewOf(box, {0, 0, 1}, 90.0, 0.0);
  EXPECT_NEAR(norm(front.back - Vec3{0, -1, 0}), 0.0, 1e-12);
  EXPECT_NEAR(norm(front.right - Vec3{1, 0, 0}), 0.0, 1e-12);
  EXPECT_NEAR(norm(side.back - Vec3{1, 0, 0}), 0.0, 1e-12);
  // Long things are seen from their long side.
  EXPECT_LT(viewOf(box, {0, 0, 1}, {}, {}).back.y, -0.8);
  EXPECT_GT(viewOf({{0, 0, 0}, {1, 3, 1}}, {0, 0, 1}, {}, {}).back.x, 0.8);
}

TEST(Pictures, AFewGrainsThatHaveFlownOffDoNotCount) {
  picture::Drawing drawing;
  for (int k = 0; k < 1000; ++k) drawing.balls.push_back({{0.001 * k, 0, 0}, 0.01, 0.0F, 0});
  drawing.balls[3].centre.x = -500.0;
  EXPECT_GT(boxOf(drawing).lower.x, -0.1);
  EXPECT_LT(boxOf(drawing).upper.x, 1.1);
}

TEST(Pictures, ColoursEndAtRoundNumbers) {
  const auto range = [](std::vector<double> values, bool signs = false) {
    Spread spread;
    spread.add(std::move(values));
    return spread.range(signs);
  };
  EXPECT_DOUBLE_EQ(range({0.01, 2.7}).low, 0.0);
  EXPECT_DOUBLE_EQ(range({0.01, 2.7}).high, 3.0);
  EXPECT_DOUBLE_EQ(range({-1.3, 0.4}, true).low, -1.5);
  EXPECT_DOUBLE_EQ(range({-1.3, 0.4}, true).high, 1.5);
  EXPECT_LT(range({5.0, 5.0}).low, 5.0);
  EXPECT_GT(range({5.0, 5.0}).high, 5.0);
  EXPECT_LT(range({0.2999, 0.3000}).low, 0.28);  // as good as the same
  EXPECT_LE(range({9.2, 10.1}).low, 9.2 + 1e-12);
  EXPECT_GT(range({9.2, 10.1}).low, 8.0);
  std::vector<double> values(2000, 1.0);
  values[7] = 1e6;
  EXPECT_LT(range(values).high, 2.0);
  EXPECT_EQ(prefixed(5e4, "Pa").second, "kPa");
  EXPECT_EQ(prefixed(2e-3, "m").second, "mm");
  EXPECT_EQ(prefixed(0.3, "").second, "");
}

}  // namespace
}  // namespace dovetail::scene
