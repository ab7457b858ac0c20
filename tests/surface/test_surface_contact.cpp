// The connector in a run: momenta and energy, numbers that change, restart, the critical step.
#include <gtest/gtest.h>

#include <algorithm>

#include "../threads.hpp"
#include "contact_scene.hpp"

namespace dovetail::surface {
namespace {

using fem::ElementShape;

class RunOn : public ::testing::TestWithParam<ElementShape> {};
struct ShapeName {
  template <class Info>
  std::string operator()(const Info& info) const {
    return fem::name(info.param);
  }
};
INSTANTIATE_TEST_SUITE_P(Shapes, RunOn,
                         ::testing::Values(ElementShape::hex8, ElementShape::hex20, ElementShape::tet4,
                                           ElementShape::tet10),
                         ShapeName{});

struct Departure {
  double energy = 0.0, momentum = 0.0, angular = 0.0;  ///< relative to what there was
  double lost = 0.0;                                   ///< J, to friction and rolling
};

Departure runFor(double time, double dt, const fem::SolidMesh& mesh, std::shared_ptr<const dem::ContactLaws> laws,
                 const Variant& variant) {
  ContactScene scene(mesh, slantingGrains(9, 5), std::move(laws), variant);
  scene.start(dt);
  const double energy = scene.ledger();
  const dem::Momenta before = scene.momenta();
  const double size = norm(before.linear);
  Departure worst;
  for (int step = 0; step < std::lround(time / dt); ++step) {
    scene.step(dt);
    worst.energy = std::max(worst.energy, std::abs(scene.ledger() - energy) / energy);
    const dem::Momenta now = scene.momenta();
    worst.momentum = std::max(worst.momentum, norm(now.linear - before.linear) / size);
    worst.angular = std::max(worst.angular, norm(now.angular - before.angular) / (0.6 * size));
  }
  worst.lost = scene.grains.booked.lost.lostPower();
  return worst;
}

/// With friction, rolling and twisting, on faces of all shapes: explicit steps keep both momenta to round-off and the
/// books to second order.
TEST_P(RunOn, MomentaAndBooksClose) {
  const fem::SolidMesh mesh = softBlock(GetParam());
  for (const Variant& variant : {Variant{"local"}, Variant{"lucy", 0.2},
                                 Variant{"linear", 0.2, cg::KernelShape::lucy, cg::KernelCorrection::linear}}) {
    if (variant.width > 0.0 && GetParam() == ElementShape::hex20) continue;
    const Departure worst = runFor(0.06, 1e-4, mesh, rollingLaws(), variant);
    EXPECT_LT(worst.momentum, 1e-12) << variant.name;
    EXPECT_LT(worst.angular, 1e-12) << variant.name;
    EXPECT_LT(worst.energy, 2e-3) << variant.name;
    EXPECT_GT(worst.lost, 1e-3) << "somebody slides";
  }
}

/// A dashpot takes the mean of the velocities before and after the kick, of grain and skin.
TEST(SurfaceContact, DashpotsAreBookedAtSecondOrder) {
  const fem::SolidMesh mesh = softBlock(ElementShape::tet4);
  const auto laws = dem::makeContactLaws(dem::ElasticLaw{{2e4, 0.5}});
  const auto error = [&](double dt) {
    ContactScene scene(mesh, slantingGrains(9, 5), laws);
    scene.start(dt);
    const double energy = scene.ledger();
    for (int step = 0; step < std::lround(0.06 / dt); ++step) scene.step(dt);
    EXPECT_EQ(scene.contact->coupling().inContact(), false);
    EXPECT_GT(scene.grains.booked.lost.dissipatedPower, 0.1 * energy);
    return std::abs(scene.ledger() - energy) / energy;
  };
  const double coarse = error(2e-4), fine = error(1e-4);
  EXPECT_LT(coarse, 1e-3);
  EXPECT_LT(fine, coarse / 3.0);
}

struct End {
  std::vector<std::pair<std::int64_t, Vec3>> grains;  // by id
  std::vector<Vec3> nodes;
};

/// @param order  of the grains at the start @param leaver  an id that is taken out half-way, −1: nobody
/// @param sortEvery  list updates
End runInOrder(std::span<const int> order, int sortEvery, std::int64_t leaver, bool newcomer) {
  const fem::SolidMesh mesh = softBlock(ElementShape::hex8);
  const dem::Particles all = slantingGrains(20, 7);
  dem::Particles particles;
  for (int k : order) dem::addParticle(particles, all.x[k], all.v[k], all.radius[k], dem::Mass{all.mass[k]});
  dem::switchOnRotation(particles);
  for (std::size_t i = 0; i < order.size(); ++i) {
    particles.omega[i] = all.omega[order[i]];
    particles.id[i] = order[i];
  }
  ContactScene scene(mesh, std::move(particles), rollingLaws());
  scene.grains.sortEvery = sortEvery;
  scene.grains.pairs.setSkin(0.002);  // updated often
  scene.start(1e-4);
  for (int step = 0; step < 300; ++step) {
    if (step == 60 && leaver >= 0)
      dem::removeParticles(scene.grains, std::vector<int>{dem::find(scene.grains.particles, leaver)});
    if (step == 80 && newcomer) {
      dem::Particles& p = scene.grains.particles;
      dem::addParticle(p, {0.5, 0.5, 0.03}, {0.1, 0, -0.3}, 0.03, dem::Mass{0.1});
    }
    scene.step(1e-4);
  }
  End end{{}, scene.solid.nodes.u};
  for (std::size_t i = 0; i < scene.grains.particles.size(); ++i)
    end.grains.emplace_back(scene.grains.particles.id[i], scene.grains.particles.x[i]);
  std::sort(end.grains.begin(), end.grains.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  return end;
}

double distance(const End& a, const End& b) {
  double largest = 0.0;
  EXPECT_EQ(a.grains.size(), b.grains.size());
  for (std::size_t i = 0; i < a.grains.size(); ++i) {
    EXPECT_EQ(a.grains[i].first, b.grains[i].first);
    largest = std::max(largest, norm(a.grains[i].second - b.grains[i].second));
  }
  for (std::size_t i = 0; i < a.nodes.size(); ++i) largest = std::max(largest, norm(a.nodes[i] - b.nodes[i]));
  return largest;
}

/// Springs go with their grains through sorting, removal and insertion.
TEST(SurfaceContact, DoesNotCareForNumbers) {
  std::vector<int> order(20), mixed;
  for (int k = 0; k < 20; ++k) order[k] = k;
  for (int k = 0; k < 20; ++k) mixed.push_back((7 * k + 3) % 20);
  for (const std::int64_t leaver : {-1, 4})
    for (const bool newcomer : {false, true}) {
      const End reference = runInOrder(order, 0, leaver, newcomer);
      EXPECT_LT(distance(reference, runInOrder(order, 1, leaver, newcomer)), 1e-12);
      EXPECT_LT(distance(reference, runInOrder(mixed, 1, leaver, newcomer)), 1e-12);
    }
}

std::vector<Vec3> allStates(const ContactScene& scene) {
  std::vector<Vec3> all = scene.grains.particles.x;
  for (const auto* part : {&scene.grains.particles.v, &scene.grains.particles.omega, &scene.solid.nodes.u,
                           &scene.solid.nodes.v, &scene.side.load.force})
    all.insert(all.end(), part->begin(), part->end());
  return all;
}

/// All but the connector, which saves and loads itself.
void copyState(ContactScene& from, ContactScene& to) {
  dem::Terms theirs = std::move(from.grains.terms), own = std::move(to.grains.terms);
  to.grains = from.grains;
  from.grains.terms = std::move(theirs);
  to.grains.terms = std::move(own);
  to.solid.nodes = from.solid.nodes;
  to.side.load = from.side.load;
}

TEST(SurfaceContact, GoesOnBitForBitFromWhatItSaved) {
  const fem::SolidMesh mesh = softBlock(ElementShape::hex8);
  for (const Variant& variant :
       {Variant{"local"}, Variant{"lucy", 0.2},
        Variant{"smooth", 0.2, cg::KernelShape::lucy, cg::KernelCorrection::symmetric, true}}) {
    const auto laws = variant.smooth ? elasticLaws(2e4, 0.8) : rollingLaws(0.8);
    ContactScene whole(mesh, slantingGrains(20, 7), laws, variant), rest(mesh, slantingGrains(20, 8), laws, variant);
    whole.start(1e-4);
    for (int step = 0; step < 120; ++step) whole.step(1e-4);
    ASSERT_TRUE(whole.contact->coupling().inContact());
    copyState(whole, rest);
    ByteWriter writer;
    whole.contact->save(writer);
    ByteReader reader(writer.bytes());
    rest.contact->load(reader);
    EXPECT_TRUE(reader.atEnd());
    for (int step = 0; step < 120; ++step) {
      whole.step(1e-4);
      rest.step(1e-4);
    }
    EXPECT_EQ(allStates(whole), allStates(rest)) << variant.name;
  }
}

TEST(SurfaceContact, IsTheSameForAnyNumberOfThreads) {
  const fem::SolidMesh mesh = softBlock(ElementShape::tet10, {4, 4, 2});
  const auto states = [&] {
    ContactScene scene(mesh, slantingGrains(100, 9), rollingLaws(0.8), {"lucy", 0.2});
    scene.start(1e-4);
    for (int step = 0; step < 60; ++step) scene.step(1e-4);
    return allStates(scene);
  };
  EXPECT_EQ(onThreads(1, states), onThreads(3, states));
}

/// ω² of the stiffest mode of grains and nodes under their contacts alone, by the power method on M⁻¹K, K from
/// differences of forces.
double stiffestMode(ContactScene& scene) {
  Random random(3);
  const fem::Nodes& nodes = scene.solid.nodes;
  const std::size_t n = scene.grains.particles.size();
  std::vector<Vec3> grain = random.field(n, 1.0), node = random.field(nodes.X.size(), 1.0);
  SurfaceCoupler seam(scene.contact->coupling().skin());
  const std::vector<Vec3> rest(nodes.X.size());
  const auto answer = [&](double h) {
    dem::Particles moved = scene.grains.particles;
    std::vector<Vec3> u = nodes.u;
    for (std::size_t i = 0; i < n; ++i) {
      moved.x[i] += h * grain[i];
      moved.v[i] = {};
    }
    for (std::size_t i = 0; i < u.size(); ++i) u[i] += h * node[i];
    return respond(seam, moved, u, rest, scene.contact->laws());
  };
  double square = 0.0;
  for (int iteration = 0; iteration < 200; ++iteration) {
    double size = 0.0;
    for (const Vec3& d : grain) size += squaredNorm(d);
    for (const Vec3& d : node) size += squaredNorm(d);
    for (Vec3& d : grain) d = d / std::sqrt(size);
    for (Vec3& d : node) d = d / std::sqrt(size);
    const double h = 1e-8;
    const Response ahead = answer(h), behind = answer(-h);
    double grown = 0.0;
    for (std::size_t i = 0; i < n; ++i) {
      grain[i] = (behind.onParticles[i] - ahead.onParticles[i]) / (2.0 * h * scene.grains.particles.mass[i]);
      grown += squaredNorm(grain[i]);
    }
    for (std::size_t i = 0; i < node.size(); ++i) node[i] = (behind.onNodes[i] - ahead.onNodes[i]) / (2.0 * h);
    scene.side.mass->solve(node);
    for (const Vec3& d : node) grown += squaredNorm(d);
    square = std::sqrt(grown);
  }
  return square;
}

/// Many grains on one face, heavy against its nodes: each meets nodes that the others push at, too.
TEST(SurfaceContact, TheCriticalStepIsSafeForAnyNumberOfGrainsOnAFace) {
  for (const ElementShape shape : {ElementShape::hex8, ElementShape::tet4, ElementShape::hex20})
    for (const int count : {-16, 1, 4, 16}) {  // < 0: with consistent masses
      dem::Particles particles;
      for (int k = 0; k < std::abs(count); ++k)
        dem::addParticle(particles, {0.23 + 0.045 * (k % 4), 0.22 + 0.045 * (k / 4), 0.02 - 1e-6}, {}, 0.02,
                         dem::Mass{100.0});
      ContactScene scene(softBlock(shape), std::move(particles), elasticLaws(2e4));
      const fem::ModelMass consistent(scene.solid, scene.motion->dofs(), 1.0);
      if (count < 0) scene.side.mass = &consistent;
      scene.start(1e-6);
      ASSERT_GE(static_cast<int>(scene.contact->coupling().contacts().size()), std::abs(count));
      const double safe = dem::criticalStep(scene.grains).dt, real = 2.0 / std::sqrt(stiffestMode(scene));
      EXPECT_LE(safe, real * (1.0 + 1e-6)) << fem::name(shape) << ", " << count;
      EXPECT_GE(safe, (count < 0 ? 0.1 : 0.4) * real) << fem::name(shape) << ", " << count;
    }
}

TEST(SurfaceContact, FrictionAndSpinAskForSmallerSteps) {
  const auto limit = [&](std::shared_ptr<const dem::ContactLaws> laws) {
    ContactScene scene(softBlock(ElementShape::hex8), slantingGrains(9, 5), std::move(laws));
    scene.start(1e-5);
    while (!scene.contact->coupling().inContact()) scene.step(1e-5);
    return dem::criticalStep(scene.grains).dt;
  };
  EXPECT_LT(limit(rollingLaws()), 0.8 * limit(elasticLaws(2e4)));
}

TEST(SurfaceContact, OfACopyMeetsTheSolidAndLoadsNobody) {
  const fem::SolidMesh mesh = softBlock(ElementShape::hex8);
  ContactScene scene(mesh, slantingGrains(3, 5), rollingLaws());
  scene.grains.particles.x[0].z -= 0.01;
  dem::findForces(scene.grains);
  const std::vector<Vec3> load = scene.side.load.force;
  dem::Model copy = scene.grains;
  copy.particles.x[0].z -= 0.001;
  dem::findForces(copy);
  EXPECT_EQ(scene.side.load.force, load);
  EXPECT_GT(copy.particles.f[0].z, scene.grains.particles.f[0].z);
}

TEST(SurfaceContact, NamesTheSurfaceThatSetsTheStep) {
  const fem::SolidMesh mesh = softBlock(ElementShape::hex8);
  dem::Particles one;
  dem::addParticle(one, {0.3, 0.3, 0.029}, {}, 0.03, dem::Mass{1.0});
  ContactScene scene(mesh, one, rollingLaws());
  scene.start(1e-5);
  EXPECT_EQ(dem::criticalStep(scene.grains).owner, "the contact of particle 0 with \"contacts\"");
}

TEST(SurfaceContact, RefusesWhatItCannotDo) {
  const fem::SolidMesh mesh = softBlock(ElementShape::hex8), other = softBlock(ElementShape::hex8, {2, 2, 1});
  ContactScene scene(mesh, slantingGrains(3, 5), rollingLaws());
  const Skin skin = makeSkin(mesh.X, mesh.faceSets.at("skin"));
  EXPECT_THROW(SurfaceContact(scene.side, SurfaceCoupler(makeSkin(other.X, other.faceSets.at("skin"))), rollingLaws()),
               InputError);
  EXPECT_THROW(SurfaceContact(scene.side, SurfaceCoupler(skin), nullptr), InputError);
  EXPECT_THROW(SurfaceContact(scene.side, SurfaceCoupler(makeSmoothSurface(skin)), rollingLaws()), InputError);
  dem::Model still;
  still.laws = elasticLaws(1e4);
  dem::addParticle(still.particles, {0.3, 0.3, 0.1}, {}, 0.03, dem::Mass{1.0});
  still.terms.add(SurfaceContact(scene.side, SurfaceCoupler(skin), rollingLaws(), "contacts"));
  EXPECT_THROW(dem::findForces(still), InputError) << "particles do not spin";
}

/// Bytes of a state may be whole and not fit: they are refused, or the contacts are found anew.
TEST(SurfaceContact, DamagedStatesNeverCrash) {
  const fem::SolidMesh mesh = softBlock(fem::ElementShape::hex8);
  const std::vector<Vec3> rest(mesh.X.size());
  dem::Particles particles = slantingGrains(12, 3);
  for (Vec3& x : particles.x) x.z -= 0.004;
  const auto laws = elasticLaws(1e4);
  for (const bool smooth : {false, true}) {
    SurfaceCoupler good = makeSeam(mesh, {.name = "", .smooth = smooth});
    respond(good, particles, rest, rest, *laws);
    ASSERT_GT(good.contacts().size(), 5U);
    ByteWriter writer;
    good.save(writer);
    std::size_t refused = 0;
    const auto load = [&](const std::vector<char>& bytes) {
      SurfaceCoupler other = good;
      try {
        ByteReader reader(bytes);
        other.load(reader);
        other.check(particles);
        respond(other, particles, rest, rest, *laws);
      } catch (const Error&) {
        ++refused;
      }
    };
    load(writer.bytes());
    EXPECT_EQ(refused, 0U);
    const std::int32_t number = 1 << 24;
    const double notANumber = std::numeric_limits<double>::quiet_NaN();
    for (std::size_t at = 0; at + 8 <= writer.bytes().size(); at += 4) {
      std::vector<char> bytes = writer.bytes();
      std::memcpy(&bytes[at], &number, sizeof number);
      load(bytes);
      std::memcpy(&bytes[at], &notANumber, sizeof notANumber);
      load(bytes);
    }
    EXPECT_GT(refused, 200U) << smooth;
  }
}

}  // namespace
}  // namespace dovetail::surface
