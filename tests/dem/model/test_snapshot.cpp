// What a snapshot of a model holds: the fields made of it keep the balance of momentum, whatever acts.
#include <gtest/gtest.h>

#include <Eigen/Core>

#include "dovetail/cg/averages.hpp"
#include "dovetail/cg/fields.hpp"
#include "dovetail/cg/wall_traction.hpp"
#include "dovetail/core/error.hpp"
#include "dovetail/dem/bodies/body_term.hpp"
#include "dovetail/dem/model/loads.hpp"
#include "dovetail/dem/model/snapshot.hpp"
#include "dovetail/dem/model/walls.hpp"
#include "walls/wall_scenes.hpp"

namespace dovetail::dem {
namespace {

using Eigen::Vector3d;

Vector3d eigen(const Vec3& a) { return {a.x, a.y, a.z}; }

/// Grains of many sizes between a plane and a wavy mesh, in a cell that repeats along x and y; some are bonded, one
/// clump lies across the border. Moved by `origin`.
Model scene(const Vec3& origin) {
  Model m;
  m.laws = makeContactLaws(ContactLaw<LinearSpringDashpot, TangentialSpring, RollingAndTwisting>{
      {2e4, 0.6}, {6e3, 0.4}, {{0.2, 0.3, 0.1}, {0.1, 0.3, 0.1}}, {}});
  m.gravity = {1, -2, -9};
  m.refusesUnstableSteps = false;
  m.pairs.setSkin(0.02);
  m.pairs.setPeriodicity({{origin, origin + Vec3{1, 1, 1}}, {true, true, false}});
  Random random(12);
  for (int i = 0; i < 160; ++i)
    addParticle(m.particles, origin + Vec3{random(0.0, 1.0), random(0.0, 1.0), random(0.03, 0.45)}, random.vector(1.0),
                random(0.03, 0.08), Density{1000.0});
  switchOnRotation(m.particles);
  for (Vec3& w : m.particles.omega) w = random.vector(10.0);
  const std::vector<Vec3> centre{{0, 0, 0}, {0.08, 0, 0}, {0.2, 0.05, 0}};
  addClump(m, makeClumpShape(centre, std::vector<double>(3, 0.06), Density{1000.0}), origin + Vec3{0.98, 0.5, 0.25}, {},
           {1, 2, 3}, {3, 2, 1});
  addWall(m, makePlane(origin, {0, 0, 1}));
  MeshWall& mesh = addWall(m, MeshWall{});
  mesh.wall = squares(4, 4, 0.25);
  for (Vec3& x : mesh.wall.x) x = origin + Vec3{x.x, x.y, 0.45 + 0.05 * std::sin(6.2831853 * x.x)};
  const Vec3 place = origin + Vec3{0.5, 0.5, 0.25};
  for (int k = 0; k < 3; ++k)
    addParticle(m.particles, place + (0.15 * k) * Vec3{1, 0.2, 0.1}, random.vector(1.0), 0.05, Density{1000.0});
  for (int k = 0; k < 2; ++k) {
    const int i = static_cast<int>(m.particles.size()) - 3 + k;
    addBond(bonds(m), m.particles, m.pairs.periodicity(), i, i + 1,
            {.youngsModulus = 1e6, .poissonRatio = 0.2, .tensileStrength = 1e12, .shearStrength = 1e12});
  }
  run(m, 1e-5, 20);
  return m;
}

/// The snapshot with the acceleration by all forces in place of the velocity: its momentum density is Σ F W.
Snapshot withForces(const Model& m) {
  Snapshot snapshot = takeSnapshot(m);
  const BodyTerm& rigid = *m.terms.all<BodyTerm>()[0];
  std::size_t item = 0;
  for (std::size_t i = 0; i < m.particles.size(); ++i)
    if (!m.particles.isMember(i)) {
      snapshot.v[item] = m.particles.f[i] / snapshot.mass[item];
      ++item;
    }
  for (std::size_t b = 0; b < rigid.bodies.size(); ++b, ++item)
    snapshot.v[item] = rigid.bodies.f[b] / snapshot.mass[item];
  EXPECT_EQ(item, snapshot.x.size());
  return snapshot;
}

/// Largest |Σ F W − ∇·σ_c − ρ g − t| over the largest |Σ F W|, by central differences of step h.
double residual(const cg::Kernel& kernel, const Model& m, std::span<const Vec3> points, double h) {
  const Snapshot snapshot = withForces(m);
  const cg::Fields at = cg::sample(kernel, points, cg::viewOf(snapshot));
  std::vector<Vector3d> sum;
  double size = 0.0, worst = 0.0;
  for (std::size_t p = 0; p < points.size(); ++p) {
    sum.push_back(eigen(at.momentum[p] - at.density[p] * m.gravity - at.wallForce[p]));
    size = std::max(size, norm(at.momentum[p]));
  }
  for (int k = 0; k < 3; ++k)
    for (const double side : {1.0, -1.0}) {
      std::vector<Vec3> moved(points.begin(), points.end());
      for (Vec3& x : moved) x[k] += side * h;
      const auto stress = cg::sample(kernel, moved, cg::viewOf(snapshot)).contactStress;
      for (std::size_t p = 0; p < points.size(); ++p) sum[p] -= side / (2.0 * h) * stress[p].col(k);
    }
  for (const Vector3d& r : sum) worst = std::max(worst, r.norm() / size);
  return worst;
}

/// Places on and across the borders, at the walls, and in between.
std::vector<Vec3> places(const Vec3& origin, Random& random) {
  std::vector<Vec3> points{{0, 0.3, 0.2},    {1, 1, 0},         {0.5, 0, 0.45},
                           {1.4, -3.1, 0.2}, {0.98, 0.5, 0.25}, {0.6, 0.5, 0.25}};
  for (int i = 0; i < 30; ++i) points.push_back({random(0.0, 1.0), random(0.0, 1.0), random(-0.1, 0.6)});
  for (Vec3& x : points) x += origin;
  return points;
}

TEST(Snapshot, ItsFieldsBalanceWhateverActsOnTheGrains) {
  Random random(3);
  for (const Vec3& origin : {Vec3{}, Vec3{300, -200, 100}}) {
    Model m = scene(origin);
    findForces(m);  // of the velocities as they are now
    ASSERT_GT(norm(primitiveWall(m, 0).force), 1.0);
    ASSERT_GT(norm(totalForce(meshWall(m, 0).wall)), 1.0);
    const Snapshot snapshot = takeSnapshot(m);
    for (std::size_t c = 0; c < snapshot.from.size(); ++c)  // no branch goes round the cell, those of the clump neither
      EXPECT_LT(norm(snapshot.from[c] - snapshot.to[c]), 0.3);
    const auto points = places(origin, random);
    for (const double width : {0.12, 0.4}) {
      const cg::Kernel kernel{cg::KernelShape::lucy, 3, width};
      const double coarse = residual(kernel, m, points, 4e-3 * width), fine = residual(kernel, m, points, 1e-3 * width);
      EXPECT_LT(fine, 1e-5) << width;
      EXPECT_LT(fine, coarse / 4.0) << width;  // of second order, down to round-off
    }
  }
}

TEST(Snapshot, CarriesTheShareThatIsModelledHere) {
  Model m = scene({});
  Random random(4);
  m.particles.weight.assign(m.particles.size(), 1.0);
  for (std::size_t i = 0; i < m.particles.size(); ++i)
    if (!m.particles.isMember(i)) m.particles.weight[i] = random(0.2, 1.0);
  findForces(m);
  for (double& factor : m.pairs.writeFactors())
    if (factor > 0.0) factor = random(0.2, 1.0);  // members of one clump stay muted
  findForces(m);
  const cg::Kernel kernel{cg::KernelShape::lucy, 3, 0.4};
  EXPECT_LT(residual(kernel, m, places({}, random), 4e-4), 1e-5);
  double mass = 0.0, volume = 0.0;
  const Snapshot snapshot = takeSnapshot(m);
  for (std::size_t i = 0; i < snapshot.x.size(); ++i) {
    mass += snapshot.mass[i];
    volume += snapshot.volume[i];
  }
  double wanted = bodies(m).bodies.mass[0];
  for (std::size_t i = 0; i < m.particles.size(); ++i)
    if (!m.particles.isMember(i)) wanted += m.particles.weight[i] * m.particles.mass[i];
  EXPECT_NEAR(mass, wanted, 1e-12 * wanted);
  EXPECT_GT(volume, mass / 1000.0);  // spheres of a clump overlap
}

TEST(Snapshot, TractionOfItsWallsIsWhatTheyAreLoadedWith) {
  Model m = scene({});
  findForces(m);
  const MeshWall& mesh = meshWall(m, 0);
  const std::vector<int> patch(mesh.wall.facets.size(), 0);
  const cg::SurfaceKernel kernel{{cg::KernelShape::lucy, 2, 0.3}, cg::KernelCorrection::linear};
  const cg::VertexTraction t = cg::wallTraction(kernel, mesh.wall.x, mesh.wall.facets, patch,
                                                {mesh.contacts.facet, mesh.contacts.weight, mesh.contacts.force});
  Vec3 force, moment, wantedMoment;
  for (std::size_t v = 0; v < t.area.size(); ++v) {
    force += t.area[v] * t.traction[v];
    moment += cross(mesh.wall.x[v], t.area[v] * t.traction[v]);
  }
  for (std::size_t c = 0; c < mesh.contacts.size(); ++c)
    wantedMoment -= cross(contactPoint(mesh.contacts, mesh.wall, c), mesh.contacts.force[c]);
  EXPECT_LT(norm(force - totalForce(mesh.wall)), 1e-11 * norm(force));
  EXPECT_LT(norm(moment - wantedMoment), 1e-10 * norm(moment));
}

TEST(Snapshot, AColumnAtRestCarriesTheWeightAbove) {
  // Columns of spheres on a floor, each at rest on the next, in a cell that repeats: mean σ_zz over a level is −g times
  // the mean mass above it, at any level above the floor's reach.
  const double r = 0.05, k = 1e4, spacing = 2.1 * r;
  const int layers = 12;
  Model m;
  m.laws = makeContactLaws(ElasticLaw{{.stiffness = k}});
  m.gravity = {0, 0, -9.81};
  m.pairs.setPeriodicity({{{0, 0, 0}, {3 * spacing, 3 * spacing, 1}}, {true, true, false}});
  const double mass = 1.3, cell = spacing * spacing;
  double z = 0.0;
  for (int layer = 0; layer < layers; ++layer) {
    z += (layer == 0 ? r : 2.0 * r) - (layers - layer) * mass * 9.81 / k;
    for (int c = 0; c < 9; ++c) addParticle(m.particles, {(c % 3) * spacing, (c / 3) * spacing, z}, {}, r, Mass{mass});
  }
  addWall(m, makePlane({}, {0, 0, 1}));
  run(m, 1e-5, 1);
  for (const Vec3& f : m.particles.f) ASSERT_LT(norm(f), 1e-9);
  const Snapshot snapshot = takeSnapshot(m);
  const cg::Kernel kernel{cg::KernelShape::lucy, 3, 4.0 * r};
  const int across = 8, up = 240;
  const double h = (layers * 2.0 * r + 2.0 * kernel.width) / up;
  const auto points =
      cg::gridPoints({{0, 0, -kernel.width + 0.5 * h}, {spacing / across, spacing / across, h}, {across, across, up}});
  const cg::Fields fields = cg::sample(kernel, points, cg::viewOf(snapshot));
  double above = 0.0, push = 0.0;  // kg/m² above the level, Pa
  for (int level = up - 1; level >= 0; --level) {
    double density = 0.0, stress = 0.0;
    for (int c = 0; c < across * across; ++c) {
      const auto p = static_cast<std::size_t>(level * across * across + c);
      density += fields.density[p] / (across * across);
      stress += fields.stress(p)(2, 2) / (across * across);
      push += fields.wallForce[p].z * h / (across * across);
    }
    const double here = above + 0.5 * h * density;
    above += h * density;
    const double height = -kernel.width + (level + 0.5) * h;
    if (height > kernel.width) {
      EXPECT_NEAR(stress, -9.81 * here, 1e-4 * 9.81 * layers * mass / cell) << height;
    }
    if (std::abs(height - 6.0 * r) < 0.5 * h) {
      const double bulk = mass / (cell * (z / (layers - 0.5)));  // per layer
      EXPECT_NEAR(stress, -bulk * 9.81 * (z + r - height), 0.02 * std::abs(stress));
    }
  }
  EXPECT_NEAR(above, layers * mass / cell, 1e-5 * above);
  EXPECT_NEAR(push, 9.81 * above, 1e-4 * push);
}

TEST(Snapshot, IsRefusedWhileVelocitiesLag) {
  Model m = scene({});
  advance(m, 1e-5);
  EXPECT_THROW(takeSnapshot(m), InputError);
  close(m);
  EXPECT_EQ(takeSnapshot(m).time, m.time);
  EXPECT_TRUE(takeSnapshot(Model{}).x.empty());
}

}  // namespace
}  // namespace dovetail::dem
