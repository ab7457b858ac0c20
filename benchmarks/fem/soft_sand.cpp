#include "soft_sand.hpp"

#include <cmath>

#include "dovetail/fem/laws/plasticity.hpp"

namespace dovetail::benchmark {

namespace {

constexpr double young = 50e6, poisson = 0.3, density = 2000.0;
constexpr double peak = 47e3, residual = 20e3;

/// How cohesion stands in k = ξ c, and the angle of η.
struct Cone {
  double tangent, cohesive;
  explicit Cone(double friction)
      : tangent(friction * std::sqrt(9.0 / (9.0 - 12.0 * friction * friction))),
        cohesive(3.0 / std::sqrt(9.0 + 12.0 * tangent * tangent)) {}
};

/// c falls with a = γ/√3.
double slopeOf(const SoftSand& s) { return std::sqrt(3.0) * s.softening / Cone(s.friction).cohesive; }

std::shared_ptr<const fem::PointMaterial> lawOf(const SoftSand& s) {
  const Cone cone(s.friction);
  const double first = peak / cone.cohesive, last = residual / cone.cohesive;
  fem::DruckerPrager law{.youngsModulus = young,
                         .poissonRatio = poisson,
                         .density = density,
                         .cohesion = 0.0,
                         .frictionAngle = std::atan(cone.tangent),
                         .dilatancyAngle = 0.0,
                         .match = fem::ConeMatch::planeStrain};
  law.cohesionCurve = fem::tabulatedYield({{0.0, first}, {(first - last) / slopeOf(s), last}});
  return fem::pointMaterial(law);
}

/// Points of a law that begin under the pressure, and some of them weaker: as if they had flowed already.
class PressedField final : public fem::PointField {
public:
  PressedField(std::shared_ptr<const fem::PointMaterial> law, const SoftSand& s)
      : inner_(fem::pointField(law)), law_(std::move(law)), settings_(s) {}
  std::string name() const override { return inner_->name(); }
  double density() const override { return inner_->density(); }
  bool isSymmetric() const override { return inner_->isSymmetric(); }
  bool hasEnergy() const override { return inner_->hasEnergy(); }
  void open(std::span<const fem::PointPlace> places) override {
    inner_->open(places);
    ByteWriter now;
    inner_->save(now);
    ByteReader reader(now.bytes());
    std::vector<double> history;
    reader(history);
    const std::size_t size = law_->historySize();
    const double strain = -allRoundPressure * (1.0 - 2.0 * poisson) / young;
    for (std::size_t p = 0; p < places.size(); ++p) {
      double* const own = &history[size * p];
      own[0] = own[4] = own[8] = std::exp(strain);
      own[9] = flowBefore(places[p].X);
      own[10] = 3.0 * strain;
    }
    ByteWriter begun;
    begun(history);
    ByteReader back(begun.bytes());
    inner_->load(back);
  }
  void evaluate(const fem::FieldRequest& request) override { inner_->evaluate(request); }
  void commit() override { inner_->commit(); }
  void revert() override { inner_->revert(); }
  void save(ByteWriter& archive) const override { inner_->save(archive); }
  void load(ByteReader& archive) override { inner_->load(archive); }

private:
  double flowBefore(const Vec3& place) const {
    if (!settings_.weakSpot) return 0.0;
    const Vec3 X = place - *settings_.weakSpot;
    return 0.1 * std::exp(-(X.x * X.x + X.y * X.y) / 0.01) * peak / Cone(settings_.friction).cohesive /
           slopeOf(settings_);
  }

  std::shared_ptr<fem::PointField> inner_;
  std::shared_ptr<const fem::PointMaterial> law_;
  SoftSand settings_;
};

}  // namespace

std::shared_ptr<fem::PointField> softSand(const SoftSand& settings) {
  return std::make_shared<PressedField>(lawOf(settings), settings);
}

}  // namespace dovetail::benchmark
