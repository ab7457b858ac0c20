#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "dovetail/scene/build.hpp"
#include "dovetail/scene/read.hpp"

namespace dovetail::scene {
namespace {

using Json = nlohmann::json;

/// Whether a value fits a schema, as far as schemas of scenes go: keys, types, enumerations and lengths.
bool fits(const Json& schema, const Json& value) {
  if (schema.contains("oneOf")) {
    int count = 0;
    for (const Json& one : schema["oneOf"]) count += fits(one, value) ? 1 : 0;
    return count == 1;
  }
  if (schema.contains("const")) return value == schema["const"];
  if (schema.contains("enum"))
    return std::find(schema["enum"].begin(), schema["enum"].end(), value) != schema["enum"].end();
  const auto is = [&](const std::string& type) {
    if (type == "integer") return value.is_number_integer();
    if (type == "number") return value.is_number();
    return type == value.type_name();
  };
  const Json types = schema["type"].is_array() ? schema["type"] : Json::array({schema["type"]});
  if (std::none_of(types.begin(), types.end(), [&](const Json& type) { return is(type); })) return false;
  if (value.is_array()) {
    if (value.size() < schema.value("minItems", 0U) || value.size() > schema.value("maxItems", 1000000U)) return false;
    return std::all_of(value.begin(), value.end(), [&](const Json& item) { return fits(schema["items"], item); });
  }
  if (!value.is_object()) return true;
  for (const Json& key : schema.value("required", Json::array()))
    if (!value.contains(key.get<std::string>())) return false;
  for (const auto& [key, inner] : value.items()) {
    const Json properties = schema.value("properties", Json::object());
    const Json& more = schema["additionalProperties"];
    if (!properties.contains(key) && !more.is_object()) return false;
    if (!fits(properties.contains(key) ? properties[key] : more, inner)) return false;
  }
  return true;
}

Json starter(const std::string& name) {
  std::ifstream file(std::filesystem::path(SCENES) / (name + ".json"));
  return Json::parse(file, nullptr, true, true);
}

TEST(SceneSchema, StarterScenesFit) {
  const Json schema = Json::parse(schemaText());
  for (const char* name :
       {"bonded-beam", "cantilever", "chute", "column", "column-collapse", "digging", "drum", "hopper", "shaft",
        "snowball", "static-cantilever", "stirrer", "tray", "two-materials", "wave"})
    EXPECT_TRUE(fits(schema, starter(name))) << name;
  for (const char* name : {"footing", "pile", "plate"}) {
    Json scene = starter(name);
    EXPECT_TRUE(fits(schema, scene)) << name;
    scene["solids"][0]["nme"] = 3;
    EXPECT_FALSE(fits(schema, scene)) << name;
    scene = starter(name);
    scene["contact"].erase("law");
    EXPECT_FALSE(fits(schema, scene)) << name;
  }
}

std::string textOf(const std::string& document) {
  std::ifstream file(std::filesystem::path(DOCS) / document);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

TEST(SceneSchema, TheSceneInTheDocumentsCanBeBuilt) {
  if (!WITH_EXPRESSIONS) GTEST_SKIP();
  const std::string text = textOf("scenes.md"), fence = "```json\n";
  const std::size_t begin = text.find(fence) + fence.size();
  const Scene scene = sceneFromText(text.substr(begin, text.find("```", begin) - begin), "scenes.md", "/");
  Built built = build(scene);
  start(built, scene);
  EXPECT_GT(built.run->grains.particles.size(), 100U);
}

TEST(SceneSchema, TheReferenceInTheDocumentsIsUpToDate) {
  EXPECT_EQ(textOf("scene-keys.md"), referenceText()) << "dovetail schema --markdown > docs/scene-keys.md";
}

}  // namespace
}  // namespace dovetail::scene
