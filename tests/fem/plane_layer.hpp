// A body of plane cells and the same of one layer of bricks whose z is held.
#pragma once

#include "dovetail/fem/laws/plasticity.hpp"
#include "dovetail/fem/mesh/mesh_shapes.hpp"
#include "dovetail/fem/terms/loads.hpp"
#include "dynamics_helpers.hpp"
#include "term_checks.hpp"

namespace dovetail::fem {

inline constexpr SolidKind kindsOfBricks[] = {{ElementShape::quad4, Formulation::standard},
                                              {ElementShape::quad4, Formulation::meanDilatation},
                                              {ElementShape::quad8, Formulation::standard},
                                              {ElementShape::quad8, Formulation::meanDilatation}};
inline constexpr double depth = 0.4;

inline SolidMesh bentBox(ElementShape shape) {
  return mappedBox(shape, {4, 2, 1}, {0.0, 0.0, 0.2}, {1.0, 0.4, 0.2 + depth}, [](const Vec3& X) {
    return Vec3{X.x + 0.1 * std::sin(2.0 * X.y), X.y + 0.1 * X.x * X.x, X.z};
  });
}

struct Body {
  SolidMesh mesh;
  Model model;
  std::shared_ptr<Solid> solid;
  Body(ElementShape shape, Formulation formulation, const std::shared_ptr<const PointMaterial>& material)
      : mesh(bentBox(shape)), model(makeModel(mesh)), solid(makeSolid(mesh, material, {.formulation = formulation})) {
    model.add(solid);
    addMass(model);
  }
};

/// The same body of plane cells and of bricks.
struct Pair {
  Body plane, bricks;
  std::vector<std::size_t> image;  // of each node of the bricks

  Pair(const SolidKind& kind, const std::shared_ptr<const PointMaterial>& material)
      : plane(kind.shape, kind.formulation, material),
        bricks(kind.shape == ElementShape::quad4 ? ElementShape::hex8 : ElementShape::hex20, kind.formulation,
               material) {
    std::vector<int> all(bricks.mesh.X.size());
    std::iota(all.begin(), all.end(), 0);
    fix(bricks.model.nodes, all, componentZ);
    for (const Vec3& X : bricks.mesh.X) {
      const auto found = std::ranges::find_if(
          plane.mesh.X, [&](const Vec3& Y) { return std::abs(X.x - Y.x) + std::abs(X.y - Y.y) < 1e-12; });
      image.push_back(static_cast<std::size_t>(found - plane.mesh.X.begin()));
    }
  }

  /// Calls act(body) for both.
  template <class Act>
  void both(Act&& act) {
    act(plane);
    act(bricks);
  }
  std::vector<Vec3> spread(const std::vector<Vec3>& field) const {
    std::vector<Vec3> result;
    for (const std::size_t n : image) result.push_back(field[n]);
    return result;
  }
  std::vector<Vec3> gathered(const std::vector<Vec3>& field) const {
    std::vector<Vec3> result(plane.mesh.X.size());
    for (std::size_t n = 0; n < image.size(); ++n) result[image[n]] += field[n];
    return result;
  }
  void displace(double amplitude, unsigned seed) {
    setRandomDisplacement(plane.model.nodes, amplitude, seed);
    bricks.model.nodes.u = spread(plane.model.nodes.u);
  }
  void expectSameDisplacements(double tolerance, const std::string& what) const {
    EXPECT_LT(largestDifference(bricks.model.nodes.u, spread(plane.model.nodes.u)),
              tolerance * largest(plane.model.nodes.u))
        << what;
    EXPECT_GT(largest(plane.model.nodes.u), 1e-3) << what;
  }
};

template <class Check>
void forEachPair(const std::shared_ptr<const PointMaterial>& material, Check&& check) {
  for (const SolidKind& kind : kindsOfBricks) {
    SCOPED_TRACE(kind.label());
    Pair pair(kind, material);
    check(pair);
  }
}

inline const auto rubber = std::make_shared<PlainNeoHookean>(2e6, 1e6);
inline const auto metal = pointMaterial(J2Plasticity{2e6, 0.3, 1000.0, linearYield(2e4, 1e5)});

/// A cantilever whose upper side is under a pressure that follows it.
inline void load(Body& body, double pressure) {
  body.model.constraints.hold(nodeSet(body.mesh, "x-"));
  body.model.add(followingPressure(body.mesh, faceSet(body.mesh, "y+"), [pressure](double t) { return pressure * t; }));
}

}  // namespace dovetail::fem
