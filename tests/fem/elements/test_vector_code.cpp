// The code for wide registers and the portable one give the same digits.
#include <gtest/gtest.h>

#include "../../core/every_vector_code.hpp"
#include "dovetail/fem/laws/point_laws.hpp"
#include "dovetail/fem/laws/viscosity.hpp"
#include "plastic_laws.hpp"
#include "solid_helpers.hpp"

namespace dovetail::fem {
namespace {

using test::expectSameDigitsOfEveryVectorCode;

std::vector<Named> timedAndOwn() {
  std::vector<Named> named = laws();
  const StVenantKirchhoff elastic{2e11, 0.3, 1000.0};
  named.push_back({"St Venant-Kirchhoff", pointMaterial(Material(elastic))});
  named.push_back({"axial springs", pointMaterial(Material(AxialSprings{2e11, 1000.0}))});
  named.push_back({"neo-Hookean", pointMaterial(neoHookean(2e11, 0.3, 1000.0))});
  named.push_back({"Hencky", pointMaterial(Hencky{2e11, 0.3, 1000.0})});
  named.push_back({"viscous", pointMaterial(kelvinVoigt(named[0].material, 1e-3, 2e11, 0.3))});
  return named;
}

TEST(VectorCode, GivesTheDigitsOfPortableCodeForEveryLaw) {
  for (const Named& law : timedAndOwn())
    expectSameDigitsOfEveryVectorCode(law.name, [&] {
      std::mt19937 random(5);
      std::vector<double> numbers;
      std::vector<double> history = freshHistory(*law.material);
      Eigen::Matrix3d F = Eigen::Matrix3d::Identity();
      for (int step = 0; step < 5; ++step) {
        F = (Eigen::Matrix3d::Identity() + randomMatrix(random, 0.05)) * F;
        const PointResult result = evaluate(*law.material, F, history, 1e-2);
        history = result.history;
        numbers.insert(numbers.end(), result.P.data(), result.P.data() + 9);
        numbers.insert(numbers.end(), result.tangent.data(), result.tangent.data() + 81);
        numbers.insert(numbers.end(), {result.energy, result.dissipated});
        numbers.insert(numbers.end(), history.begin(), history.end());
      }
      return numbers;
    });
}

TEST(VectorCode, GivesTheDigitsOfPortableCodeForEveryElement) {
  for (const SolidKind& kind : allSolidKinds())
    expectSameDigitsOfEveryVectorCode(kind.label(), [&] {
      SolidScene scene = solidScene(kind, true);
      setRandom(scene.model.nodes.u, 0.02, 7);
      const std::vector<Vec3> f = forcesOf(*scene.solid, scene.model.nodes);
      const linalg::BlockMatrix K = tangentOf(*scene.solid, scene.model.nodes);
      std::vector<double> numbers(K.values().begin(), K.values().end());
      for (const Vec3& force : f) numbers.insert(numbers.end(), {force.x, force.y, force.z});
      numbers.push_back(scene.solid->energy(scene.model.nodes, {}));
      return numbers;
    });
}

TEST(VectorCode, GivesTheDigitsOfPortableCodeForTheKernelsOfBricks) {
  for (const Formulation formulation : {Formulation::standard, Formulation::assumedStress})
    for (const bool distorted : {false, true})
      expectSameDigitsOfEveryVectorCode("kernel", [&] {
        SolidScene scene = sceneOf(testMesh({2, 3, 3}, distorted), formulation, StVenantKirchhoff{1.0e6, 0.3, 1.0});
        Nodes& nodes = scene.model.nodes;
        setRandom(nodes.u, 0.01, 3);
        std::vector<double> numbers = {scene.solid->addForcesAndEnergy(nodes, {}, nodes.f)};
        for (const Vec3& force : nodes.f) numbers.insert(numbers.end(), {force.x, force.y, force.z});
        return numbers;
      });
}

}  // namespace
}  // namespace dovetail::fem
