// The assumed-stress brick as a term of a model.
#include "dovetail/core/error.hpp"
#include "elements/bricks/brick_cache.hpp"
#include "elements/kernels/cell_kernels.hpp"
#include "elements/kernels/kernels.hpp"

namespace dovetail::fem::detail {

namespace {

class AssumedStressSolid final : public SolidBase {
public:
  AssumedStressSolid(SolidCells cells, std::unique_ptr<SolidPoints> points, const SolidOptions& options,
                     const Material& law)
      : SolidBase(std::move(cells), std::move(points), options, true) {
    useKernels(law, true);
  }

private:
  void deformation(const BatchTask& task, Lane* F) const override {
    withVectors([&] {
      Lane U[24];
      gatherNodes<8>(cells_, task.batch, task.u, U);
      for (std::size_t q = 0; q < 8; ++q) {
        displacementGradient<8>(U, &rule_->gradient[8 * q], geometry_[task.batch * 8 + q].map, F + 9 * q);
        addIdentity(F + 9 * q);
      }
    });
  }
  void forces(const BatchTask& task, BatchResult& result) override { forcesByKernels(task, result); }
  void tangent(const BatchTask& task, Lane* K) override {
    bricks::hybridTangent(*bricks_, bricks_->batches[task.batch], task.u, K);
  }
};

}  // namespace

std::shared_ptr<Solid> makeAssumedStressSolid(SolidCells cells, std::unique_ptr<SolidPoints> points,
                                              const SolidOptions& options) {
  const auto law = points->law()->brickLaw();
  if (!law || !std::holds_alternative<StVenantKirchhoff>(*law))
    throw InputError("assumed stress is for St Venant-Kirchhoff, not for " + points->law()->name(), "elements",
                     "take the enhanced formulation, which is for any material");
  return std::make_shared<AssumedStressSolid>(std::move(cells), std::move(points), options, *law);
}

}  // namespace dovetail::fem::detail
