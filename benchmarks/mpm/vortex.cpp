// A ring of neo-Hookean material whose circles turn by α(R, t) about their centre, driven by the body force that this
// takes (the generalised vortex of Kamojjala, Brannon, Sadeghirad & Guilkey 2015, Engng with Computers 31).
#include <cmath>
#include <cstdio>
#include <numbers>
#include <vector>

#include "cases.hpp"
#include "dovetail/fem/laws/point_laws.hpp"
#include "dovetail/fem/motion/dynamics.hpp"
#include "dovetail/fem/motion/stable_step.hpp"
#include "scenes.hpp"

namespace dovetail::benchmark {

namespace {

constexpr double inner = 0.75, outer = 1.25, youngs = 1000.0, poisson = 0.3, pi = std::numbers::pi;
constexpr double mu = youngs / (2.0 * (1.0 + poisson)), lambda = 2.0 * mu * poisson / (1.0 - 2.0 * poisson);

/// α = A sin(π t) h(R), h = (1 − 4 s²)², s from −½ to ½ over the ring: no strain at its faces.
struct Turn {
  double amplitude;
  static constexpr double wide = outer - inner;

  double h(double R) const { return std::pow(1.0 - 4.0 * s(R) * s(R), 2); }
  double slope(double R) const { return -16.0 * s(R) * (1.0 - 4.0 * s(R) * s(R)) / wide; }
  double curvature(double R) const { return (-16.0 + 192.0 * s(R) * s(R)) / (wide * wide); }
  double angle(double R, double t) const { return amplitude * std::sin(pi * t) * h(R); }

  Vec3 place(const Vec3& X, double t) const {
    const double a = angle(norm(X), t), c = std::cos(a), d = std::sin(a);
    return {c * X.x - d * X.y, d * X.x + c * X.y, 0.0};
  }
  Vec3 velocity(const Vec3& X, double t) const {
    const Vec3 x = place(X, t);
    return amplitude * pi * std::cos(pi * t) * h(norm(X)) * Vec3{-x.y, x.x, 0.0};
  }
  /// With P = μ (F − F⁻ᵀ), F = Q(α) (1 + γ e_Θ ⊗ e_R), γ = R α′:
  /// Div P = Q ((τ′ + 2 τ/R) e_Θ − α′ τ e_R), τ = μ γ.
  Vec3 bodyForce(const Vec3& X, double t) const {
    const double R = norm(X), wave = amplitude * std::sin(pi * t), rate = amplitude * pi * std::cos(pi * t) * h(R);
    const double d1 = wave * slope(R), d2 = wave * curvature(R), tau = mu * R * d1, dtau = mu * (d1 + R * d2);
    const double along = -pi * pi * wave * h(R) * R - (dtau + 2.0 * tau / R) / density;
    const double out = -rate * rate * R + d1 * tau / density;
    const Vec3 x = place(X, t), radial = 1.0 / R * x;
    return along * Vec3{-radial.y, radial.x, 0.0} + out * radial;
  }

private:
  static double s(double R) { return (R - 0.5 * (inner + outer)) / wide; }
};

/// On circles, each point with its part of the area.
mpm::MaterialPoints ring(double distance, const Turn& turn) {
  mpm::MaterialPoints points;
  const int circles = static_cast<int>(std::lround((outer - inner) / distance));
  const double across = (outer - inner) / circles;
  for (int i = 0; i < circles; ++i) {
    const double R = inner + (i + 0.5) * across;
    const int count = static_cast<int>(std::lround(2.0 * pi * R / distance));
    for (int k = 0; k < count; ++k) {
      const double at = 2.0 * pi * (k + 0.5 * (i % 2)) / count;
      points.x.push_back({R * std::cos(at), R * std::sin(at), 0.0});
      points.v.push_back(turn.velocity(points.x.back(), 0.0));
      points.volume.push_back(2.0 * pi * R * across / count);
    }
  }
  return points;
}

struct Setting {
  double amplitude = 0.1, end = 0.5, renewal = 0.25;
  mpm::Shape shape = mpm::Shape::quadratic;
  mpm::Transfer transfer = mpm::Transfer::flip;
};

struct Answer {
  double error = 0.0;  ///< root of the mean square over points and time, over the largest displacement
  std::int64_t renewals = 0;
};

Answer turnRing(const Setting& set, int cells) {
  const double spacing = 2.0 * outer / cells;
  const Turn turn{set.amplitude};
  const mpm::MaterialPoints points = ring(0.5 * spacing, turn);
  const auto field = fem::pointField(fem::pointMaterial(fem::CoupledNeoHookean{lambda, mu, density}));
  const auto solid = mpm::makePoints(
      points, field,
      {.grid = {.spacing = spacing, .shape = set.shape}, .transfer = set.transfer, .renewal = set.renewal});
  fem::Model model = mpm::makeModel(solid);
  model.add(push(solid, [&](std::size_t p, const Vec3&, double t) { return turn.bodyForce(points.x[p], t); }));
  fem::addMass(model);
  const double dt = set.end / std::ceil(set.end / std::min(0.3 * fem::stableStep(model).dt, 0.2 * spacing));
  fem::ExplicitIntegrator run(model, dt, {.energyEvery = 0});
  // The error is a wave that swings across the ring: one instant alone may find it anywhere.
  constexpr int instants = 20;
  double all = 0.0;
  for (int k = 1; k <= instants; ++k) {
    const double t = set.end * k / instants;
    run.runUntil(t);
    const std::vector<Vec3> x = solid->places(model.nodes);
    for (std::size_t p = 0; p < x.size(); ++p) all += squaredNorm(x[p] - turn.place(points.x[p], t)) / instants;
  }
  return {std::sqrt(all / static_cast<double>(points.x.size())) / (set.amplitude * 0.5 * (inner + outer)),
          solid->renewals()};
}

/// What more renewals cost.
void showRenewals(bool quick) {
  constexpr double renewal = 0.004;
  std::printf("| 0.1 | 0.5 | apic | quadratic, renewed after %g of a cell | ", renewal);
  std::string line;
  std::int64_t renewals = 0;
  for (const int cells : {32, 64, 128}) {
    if (quick && cells > 64) continue;
    const Answer a = turnRing({.renewal = renewal, .transfer = mpm::Transfer::apic}, cells);
    char text[32];
    std::snprintf(text, sizeof text, " %.3f |", 100.0 * a.error);
    line += text, renewals = a.renewals;
  }
  std::printf("%ld |%s |\n", static_cast<long>(renewals), line.c_str());
}

}  // namespace

bool vortex(bool quick) {
  bool holds = true;
  std::printf(
      "Error of displacements in %%, over all time, at cells across the ring's outer circle\n\n"
      "| turned by, rad | until, s | transfer | shape | renewals (finest) | 32 | 64 | 128 | order |\n"
      "|---|---|---|---|---|---|---|---|---|\n");
  for (const double amplitude : {0.1, 0.4})
    for (const mpm::Transfer transfer : {mpm::Transfer::flip, mpm::Transfer::apic})
      for (const mpm::Shape shape : {mpm::Shape::quadratic, mpm::Shape::cubic}) {
        if (quick && amplitude != 0.1) continue;
        if (amplitude != 0.1 && shape != mpm::Shape::quadratic) continue;
        const Setting set{.amplitude = amplitude, .shape = shape, .transfer = transfer};
        std::vector<double> error;
        std::string line;
        std::int64_t renewals = 0;
        try {
          for (const int cells : {32, 64, 128}) {
            if (quick && cells > 64) continue;
            const Answer answer = turnRing(set, cells);
            error.push_back(answer.error), renewals = answer.renewals;
            char text[32];
            std::snprintf(text, sizeof text, " %.3f |", 100.0 * answer.error);
            line += text;
          }
          std::printf("| %g | %g | %s | %s | %ld |%s %.2f |\n", amplitude, set.end, nameOf(transfer), name(shape),
                      static_cast<long>(renewals), line.c_str(), std::log2(error[error.size() - 2] / error.back()));
        } catch (const std::exception& broken) {
          std::printf("| %g | %g | %s | %s | |%s %s |\n", amplitude, set.end, nameOf(transfer), name(shape),
                      line.c_str(), broken.what());
        }
        std::fflush(stdout);
        if (!quick && amplitude == 0.1 && shape == mpm::Shape::quadratic)
          holds = holds && error.size() > 2 && std::log2(error[1] / error[2]) > 1.8;
      }
  showRenewals(quick);
  return holds;
}

}  // namespace dovetail::benchmark
