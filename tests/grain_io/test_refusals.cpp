// Faults of files are refused with the file and the line, and nothing makes a reader do worse.
#include <random>

#include "../mutated.hpp"
#include "samples.hpp"

namespace dovetail::grain_io {
namespace {

using test::read, test::refusalOf, test::replaced, test::sample, test::textOf;

struct Fault {
  const char *from, *to, *message;
};

void expectRefusals(const std::string& name, const std::vector<Fault>& faults) {
  const std::string text = textOf(sample(name));
  for (const Fault& fault : faults) {
    const std::string said = refusalOf(replaced(text, fault.from, fault.to));
    EXPECT_TRUE(test::says(said, fault.message)) << fault.to << ": " << said;
  }
}

TEST(Refusals, DataFilesOfLammps) {
  expectRefusals("lammps/sphere-2022.data",
                 {{"7 1 0.005", "7 1 -0.005", "line 12: a radius is -0.0025"},
                  {"7 1 0.005", "7 1 0", "line 12: a radius is 0"},
                  {"1200", "0", "line 12: a density is 0"},
                  {"0.03 0.04", "nan 0.04", "line 12: a number is 'nan'"},
                  {"0.03 0.04", "1e999 0.04", "line 12: '1e999' is not a number"},
                  {"0.03 0.04", "1e16 0.04", "line 12: a sphere lies at 1e+16"},
                  {"1 1 0.008", "7 1 0.008", "line 13: the id 7 occurs twice"},
                  {"1 1 0.008", "x 1 0.008", "line 13: the section Atoms ends after 1 of 3 lines"},
                  {"0.01 0.02 0.03 0 0 0", "0.01 0.02 0.03", "line 13: a line of Atoms has 7 columns, that before 10"},
                  {"1 0.1", "3 0.1", "line 18: there is no sphere of id 3"},
                  {"1 0.1", "7 0.1", "line 20: the velocity of id 7 is given twice"},
                  {"1 2 -3", "1 2", "line 18: a line of Velocities has 6 columns"},
                  {"3 atoms", "4 atoms", "line 16: the section Atoms ends after 3 of 4 lines"},
                  {"3 atoms", "2 atoms", "line 14: the line belongs to no section"},
                  {"3 atoms", "99999999999 atoms", "line 3: it announces 99999999999 atoms"},
                  {"3 atoms", "-3 atoms", "line 3: it announces -3 atoms"},
                  {"3 atoms\n", "", "the file is none that is known"},
                  {"0 0.06 xlo xhi", "0 -0.06 xlo xhi", "line 6: the box has no extent"},
                  {"0 0.06 xlo xhi", "0 0.06 xlo xhj", "line 6: the line is no header"},
                  {"0 0.1 zlo zhi", "0 0.1 zlo zhi\n0.1 0 0 xy xz yz", "line 9: the box is sheared"},
                  {"Atoms # sphere", "Atom # sphere", "line 10: there is no section 'Atom'"},
                  {"Atoms # sphere", "Atoms # full", "line 12: the atom style is 'full'"},
                  {"Atoms # sphere", "Atoms # hybrid full", "the atom style hybrid has 'full'"},
                  {"Velocities", "Atoms # sphere", "line 16: there are two sections Atoms"},
                  {"units = si", "units = metal", "the file is in units 'metal'"}});
  EXPECT_NE(refusalOf("\n0 atoms\n\nAtoms # sphere\n\n").find("the file has no spheres"), std::string::npos);
  EXPECT_NE(refusalOf("\n1 atoms\n1 atom types\n0 1 xlo xhi\n").find("no section Atoms"), std::string::npos);
}

TEST(Refusals, DumpsOfLammps) {
  expectRefusals("lammps/custom.dump", {{"0.004", "-0.004", "line 14: a radius is -0.004"},
                                        {"0.004", "inf", "line 14: a number is 'inf'"},
                                        {"0.004", "0.004 1", "line 14: a row has 17 values"},
                                        {"0.0006702", "-0.0006702", "line 14: a density is -2"},
                                        {"\n7 1", "\n1 1", "line 15: the id 1 occurs twice"},
                                        {"\n3\n", "\n4\n", "the dump breaks off after 3 of 4 atoms"},
                                        {"\n3\n", "\n2\n", "line 16: the line belongs to no part of a dump"},
                                        {"\n3\n", "\n-1\n", "it announces -1 atoms"},
                                        {"pp pp ff\n0.0", "pp pp ff\n1.0", "line 10: the box has no extent"},
                                        {"pp pp ff", "abc origin pp pp ff", "the box is not along the axes"},
                                        {" vy ", " wy ", "line 13: there is no column vy"},
                                        {"radius", "quatw", "line 13: the column 'quatw' is of other shapes"},
                                        {" x y z", " a b c", "line 13: there are no positions"},
                                        {"ITEM: UNITS", "ITEM: LABEL", "a dump of 'LABEL' has no spheres"}});
  const std::string three = textOf(sample("lammps/liggghts.dump"));
  const std::string cut = three.substr(0, three.rfind("\n7 1 1") + 1);
  EXPECT_NE(refusalOf(cut).find("take an earlier frame"), std::string::npos);
  for (const std::string& text : {cut, three.substr(0, three.find("2000")), three.substr(0, three.rfind("BOX"))}) {
    const test::Written file(text);
    EXPECT_EQ(read(file.path(), -2).position[0].x, 0.0105);
  }
}

TEST(Refusals, TextsOfYade) {
  expectRefusals("yade/materials.txt", {{"0.004", "-1", "line 3: a radius is -1"},
                                        {"0.004", "nan", "line 3: a number is 'nan'"},
                                        {"0.004\t0", "0.004", "line 3: a row has 4 values"},
                                        {"0.004\t0", "0.004\t0\t0", "line 3: a row has 6 values"},
                                        {"x_y_z_r_matId", "", "line 1: the format is nothing"},
                                        {"# a cloud", "0 0 0 1 0\n#format x_y_z_r\n#", "line 3: the format changes"}});
  expectRefusals("yade/ids.txt", {{"\n2\t", "\n1\t", "line 3: the id 1 occurs twice"}});
  EXPECT_NE(refusalOf("#format x_y_z_r\n").find("no spheres"), std::string::npos);
}

TEST(Refusals, FilesOfMercury) {
  expectRefusals(
      "mercury/base-particles.restart",
      {{"radius 0.004", "radius 0", "a radius is 0"},
       {"radius 0.004", "", "the line has no radius"},
       {"velocity 0.1 -0.2 0.3", "velocity 0.1 -0.2", "line 17: 'angularVelocity' is not a number"},
       {"id 1 indSpecies 0 position 0.01", "id 2 indSpecies 0 position 0.01", "the id 2 occurs twice"},
       {"indSpecies 0 position 0.05", "indSpecies 5 position 0.05", "the species 5 of the particle is not there"},
       {"Particles 3", "Particles 4", "there are 3 particles, not 4"},
       {"Particles 3", "Particles 999999999", "it announces 999999999 items"},
       {"Particles 3", "Grains 3", "no section Particles"},
       {"restart_version", "version", "the file is none that is known"}});
  expectRefusals("mercury/two-frames.data", {{"3 0.5 0", "4 0.5 0", "breaks off after 3 of 4 particles"},
                                             {"3 0.5 0", "3 0.5", "line 5: the head of a frame has 7 numbers"},
                                             {"3 0.5 0 0 0 0.06 0.06 0.1\n0.01", "3 0.5 0 0 0 0.06 0.06 0.1\n0.01 1",
                                              "line 6: a particle has 15 columns"}});
}

TEST(Refusals, NoFileAtAll) {
  EXPECT_NE(refusalOf("").find("none that is known"), std::string::npos);
  EXPECT_NE(refusalOf(std::string("\x1F\x8B\0\0", 4)).find("packed by gzip"), std::string::npos);
  EXPECT_NE(refusalOf(std::string("3 0 0\0", 6)).find("no text"), std::string::npos);
  EXPECT_NE(test::refusal([] { readLammps("/nowhere/a.data"); }).find("cannot be read"), std::string::npos);
  EXPECT_NE(test::refusal([] { readMercury(sample("yade/text.txt")); }).find("no restart or data file"),
            std::string::npos);
}

void requireSound(const GrainFile& file) {
  ASSERT_GT(file.size(), 0u);
  for (std::size_t i = 0; i < file.size(); ++i) {
    ASSERT_GT(file.radius[i], 0.0);
    ASSERT_TRUE(isFinite(file.position[i]));
  }
  for (const std::size_t size : {file.density.size(), file.velocity.size(), file.spin.size(), file.id.size()})
    ASSERT_TRUE(size == 0 || size == file.size());
}

TEST(Refusals, ChangedFilesAreReadOrRefused) {
  std::mt19937 random(11);
  std::size_t taken = 0, refused = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(SAMPLES)) {
    if (!entry.is_regular_file()) continue;
    const std::string text = textOf(entry.path());
    for (int round = 0; round < 100; ++round) {
      const test::Written file(dovetail::test::mutated(text, random));
      GrainFile grains;
      if (const std::string said = test::refusal([&] { grains = read(file.path()); }); !said.empty()) {
        ++refused;
        continue;
      }
      requireSound(grains);
      ++taken;
    }
  }
  EXPECT_GT(refused, 300u);
  EXPECT_GT(taken, 100u);
}

}  // namespace
}  // namespace dovetail::grain_io
