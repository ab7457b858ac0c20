// Scenes of the benchmarks beside their programs.
#include <gtest/gtest.h>

#include <filesystem>

#include "benchmarks/cantilever/model.hpp"
#include "benchmarks/wave_propagation/model.hpp"
#include "dovetail/scene/build.hpp"
#include "dovetail/scene/read.hpp"

namespace dovetail::scene {
namespace {

Built startedScene(const std::string& name) {
  if (!WITH_EXPRESSIONS) return {};
  const Scene file = readScene(std::filesystem::path(SCENES) / (name + ".json"));
  Built built = build(file);
  start(built, file);
  return built;
}

TEST(BenchmarkScenes, CantileverHasTheDigitsOfTheProgram) {
  Built built = startedScene("cantilever");
  if (!built.run) GTEST_SKIP();
  const cantilever::Settings settings;
  const fem::SolidMesh mesh = cantilever::makeMesh(settings);
  const cantilever::Scene program = cantilever::makeScene(settings, mesh);
  program.run->start(settings.dtFactor * cantilever::contactTime(cantilever::Case{}));
  EXPECT_EQ(built.run->dt(), program.run->dt());
  for (coupling::CoupledRun* const run : {built.run.get(), program.run.get()}) run->advance(5000);
  // Grains are sorted in a scene, so that loads are summed up in another order.
  const dem::Particles &ours = built.run->grains.particles, &theirs = program.run->grains.particles;
  for (const std::int64_t id : {0, 1}) {
    const auto a = static_cast<std::size_t>(find(ours, id)), b = static_cast<std::size_t>(find(theirs, id));
    EXPECT_LT(norm(ours.x[a] - theirs.x[b]), 1e-14);
    EXPECT_LT(norm(ours.v[a] - theirs.v[b]), 1e-12);
  }
  for (std::size_t n = 0; n < mesh.X.size(); ++n)
    EXPECT_LT(norm(built.run->solid(0).nodes().u[n] - program.beam->nodes().u[n]), 1e-14);
  EXPECT_GT(built.run->ledger().joules("beam: kinetic"), 0.0);
}

/// Displacement of all particles from where they were at the start, by that place.
std::vector<std::pair<Vec3, Vec3>> motions(const std::vector<Vec3>& start, const dem::Particles& now) {
  std::vector<std::pair<Vec3, Vec3>> found;
  for (std::size_t i = 0; i < start.size(); ++i)
    found.emplace_back(start[i], now.x[static_cast<std::size_t>(find(now, static_cast<std::int64_t>(i)))] - start[i]);
  const auto rounded = [](const Vec3& x) {
    return std::array{std::lround(1e6 * x.y), std::lround(1e6 * x.z), std::lround(1e6 * x.x)};
  };
  std::sort(found.begin(), found.end(),
            [&](const auto& a, const auto& b) { return rounded(a.first) < rounded(b.first); });
  return found;
}

TEST(BenchmarkScenes, WaveGoesAsInTheProgram) {
  Built built = startedScene("wave");
  if (!built.run) GTEST_SKIP();
  wave::Settings settings;
  settings.dtFactor = 0.01;
  double penalty = wave::penaltyOf(settings);
  const wave::Bar bar = wave::makeBar(settings, penalty);
  const wave::StepPlan plan = wave::planSteps(settings, wave::criticalStep(settings, bar));
  bar.run->start(plan.dt);
  EXPECT_NEAR(built.run->dt(), plan.dt, 1e-12 * plan.dt);
  const std::vector<Vec3> first = built.run->grains.particles.x, second = bar.run->grains.particles.x;
  ASSERT_EQ(first.size(), second.size());
  for (coupling::CoupledRun* const run : {built.run.get(), bar.run.get()}) run->advance(plan.windows);
  const auto ours = motions(first, built.run->grains.particles), theirs = motions(second, bar.run->grains.particles);
  const fem::Nodes &a = built.run->solid(0).nodes(), &b = bar.solid->nodes();
  ASSERT_EQ(a.u.size(), b.u.size());
  double largest = 0.0, apart = 0.0;
  for (std::size_t n = 0; n < b.u.size(); ++n) {
    largest = std::max(largest, norm(b.u[n]));
    apart = std::max(apart, norm(a.u[n] - b.u[n]));
  }
  for (std::size_t i = 0; i < ours.size(); ++i) apart = std::max(apart, norm(ours[i].second - theirs[i].second));
  EXPECT_GT(largest, 1e-4);
  EXPECT_LT(apart, 1e-9 * largest) << apart / largest;
  EXPECT_NEAR(built.run->ledger().joules("bar: kinetic"), bar.run->ledger().joules("solid: kinetic"),
              1e-9 * bar.run->ledger().joules("solid: kinetic"));
}

}  // namespace
}  // namespace dovetail::scene
