#include <gtest/gtest.h>

#include <map>
#include <numbers>

#include "dovetail/core/error.hpp"
#include "dovetail/fem/mesh/mesh_quality.hpp"
#include "dovetail/fem_cgal/tetrahedra.hpp"

namespace dovetail::fem {
namespace {

using geometry::TriangleMesh;

/// The unit cube, each side cut into two facets.
TriangleMesh cube() {
  TriangleMesh mesh;
  const SolidMesh box = boxOf(ElementShape::hex8, {1, 1, 1}, {}, {1.0, 1.0, 1.0});
  mesh.x = box.X;
  for (const Face& f : boundaryFaces(box)) {
    mesh.facets.push_back({f.node[0], f.node[1], f.node[2]});
    mesh.facets.push_back({f.node[0], f.node[2], f.node[3]});
  }
  return mesh;
}

/// A sphere of radius 1 by dividing an octahedron.
TriangleMesh sphere(int divisions) {
  TriangleMesh mesh{{{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}},
                    {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}}};
  for (int d = 0; d < divisions; ++d) {
    std::map<std::pair<int, int>, int> middle;
    std::vector<geometry::Facet> finer;
    const auto between = [&](int a, int b) {
      const auto [entry, isNew] = middle.emplace(std::minmax(a, b), static_cast<int>(mesh.x.size()));
      if (isNew)
        mesh.x.push_back(normalized(mesh.x[static_cast<std::size_t>(a)] + mesh.x[static_cast<std::size_t>(b)]));
      return entry->second;
    };
    for (const auto& f : mesh.facets) {
      const int ab = between(f[0], f[1]), bc = between(f[1], f[2]), ca = between(f[2], f[0]);
      finer.insert(finer.end(), {{f[0], ab, ca}, {f[1], bc, ab}, {f[2], ca, bc}, {ab, bc, ca}});
    }
    mesh.facets = finer;
  }
  return mesh;
}

double skinVolume(const SolidMesh& mesh) {
  std::vector<geometry::Facet> facets;
  for (const Face& f : faceSet(mesh, "skin")) facets.push_back({f.node[0], f.node[1], f.node[2]});
  return geometry::signedVolume(mesh.X, facets);
}

/// One piece of sound tetrahedra whose skin is closed, points outwards and holds their volume.
double soundVolume(const SolidMesh& mesh) {
  EXPECT_NO_THROW(validate(mesh));
  EXPECT_NO_THROW(requireConnected(mesh));
  EXPECT_NO_THROW(requireConforming(mesh));
  const MeshQuality quality = measureQuality(mesh);
  for (const ElementQuality& e : quality.element) EXPECT_GT(e.volume, 0.0);
  EXPECT_NEAR(skinVolume(mesh), quality.shapes[0].volume, 1e-12);
  EXPECT_EQ(faceSet(mesh, "skin").size(), boundaryFaces(mesh).size());
  return quality.shapes[0].volume;
}

TEST(Tetrahedra, TheCubeIsFilledWithItsEdges) {
  const SolidMesh mesh = tetrahedraInside(cube(), {.size = 0.3});
  EXPECT_NEAR(soundVolume(mesh), 1.0, 1e-9);
  int corners = 0;
  for (const Vec3& X : mesh.X)
    corners +=
        std::abs(X.x - std::round(X.x)) + std::abs(X.y - std::round(X.y)) + std::abs(X.z - std::round(X.z)) < 1e-12;
  EXPECT_EQ(corners, 8);
}

TEST(Tetrahedra, TheSphereIsApproachedWithTheSize) {
  const TriangleMesh surface = sphere(4);
  const double exact = 4.0 / 3.0 * std::numbers::pi;
  // Faces within d of the surface leave out at most 4 π d.
  double last = 0.0;
  for (const double size : {0.5, 0.25}) {
    const double volume = soundVolume(tetrahedraInside(surface, {.size = size, .surfaceDistance = size / 20.0}));
    EXPECT_NEAR(volume, exact, 3.0 * size / 20.0 * exact);
    EXPECT_GT(volume, last);
    last = volume;
  }
}

TEST(Tetrahedra, TheSameInputGivesTheSameMesh) {
  const TriangleMesh surface = sphere(3);
  const SolidMesh first = tetrahedraInside(surface, {.size = 0.5}), second = tetrahedraInside(surface, {.size = 0.5});
  EXPECT_TRUE(first.X == second.X);
  EXPECT_TRUE(first.groups[0].node == second.groups[0].node);
}

TEST(Tetrahedra, SurfacesThatBoundNoVolumeAreRefused) {
  TriangleMesh open = cube(), turned = cube();
  open.facets.pop_back();
  for (auto& f : turned.facets) std::swap(f[0], f[1]);
  EXPECT_THROW(tetrahedraInside(open, {.size = 0.3}), InputError);
  EXPECT_THROW(tetrahedraInside(turned, {.size = 0.3}), InputError);
  EXPECT_THROW(tetrahedraInside({}, {.size = 0.3}), InputError);
  EXPECT_THROW(tetrahedraInside(cube(), {.size = 0.0}), InputError);
  EXPECT_THROW(tetrahedraInside(cube(), {.size = 0.3, .faceAngle = 40.0}), InputError);
  EXPECT_THROW(tetrahedraInside(cube(), {.size = 0.3, .radiusToEdge = 1.0}), InputError);
}

}  // namespace
}  // namespace dovetail::fem
