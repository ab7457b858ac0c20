// Every sample is read to the same spheres, or refused with the reason.
#include "samples.hpp"

namespace dovetail::grain_io {
namespace {

using test::read, test::refusal, test::sample;

struct Known {
  std::int64_t id;
  Vec3 x;
  double radius, density;
  Vec3 v, spin;
  std::int64_t type;
};
const std::array<Known, 3> known{{{1, {0.01, 0.02, 0.03}, 0.004, 2500.0, {0.1, -0.2, 0.3}, {1.0, 2.0, -3.0}, 0},
                                  {2, {0.05, 0.02, 0.005}, 0.005, 2500.0, {}, {}, 1},
                                  {7, {0.03, 0.04, 0.07}, 0.0025, 1200.0, {-0.5, 0.0, 0.25}, {0.0, 0.0, 10.0}, 0}}};

std::size_t placeOf(const GrainFile& file, const Known& one, std::size_t otherwise) {
  for (std::size_t i = 0; i < file.id.size(); ++i)
    if (file.id[i] == one.id) return i;
  return otherwise;
}

void expectNear(const Vec3& a, const Vec3& b, double scale) { EXPECT_LE(norm(a - b), 1e-14 * scale); }

void expectKnown(const GrainFile& file) {
  ASSERT_EQ(file.size(), 3u);
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t i = placeOf(file, known[k], k);
    expectNear(file.position[i], known[k].x, 0.1);
    EXPECT_NEAR(file.radius[i], known[k].radius, 1e-17);
    if (!file.density.empty()) {
      EXPECT_NEAR(file.density[i], known[k].density, 1e-11);
    }
    if (!file.velocity.empty()) expectNear(file.velocity[i], known[k].v, 1.0);
    if (!file.spin.empty()) expectNear(file.spin[i], known[k].spin, 10.0);
  }
}

TEST(Samples, FilesOfLammpsHoldTheKnownSpheres) {
  for (const char* const name :
       {"sphere-2022.data", "write-data-2014.data", "liggghts-by-hand.data", "bonded-2023.data", "hybrid.data",
        "micro.data", "custom.dump", "scaled.dump", "liggghts.dump", "unwrapped.dump"}) {
    SCOPED_TRACE(name);
    const GrainFile file = read(sample(std::string("lammps/") + name));
    expectKnown(file);
    EXPECT_EQ(file.density.size(), 3u);
    EXPECT_EQ(file.velocity.size(), 3u);
    EXPECT_EQ(file.spin.size(), 3u);
    EXPECT_EQ(file.id.size(), 3u);
    for (std::size_t k = 0; k < 3; ++k) EXPECT_EQ(file.type[placeOf(file, known[k], k)], known[k].type + 1);
    ASSERT_TRUE(file.box);
    expectNear(file.box->upper, {0.06, 0.06, 0.1}, 0.1);
    const bool isDump = std::string(name).ends_with(".dump");
    EXPECT_EQ(file.periodic.has_value(), isDump);
    if (isDump) {
      EXPECT_EQ((*file.periodic)[0], std::string(name) != "liggghts.dump");
    }
    if (isDump) {
      EXPECT_FALSE((*file.periodic)[2]);
    }
  }
}

TEST(Samples, FilesOfYadeHoldTheKnownSpheres) {
  for (const char* const name : {"text.txt", "materials.txt", "attributes.txt", "ids.txt", "plain.txt"}) {
    SCOPED_TRACE(name);
    const GrainFile file = readYade(sample(std::string("yade/") + name));
    expectKnown(file);
    EXPECT_TRUE(file.density.empty());
    EXPECT_FALSE(file.box);
    for (std::size_t k = 0; k < file.type.size(); ++k) EXPECT_EQ(file.type[k], known[k].type);
  }
  EXPECT_EQ(readYade(sample("yade/materials.txt")).type.size(), 3u);
  EXPECT_EQ(readYade(sample("yade/ids.txt")).id.size(), 3u);
}

TEST(Samples, FilesOfMercuryHoldTheKnownSpheres) {
  for (const char* const name : {"base-particles.restart", "spherical-particles.restart", "two-frames.data"}) {
    SCOPED_TRACE(name);
    const GrainFile file = read(sample(std::string("mercury/") + name));
    expectKnown(file);
    EXPECT_EQ(file.velocity.size(), 3u);
    EXPECT_EQ(file.spin.size(), 3u);
    EXPECT_EQ(file.type[2], 1);
    EXPECT_EQ(file.time, 0.5);
    ASSERT_TRUE(file.box);
    EXPECT_EQ(file.box->upper.x, 0.06);
  }
  EXPECT_EQ(read(sample("mercury/base-particles.restart")).periodic, (std::array{true, true, false}));
  const GrainFile discs = read(sample("mercury/discs.data"));
  EXPECT_EQ(discs.position[0], (Vec3{0.01, 0.03, 0.0}));
  EXPECT_EQ(discs.velocity[0], (Vec3{0.1, 0.3, 0.0}));
  EXPECT_EQ(discs.spin[0], (Vec3{0.0, 0.0, -3.0}));
  EXPECT_EQ(discs.radius[1], 0.005);
}

TEST(Samples, FramesAreChosen) {
  const auto firstX = [](const std::string& name, std::int64_t frame) {
    return read(sample(name), frame).position[0].x;
  };
  EXPECT_EQ(firstX("lammps/liggghts.dump", 0), 0.011);
  EXPECT_EQ(firstX("lammps/liggghts.dump", 1), 0.0105);
  EXPECT_EQ(firstX("lammps/liggghts.dump", -2), 0.0105);
  EXPECT_EQ(firstX("lammps/liggghts.dump", -1), 0.01);
  EXPECT_EQ(firstX("mercury/two-frames.data", 0), 0.011);
  for (const std::int64_t frame : {3, -4})
    EXPECT_NE(refusal([&] { firstX("lammps/liggghts.dump", frame); }).find("the file has 3: give 0 to 2"),
              std::string::npos);
  EXPECT_NE(refusal([&] { firstX("lammps/sphere-2022.data", 0); }).find("a data file has one frame"),
            std::string::npos);
}

TEST(Samples, WhatIsNotReadIsTold) {
  const auto notes = [](const std::string& name) {
    std::string text;
    for (const std::string& note : read(sample(name)).notes) text += note + "\n";
    return text;
  };
  EXPECT_EQ(notes("lammps/bonded-2023.data"), "1 bonds of the file are not read.\n");
  EXPECT_NE(notes("lammps/write-data-2014.data").find("does not name its style"), std::string::npos);
  EXPECT_NE(notes("lammps/sphere-2022.data").find("Image flags"), std::string::npos);
  EXPECT_NE(notes("lammps/custom.dump").find("'ix', 'iy', 'iz'"), std::string::npos);
  EXPECT_NE(notes("yade/attributes.txt").find("attributes"), std::string::npos);
  EXPECT_NE(notes("mercury/base-particles.restart").find("Walls of the file are not read: 1 'InfiniteWall'"),
            std::string::npos);
  EXPECT_NE(notes("mercury/base-particles.restart").find("1 particle is fixed in the file"), std::string::npos);
  EXPECT_NE(notes("mercury/spherical-particles.restart").find("1 'IntersectionOfWalls', 2 'TriangleWall'"),
            std::string::npos);
  EXPECT_NE(notes("mercury/spherical-particles.restart").find("1 'DeletionBoundary'"), std::string::npos);
  EXPECT_NE(notes("mercury/discs.data").find("discs"), std::string::npos);
}

TEST(Samples, OthersAreRefusedByName) {
  const std::vector<std::array<const char*, 2>> cases{
      {"lammps/hybrid-unnamed.data", "line 12: the parts of the atom style hybrid are not named"},
      {"lammps/full.data", "the file is in units 'real'"},
      {"lammps/ellipsoids.data", "line 5: the file has ellipsoids"},
      {"lammps/lj.data", "units lj"},
      {"lammps/multisphere.dump", "line 10: the sphere is a part of a multisphere"},
      {"lammps/contacts.dump", "line 3: a dump of 'ENTRIES' has no spheres"},
      {"lammps/no-radius.dump", "line 9: there are no radii"},
      {"yade/clumps.txt", "line 1: the format x_y_z_r_clumpId is of clumps"},
      {"yade/facets.txt", "line 1: the format is 'x1_y1_z1"},
      {"mercury/superquadric.restart", "the particle is of the kind 'SuperQuadricParticle'"},
      {"mercury/clump.restart", "the particle is of the kind 'ClumpParticle'"}};
  for (const auto& [name, message] : cases) {
    const std::string said = refusal([&, file = name] { read(sample(file)); });
    EXPECT_TRUE(test::says(said, message)) << name << ": " << said;
  }
}

TEST(Samples, UnitsAreThoseThatTheFileNamesOrTheCallerGives) {
  const GrainFile file = readLammps(sample("lammps/lj.data"), Units::lj);
  EXPECT_EQ(file.position[0].z, 0.5);
  EXPECT_NE(refusal([] { readLammps(sample("lammps/micro.data"), Units::si); }).find("in units micro, not si"),
            std::string::npos);
  // The same numbers in cgs: centimetres, grams.
  const GrainFile small = readLammps(sample("lammps/write-data-2014.data"), Units::cgs);
  EXPECT_DOUBLE_EQ(small.radius[0], 4e-5);
  EXPECT_DOUBLE_EQ(small.density[0], 2.5e6);
  EXPECT_DOUBLE_EQ(small.velocity[0].x, 1e-3);
  EXPECT_DOUBLE_EQ(small.spin[0].x, 1.0);
  EXPECT_DOUBLE_EQ(readLammps(sample("lammps/write-data-2014.data"), Units::nano).density[0], 2.5e9);
}

}  // namespace
}  // namespace dovetail::grain_io
