#include <bit>
#include <random>

#include "samples.hpp"

namespace dovetail::grain_io {
namespace {

bool sameBits(double a, double b) { return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b); }
bool sameBits(const Vec3& a, const Vec3& b) { return sameBits(a.x, b.x) && sameBits(a.y, b.y) && sameBits(a.z, b.z); }

GrainFile randomGrains(std::size_t count, bool moves) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> unit(-1.0, 1.0), power(-12.0, 3.0);
  const auto number = [&] { return unit(random) * std::pow(10.0, power(random)); };
  const auto vector = [&] { return Vec3{number(), number(), number()}; };
  GrainFile grains;
  for (std::size_t i = 0; i < count; ++i) {
    grains.position.push_back(vector());
    grains.radius.push_back(std::abs(number()) + 1e-9);
    grains.density.push_back(1e3 * (1.5 + unit(random)));
    grains.id.push_back(static_cast<std::int64_t>(3 * (count - i)));
    grains.type.push_back(1 + static_cast<std::int64_t>(i % 3));
    if (!moves) continue;
    grains.velocity.push_back(vector());
    grains.spin.push_back(vector());
  }
  grains.box = geometry::Box{{-0.1, -1.0 / 3.0, 1e-7}, {0.1, 2.0 / 3.0, 7.0}};
  return grains;
}

TEST(RoundTrips, LammpsDataKeepsEveryBit) {
  for (const bool moves : {false, true}) {
    const GrainFile grains = randomGrains(200, moves);
    const test::Written file(lammpsText(grains));
    const GrainFile read = readLammps(file.path());
    ASSERT_EQ(read.size(), grains.size());
    EXPECT_EQ(read.id, grains.id);
    EXPECT_EQ(read.type, grains.type);
    EXPECT_EQ(read.velocity.size(), grains.velocity.size());
    EXPECT_TRUE(read.notes.empty());
    EXPECT_EQ(read.box, grains.box);
    for (std::size_t i = 0; i < grains.size(); ++i) {
      EXPECT_TRUE(sameBits(read.position[i], grains.position[i]));
      EXPECT_TRUE(sameBits(read.radius[i], grains.radius[i]));
      EXPECT_TRUE(sameBits(read.density[i], grains.density[i]));
      if (moves) {
        EXPECT_TRUE(sameBits(read.velocity[i], grains.velocity[i]));
      }
      if (moves) {
        EXPECT_TRUE(sameBits(read.spin[i], grains.spin[i]));
      }
    }
    EXPECT_EQ(lammpsText(read), lammpsText(grains));
  }
}

TEST(RoundTrips, EverySampleThatIsReadKeepsItsSpheres) {
  std::size_t count = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(SAMPLES)) {
    if (!entry.is_regular_file()) continue;
    GrainFile first;
    if (!test::refusal([&] { first = test::read(entry.path()); }).empty()) continue;
    if (first.density.empty()) first.density.assign(first.size(), 2600.0);
    const test::Written file(lammpsText(first));
    const GrainFile second = readLammps(file.path());
    EXPECT_EQ(second.position, first.position) << entry.path();
    EXPECT_EQ(second.radius, first.radius);
    EXPECT_EQ(second.density, first.density);
    if (!second.spin.empty()) {
      EXPECT_EQ(second.spin, first.spin);
    }
    ++count;
  }
  EXPECT_GE(count, 18u);
}

TEST(RoundTrips, TheBoxHoldsAllSpheresAndTypesBeginWithOne) {
  GrainFile grains = randomGrains(50, false);
  grains.box.reset();
  for (std::int64_t& type : grains.type) type -= 1;
  grains.id.clear();
  const test::Written file(lammpsText(grains));
  const GrainFile read = readLammps(file.path());
  for (std::size_t i = 0; i < read.size(); ++i)
    for (int c = 0; c < 3; ++c) {
      EXPECT_GE(read.position[i][c] - read.radius[i], read.box->lower[c]);
      EXPECT_LE(read.position[i][c] + read.radius[i], read.box->upper[c]);
    }
  EXPECT_EQ(read.type[0], 1);
  EXPECT_EQ(read.type[2], 3);
  EXPECT_EQ(read.id[49], 50);
}

TEST(RoundTrips, WithoutDensitiesNothingIsWritten) {
  GrainFile grains = randomGrains(2, false);
  grains.density.clear();
  EXPECT_NE(test::refusal([&] { lammpsText(grains); }).find("0 densities of 2 spheres"), std::string::npos);
  EXPECT_NE(test::refusal([] { lammpsText({}); }).find("no spheres"), std::string::npos);
}

}  // namespace
}  // namespace dovetail::grain_io
