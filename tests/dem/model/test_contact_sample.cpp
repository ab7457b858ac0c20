// Contacts one by one, and the averages over them, against known strains and wall forces.
#include <gtest/gtest.h>

#include "dovetail/cg/averages.hpp"
#include "dovetail/core/error.hpp"
#include "dovetail/core/parallel.hpp"
#include "dovetail/dem/model/sample.hpp"
#include "dovetail/dem/model/walls.hpp"
#include "dovetail/dem/setup/packing.hpp"
#include "walls/wall_scenes.hpp"

namespace dovetail::dem {
namespace {

using Eigen::Matrix3d;

const FrictionalLaw rubbing{{.stiffness = 2e4}, {.stiffness = 6e3, .friction = 0.4}};

cg::BranchView branches(const ContactSample& sample) { return {sample.from, sample.to, sample.force}; }
cg::ParticleView view(const Particles& particles) { return {particles.x, particles.v, particles.mass}; }

TEST(ContactSample, GivesTheForcesThatTheSweepHasAdded) {
  const auto laws = makeContactLaws(rubbing);
  Random random(2);
  Particles particles;
  for (int i = 0; i < 300; ++i) addParticle(particles, random.vector(0.3), random.vector(1.0), 0.06, Density{1000.0});
  switchOnRotation(particles);
  for (Vec3& w : particles.omega) w = random.vector(10.0);
  PairList list;
  list.setSkin(0.01);
  findPairs(particles, list);
  EXPECT_THROW(laws->sample(particles, list), InputError);
  for (int step = 0; step < 20; ++step) {
    drift(particles, 1e-4);
    updatePairs(particles, list);
    clearForces(particles);
    laws->pairs(particles, list, 1e-4, Booking::on);
  }
  const auto memory = list.memory();
  const ContactSample sample = laws->sample(particles, list);
  EXPECT_EQ(list.memory(), memory);
  std::vector<Vec3> f(particles.size());
  double largest = 0.0;
  for (std::size_t c = 0; c < sample.size(); ++c) {
    f[sample.first[c]] += sample.force[c];
    f[sample.second[c]] -= sample.force[c];
    EXPECT_NEAR(norm(sample.normal[c]), 1.0, 1e-14);
    EXPECT_LE(norm(cross(sample.normal[c], sample.from[c] - sample.to[c])), 1e-14);
    largest = std::max(largest, norm(sample.force[c] - dot(sample.force[c], sample.normal[c]) * sample.normal[c]));
  }
  EXPECT_GT(largest, 1.0);  // friction is among them
  double size = 0.0;
  for (const Vec3& force : particles.f) size += norm(force) / static_cast<double>(f.size());
  for (std::size_t i = 0; i < f.size(); ++i) EXPECT_LE(norm(f[i] - particles.f[i]), 1e-9 * size) << i;
}

TEST(ContactSample, OfAModelHasTheForcesAndTorquesOfItsParticlesAndWalls) {
  Model m;
  m.laws = makeContactLaws(ContactLaw<LinearSpringDashpot, TangentialSpring, RollingAndTwisting>{
      {2e4}, {6e3, 0.4}, {{0.2, 0.3}, {0.1, 0.3}}, {}});
  m.pairs.setSkin(0.02);
  m.pairs.setPeriodicity({{{0, 0, 0}, {1, 1, 1}}, {true, true, false}});
  Random random(12);
  for (int i = 0; i < 200; ++i)
    addParticle(m.particles, {random(0.0, 1.0), random(0.0, 1.0), random(0.03, 0.4)}, random.vector(1.0), 0.06,
                Density{1000.0});
  switchOnRotation(m.particles);
  for (Vec3& w : m.particles.omega) w = random.vector(10.0);
  EXPECT_THROW(sampleContacts(m), InputError);
  addWall(m, makePlane({}, {0, 0, 1}));
  addWall(m, makeCylinder({0, 0.5, 0.2}, {1, 0, 0}, 0.15, false)).angularVelocity = {3, 0, 0};
  MeshWall& mesh = addWall(m, MeshWall{});
  mesh.wall = squares(4, 4, 0.25);
  for (Vec3& x : mesh.wall.x) x.z = 0.35 + 0.05 * std::sin(6.2831853 * x.x);
  for (int s = 0; s < 20; ++s) advance(m, 1e-5);  // velocities stay those that the forces saw
  const ContactSample sample = sampleContacts(m);
  std::vector<Vec3> force(m.particles.size()), torque(m.particles.size());
  Vec3 onWalls;
  for (std::size_t c = 0; c < sample.size(); ++c) {
    force[sample.first[c]] += sample.force[c];
    torque[sample.first[c]] += sample.torqueFirst[c];
    // The moment of a contact about any point is balanced.
    const Vec3 couple = sample.torqueFirst[c] + sample.torqueSecond[c];
    EXPECT_LE(norm(couple + cross(sample.from[c] - sample.to[c], sample.force[c])), 1e-12 * norm(sample.force[c]));
    EXPECT_LE(norm(sample.to[c] - sample.from[c]), 0.2);  // the nearest image
    if (sample.second[c] >= 0) {
      force[sample.second[c]] -= sample.force[c];
      torque[sample.second[c]] += sample.torqueSecond[c];
    } else {
      onWalls -= sample.force[c];
    }
  }
  const Vec3 wanted = primitiveWall(m, 0).force + primitiveWall(m, 1).force + totalForce(meshWall(m, 0).wall);
  EXPECT_GT(norm(primitiveWall(m, 0).force), 1.0);
  EXPECT_GT(norm(primitiveWall(m, 1).force), 1.0);
  EXPECT_GT(norm(totalForce(meshWall(m, 0).wall)), 1.0);
  EXPECT_LE(norm(onWalls - wanted), 1e-11 * norm(wanted));
  double size = 0.0, moment = 0.0;
  for (std::size_t i = 0; i < force.size(); ++i) {
    size = std::max(size, norm(m.particles.f[i]));
    moment = std::max(moment, norm(m.particles.torque[i]));
  }
  for (std::size_t i = 0; i < force.size(); ++i) {
    EXPECT_LE(norm(force[i] - m.particles.f[i]), 1e-9 * size) << i;
    EXPECT_LE(norm(torque[i] - m.particles.torque[i]), 1e-9 * moment) << i;
  }
}

/// Its dashpots see the velocities that particles have, which a step knows to second order.
TEST(ContactSample, HasTheDashpotsOfTheVelocitiesAsTheyAre) {
  const auto difference = [](int steps) {
    Model m;
    m.laws = makeContactLaws(FrictionalLaw{{2e4, 0.5}, {6e3, 0.4, 0.5}});
    for (const double x : {-0.0501, 0.0501}) addParticle(m.particles, {x, 0, 0}, {-20.0 * x, x, 0}, 0.05, Mass{1.0});
    run(m, 0.008 / steps, steps);  // within their contact
    const ContactSample sample = sampleContacts(m);
    EXPECT_EQ(sample.size(), 1u);
    EXPECT_GT(norm(sample.force[0]), 50.0);
    return norm(sample.force[0] - m.particles.f[0]) / norm(m.particles.f[0]);
  };
  const double coarse = difference(20), fine = difference(40);
  EXPECT_LE(coarse, 2e-2);
  EXPECT_NEAR(coarse / fine, 4.0, 1.0);
}

TEST(ContactSample, IsTheSameForAnyThreadsAndPairByPairThatOfThePairAlone) {
  const auto laws = makeContactLaws(rubbing);
  Random random(4);
  Particles particles;
  for (int i = 0; i < 1500; ++i)
    addParticle(particles, random.vector(0.5), random.vector(1.0), random(0.04, 0.06), Density{1000.0});
  switchOnRotation(particles);
  PairList list;
  list.setPeriodicity({{{-0.5, -0.5, -0.5}, {0.5, 0.5, 0.5}}, {true, true, true}});
  list.setSkin(0.01);
  findPairs(particles, list);
  laws->pairs(particles, list, 1e-4, Booking::on);
  ASSERT_GT(list.size(), 2048u);  // several chunks
  ASSERT_NE(list.size() % 64, 0u);
  std::vector<ContactSample> samples;
  for (const int count : {1, 2, 3}) {
    setThreads(count);
    samples.push_back(laws->sample(particles, list));
  }
  setThreads(1);
  const ContactSample& once = samples[0];
  for (const ContactSample& s : samples) {
    EXPECT_TRUE(s.first == once.first && s.second == once.second);
    EXPECT_TRUE(s.from == once.from && s.to == once.to && s.point == once.point && s.normal == once.normal);
    EXPECT_TRUE(s.force == once.force && s.torqueFirst == once.torqueFirst && s.torqueSecond == once.torqueSecond);
  }
  std::size_t c = 0;
  for (std::size_t p = 0; p < list.size(); ++p) {
    detail::PairsApart alone(1);
    alone.take(particles, list, p, laws->memory());
    laws->pairs(alone.particles, alone.list, 1e-100, Booking::on);
    if (alone.particles.f[0] == Vec3{}) continue;
    ASSERT_EQ(once.first[c], list.pairs()[p][0]);
    ASSERT_EQ(once.second[c], list.pairs()[p][1]);
    ASSERT_EQ(once.force[c], alone.particles.f[0]);
    ASSERT_EQ(once.torqueSecond[c++], alone.particles.torque[1]);
  }
  EXPECT_EQ(c, once.size());
}

/// What each bond of a touching lattice becomes under a strain, from a double loop: V σ and how many there are.
struct Bonds {
  Matrix3d stress = Matrix3d::Zero();
  int count = 0;
};
template <class Strained>
Bonds bondsOf(const Packing& block, const Strained& strained, double stiffness) {
  Bonds bonds;
  for (std::size_t i = 0; i < block.centre.size(); ++i)
    for (std::size_t j = i + 1; j < block.centre.size(); ++j) {
      const Vec3 d = block.space.minimumImage(block.centre[i] - block.centre[j]);
      const double diameter = 2.0 * block.radius[0];
      if (norm(d) > diameter * (1.0 + 1e-9)) continue;
      const Vec3 l = strained(d);
      const Eigen::Vector3d branch(l.x, l.y, l.z);
      bonds.stress -= stiffness * (diameter - norm(l)) / norm(l) * branch * branch.transpose();
      ++bonds.count;
    }
  return bonds;
}

TEST(LoveWeberStress, OfALatticeUnderAKnownStrainIsTheAnalyticOne) {
  for (const Lattice lattice : {Lattice::simpleCubic, Lattice::bodyCentred, Lattice::faceCentred, Lattice::hexagonal}) {
    const double k = 1e5, r = 0.05;
    Packing block = latticeBlock(lattice, {4, 3, 3}, r, 2.0 * r);
    const Vec3 stretch{0.99, 0.995, 0.985};  // affine compression along the axes
    const auto strained = [&](const Vec3& x) { return Vec3{stretch.x * x.x, stretch.y * x.y, stretch.z * x.z}; };
    const Bonds bonds = bondsOf(block, strained, k);
    for (Vec3& x : block.centre) x = strained(x);
    block.space.box.upper = strained(block.space.box.upper);
    const Matrix3d wanted = bonds.stress / block.volume();
    Particles particles;
    addPacking(particles, block, Density{1000.0}, {3, 2, 1});
    PairList list;
    list.setPeriodicity(block.space);
    list.setSkin(0.1 * r);
    findPairs(particles, list);
    const auto laws = makeContactLaws(ElasticLaw{{.stiffness = k}});
    laws->pairs(particles, list, 0.0, Booking::on);
    const ContactSample sample = laws->sample(particles, list);
    EXPECT_EQ(static_cast<int>(sample.size()), bonds.count);
    const cg::AverageStress stress = cg::loveWeberStress(branches(sample), view(particles), block.volume());
    EXPECT_LE((stress.contact - wanted).norm(), 1e-12 * wanted.norm());
    EXPECT_LE(stress.kinetic.norm(), 1e-12);  // a common velocity is no pressure
    if (lattice == Lattice::simpleCubic) {
      const double edge = 2.0 * r;
      for (int a = 0; a < 3; ++a) {
        const double area = edge * edge * stretch[(a + 1) % 3] * stretch[(a + 2) % 3];
        EXPECT_NEAR(stress.contact(a, a), -k * edge * (1.0 - stretch[a]) / area, 1e-9 * wanted.norm());
      }
    }
    const cg::Coordination c = cg::coordination(sample.first, sample.second, static_cast<int>(particles.size()));
    EXPECT_EQ(c.rattlers, 0);
    EXPECT_DOUBLE_EQ(c.mean, 2.0 * bonds.count / static_cast<double>(particles.size()));
    EXPECT_NEAR(cg::fabric(sample.normal).trace(), 1.0, 1e-12);
  }
}

/// The box of a packing as a sheet.
TriangulatedWall wallsOf(const Packing& packing) {
  const Vec3 a = packing.space.box.lower, b = packing.space.box.upper;
  std::vector<Vec3> x;
  for (int c = 0; c < 8; ++c) x.push_back({c & 1 ? b.x : a.x, c & 2 ? b.y : a.y, c & 4 ? b.z : a.z});
  return makeWall(x, {{0, 3, 2},
                      {0, 1, 3},
                      {4, 7, 5},
                      {4, 6, 7},
                      {0, 5, 1},
                      {0, 4, 5},
                      {2, 7, 6},
                      {2, 3, 7},
                      {0, 6, 4},
                      {0, 2, 6},
                      {1, 7, 3},
                      {1, 5, 7}});
}

TEST(LoveWeberStress, OfARestingPackingIsWhatItsWallsPressBack) {
  PackingReport report;
  Packing packing = growPacking(UniformSizes{0.08, 0.12}, {{{0, 0, 0}, {1, 1, 1}}, {false, false, false}},
                                {.solidFraction = 0.5, .seed = 9}, report);
  report = compressToPressure(packing, {.stiffness = 1e5, .pressure = 2000.0});
  ASSERT_TRUE(report.reached);
  const TriangulatedWall wall = wallsOf(packing);
  Particles particles;
  addPacking(particles, packing, Density{1000.0});
  const auto laws = makeContactLaws(ElasticLaw{{.stiffness = 1e5}});
  PairList list;
  list.setSkin(0.01);
  findPairs(particles, list);
  laws->pairs(particles, list, 0.0, Booking::on);
  WallCandidates candidates;
  WallContacts contacts;
  findWallCandidates(particles, wall, 0.01, candidates);
  findWallContacts(particles, wall, candidates, EdgeRule::projected, contacts);
  laws->wall(particles, wall, contacts, 0.0, Booking::on);
  ContactSample sample = laws->sample(particles, list);
  addWallContacts(particles, wall, contacts, sample);
  const Matrix3d stress = cg::loveWeberStress(branches(sample), view(particles), packing.volume()).total();
  EXPECT_NEAR(-stress.trace() / 3.0, 2000.0, 10.0);
  Matrix3d fromWalls = Matrix3d::Zero();
  for (std::size_t c = 0; c < contacts.size(); ++c) {
    const Vec3 p = contactPoint(contacts, wall, c), f = contacts.force[c];
    fromWalls += Eigen::Vector3d(f.x, f.y, f.z) * Eigen::RowVector3d(p.x, p.y, p.z) / packing.volume();
  }
  EXPECT_LE((stress - fromWalls).norm(), 1e-3 * stress.norm());
  const cg::Coordination c = cg::coordination(sample.first, sample.second, static_cast<int>(particles.size()));
  EXPECT_GT(c.withoutRattlers, 4.0);
  EXPECT_GE(c.withoutRattlers, c.mean);
  EXPECT_NEAR(cg::solidFraction(packing.centre, packing.radius, {packing.space.box.lower, packing.space.box.upper}),
              report.solidFraction, 2e-3);
}

TEST(JoinMembers, TheStressOfASqueezedClumpIsWhatSqueezesIt) {
  // A rod of three spheres, and a ball that presses on either end, along the rod but beside its axis.
  Particles particles;
  Bodies bodies;
  Clumps clumps;
  const std::vector<Vec3> centre{{0, 0, 0}, {0.08, 0, 0}, {0.2, 0, 0}};
  addClump(particles, bodies, clumps, makeClumpShape(centre, std::vector<double>(3, 0.05), Density{1000.0}),
           {0.1, 0, 0});
  const Vec3 shift = particles.x[0];
  addParticle(particles, shift + Vec3{-0.095, 0.01, 0}, {}, 0.05, Mass{1.0});
  addParticle(particles, shift + Vec3{0.295, -0.01, 0}, {}, 0.05, Mass{1.0});
  PairList list;
  list.setSkin(0.0);
  findPairs(particles, list);
  muteMemberPairs(clumps, list);
  const auto laws = makeContactLaws(ElasticLaw{{.stiffness = 1e5}});
  ContactSample sample = laws->sample(particles, list);
  ASSERT_EQ(sample.size(), 2u);
  // Hands that hold the balls push back with the opposite force, at their centres.
  Matrix3d wanted = Matrix3d::Zero();
  for (std::size_t c = 0; c < 2; ++c) {
    const Vec3 f = sample.force[c], p = sample.to[c];  // balls have the higher numbers
    wanted += Eigen::Vector3d(f.x, f.y, f.z) * Eigen::RowVector3d(p.x, p.y, p.z);
  }
  const double volume = 0.01;
  EXPECT_GT((cg::loveWeberStress(branches(sample), {}, volume).contact - wanted / volume).norm(), 0.1 * wanted.norm());
  joinMembers(particles, bodies, clumps, {}, sample);
  EXPECT_LE((cg::loveWeberStress(branches(sample), {}, volume).contact - wanted / volume).norm(),
            1e-12 * wanted.norm() / volume);
  EXPECT_LT(wanted(0, 0), 0.0);
}

}  // namespace
}  // namespace dovetail::dem
