#include <gtest/gtest.h>

#include "dovetail/core/error.hpp"
#include "dovetail/fem/elements/elements.hpp"
#include "dovetail/fem/laws/point_laws.hpp"
#include "solid_helpers.hpp"

namespace dovetail::fem {
namespace {

const Material kirchhoff = StVenantKirchhoff{3e6, 0.3, 1000.0};

/// The same law without hand-written kernels.
class Plain : public PointMaterial {
public:
  std::string name() const override { return "plain"; }
  double density() const override { return 1000.0; }
  void evaluate(const PointBatch& batch) const override { law_->evaluate(batch); }

private:
  std::shared_ptr<const PointMaterial> law_ = pointMaterial(kirchhoff);
};

TEST(BrickSolid, HandWrittenAndGeneralKernelsAgree) {
  const SolidMesh mesh = testSolidMesh(CellShape::hex8, true);
  Model model = makeModel(mesh);
  setRandom(model.nodes.u, 0.05, 4);
  const auto fast = makeSolid(mesh, pointMaterial(kirchhoff)), general = makeSolid(mesh, std::make_shared<Plain>());
  const Eigen::VectorXd a = flat(forcesOf(*fast, model.nodes)), b = flat(forcesOf(*general, model.nodes));
  EXPECT_LT((a - b).norm(), 1e-12 * b.norm());
  EXPECT_NEAR(fast->energy(model.nodes, {}), general->energy(model.nodes, {}),
              1e-12 * general->energy(model.nodes, {}));
}

TEST(BrickSolid, AssumedStressIsHybrid8) {
  const SolidMesh mesh = testSolidMesh(CellShape::hex8, true);
  Model model = makeModel(mesh);
  setRandom(model.nodes.u, 0.05, 4);
  const auto solid = makeSolid(mesh, pointMaterial(kirchhoff), {.formulation = Formulation::assumedStress});
  const ElementBlock block = makeElements(brickMesh(mesh), ElementType::hybrid8, kirchhoff);
  clearForces(model.nodes);
  const double energy = addInternalForces(block, model.nodes, true);
  const Eigen::VectorXd a = flat(forcesOf(*solid, model.nodes)), b = flat(model.nodes.f);
  EXPECT_LT((a - b).norm(), 1e-13 * b.norm());
  EXPECT_NEAR(solid->energy(model.nodes, {}), energy, 1e-13 * energy);
  const Eigen::MatrixXd K = dense(tangentOf(*solid, model.nodes)), expected = dense(tangent(block, model.nodes));
  EXPECT_LT((K - expected).norm(), 1e-13 * expected.norm());
  EXPECT_THROW(makeSolid(mesh, std::make_shared<Plain>(), {.formulation = Formulation::assumedStress}), InputError);
}

}  // namespace
}  // namespace dovetail::fem
