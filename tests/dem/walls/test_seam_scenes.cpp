// Seams between walls that move, that keep a force, under clumps, and over restarts.
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <limits>
#include <utility>

#include "dovetail/core/error.hpp"
#include "dovetail/dem/bodies/body_term.hpp"
#include "dovetail/dem/model/checkpoint.hpp"
#include "dovetail/dem/model/walls.hpp"
#include "wall_scenes.hpp"

namespace dovetail::dem {
namespace {

constexpr double dt = 5e-5;

std::shared_ptr<const ContactLaws> rough() {
  ContactLaw<LinearSpringDashpot, TangentialSpring> law;
  law.normal = {.stiffness = 1e5};
  law.tangential = {.stiffness = 3e4, .friction = 0.5};
  return makeContactLaws(law);
}

/// The square |x|, |y| < 2 at a height, in halves that meet at x = 0 without common vertices: in one wall or in two.
std::vector<MeshWall> halves(double z, bool two) {
  const std::vector<Vec3> left{{-2, -2, z}, {0, -2, z}, {-2, 2, z}, {0, 2, z}};
  std::vector<Vec3> right = left;
  for (Vec3& x : right) x.x += 2.0;
  const std::vector<geometry::Facet> facets{{0, 1, 3}, {0, 3, 2}};
  std::vector<MeshWall> walls(two ? 2 : 1);
  walls[0].wall = makeWall(left, facets);
  if (two) {
    walls[1].wall = makeWall(right, facets);
    return walls;
  }
  std::vector<Vec3> both = left;
  both.insert(both.end(), right.begin(), right.end());
  walls[0].wall = makeWall(both, {{0, 1, 3}, {0, 3, 2}, {4, 5, 7}, {4, 7, 6}});
  return walls;
}

Model scene(bool two, const std::function<void(MeshWall&)>& drive = {}) {
  Model m;
  m.laws = rough();
  m.gravity = {0, 0, -9.81};
  for (MeshWall& wall : halves(0.0, two)) {
    if (drive) drive(wall);
    addWall(m, std::move(wall));
  }
  return m;
}

void addBall(Model& m, const Vec3& x, const Vec3& v, const Vec3& omega) {
  addParticle(m.particles, x, v, 0.1, Mass{0.5});
  switchOnRotation(m.particles);
  m.particles.omega[0] = omega;
}

/// The start of a ball that rolls and slips towards the seam, at rest on the ground.
const Vec3 before{-0.06, 0.1, 0.1 - 0.5 * 9.81 / 1e5};

TEST(SeamScenes, WallsThatMoveTogetherActAsOne) {
  const auto drive = [](MeshWall& wall) {
    prescribe(wall,
              [](double t) {
                const double up = 1e-3 * std::sin(40.0 * t), rise = 0.04 * std::cos(40.0 * t);
                return RigidMotion{{0.2 * t, 0.3 * t, up}, {}, {0.2, 0.3, rise}, {}};
              },
              {});
  };
  Vec3 x[2], v[2], omega[2];
  double residual[2];
  for (const bool two : {false, true}) {
    Model m = scene(two, drive);
    addBall(m, before, {1.0, 0.1, 0}, {0, 9.0, 0});
    findForces(m);
    const double start = energies(m).balance();
    run(m, dt, 2400);
    x[two] = m.particles.x[0];
    v[two] = m.particles.v[0];
    omega[two] = m.particles.omega[0];
    residual[two] = energies(m).balance() - start;
    EXPECT_GT(x[two].x, 0.2 * m.time + 0.02);
  }
  EXPECT_LE(norm(x[1] - x[0]), 1e-12);
  EXPECT_LE(norm(v[1] - v[0]), 1e-10);
  EXPECT_LE(norm(omega[1] - omega[0]), 1e-9);
  EXPECT_NEAR(residual[1], residual[0], 1e-12);
}

/// A ball rolls from a half at rest onto one that slides along the seam, and comes to roll there.
TEST(SeamScenes, ABallPassesToAHalfThatSlides) {
  Model m = scene(true);
  MeshWall& right = meshWall(m, 1);
  prescribe(right, [](double t) { return RigidMotion{{0, 0.4 * t, 0}, {}, {0, 0.4, 0}, {}}; }, {});
  addBall(m, before, {0.5, 0, 0}, {0, 5.0, 0});
  findForces(m);
  const double start = energies(m).balance(), fall = m.particles.x[0].z;
  constexpr int steps = 8000, last = 4000;
  Vec3 mean;  // over many periods of the undamped spring
  for (int step = 0; step < steps; ++step) {
    run(m, dt, 1);
    ASSERT_NEAR(m.particles.x[0].z, fall, 1e-9) << step;
    if (step >= steps - last) mean += m.particles.v[0] / last;
  }
  EXPECT_NEAR(energies(m).balance(), start, 1e-6 * energies(m).kinetic);
  // Its angular momentum about the ground has not changed.
  EXPECT_LE(norm(mean - Vec3{0.5, 2.0 / 7.0 * 0.4, 0}), 2e-3);
}

/// Two lids that meet over a ball, each pressed by a servo: their forces are those of the balls, once each.
TEST(SeamScenes, LidsOfServosCountABallAtTheirSeamOnce) {
  constexpr double radius = 0.1, load = 40.0;
  Model m;
  m.laws = makeContactLaws(ElasticLaw{{1e5}});
  addWall(m, makePlane({}, {0, 0, 1}));
  for (MeshWall& lid : halves(2.0 * radius, true)) {
    prescribe(lid, makeServo({0, 0, -1}, load, 5.0, 0.5 * std::sqrt(5.0 * 1e5)));
    addWall(m, std::move(lid));
  }
  for (const double x : {-1.0, 0.0, 1.0})
    for (const double y : {-1.0, 1.0}) addParticle(m.particles, {x, y, radius}, {}, radius, Mass{0.5});
  findForces(m);
  const double start = energies(m).balance();
  double work = 0.0, pressed = 0.0;
  constexpr int steps = 6000, last = 3000;
  for (int step = 0; step < steps; ++step) {
    run(m, dt, 1);
    Vec3 onLids, floor;
    for (const std::size_t lid : {0u, 1u}) onLids += totalForce(meshWall(m, lid).wall);
    for (const Vec3& f : m.particles.f) floor += f;
    ASSERT_LE(norm(onLids + primitiveWall(m, 0).force + floor), 1e-9);
    ASSERT_LE(meshWall(m, 0).contacts.size() + meshWall(m, 1).contacts.size(), m.particles.size());
    if (step >= steps - last) pressed += onLids.z / last;
    const auto& servo = std::get<WallServo>(meshWall(m, 0).motion);
    work = std::max(work, servo.work + std::get<WallServo>(meshWall(m, 1).motion).work);
  }
  EXPECT_NEAR(energies(m).balance(), start, 1e-4 * work);
  EXPECT_NEAR(pressed, 2.0 * load, 1e-2 * load);
}

TEST(SeamScenes, AClumpRestsAndRocksOnASeamAsOnOneWall) {
  Vec3 x[2], v[2];
  double energy[2];
  for (const bool two : {false, true}) {
    Model m = scene(two);
    const ClumpShape rod = makeClumpShape(std::vector<Vec3>{{-0.12, 0, 0}, {0, 0, 0}, {0.12, 0, 0}},
                                          std::vector<double>{0.1, 0.1, 0.1}, Density{300.0});
    addClump(m, rod, {0.03, 0.2, 0.12}, fromRotationVector({0.1, 0.15, 0.3}), {0.1, -0.1, 0}, {0.5, 1.0, 0});
    findForces(m);
    std::size_t met[2]{};
    for (int step = 0; step < 6000; ++step) {
      run(m, dt, 1);
      for (const std::size_t i : {0u, 1u})
        if (two) met[i] += meshWall(m, i).contacts.size() > 0;
    }
    EXPECT_GE(std::min(met[0], met[1]), two ? 100u : 0u);
    x[two] = m.particles.x[0];
    v[two] = m.particles.v[2];
    energy[two] = energies(m).balance();
  }
  EXPECT_LE(norm(x[1] - x[0]), 1e-9);
  EXPECT_LE(norm(v[1] - v[0]), 1e-7);
  EXPECT_NEAR(energy[1], energy[0], 1e-9);
}

/// A ball that rolls and slips towards the seam, as far as some steps behind the one that takes it to the other wall.
Model rolled(int steps) {
  Model m = scene(true);
  addBall(m, before, {1.0, 0.1, 0}, {0, 9.0, 0});
  addParticle(m.particles, {1.0, 1.0, 0.0999}, {0, 0.5, 0}, 0.1, Mass{0.5});
  findForces(m);
  std::vector<Model> last(1, m);
  const auto passed = [&] { return meshWall(m, 0).contacts.size() == 0; };
  while (!passed() && m.time < 0.2) {
    if (last.size() > 50) last.erase(last.begin());
    run(m, dt, 1);
    last.push_back(m);
  }
  EXPECT_TRUE(passed());
  if (steps < 0) return last.at(last.size() - 1 - static_cast<std::size_t>(-steps));
  run(m, dt, steps);
  return m;
}

TEST(SeamScenes, ARestartAtASeamChangesNothing) {
  for (const int steps : {-40, -1, 0, 1, 40}) {
    Model through = rolled(steps);
    Model again = scene(true);
    loadState(saveState(through), "memory", again);
    run(through, dt, 400);
    run(again, dt, 400);
    EXPECT_EQ(again.particles.x[0], through.particles.x[0]) << steps;
    EXPECT_EQ(again.particles.v[0], through.particles.v[0]) << steps;
    EXPECT_EQ(again.particles.omega[0], through.particles.omega[0]) << steps;
    EXPECT_EQ(energies(again).balance(), energies(through).balance()) << steps;
  }
}

/// What spoils a wall or a grain, and what mends it.
using Change = std::function<void(Model&)>;

/// A ball at a seam, its spring stretched: forces are found once more, after they were found in vain or not.
void expectNothingLeftOver(const Change& spoil, const Change& mend) {
  for (const int steps : {-1, 0}) {
    Model once = rolled(steps);
    Model twice = once;
    spoil(twice);
    EXPECT_THROW(findForces(twice), Error);
    mend(twice);
    for (Model* m : {&once, &twice}) {
      findForces(*m);
      run(*m, dt, 300);
    }
    for (const std::size_t i : {0u, 1u}) {
      EXPECT_EQ(twice.particles.x[i], once.particles.x[i]);
      EXPECT_EQ(twice.particles.v[i], once.particles.v[i]);
      EXPECT_EQ(twice.particles.omega[i], once.particles.omega[i]);
      EXPECT_EQ(totalForce(meshWall(twice, i).wall), totalForce(meshWall(once, i).wall));
    }
    EXPECT_EQ(energies(twice).balance(), energies(once).balance());
    EXPECT_EQ(twice.work.elasticEnergy, once.work.elasticEnergy);
  }
}

TEST(SeamScenes, AnEvaluationBrokenOffLeavesNothing) {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  for (const std::size_t i : {0u, 1u}) {
    Vec3 kept;
    expectNothingLeftOver(
        [&](Model& m) {
          kept = std::exchange(m.particles.x[i], {nan, nan, nan});
        },
        [&](Model& m) { m.particles.x[i] = kept; });
    // A wall at rest whose vertices somebody moves, before and behind one whose contacts are found.
    expectNothingLeftOver([&](Model& m) { meshWall(m, i).wall.x[2].z += 0.01; },
                          [&](Model& m) { meshWall(m, i).wall.x[2].z = 0.0; });
    expectNothingLeftOver([&](Model& m) { meshWall(m, i).wall.x[1].y = nan; },
                          [&](Model& m) { meshWall(m, i).wall.x[1].y = -2.0; });
  }
}

}  // namespace
}  // namespace dovetail::dem
