#include "dovetail/core/error.hpp"
#include "dovetail/mpm/point_solid.hpp"
#include "scatter.hpp"

namespace dovetail::mpm {

namespace {

class PointGravity final : public fem::Term {
public:
  PointGravity(std::shared_ptr<const PointSolid> points, const Vec3& g, std::string name)
      : points_(std::move(points)), g_(g), name_(std::move(name)) {}
  std::string name() const override { return name_; }
  bool usesVelocity() const override { return false; }
  bool hasEnergy() const override { return true; }

  void addForces(const fem::Nodes&, const fem::Instant&, std::span<Vec3> f) override {
    const GridRows& rows = points_->rows();
    detail::addToNodes<Vec3>(rows, f, [&](std::size_t p, detail::OfReached<Vec3>& sums) {
      const Vec3 weight = points_->masses()[p] * g_;
      for (std::size_t a = 0; a < rows.perPoint; ++a) sums[a] += rows.weight[rows.perPoint * p + a] * weight;
    });
  }
  double energy(const fem::Nodes& nodes, const fem::Instant&) override {
    double sum = 0.0;
    const std::vector<Vec3> x = points_->places(nodes);
    for (std::size_t p = 0; p < x.size(); ++p) sum -= points_->masses()[p] * dot(g_, x[p]);
    return sum;
  }

private:
  std::shared_ptr<const PointSolid> points_;
  Vec3 g_;
  std::string name_;
};

}  // namespace

std::shared_ptr<fem::Term> gravity(std::shared_ptr<const PointSolid> points, const Vec3& g, std::string name) {
  if (points == nullptr) throw InputError("there are no points", "mpm::gravity", "give those of makePoints");
  if (!isFinite(g)) throw InputError("it is not finite", "mpm::gravity", "give three numbers, m/s²");
  return std::make_shared<PointGravity>(std::move(points), g, std::move(name));
}

}  // namespace dovetail::mpm
