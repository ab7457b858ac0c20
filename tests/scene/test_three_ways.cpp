// The problems of docs/three-ways.md are the same in all ways.
#include <algorithm>

#include "refusal.hpp"
#include "scene_parts.hpp"

namespace dovetail::scene::test {
namespace {

/// Without running it: any file stands for the packing.
Scene shipped(const std::string& name, const std::string& state) {
  const std::string any = starter("column").string();
  std::vector<std::string> settings{"particles.0.file=" + any};
  if (!state.empty()) settings.push_back(state + "=" + any);
  return readScene(starter("three-ways/" + name).string(), settings);
}

/// What is left of a scene without what stands for grains that are not there: a solid, and what belongs to it.
std::string withoutSolid(Scene scene, const std::string& solid) {
  std::erase_if(scene.solids, [&](const Solid& one) { return one.name == solid; });
  std::erase_if(scene.couplings, [&](const Coupling& one) { return one.solid == solid; });
  std::erase_if(scene.walls, [](const Wall& one) { return one.name == "floor"; });
  std::erase_if(scene.output.probes, [](const Probe& one) { return one.name == "far"; });
  scene.title.clear();
  return sceneText(scene);
}

TEST(ThreeWays, WithoutItsSolidAnOverlapIsTheGrains) {
  EXPECT_EQ(withoutSolid(shipped("pulse-overlap", "walls.0.state.file"), "column"),
            withoutSolid(shipped("pulse-grains", "walls.0.state.file"), "column"));
  EXPECT_EQ(withoutSolid(shipped("footing-overlap", ""), "soil"), withoutSolid(shipped("footing-grains", ""), "soil"));
}

}  // namespace
}  // namespace dovetail::scene::test
