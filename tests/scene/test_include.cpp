// Scenes that include others.
#include <gtest/gtest.h>

#include <fstream>

#include "../io/scratch_folder.hpp"
#include "refusal.hpp"
#include "scene_parts.hpp"

namespace dovetail::scene::test {
namespace {

class SceneInclude : public testing::Test {
protected:
  void write(const std::string& name, const std::string& text) {
    std::filesystem::create_directories((folder / name).parent_path());
    std::ofstream(folder / name) << text;
  }
  std::string refusal(const std::string& name) {
    try {
      readScene(folder / name);
      return "";
    } catch (const InputError& error) {
      return error.what();
    }
  }
  io::test::ScratchFolder folder;
};

const std::string stages = R"("stages": [{"do": "run", "time": 1e-3}])";

TEST_F(SceneInclude, ItsOwnValuesWinAndListsGrow) {
  write("parts/common.json", R"({"let": {"r": 0.1, "e": 0.7}, "gravity": [0, 0, -9.81],
    "contact": {"law": "linear", "stiffness": 1e4, "restitution": "e", "friction": 0.3},
    "walls": [{"shape": "plane", "point": [0, 0, 0], "normal": [0, 0, 1]}],
    "particles": [{"from": "csv", "file": "g.csv", "density": 2500}]})");
  write("parts/g.csv", "x_m,y_m,z_m,radius_m\n0,0,1,0.1\n");
  write("mine.json", R"({"include": ["parts/common.json"], "let": {"e": 0.9}, "gravity": [0, 0, -1],
    "contact": {"friction": 0.5}, "walls": [{"shape": "plane", "point": [0, 0, 9], "normal": [0, 0, -1]}], )" +
                         stages + "}");
  const Scene scene = readScene(folder / "mine.json", {"r=0.2"});
  EXPECT_EQ(scene.gravity.z, -1.0);
  EXPECT_EQ(scene.contact->restitution, 0.9);
  EXPECT_EQ(scene.contact->friction, 0.5);
  ASSERT_EQ(scene.walls.size(), 2U);
  EXPECT_EQ(std::get<Plane>(scene.walls[0].shape).point.z, 0.0);
  EXPECT_EQ(build(scene).run->grains.particles.size(), 1U);
}

TEST_F(SceneInclude, WhatIsIncludedTwiceCountsOnce) {
  write("walls.json", R"({"walls": [{"shape": "plane", "point": [0, 0, 0], "normal": [0, 0, 1]}]})");
  write("a.json", R"({"include": ["walls.json"]})");
  write("b.json", R"({"include": ["a.json", "walls.json", "./walls.json"], )" + stages + "}");
  EXPECT_EQ(readScene(folder / "b.json").walls.size(), 1U);
}

TEST_F(SceneInclude, LaterVersionsAreRefused) {
  write("later.json", R"({"version": "99.0", "gravity": [0, 0, -1]})");
  write("mine.json", R"({"include": ["later.json"], "version": "0.1", )" + stages + "}");
  expectParts(refusal("mine.json"), {"written for Dovetail 99.0", "later.json:1:13"});
}

TEST_F(SceneInclude, SettingsIncludeToo) {
  write("light.json", R"({"gravity": [0, 0, -1]})");
  write("mine.json", "{" + stages + "}");
  EXPECT_EQ(readScene(folder / "mine.json", {R"(include=["light.json"])"}).gravity.z, -1.0);
  EXPECT_EQ(readScene(folder / "mine.json", {"gravity=[0, 0, -2]", R"(include=["light.json"])"}).gravity.z, -2.0);
  write("other.json", R"({"include": ["none.json"], )" + stages + "}");
  EXPECT_EQ(readScene(folder / "other.json", {"include.0=light.json"}).gravity.z, -1.0);
}

TEST_F(SceneInclude, CyclesAreRefusedWithTheirChain) {
  write("a.json", R"({"include": ["sub/b.json"], )" + stages + "}");
  write("sub/b.json", "{\n  \"include\": [\"../a.json\"]}");
  expectParts(refusal("a.json"), {"includes itself", "a.json -> ", "b.json -> ", "sub/b.json:2:15"});
  write("self.json", R"({"include": ["self.json"]})");
  expectParts(refusal("self.json"), {"includes itself", "self.json:1:14"});
}

TEST_F(SceneInclude, ErrorsNameTheFileAndItsLine) {
  write("mine.json", R"({"include": ["part.json"], )" + stages + "}");
  write("part.json",
        "{\n  \"walls\": [\n    {\"shape\": \"plane\", \"point\": [0, 0, 0], \"normal\": [0, 0, 1], \"velocty\": 3}]}");
  expectParts(refusal("mine.json"), {"part.json:3:", "walls.0", "velocity"});
  write("part.json", "{\n  \"gravity\": [0, 0,\n \"5 m\"]}");
  expectParts(refusal("mine.json"), {"part.json:3:2", "gravity"});
  write("part.json", "{\n  \"gravity\": [0, 0}");
  expectParts(refusal("mine.json"), {"part.json:2:", "no JSON"});
  write("part.json", "{\n  \"walls\": [\n    {\"shape\": \"mesh\",\n \"file\": \"w.stl\"}]}");
  expectParts(refusal("mine.json"), {"part.json:4:", "w.stl"});
  write("mine.json", R"({"include": ["none.json"], )" + stages + "}");
  expectParts(refusal("mine.json"), {"none.json", "mine.json:1:14", "include"});
  write("mine.json", R"({"include": "part.json", )" + stages + "}");
  expectParts(refusal("mine.json"), {"write a list", "mine.json:1:13"});
  write("mine.json", R"({"include": ["part.json", 3], )" + stages + "}");
  write("part.json", "[]");
  expectParts(refusal("mine.json"), {"part.json", "mine.json:1:14"});
  write("part.json", "{}");
  expectParts(refusal("mine.json"), {"the number 3", "mine.json:1:27"});
}

}  // namespace
}  // namespace dovetail::scene::test
