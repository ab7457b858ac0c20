// What SurfaceCoupler::wallWork books.
#include <gtest/gtest.h>

#include <functional>

#include "scenes.hpp"

namespace dovetail::surface {
namespace {

constexpr double radius = 0.35;
const auto laws = elasticLaws(1e4);

/// A prescribed motion of one particle and all nodes while they touch, t from 0 to 1. The contact stays in one facet,
/// or on the smooth surface between the knots in the middles of the faces, because crossing would leave a kink in the
/// force.
struct Motion {
  double startX = 1.4;
  fem::SolidMesh mesh = unitBlock();
  std::vector<Vec3> mode = Random(1).field(mesh.X.size(), 0.03), other = Random(2).field(mesh.X.size(), 0.03);

  std::vector<Vec3> u(double t) const {
    std::vector<Vec3> values(mode.size());
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = (0.3 + std::sin(2.0 * t)) * mode[i] + t * t * other[i];
    return values;
  }
  Vec3 x(double t) const {
    return {startX + 0.2 * t, 1.15 + 0.03 * std::sin(2.0 * t), radius - 0.06 - 0.02 * std::cos(4.0 * t)};
  }
};

struct Books {
  double energyChange = 0.0, workOnParticle = 0.0, workOnSkin = 0.0, workOnNodes = 0.0;
  double residual() const { return energyChange + workOnParticle + workOnSkin; }
};

/// Trapezoidal work of the contact on the particle and of the load on the nodes, with `steps` exchanges.
Books book(SurfaceCoupler seam, int steps, double startX = 1.4) {
  Motion motion;
  motion.startX = startX;
  seam.bookWallWork(true);
  Books books;
  dem::Particles particles;
  dem::addParticle(particles, motion.x(0), {}, radius, dem::Mass{1.0});
  double firstEnergy = 0.0, energy = 0.0;
  Vec3 lastForce, lastX;
  std::vector<Vec3> lastLoad, lastU;
  for (int step = 0; step <= steps; ++step) {
    const double t = static_cast<double>(step) / steps;
    const auto u = motion.u(t);
    particles.x[0] = motion.x(t);
    particles.f[0] = {};
    energy = seam.exchange(particles, u, std::vector<Vec3>(u.size()), *laws, 1.0 / steps).storedEnergy();
    EXPECT_GT(energy, 0.0);
    const auto load = seam.load().force;
    if (step == 0) {
      firstEnergy = energy;
      EXPECT_EQ(seam.wallWork(), 0.0) << "no work before the second exchange, wherever the skin begins";
    } else {
      books.workOnParticle += 0.5 * dot(lastForce + particles.f[0], particles.x[0] - lastX);
      for (std::size_t i = 0; i < u.size(); ++i) books.workOnNodes += 0.5 * dot(lastLoad[i] + load[i], u[i] - lastU[i]);
    }
    lastForce = particles.f[0];
    lastX = particles.x[0];
    lastLoad = load;
    lastU = u;
  }
  books.energyChange = energy - firstEnergy;
  books.workOnSkin = seam.wallWork();
  return books;
}

/// @param make  gives a new seam
template <class Make>
void expectSecondOrder(Make&& make, double startX = 1.4) {
  const Books coarse = book(make(), 100, startX), fine = book(make(), 200, startX);
  EXPECT_GT(std::abs(fine.workOnSkin), 0.05 * std::abs(fine.energyChange));
  EXPECT_LT(std::abs(fine.residual()), 2e-3 * std::abs(fine.workOnSkin));
  const double order = std::log2(std::abs(coarse.residual() / fine.residual()));
  EXPECT_GT(order, 1.8);
  EXPECT_LT(order, 2.2);
}

SurfaceCoupler flatSeam(const Variant& variant, double margin = 0.0) {
  return SurfaceCoupler(carriedSkin(unitBlock(), variant), {dem::EdgeRule::projected, margin});
}

TEST(WallWork, ClosesTheEnergyOfThePrescribedMotion) {
  for (const Variant& variant : flatVariants()) expectSecondOrder([&] { return flatSeam(variant); });
}

TEST(WallWork, ClosesItOnTheSmoothSurface) {
  for (const Variant& variant : flatVariants())
    expectSecondOrder([&] { return SurfaceCoupler(makeSmoothSurface(carriedSkin(unitBlock(), variant))); }, 1.65);
}

TEST(WallWork, ClosesItForTheSpreadLoadWhoseNodesGetOtherWork) {
  const fem::SolidMesh mesh = unitBlock();
  const auto faces = mesh.faceSets.at("skin");
  const auto spreadSeam = [&] {
    SurfaceCoupler seam(makeSkin(mesh.X, faces));
    seam.spreadLoad(SpreadLoad({{cg::KernelShape::lucy, 2, 1.3}, {}}, mesh.X, seam.skin(), faces));
    return seam;
  };
  const Books spread = book(spreadSeam(), 100);
  EXPECT_LT(std::abs(spread.residual()), 2e-3 * std::abs(spread.workOnSkin));
  EXPECT_GT(std::abs(spread.workOnNodes - spread.workOnSkin), 0.05 * std::abs(spread.workOnSkin));
}

/// To round-off where vertices are linear in the nodes, else with the error of the trapezoidal rule.
TEST(WallWork, IsTheWorkOfTheLoadForTheAdjointPair) {
  for (const Variant& variant : flatVariants()) {
    const Books books = book(flatSeam(variant), 50);
    EXPECT_NEAR(books.workOnNodes, books.workOnSkin, 1e-12 * std::abs(books.workOnSkin)) << variant.name;
  }
}

/// Vertices that come into use with new candidates have not moved unbooked before.
TEST(WallWork, DoesNotDependOnTheMargin) {
  const double reference = book(flatSeam({"local"}, 2.0), 50).workOnSkin;
  for (double margin : {1e-3, 0.03, 0.1})
    EXPECT_NEAR(book(flatSeam({"local"}, margin), 50).workOnSkin, reference, 1e-13 * std::abs(reference));
}

TEST(WallWork, StandsStillWhenSwitchedOff) {
  const Motion motion;
  SurfaceCoupler seam = flatSeam({"local"});
  dem::Particles particles;
  dem::addParticle(particles, motion.x(0), {}, radius, dem::Mass{1.0});
  for (double t : {0.0, 0.5, 1.0}) {
    const auto u = motion.u(t);
    seam.exchange(particles, u, u, *laws, 0.5);
  }
  EXPECT_EQ(seam.wallWork(), 0.0);
}

}  // namespace
}  // namespace dovetail::surface
