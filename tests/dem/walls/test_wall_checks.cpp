// Walls that are wrong are named before the first step; meshes are known again.
#include <gtest/gtest.h>

#include "dovetail/core/error.hpp"
#include "dovetail/dem/walls/wall_checks.hpp"
#include "wall_scenes.hpp"

namespace dovetail::dem {
namespace {

TEST(WallChecks, PrimitiveWallsThatAreWrongAreRefused) {
  const auto refused = [](auto change, const PrimitiveWall& from) {
    PrimitiveWall wall = from;
    EXPECT_NO_THROW(validate(wall, 2));
    change(wall);
    EXPECT_THROW(validate(wall, 2), InputError);
  };
  const PrimitiveWall plane = makePlane({}, {0, 0, 1}), drum = makeCylinder({}, {0, 1, 0}, 0.5);
  refused([](PrimitiveWall& w) { w.skin = -1.0; }, plane);
  refused([](PrimitiveWall& w) { w.velocity.y = NAN; }, plane);
  refused([](PrimitiveWall& w) { w.angularVelocity.x = INFINITY; }, drum);
  refused([](PrimitiveWall& w) { w.material = 2; }, plane);
  refused([](PrimitiveWall& w) { w.material = -1; }, plane);
  refused([](PrimitiveWall& w) { w.axis = {0, 0, 2}; }, plane);
  refused([](PrimitiveWall& w) { w.radius = 0.0; }, drum);
  refused([](PrimitiveWall& w) { w.surfaceVelocity = {1, 0, 0.1}; }, plane);
  refused([](PrimitiveWall& w) { w.surfaceVelocity = {1, 0, 0}; }, drum);
  refused([](PrimitiveWall& w) { w.servo = WallServo{}; }, plane);
  PrimitiveWall belt = plane;
  belt.surfaceVelocity = {1, 2, 0};
  EXPECT_NO_THROW(validate(belt));
}

TEST(WallChecks, MeshWallsThatAreWrongAreRefused) {
  const auto refused = [](auto change) {
    MeshWall mesh;
    mesh.wall = squares(2, 2, 1.0);
    EXPECT_NO_THROW(validate(mesh, 1));
    change(mesh);
    EXPECT_THROW(validate(mesh, 1), InputError);
  };
  refused([](MeshWall& m) { m.candidates.skin = -0.1; });
  refused([](MeshWall& m) { m.wall.material = 1; });
  refused([](MeshWall& m) { m.wall.x[3].y = NAN; });
  refused([](MeshWall& m) { m.wall.v.pop_back(); });
  refused([](MeshWall& m) { m.motion = PrescribedMotion{}; });
  refused([](MeshWall& m) { m.motion = steadyMotion({}); });
}

TEST(WallChecks, AMeshIsKnownByItsShapeWhereverItIs) {
  MeshWall mesh;
  mesh.wall = squares(3, 2, 0.5);
  const auto atRest = fingerprint(mesh);
  MeshWall other = mesh;
  EXPECT_EQ(fingerprint(other), atRest);
  other.wall.x[4].z += 1e-12;
  EXPECT_NE(fingerprint(other), atRest);
  other = mesh;
  std::swap(other.wall.facets[1], other.wall.facets[2]);
  EXPECT_NE(fingerprint(other), atRest);
  other = mesh;
  other.wall.oneSided = true;
  EXPECT_NE(fingerprint(other), atRest);
  prescribe(mesh, steadyMotion({{1, 0, 0}, {}, {0.5, 0, 0}, {0, 0, 1}}, 2.0), {});
  const auto moving = fingerprint(mesh);
  moveWall(mesh, 2.0, 0.0);
  EXPECT_NEAR(mesh.wall.x[1].x - mesh.offset[1].x, 1.0, 1e-15);
  moveWall(mesh, 3.0, 1.0);
  EXPECT_EQ(fingerprint(mesh), moving);
}

}  // namespace
}  // namespace dovetail::dem
