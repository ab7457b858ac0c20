// Starts, steps and checks of a model.
#include <gtest/gtest.h>

#include <limits>

#include "dovetail/core/error.hpp"
#include "dovetail/dem/model/loads.hpp"
#include "dovetail/dem/model/walls.hpp"
#include "walls/wall_scenes.hpp"

namespace dovetail::dem {
namespace {

constexpr double k = 1e4, pi = 3.14159265358979324;

Model oneSphere(const Vec3& x, const Vec3& v) {
  Model model;
  model.laws = makeContactLaws(ElasticLaw{{k}});
  model.pairs.setSkin(0.01);
  addParticle(model.particles, x, v, 0.1, Mass{1.0});
  return model;
}

TEST(Start, FreeFallIsExactFromTheFirstStepOn) {
  Model model = oneSphere({}, {});
  model.gravity = {0, 0, -9.81};
  run(model, 1e-3, 100);
  EXPECT_NEAR(model.particles.v[0].z, -0.981, 1e-14);
  EXPECT_NEAR(model.particles.x[0].z, -0.5 * 9.81 * 0.01, 1e-15);
}

TEST(Start, AStepMayChangeInFlight) {
  Model model = oneSphere({}, {});
  model.gravity = {0, 0, -10.0};
  for (int i = 0; i < 50; ++i) {
    advance(model, 1e-4);
    advance(model, 1e-3);
  }
  close(model);
  EXPECT_NEAR(model.particles.v[0].z, -0.55, 1e-14);
  EXPECT_NEAR(model.particles.x[0].z, -5.0 * 0.055 * 0.055, 1e-15);
  EXPECT_NEAR(model.time, 0.055, 1e-16);
}

TEST(Start, TimeIsCountedNotSummedUp) {
  Model model = oneSphere({}, {});
  run(model, 0.1, 1000);
  EXPECT_EQ(model.time, 1000 * 0.1);
}

/// Error of position and velocity after a quarter of the period of a sphere that sinks into a plane, m/s.
double errorOfImpact(double steps) {
  Model model = oneSphere({0, 0, 0.1 - 0.002}, {0, 0, -0.5});  // touches from the start
  addWall(model, makePlane({}, {0, 0, 1}));
  const double omega = std::sqrt(k), end = 0.25 * pi / omega;
  run(model, end / steps, static_cast<std::int64_t>(steps));
  const double x = -0.002 * std::cos(omega * end) - 0.5 / omega * std::sin(omega * end);
  const double v = 0.002 * omega * std::sin(omega * end) - 0.5 * std::cos(omega * end);
  return std::hypot(omega * (model.particles.x[0].z - 0.1 - x), model.particles.v[0].z - v);
}

TEST(Start, AnElasticImpactIsOfSecondOrder) {
  const double coarse = errorOfImpact(20), fine = errorOfImpact(40);
  EXPECT_LT(coarse, 1e-3);
  EXPECT_NEAR(coarse / fine, 4.0, 0.2);
}

TEST(Start, BooksOpenedBeforeTheFirstStepHaveTheContactsOfACompressedStart) {
  Model model = oneSphere({0, 0, 0}, {});
  addParticle(model.particles, {0.19, 0, 0}, {}, 0.1, Mass{1.0});
  const Energies start = energies(model);
  EXPECT_NEAR(start.contacts, 0.5 * k * 1e-4, 1e-15);
  run(model, 1e-4, 10);
  EXPECT_NEAR(energies(model).balance(), start.balance(), 1e-3 * start.contacts);
}

TEST(Start, AStepBeyondTheLimitIsRefusedBeforeAnythingMoves) {
  Model model = oneSphere({0, 0, 0}, {});
  addParticle(model.particles, {0.19, 0, 0}, {}, 0.1, Mass{1.0});
  const double limit = 2.0 / std::sqrt(2.0 * k);
  for (const double dt : {1.0, 1.01 * limit}) EXPECT_THROW(advance(model, dt), InputError) << dt;
  EXPECT_EQ(model.particles.x[1].x, 0.19);
  EXPECT_NO_THROW(advance(model, 0.01 * limit));
  EXPECT_THROW(advance(model, 1.01 * limit), InputError);
  for (const double dt : {0.0, -1e-4, std::numeric_limits<double>::quiet_NaN()})
    EXPECT_THROW(advance(model, dt), InputError) << dt;
}

TEST(Start, ParticlesAddedBetweenStepsGetTheirFirstHalfKick) {
  Model model = oneSphere({}, {});
  model.gravity = {0, 0, -10.0};
  run(model, 1e-3, 10);
  addParticle(model.particles, {1, 0, 0}, {}, 0.1, Mass{1.0});
  run(model, 1e-3, 50);
  EXPECT_NEAR(model.particles.v[1].z, -0.5, 1e-15);
  EXPECT_NEAR(model.particles.v[0].z, -0.6, 1e-15);
}

/// Lets one sphere of 2 kg in at step 10.
class Gate final : public Term {
public:
  Gate(const Vec3& v, double radius) : v_(v), radius_(radius) {}
  std::string name() const override { return "gate"; }
  std::unique_ptr<Term> clone() const override { return std::make_unique<Gate>(*this); }
  void exchange(Model& m, const Step& step) override {
    if (step.number != 10) return;
    const std::size_t first = m.particles.size();
    addParticle(m.particles, {1, 0, 0}, v_, radius_, Mass{2.0});
    admitParticles(m, first);
  }

private:
  Vec3 v_;
  double radius_;
};

TEST(Start, ParticlesThatEnterWithinAStepFallFromThatMomentAndAreBooked) {
  Model model = oneSphere({}, {});
  model.gravity = {0, 0, -10.0};
  model.terms.add(Gate({0, 0, 1}, 0.1));
  run(model, 1e-3, 60);
  ASSERT_EQ(model.particles.size(), 2u);
  EXPECT_NEAR(model.particles.v[1].z, 0.5, 1e-14);
  EXPECT_NEAR(model.particles.x[1].z, 0.05 - 5.0 * 0.0025, 1e-14);
  EXPECT_EQ(model.entered.count, 1);
  EXPECT_EQ(model.entered.mass, 2.0);
  EXPECT_EQ(model.entered.momentum, (Vec3{0, 0, 2.0}));
  EXPECT_NEAR(energies(model).balance(), 0.0, 1e-14);
}

TEST(Start, ASmallParticleThatEntersWithinAStepCountsInTheCheckOfMoves) {
  Model model = oneSphere({}, {});
  model.terms.add(Gate({0, 0, 20}, 0.01));  // fast beside its size, but not beside that of the other
  run(model, 1e-3, 10);
  ASSERT_EQ(model.particles.size(), 2u);
  try {
    run(model, 1e-3, 1);  // 20 mm: twice its radius, a fifth of the other's
    FAIL();
  } catch (const NumericalError& error) {
    EXPECT_NE(std::string(error.what()).find("particle 1"), std::string::npos) << error.what();
  }
}

TEST(Check, SaysWhatIsMissingOrWrong) {
  const auto refused = [](auto&& spoil, const char* word) {
    Model model = oneSphere({}, {});
    addWall(model, makePlane({0, 0, -1}, {0, 0, 1}));
    spoil(model);
    try {
      run(model, 1e-4, 1);
      ADD_FAILURE() << word;
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find(word), std::string::npos) << error.what();
    }
  };
  refused([](Model& m) { m.laws.reset(); }, "contact laws");
  refused([](Model& m) { m.gravity.y = NAN; }, "gravity");
  refused([](Model& m) { m.particles.mass.clear(); }, "mass");
  refused([](Model& m) { m.particles.v[0].x = NAN; }, "velocity");
  refused([](Model& m) { m.sortEvery = -1; }, "sortEvery");
  refused([](Model& m) { primitiveWall(m, 0).skin = -1.0; }, "skin");
  refused([](Model& m) { primitiveWall(m, 0).velocity.x = NAN; }, "wall");
  refused([](Model& m) { damping(m).viscousRate = -1.0; }, "viscous damping");
  refused([](Model& m) { damping(m).local = NAN; }, "local damping");
  refused([](Model& m) { m.terms.add(ExternalForceTerm("wind", {})); }, "wind");
  refused(
      [](Model& m) {
        m.laws = makeContactLaws(LawTable<ElasticLaw>(2, ElasticLaw{{k}}));
        m.particles.material = {3};
      },
      "material 3");
  refused(
      [](Model& m) {
        m.laws = makeContactLaws(LawTable<ElasticLaw>(2, ElasticLaw{{k}}));
        primitiveWall(m, 0).material = 2;
      },
      "material 2");
}

TEST(Check, ParticlesSpinWhereLawsExertTorques) {
  Model model = oneSphere({}, {});
  model.laws = makeContactLaws(FrictionalLaw{{k}, {k, 0.5}});
  run(model, 1e-4, 1);
  EXPECT_TRUE(model.particles.rotates());
  Model slides = oneSphere({}, {});
  slides.laws = model.laws;
  slides.rotation = Rotation::off;
  run(slides, 1e-4, 1);
  EXPECT_FALSE(slides.particles.rotates());
}

TEST(Loads, ExternalForcesDoWorkThatIsBooked) {
  Model model = oneSphere({}, {0.3, 0, 0});
  addParticle(model.particles, {0, 1, 0}, {}, 0.1, Mass{2.0});
  model.terms.add(ExternalForceTerm("wind", [](const Particles& particles, double time, std::span<Vec3> f) {
    for (std::size_t i = 0; i < particles.size(); ++i) f[i] += Vec3{std::cos(20.0 * time), -particles.v[i].y, 0.1};
  }));
  damping(model).viscousRate = 0.5;
  const double start = energies(model).balance();
  run(model, 1e-3, 1000);
  const Energies end = energies(model);
  EXPECT_GT(std::abs(end.external), 1e-3);
  EXPECT_NEAR(end.balance(), start, 1e-3 * end.damping);
}

TEST(Loads, DrivenParticlesKeepToTheirPathAndTheirWorkIsBooked) {
  Model model = oneSphere({}, {});
  addParticle(model.particles, {0.195, 0, 0}, {}, 0.1, Mass{1.0});
  const auto path = [](double t) { return Vec3{0.01 * std::sin(30.0 * t), 0, 0}; };
  auto& drive = model.terms.add(DriveTerm({0}, path, [](double t) { return Vec3{0.3 * std::cos(30.0 * t), 0, 0}; }));
  model.particles.v[0].x = 0.3;
  const double start = energies(model).balance();
  const Vec3 before = momenta(model).linear;
  run(model, 1e-4, 700);
  EXPECT_NEAR(model.particles.x[0].x, path(0.07).x, 1e-15);
  const Energies end = energies(model);
  EXPECT_GT(std::abs(end.walls), 1e-3);
  EXPECT_NEAR(end.balance(), start, 1e-4 * end.stored());
  EXPECT_LT(norm(momenta(model).linear - before - drive.supportImpulse), 1e-14);
}

TEST(Weights, APileOfEqualWeightsMovesAsOneWithout) {
  const auto end = [](double weight) {
    Model model;
    model.laws = makeContactLaws(FrictionalLaw{{k, 0.5}, {k, 0.5}});
    model.gravity = {0, 0, -10};
    model.pairs.setSkin(0.01);
    Random random(4);
    for (int i = 0; i < 60; ++i)
      addParticle(model.particles, {0.19 * (i % 4), 0.19 * (i / 4 % 4), 0.099 + 0.19 * (i / 16)}, random.vector(0.1),
                  0.1, Mass{1.0 + 0.5 * (i % 3)});
    if (weight < 1.0) model.particles.weight.assign(60, weight);
    addWall(model, makePlane({}, {0, 0, 1}));
    run(model, 2e-4, 400);
    return model;
  };
  const Model whole = end(1.0), quarter = end(0.25);  // a power of two: the digits stay
  EXPECT_EQ(whole.particles.x, quarter.particles.x);
  EXPECT_EQ(whole.particles.omega, quarter.particles.omega);
  const Energies a = energies(whole), b = energies(quarter);
  EXPECT_NEAR(0.25 * a.kinetic, b.kinetic, 1e-12 * a.kinetic);
  EXPECT_NEAR(0.25 * a.gravity, b.gravity, 1e-12 * std::abs(a.gravity));
  EXPECT_NEAR(0.25 * a.contacts, b.contacts, 1e-12 * a.contacts);
  EXPECT_NEAR(0.25 * a.lost.lostPower(), b.lost.lostPower(), 1e-12 * a.lost.lostPower());
}

TEST(Terms, ACopyOfAModelGoesItsOwnWay) {
  Model model = oneSphere({0, 0, 0.2}, {0, 0, -1});
  addWall(model, makePlane({}, {0, 0, 1}));
  Model copy = model;
  primitiveWall(copy, 0).point.z = -5.0;
  run(model, 1e-3, 150);
  run(copy, 1e-3, 150);
  EXPECT_GT(model.particles.x[0].z, 0.05);
  EXPECT_NEAR(copy.particles.x[0].z, 0.05, 1e-14);
}

}  // namespace
}  // namespace dovetail::dem
