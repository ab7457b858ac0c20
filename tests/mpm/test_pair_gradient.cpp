// The energy of the gradient of F between points: identities at random states, exact values on lattices.
#include <gtest/gtest.h>

#include <cmath>

#include "dovetail/core/error.hpp"
#include "dovetail/core/parallel.hpp"
#include "dovetail/fem/motion/dynamics.hpp"
#include "dovetail/fem/motion/stable_step.hpp"
#include "dovetail/linalg/block_matrix.hpp"
#include "dovetail/mpm/pair_gradient.hpp"
#include "random_points.hpp"

namespace dovetail::mpm::test {
namespace {

constexpr double modulus = 300.0;

struct Body {
  std::shared_ptr<PointSolid> points;
  std::shared_ptr<fem::Term> gradient;
  fem::Model model;

  Body(const MaterialPoints& start, const PointOptions& options, double D = modulus)
      : points(makePoints(start, elastic(), options)),
        gradient(pairGradient(points, start, {.modulus = D})),
        model(makeModel(points)) {
    model.add(gradient);
    fem::addMass(model);
  }
  std::vector<Vec3> forces() {
    std::vector<Vec3> f(model.nodes.X.size());
    gradient->addForces(model.nodes, {}, f);
    return f;
  }
  double energy() { return gradient->energy(model.nodes, {}); }
  void move(double size, Random& random, bool plane) {
    for (std::size_t n = 0; n < model.nodes.u.size(); ++n) {
      model.nodes.u[n] += random.vector(size, plane);
      for (int c = 0; c < 3; ++c)
        if (model.nodes.fixed[n] >> c & 1) model.nodes.u[n][c] = 0.0;
    }
  }
  void renew() {
    points->requireValid(model.nodes, "now", fem::Scrutiny::inversion);  // finds F
    points->renewNodes(model.nodes, 0.1);
  }
};

/// Calls check(body, plane, random) on scattered points: as they start, and after a renewal of the deformed body.
template <class Check>
void forEachBody(const std::vector<GridBorder>& borders, Check&& check) {
  Random random;
  for (const bool plane : {true, false})
    for (const Shape shape : {Shape::quadratic, Shape::cubic, Shape::gimp}) {
      SCOPED_TRACE(std::string(name(shape)) + (plane ? " plane" : ""));
      Body body(scattered(plane ? 90 : 150, plane, random),
                {.grid = {.spacing = plane ? 0.2 : 0.4, .shape = shape, .plane = plane, .borders = borders}});
      body.move(0.01, random, plane);
      check(body, plane, random);
      body.renew();
      body.move(0.01, random, plane);
      check(body, plane, random);
    }
}

double sumOfNorms(const std::vector<Vec3>& f) {
  double sum = 0.0;
  for (const Vec3& one : f) sum += norm(one);
  return sum;
}

TEST(PairGradient, ForcesAreDerivativesOfTheEnergyAndTangentsOfForces) {
  forEachBody({{.axis = 0, .place = 0.0, .kind = BorderKind::held}, {.axis = 1, .place = 0.0}},
              [](Body& body, bool plane, Random& random) {
                std::vector<Vec3> way(body.model.nodes.u.size());
                for (Vec3& w : way) w = random.vector(1.0, plane);
                const std::vector<Vec3> u = body.model.nodes.u, force = body.forces();
                const auto at = [&](double step) {
                  for (std::size_t n = 0; n < u.size(); ++n) body.model.nodes.u[n] = u[n] + step * way[n];
                };
                double power = 0.0;
                for (std::size_t n = 0; n < u.size(); ++n) power += dot(force[n], way[n]);
                constexpr double d = 1e-3;  // the energy is quadratic
                at(d);
                const double after = body.energy();
                const std::vector<Vec3> forward = body.forces();
                at(-d);
                const double before = body.energy();
                at(0.0);
                const double scale = sumOfNorms(force);
                EXPECT_NEAR((after - before) / (2.0 * d), -power, 1e-9 * scale);
                linalg::BlockMatrix K = fem::zeroTangent(body.model);
                body.gradient->addTangent(body.model.nodes, {}, K);
                std::vector<Vec3> pull(u.size());
                K.multiply(way, pull);
                for (std::size_t n = 0; n < u.size(); ++n)
                  EXPECT_LE(norm(forward[n] - force[n] + d * pull[n]), 1e-11 * scale);
                EXPECT_GT(scale, 0.0);
              });
}

TEST(PairGradient, HasNoSumAndNoMomentAndTurnsWithTheBody) {
  forEachBody({}, [](Body& body, bool, Random&) {
    const std::vector<Vec3> f = body.forces();
    const double scale = sumOfNorms(f), energy = body.energy();
    Vec3 sum, moment;
    fem::Nodes& nodes = body.model.nodes;
    for (std::size_t n = 0; n < f.size(); ++n) sum += f[n], moment += cross(nodes.X[n] + nodes.u[n], f[n]);
    EXPECT_LE(norm(sum), 1e-13 * scale);
    EXPECT_LE(norm(moment), 1e-13 * scale);
    const double c = std::cos(1.0), s = std::sin(1.0);
    for (std::size_t n = 0; n < f.size(); ++n) {
      const Vec3 x = nodes.X[n] + nodes.u[n];
      nodes.u[n] = Vec3{c * x.x - s * x.y, s * x.x + c * x.y, x.z} - nodes.X[n];
    }
    EXPECT_NEAR(body.energy(), energy, 1e-12 * energy);
    const std::vector<Vec3> turned = body.forces();
    for (std::size_t n = 0; n < f.size(); ++n)
      EXPECT_LE(norm(turned[n] - Vec3{c * f[n].x - s * f[n].y, s * f[n].x + c * f[n].y, f[n].z}), 1e-12 * scale);
  });
}

TEST(PairGradient, UniformDeformationHasNoForceAndRenewalsKeepTheEnergy) {
  forEachBody({}, [](Body& body, bool plane, Random&) {
    const double scale = sumOfNorms(body.forces()), energy = body.energy();
    fem::Nodes nodes = body.model.nodes;
    body.renew();
    EXPECT_NEAR(body.energy(), energy, 1e-12 * energy);
    EXPECT_GT(energy, 0.0);
    // Back to where all points are as they started, up to one F.
    Body fresh({{{0, 0, 0}, {0.1, 0, 0}, {0, 0.1, 0}, {0.1, 0.1, 0}}, {}, {0.01, 0.01, 0.01, 0.01}},
               {.grid = {.spacing = 0.2}});
    for (std::size_t n = 0; n < fresh.model.nodes.u.size(); ++n) {
      const Vec3& X = fresh.model.nodes.X[n];
      fresh.model.nodes.u[n] = {0.1 * X.x + 0.2 * X.y, -0.1 * X.x + 0.3 * X.y, 0.0};
    }
    EXPECT_LE(sumOfNorms(fresh.forces()), 1e-12 * scale) << plane;
  });
}

/// Stored on n points along each axis whose F falls by `slope` per metre, J.
double storedOnLattice(int n, bool plane) {
  constexpr double d = 0.1;
  const double size = n * d;
  Body body(block({}, {size, size, size}, d, plane), {.grid = {.spacing = 2.0 * d, .plane = plane}});
  for (std::size_t k = 0; k < body.model.nodes.u.size(); ++k) {
    const Vec3& X = body.model.nodes.X[k];
    body.model.nodes.u[k] = {0.5 * 0.3 * X.x * X.x, 0.2 * X.x * X.y + 0.5 * 0.4 * X.y * X.y, 0.0};
  }
  return body.energy();
}

TEST(PairGradient, IsExactForLinearDeformationOnLattices) {
  // u_x = 0.15 x², u_y = 0.2 x y + 0.2 y²: ∂F₁₁/∂x = 0.3, ∂F₂₁/∂y = ∂F₂₂/∂x = 0.2, ∂F₂₂/∂y = 0.4. A body of n points
  // stores e n² (n³) less what its edges and corners lack, a polynomial in n.
  constexpr double perVolume = 0.5 * modulus * (0.09 + 0.04 + 0.04 + 0.16);
  const auto at = [](int n) { return storedOnLattice(n, true); };
  EXPECT_NEAR(0.5 * (at(12) - 2.0 * at(11) + at(10)), perVolume * 0.01, 1e-9 * perVolume * 0.01);
  const auto solid = [](int n) { return storedOnLattice(n, false); };
  EXPECT_NEAR((solid(9) - 3.0 * solid(8) + 3.0 * solid(7) - solid(6)) / 6.0, perVolume * 1e-3, 1e-8 * perVolume * 1e-3);
}

TEST(PairGradient, IsInTheStableStepAndTheSameOnAnyNumberOfThreads) {
  Random random;
  const MaterialPoints start = scattered(300, true, random);
  Body hardly(start, {.grid = {.spacing = 0.13}}, 1e-9);
  const double alone = fem::stableStep(hardly.model).dt;
  Body body(start, {.grid = {.spacing = 0.13}}, 3e4);
  const double bound = fem::stableStep(body.model).dt, exact = fem::assembledStableStep(body.model, 1e-3);
  EXPECT_LT(bound, 0.8 * alone);
  EXPECT_LT(bound, exact);
  EXPECT_GT(bound, 0.1 * exact);
  body.move(0.01, random, true);
  setThreads(1);
  const std::vector<Vec3> one = body.forces();
  const double energy = body.energy();
  setThreads(2);
  const std::vector<Vec3> two = body.forces();
  EXPECT_EQ(energy, body.energy());
  for (std::size_t n = 0; n < one.size(); ++n) EXPECT_EQ(norm(one[n] - two[n]), 0.0);
  setThreads(1);
}

TEST(PairGradient, RefusesWhatHasNoMeaning) {
  Random random;
  const MaterialPoints start = scattered(60, true, random);
  const PointOptions options{.grid = {.spacing = 0.2}};
  Body body(start, options);
  EXPECT_THROW(pairGradient(nullptr, start, {.modulus = 1.0}), InputError);
  for (const double bad : {0.0, -1.0, std::nan("")})
    EXPECT_THROW(pairGradient(body.points, start, {.modulus = bad}), InputError);
  EXPECT_THROW(pairGradient(body.points, scattered(50, true, random), {.modulus = 1.0}), InputError);
  body.renew();
  EXPECT_THROW(pairGradient(body.points, start, {.modulus = 1.0}), InputError);
}

}  // namespace
}  // namespace dovetail::mpm::test
