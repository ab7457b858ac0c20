// Files that are cut off, damaged or something else: an InputError that names the place, and never anything worse.
#include <gtest/gtest.h>

#include <map>

#include "cube_files.hpp"
#include "dovetail/core/error.hpp"
#include "dovetail/mesh_io/surface_files.hpp"

namespace dovetail::mesh_io {
namespace {

using namespace test;

std::map<std::string, std::string> goodFiles(const ScratchFolder& folder) {
  writeStl(folder / "written.stl", cube().x, cube().facets);
  return {{"binary.stl", readText(folder / "written.stl")},
          {"ascii.stl", asciiStl(cube())},
          {"cube.obj", cubeObj()},
          {"ascii.ply", asciiPly()},
          {"binary.ply", binaryPly()}};
}

std::string refusal(const ScratchFolder& folder, const std::string& name, const std::string& content) {
  writeText(folder / name, content);
  return messageOf<InputError>([&] { readSurface(folder / name); });
}

TEST(BrokenFiles, CutOffAnywhereTheyAreRefusedOrWhole) {
  // An ASCII file may end without its last blank; an OBJ after any line.
  const std::map<std::string, std::size_t> harmless{
      {"binary.stl", 0}, {"binary.ply", 0}, {"ascii.stl", 1}, {"ascii.ply", 4}};
  const ScratchFolder folder;
  for (const auto& [name, good] : goodFiles(folder)) {
    const auto found = harmless.find(name);
    for (std::size_t length = 0; length < good.size(); length += length < 120 || length + 40 > good.size() ? 1 : 11) {
      const std::string message = refusal(folder, name, good.substr(0, length));
      if (!message.empty()) {
        ASSERT_NE(message.find(name), std::string::npos) << message;
      } else if (found != harmless.end()) {
        ASSERT_GE(length + found->second, good.size()) << name;
      }
    }
  }
}

TEST(BrokenFiles, WithFlippedBitsTheyGiveAnErrorOrAWholeMesh) {
  const ScratchFolder folder;
  std::mt19937_64 random(3);
  for (const auto& [name, good] : goodFiles(folder)) {
    int refused = 0;
    for (int round = 0; round < 400; ++round) {
      std::string bad = good;
      for (int flips = 1 + round % 3; flips > 0; --flips)
        bad[random() % bad.size()] ^= static_cast<char>(1 << random() % 8);
      writeText(folder / name, bad);
      try {
        const TriangleMesh mesh = readSurface(folder / name);
        ASSERT_FALSE(mesh.facets.empty());
        for (const auto& f : mesh.facets)
          for (const int v : f) ASSERT_TRUE(v >= 0 && v < static_cast<int>(mesh.x.size()));
        for (const Vec3& x : mesh.x) ASSERT_TRUE(isFinite(x));
      } catch (const InputError&) {
        ++refused;
      }
    }
    EXPECT_GT(refused, 8) << name;
  }
}

TEST(BrokenFiles, TheErrorSaysWhatIsWrongAndWhere) {
  const ScratchFolder folder;
  const auto expectSays = [&](const std::string& name, const std::string& content, const std::string& where,
                              const std::string& what) {
    const std::string message = refusal(folder, name, content);
    EXPECT_NE(message.find(name + where), std::string::npos) << message;
    EXPECT_NE(message.find(what), std::string::npos) << message;
  };
  const auto replaced = [](std::string text, const std::string& from, const std::string& to) {
    return text.replace(text.find(from), from.size(), to);
  };
  std::string stl = goodFiles(folder)["binary.stl"];
  expectSays("a.stl", stl + "x", ", byte 80", "12 facets need 684");
  expectSays("a.stl", "short", ", line 1",
             "neither a text that starts with 'solid' nor a binary STL: there is 'short'");
  expectSays("a.stl", "# made by\n" + asciiStl(cube()).substr(1), ", line 2", "neither");
  expectSays("a.stl", "# nothing but this\n", "", "neither");
  expectSays("a.stl", std::string("\xFF\xFEs\0o\0", 6), "", "UTF-16");
  expectSays("a.obj", std::string("\xFF\xFEv\0", 4), "", "UTF-16");
  expectSays("a.obj", "v 0 0 0\nv +-1 0 0\nv 0 1 0\nf 1 2 3\n", ", line 2", "'+-1' is not a number");
  std::string infinite = stl;
  infinite.replace(84 + 50 + 12 + 2, 2, "\x80\x7f");
  expectSays("a.stl", infinite, ", facet 1 at byte 146", "NaN or infinite");
  expectSays("a.stl", replaced(asciiStl(cube()), "vertex 0", "vertex nan"), ", line 4", "'nan'");
  expectSays("a.stl", replaced(asciiStl(cube()), "vertex 0", "vertex 1e999"), ", line 4", "'1e999'");
  expectSays("a.stl", replaced(asciiStl(cube()), "endloop", "endlop"), ", line 7", "'endlop'");
  expectSays("a.stl", "solid nothing\nendsolid\n", "", "no facets");
  expectSays("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\n\nf 1 2 4\n", ", line 5", "vertex 4 is used after only 3");
  expectSays("a.obj", "v 0 0 0\nf 1 1\n", ", line 2", "a face has 2 vertices");
  expectSays("a.obj", "v 0 0\nv 1 0 0\n", ", line 1", "nothing is not a number");
  expectSays("a.obj", "v 0 0 0\nv 12 0 0\nv 0 1 0\nf 1 2 3", ", line 4", "breaks off");
  expectSays("a.obj", "v 0 0 0\nv 1e30 0 0\nv 0 1 0\nf 1 2 3\n", ", vertex 1", "farther than 1e15 m");
  expectSays("a.obj", "%PDF-1.4\n", ", line 1", "'%PDF-1.4'");
  expectSays("a.ply", replaced(asciiPly(), "4 0 2 3 1", "4 0 2 8 1"), ", line 24", "names vertex 8");
  expectSays("a.ply", replaced(asciiPly(), "4 0 2 3 1", "4 0 2 -3 1"), ", line 24", "names vertex -3");
  expectSays("a.ply", replaced(asciiPly(), "4 0 2 3 1", "4 0 2 1.5 1"), ", line 24", "no whole number");
  expectSays("a.ply", replaced(asciiPly(), "255 0 0 0", "255 0 inf 0"), ", line 15", "'inf'");
  expectSays("a.ply", replaced(asciiPly(), "element face 6", "element face 2000000000"), "", "too short");
  expectSays("a.ply", replaced(asciiPly(), "ascii", "binary_big_endian"), ", line 2", "binary_big_endian");
  expectSays("a.ply", binaryPly() + "x", ", byte " + std::to_string(binaryPly().size()),
             "continues after its last element");
  expectSays("a.ply", asciiPly() + "1 2 3\n", ", line 30", "continues after its last element");
  expectSays("a.ply", "", "", "the file is empty");
  EXPECT_NE(messageOf<InputError>([&] { readStl(folder / "not_there.stl"); }).find("not_there.stl"), std::string::npos);
  EXPECT_NE(messageOf<InputError>([&] { readObj(folder.path()); }), "");
}

}  // namespace
}  // namespace dovetail::mesh_io
