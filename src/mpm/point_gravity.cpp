#include "dovetail/core/error.hpp"
#include "dovetail/mpm/point_solid.hpp"
#include "scatter.hpp"

namespace dovetail::mpm {

namespace {

class PointGravity final : public fem::Term {
public:
  PointGravity(std::shared_ptr<const PointSolid> points, std::function<Vec3(double)> g, bool steady, std::string name)
      : points_(std::move(points)), g_(std::move(g)), steady_(steady), name_(std::move(name)) {}
  std::string name() const override { return name_; }
  bool usesVelocity() const override { return false; }
  bool hasEnergy() const override { return steady_; }

  void addForces(const fem::Nodes&, const fem::Instant& now, std::span<Vec3> f) override {
    const GridRows& rows = points_->rows();
    const Vec3 g = g_(now.t);
    detail::addToNodes<Vec3>(rows, f, [&](std::size_t p, detail::OfReached<Vec3>& sums) {
      const Vec3 weight = points_->masses()[p] * g;
      for (std::size_t a = 0; a < rows.perPoint; ++a) sums[a] += rows.weight[rows.perPoint * p + a] * weight;
    });
  }
  double energy(const fem::Nodes& nodes, const fem::Instant& now) override {
    if (!steady_) return 0.0;
    const Vec3 g = g_(now.t);
    double sum = 0.0;
    const std::vector<Vec3> x = points_->places(nodes);
    for (std::size_t p = 0; p < x.size(); ++p) sum -= points_->masses()[p] * dot(g, x[p]);
    return sum;
  }

private:
  std::shared_ptr<const PointSolid> points_;
  std::function<Vec3(double)> g_;
  bool steady_;
  std::string name_;
};

void requirePoints(const PointSolid* points) {
  if (points == nullptr) throw InputError("there are no points", "mpm::gravity", "give those of makePoints");
}

}  // namespace

std::shared_ptr<fem::Term> gravity(std::shared_ptr<const PointSolid> points, const Vec3& g, std::string name) {
  requirePoints(points.get());
  if (!isFinite(g)) throw InputError("it is not finite", "mpm::gravity", "give three numbers, m/s²");
  return std::make_shared<PointGravity>(
      std::move(points), [g](double) { return g; }, true, std::move(name));
}

std::shared_ptr<fem::Term> gravity(std::shared_ptr<const PointSolid> points, std::function<Vec3(double)> g,
                                   std::string name) {
  requirePoints(points.get());
  if (!g) throw InputError("there is no function", "mpm::gravity", "give one, or a vector");
  return std::make_shared<PointGravity>(std::move(points), std::move(g), false, std::move(name));
}

}  // namespace dovetail::mpm
