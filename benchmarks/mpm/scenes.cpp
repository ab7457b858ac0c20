#include "scenes.hpp"

#include <cmath>
#include <ctime>

#include "dovetail/fem/laws/point_laws.hpp"

namespace dovetail::benchmark {

mpm::MaterialPoints box(const Vec3& low, double width, double height, double distance) {
  mpm::MaterialPoints points;
  const auto along = [&](double length) { return static_cast<int>(std::lround(length / distance)); };
  for (int j = 0; j < along(height); ++j)
    for (int i = 0; i < along(width); ++i) {
      points.x.push_back(low + Vec3{distance * (i + 0.5), distance * (j + 0.5), 0.0});
      points.volume.push_back(distance * distance);
    }
  points.v.resize(points.x.size());
  return points;
}

std::shared_ptr<fem::PointField> neoHookeanField(double youngs, double poisson) {
  return fem::pointField(fem::pointMaterial(fem::neoHookean(youngs, poisson, density)));
}

const char* nameOf(mpm::Transfer transfer) { return transfer == mpm::Transfer::flip ? "flip" : "apic"; }

namespace {

class Push final : public fem::Term {
public:
  Push(std::shared_ptr<const mpm::PointSolid> points, PointAcceleration acceleration)
      : points_(std::move(points)), acceleration_(std::move(acceleration)) {}
  std::string name() const override { return "push"; }
  bool usesVelocity() const override { return false; }
  void addForces(const fem::Nodes& nodes, const fem::Instant& now, std::span<Vec3> f) override {
    const mpm::GridRows& rows = points_->rows();
    const std::vector<Vec3> x = points_->places(nodes);
    for (std::size_t p = 0; p < x.size(); ++p) {
      const Vec3 force = points_->masses()[p] * acceleration_(p, x[p], now.t);
      const std::size_t begin = rows.perPoint * static_cast<std::size_t>(rows.cell[p]);
      for (std::size_t a = 0; a < rows.perPoint; ++a)
        f[static_cast<std::size_t>(rows.node[begin + a])] +=
            mpm::flipped(rows.weight[rows.perPoint * p + a] * force, rows.flip[begin + a]);
    }
  }

private:
  std::shared_ptr<const mpm::PointSolid> points_;
  PointAcceleration acceleration_;
};

}  // namespace

std::shared_ptr<fem::Term> push(std::shared_ptr<const mpm::PointSolid> points, PointAcceleration acceleration) {
  return std::make_shared<Push>(std::move(points), std::move(acceleration));
}

double seconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

}  // namespace dovetail::benchmark
