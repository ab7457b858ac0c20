#include "band_biaxial.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <ctime>
#include <numbers>

#include "dovetail/core/error.hpp"
#include "dovetail/fem/elements/solid.hpp"
#include "dovetail/fem/laws/plasticity.hpp"
#include "dovetail/fem/motion/dynamics.hpp"
#include "dovetail/fem/motion/stable_step.hpp"
#include "dovetail/fem/terms/gradient_energy.hpp"
#include "dovetail/fem/terms/loads.hpp"

namespace dovetail::benchmark {

namespace {

constexpr double young = 50e6, poisson = 0.3, density = 2000.0, allRound = 1e5;
constexpr double friction = 0.3, peak = 47e3, residual = 20e3;
constexpr double height = 2.0, rate = 0.05, damping = 20.0;

/// How cohesion stands in k = ξ c, and the angle of η = friction.
struct Cone {
  double tangent = friction * std::sqrt(9.0 / (9.0 - 12.0 * friction * friction));
  double cohesive = 3.0 / std::sqrt(9.0 + 12.0 * tangent * tangent);
};

/// c falls with a = γ/√3.
double slopeOf(double softening) { return std::sqrt(3.0) * softening / Cone().cohesive; }

std::shared_ptr<const fem::PointMaterial> sand(double softening) {
  const Cone cone;
  const double first = peak / cone.cohesive, last = residual / cone.cohesive;
  fem::DruckerPrager law{.youngsModulus = young,
                         .poissonRatio = poisson,
                         .density = density,
                         .cohesion = 0.0,
                         .frictionAngle = std::atan(cone.tangent),
                         .dilatancyAngle = 0.0,
                         .match = fem::ConeMatch::planeStrain};
  law.cohesionCurve = fem::tabulatedYield({{0.0, first}, {(first - last) / slopeOf(softening), last}});
  return fem::pointMaterial(law);
}

/// Points of a law that begin under the pressure, and some of them weaker: as if they had flowed already.
class PressedField final : public fem::PointField {
public:
  PressedField(std::shared_ptr<const fem::PointMaterial> law, double softening)
      : inner_(fem::pointField(law)), law_(std::move(law)), slope_(slopeOf(softening)) {}
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
    const double strain = -allRound * (1.0 - 2.0 * poisson) / young;
    for (std::size_t p = 0; p < places.size(); ++p) {
      double* const own = &history[size * p];
      own[0] = own[4] = own[8] = std::exp(strain);
      const Vec3 X = places[p].X - Vec3{0.0, 0.5, 0.0};
      own[9] = 0.1 * std::exp(-(X.x * X.x + X.y * X.y) / 0.01) * peak / Cone().cohesive / slope_;
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
  std::shared_ptr<fem::PointField> inner_;
  std::shared_ptr<const fem::PointMaterial> law_;
  double slope_;
};

fem::SolidMesh meshOf(const SoftBiaxial& s) {
  fem::SolidMesh mesh = fem::boxOf(s.shape, {s.across, 2 * s.across, 1}, {}, {1.0, height, 1.0});
  for (Vec3& X : mesh.X)
    X.y += s.skew / s.across * std::sin(std::numbers::pi * X.x) * std::sin(3.0 * std::numbers::pi * X.y);
  return mesh;
}

fem::Model modelOf(const SoftBiaxial& s, const fem::SolidMesh& mesh) {
  fem::Model model = fem::makeModel(mesh);
  const auto formulation = s.shape == fem::ElementShape::quad8 ? fem::Formulation::reduced : fem::Formulation::standard;
  model.add(fem::makeSolid(mesh, std::make_shared<PressedField>(sand(s.softening), s.softening),
                           {.formulation = formulation, .name = "sand"}));
  if (s.modulus > 0.0) model.add(fem::gradientEnergy(mesh, {.modulus = s.modulus}));
  for (const char* const side : {"x-", "x+"})
    model.add(fem::deadPressure(mesh, fem::faceSet(mesh, side), allRound, std::string("pressure on ") + side));
  model.add(fem::massDamping(damping));
  const std::vector<int>& bottom = fem::nodeSet(mesh, "y-");
  model.constraints.hold(bottom, fem::componentY);
  model.constraints.hold(std::array{bottom.front()}, fem::componentX);
  model.constraints.prescribe(fem::nodeSet(mesh, "y+"), 1, [](double t) {
    constexpr double start = 0.005 / rate;  // s, to come to its speed
    return -height * rate * (t < start ? 0.5 * t * t / start : t - 0.5 * start);
  });
  fem::addMass(model);
  return model;
}

void lookAtShear(const fem::Solid::Sample& sample, BiaxialCourse& course) {
  std::vector<std::pair<double, double>> shear;  // and volume
  double all = 0.0, volume = 0.0, part = 0.0, taken = 0.0;
  for (std::size_t p = 0; p < sample.volume.size(); ++p) {
    const double* const F = &sample.F[9 * p];
    shear.emplace_back(std::hypot(F[0] - F[4], F[1] + F[3]), sample.volume[p]);
    all += shear.back().first * sample.volume[p];
    volume += sample.volume[p];
  }
  std::ranges::sort(shear, std::greater<>());
  course.largest = shear.front().first;
  for (std::size_t k = 0; k < shear.size() && part < 0.5 * all; ++k)
    part += shear[k].first * shear[k].second, taken += shear[k].second;
  course.fraction = taken / volume;
}

}  // namespace

BiaxialCourse pressTogether(const SoftBiaxial& s) {
  const fem::SolidMesh mesh = meshOf(s);
  fem::Model model = modelOf(s, mesh);
  BiaxialCourse course;
  const std::clock_t began = std::clock();
  course.step = 0.8 * fem::stableStep(model).dt;
  fem::ExplicitIntegrator run(model, course.step, {.energyEvery = 50, .checkEvery = 10});
  const std::vector<int>& plate = fem::nodeSet(mesh, "y+");
  const auto strain = [&] { return -model.nodes.u[static_cast<std::size_t>(plate.front())].y / height; };
  double sum = 0.0, mark = 0.0025;
  int count = 0, looks = 0;
  try {
    while (strain() < s.end - 1e-9) {
      run.step();
      ++course.steps;
      for (const int n : plate) sum += model.nodes.f[static_cast<std::size_t>(n)].y;
      ++count;
      if (strain() < mark) continue;
      if (++looks % 4 == 0) course.axial.push_back(sum / count);
      mark += 0.0025;
      sum = 0.0, count = 0;
    }
  } catch (const NumericalError&) {
    course.turned = strain();
  }
  course.seconds = static_cast<double>(std::clock() - began) / CLOCKS_PER_SEC;
  if (course.turned == 0.0)
    lookAtShear(dynamic_cast<fem::Solid&>(*model.terms.front()).sample(model.nodes, {model.t, 0.0}), course);
  course.residual = run.ledger().largestResidual() / std::abs(run.ledger().joules("supports"));
  return course;
}

}  // namespace dovetail::benchmark
