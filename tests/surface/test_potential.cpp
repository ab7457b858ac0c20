// Forces are the gradient of the contact energy with respect to particle and nodes, at random states.
#include <gtest/gtest.h>

#include <functional>

#include "scenes.hpp"

namespace dovetail::surface {
namespace {

constexpr double radius = 0.35;
const auto laws = elasticLaws(1e4);

struct State {
  std::vector<Vec3> u;
  Vec3 above, direction;  ///< whence and whither the particle is pushed
  double overlap;
};
using Draw = std::function<State(const fem::SolidMesh&, Random&)>;

State onFace(const fem::SolidMesh& mesh, Random& random) {
  return {random.field(mesh.X.size(), 0.05),
          {random(0.6, 3.4), random(0.6, 3.4), 1.0},
          {0, 0, -1},
          random(0.001, 0.05) * radius};
}

/// Over an edge between two faces, exactly in the reference shape and nearly in the deformed one.
State onFaceBoundary(const fem::SolidMesh& mesh, Random& random) {
  State state = onFace(mesh, random);
  state.above.x = std::round(state.above.x) + random(-0.01, 0.01);
  return state;
}

State onNode(const fem::SolidMesh& mesh, Random& random) {
  State state = onFaceBoundary(mesh, random);
  state.above.y = std::round(state.above.y) + random(-0.01, 0.01);
  return state;
}

/// A node pulled down and its neighbours with it: a hollow of about the particle's size.
State inDent(const fem::SolidMesh& mesh, Random& random) {
  State state{random.field(mesh.X.size(), 0.02), {}, {0, 0, -1}, random(0.001, 0.05) * radius};
  const Vec3 centre{2.0, 2.0, 0.0};
  const double depth = random(0.2, 0.5);
  for (std::size_t i = 0; i < mesh.X.size(); ++i) {
    const double r2 = squaredNorm(mesh.X[i] - centre);
    state.u[i].z -= depth * std::exp(-r2);
  }
  state.above = {centre.x + random(-0.1, 0.1), centre.y + random(-0.1, 0.1), 1.0};
  return state;
}

State overSharpEdge(const fem::SolidMesh& mesh, Random& random) {
  State state = onFace(mesh, random);
  const double angle = random(0.15, 0.35) * std::numbers::pi;
  const Vec3 outward{std::cos(angle), 0.0, std::sin(angle)};
  state.above = Vec3{4.0, random(0.6, 3.4), 0.0} + outward;
  state.direction = -outward;
  return state;
}

State overCorner(const fem::SolidMesh& mesh, Random& random) {
  State state = onFace(mesh, random);
  const Vec3 outward = normalized(Vec3{random(0.7, 1.3), random(0.7, 1.3), random(0.7, 1.3)});
  state.above = Vec3{4.0, 4.0, 0.0} + outward;
  state.direction = -outward;
  return state;
}

/// Two sheets of 4 × 2 unit faces that meet along the y axis in a valley of 105°: a sharp edge.
fem::SolidMesh valley() {
  fem::SolidMesh mesh;
  const double slope = 37.5 * std::numbers::pi / 180.0;
  for (int j = 0; j <= 4; ++j)
    for (int i = -2; i <= 2; ++i)
      mesh.X.push_back({i * std::cos(slope), static_cast<double>(j), std::abs(i) * std::sin(slope)});
  for (int j = 0; j < 4; ++j)
    for (int i = 0; i < 4; ++i) {
      const int a = 5 * j + i;
      mesh.faceSets["skin"].push_back({fem::FaceShape::quad4, {a, a + 1, a + 6, a + 5, -1, -1, -1, -1, -1}});
    }
  return mesh;
}

State inValley(const fem::SolidMesh& mesh, Random& random) {
  return {random.field(mesh.X.size(), 0.05),
          {random(-0.02, 0.02), random(0.6, 3.4), 1.0},
          {0, 0, -1},
          random(0.001, 0.05) * radius};
}

struct Coverage {
  int touching = 0, several = 0;
  double worst = 0.0, worstOfSeveral = 0.0;
};

double energyAt(SurfaceCoupler& seam, const dem::Particles& particles, std::span<const Vec3> u, const Vec3& dx,
                std::span<const Vec3> du, double h) {
  dem::Particles moved = particles;
  moved.x[0] += h * dx;
  std::vector<Vec3> displaced(u.begin(), u.end());
  for (std::size_t i = 0; i < displaced.size(); ++i) displaced[i] += h * du[i];
  return respond(seam, moved, displaced, std::vector<Vec3>(u.size()), *laws).energy;
}

/// Largest |dV/ds + F·s| over directions s of particle, nodes and both, relative to the force and |s|.
double gradientError(SurfaceCoupler& seam, const dem::Particles& particles, std::span<const Vec3> u,
                     const Response& response, Random& random) {
  const double size = norm(response.onParticles[0]);
  double worst = 0.0;
  for (int k = 0; k < 3; ++k) {
    const Vec3 dx = k == 1 ? Vec3{} : random.vector(1.0);
    const auto du = random.field(u.size(), k == 0 ? 0.0 : 1.0);
    double work = dot(response.onParticles[0], dx);
    for (std::size_t i = 0; i < u.size(); ++i) work += dot(response.onNodes[i], du[i]);
    const double h = 1e-6 * radius;
    const double slope =
        (energyAt(seam, particles, u, dx, du, h) - energyAt(seam, particles, u, dx, du, -h)) / (2.0 * h);
    worst = std::max(worst, std::abs(slope + work) / size);
  }
  return worst;
}

Coverage survey(const fem::SolidMesh& mesh, const Variant& variant, const Draw& draw, int states, unsigned seed) {
  SurfaceCoupler seam = makeSeam(mesh, variant);
  Random random(seed);
  Coverage coverage;
  dem::Particles particles;
  dem::addParticle(particles, {}, {}, radius, dem::Mass{1.0});
  for (int s = 0; s < states; ++s) {
    const State state = draw(mesh, random);
    pushDown(seam, particles, state.u, state.above, state.direction, state.overlap);
    const Response response = respond(seam, particles, state.u, std::vector<Vec3>(state.u.size()), *laws);
    if (response.contacts == 0) continue;
    ++coverage.touching;
    const double error = gradientError(seam, particles, state.u, response, random);
    coverage.worst = std::max(coverage.worst, error);
    if (response.contacts > 1) {
      ++coverage.several;
      coverage.worstOfSeveral = std::max(coverage.worstOfSeveral, error);
    }
  }
  return coverage;
}

class Potential : public ::testing::TestWithParam<Variant> {
protected:
  void expectGradient(const Draw& draw, unsigned seed, int leastSeveral = 0, const fem::SolidMesh& mesh = unitBlock()) {
    constexpr int states = 80;
    const Coverage coverage = survey(mesh, GetParam(), draw, states, seed);
    EXPECT_EQ(coverage.touching, states);
    EXPECT_GE(coverage.several, leastSeveral);
    EXPECT_LE(coverage.worst, 1e-6) << coverage.several << " states with several contacts, worst "
                                    << coverage.worstOfSeveral;
  }
};

TEST_P(Potential, OnAFace) { expectGradient(onFace, 1); }
TEST_P(Potential, OnTheBoundaryOfTwoFaces) { expectGradient(onFaceBoundary, 2); }
TEST_P(Potential, OnANode) { expectGradient(onNode, 3); }
TEST_P(Potential, InADent) { expectGradient(inDent, 4, GetParam().name == "local" ? 1 : 0); }
TEST_P(Potential, OverASharpEdge) { expectGradient(overSharpEdge, 5); }
TEST_P(Potential, InAValley) { expectGradient(inValley, 7, 5, valley()); }
TEST_P(Potential, OverACorner) { expectGradient(overCorner, 6); }

INSTANTIATE_TEST_SUITE_P(Variants, Potential, ::testing::ValuesIn(allVariants()), VariantName{});

}  // namespace
}  // namespace dovetail::surface
