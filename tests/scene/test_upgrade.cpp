// Scenes with names of earlier versions.
#include <nlohmann/json.hpp>

#include "../../src/scene/keys/renamed.hpp"
#include "dovetail/core/error.hpp"
#include "dovetail/scene/read.hpp"
#include "dovetail/scene/upgrade.hpp"
#include "refusal.hpp"
#include "scene_parts.hpp"

namespace dovetail::scene::test {
namespace {

const std::string old = R"({
  // a comment with "windows" in it
  "title": "windows",
  "contact": {"law": "linear", "stiffness": 1e4},
  "particles": [{"from": "list", "density": 2500, "spheres": [{"at": [0, 0, 0], "radius": 0.1}]}],
  "steps": {"dt": 1e-5, "per_window": 2},
  "stages": [{"do": "settle", "windows": 30}, {"do": "run", "time": 1e-3}]
})";

TEST(SceneUpgrade, GivesNamesOfTodayAndLeavesAllElse) {
  const Upgrade upgrade = upgraded(old, "s.json");
  ASSERT_EQ(upgrade.changes.size(), 3U);
  EXPECT_EQ(upgrade.changes[0], "s.json:6:25: \"per_window\" is \"per_macro_step\"");
  std::string wanted = replaced(old, "\"per_window\"", "\"per_macro_step\"");
  wanted = replaced(wanted, R"("do": "settle", "windows")", R"("do": "relax", "macro_steps")");
  EXPECT_EQ(upgrade.text, wanted);
  EXPECT_TRUE(upgraded(wanted, "s.json").changes.empty());
  const Scene scene = sceneFromText(upgrade.text, "s.json", "/");
  EXPECT_EQ(scene.steps.stepsPerMacroStep, 2);
  EXPECT_EQ(std::get<Relax>(scene.stages[0].kind).macroSteps, 30);
}

TEST(SceneUpgrade, OldNamesAreRefusedWithTheirNewOnes) {
  const auto refusal = [](const std::string& text) {
    try {
      sceneFromText(text, "s.json", "/");
      return std::string();
    } catch (const InputError& error) {
      return std::string(error.what());
    }
  };
  expectParts(refusal(old), {"\"per_window\"", "write \"per_macro_step\", its name since version", "upgrade FILE"});
  expectParts(refusal(replaced(old, "per_window", "per_macro_step")), {"\"settle\"", "write \"relax\""});
}

/// Every row of the table of keys and words changes some scene.
TEST(SceneUpgrade, KnowsEveryRow) {
  for (const Renamed& one : renamed) {
    if (one.kind == Renamed::Kind::column) continue;
    const std::string holder(one.within.substr(0, one.within.find('.')));
    const bool isWord = one.kind == Renamed::Kind::word;
    const std::string key = isWord ? std::string(one.within.substr(holder.size() + 1)) : std::string(one.was);
    const std::string text = "{\"" + holder + "\": {\"" + key + "\": \"" + std::string(one.was) + "\"}}";
    EXPECT_EQ(upgraded(text, "s.json").changes.size(), 1U) << text;
  }
}

/// New names of keys and words are known where the table says that they are.
TEST(SceneUpgrade, LeadsToNamesThatScenesHave) {
  const nlohmann::json schema = nlohmann::json::parse(schemaText());
  for (const Renamed& one : renamed) {
    if (one.kind == Renamed::Kind::column) continue;
    const std::string holder(one.within.substr(0, one.within.find('.')));
    const std::string known = schema.at("properties").at(holder).dump();
    EXPECT_NE(known.find('"' + std::string(one.is) + '"'), std::string::npos) << holder << ' ' << one.is;
  }
}

TEST(SceneUpgrade, LooksAtTheVersion) {
  const auto with = [](const std::string& version) {
    return replaced(replaced(replaced(old, "per_window", "per_macro_step"), R"("do": "settle", "windows")",
                             R"("do": "relax", "macro_steps")"),
                    R"("title": "windows")", R"("title": "windows", "version": )" + version);
  };
  const auto refusal = [&](const std::string& version) {
    try {
      sceneFromText(with(version), "s.json", "/");
      return std::string();
    } catch (const InputError& error) {
      return std::string(error.what());
    }
  };
  for (const char* const known : {R"("0.1")", R"("0.1.0")", R"("0.0.9")"}) EXPECT_EQ(refusal(known), "");
  expectParts(refusal(R"("99.1")"), {"s.json:3:34", "written for Dovetail 99.1", "a later one"});
  for (const char* const no : {R"("new")", R"("0.")", R"("-1")", R"("")", "0.1"})
    expectParts(refusal(no), {"no version of Dovetail", "write \"0.1\""});
  const Upgrade upgrade = upgraded(with(R"("0.0")"), "s.json");
  ASSERT_EQ(upgrade.changes.size(), 1U);
  EXPECT_EQ(upgrade.text, with(R"("0.1")"));
  EXPECT_THROW(upgraded(with(R"("1.0")"), "s.json"), InputError);
}

}  // namespace
}  // namespace dovetail::scene::test
