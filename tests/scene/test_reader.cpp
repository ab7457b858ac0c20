#include <gtest/gtest.h>

#include "refusal.hpp"

namespace dovetail::scene::test {
namespace {

const char* const starters[] = {"footing", "pile", "plate"};

TEST(SceneReader, ValuesAreInSi) {
  const Scene scene = sceneFromText(smallScene, "s.json", SCENES);
  EXPECT_EQ(std::get<LinearContact>(scene.contact->normal).stiffness, 5000.0);
  const Sphere& sphere = std::get<SphereList>(scene.particles.at(0).from).spheres.at(0);
  EXPECT_EQ(sphere.radius, 0.01);
  EXPECT_EQ(sphere.at.z, 0.015);
  EXPECT_EQ(scene.particles[0].where, "s.json:9:5, particles.0");
}

TEST(SceneReader, AWrittenSceneReadsBackToTheSameText) {
  if (!WITH_EXPRESSIONS) GTEST_SKIP() << "the starter scenes have expressions";
  for (const char* name : starters) {
    const std::string text = sceneText(readScene(starter(name)));
    EXPECT_EQ(sceneText(sceneFromText(text, "again", "/")), text) << name;
    EXPECT_EQ(text.find("null"), std::string::npos) << name;
  }
}

TEST(SceneReader, RefusalsNameThePlaceAndTheNearestName) {
  const auto refusalOf = [](const char* from, const char* to) { return refusal(replaced(smallScene, from, to)); };
  EXPECT_EQ(refusalOf("\"restitution\"", "\"restitusion\""),
            "there is no key \"restitusion\" [s.json:6:5, contact]: write \"restitution\"");
  EXPECT_EQ(refusalOf("\"5 kN/m\"", "\"5 kN\""),
            "\"stiffness\" is the text \"5 kN\", in N [s.json:5:18, contact]: write one in N/m");
  EXPECT_EQ(refusalOf("\"linear\"", "\"lineal\""),
            "\"law\" is the text \"lineal\" [s.json:4:12, contact]: write \"linear\"");
  EXPECT_EQ(refusalOf("2500", "-2500"), "\"density\" is -2500 [s.json:9:33, particles.0]: write one above 0 kg/m3");
  EXPECT_EQ(refusalOf("\"radius\"", "\"radios\""),
            "there is no key \"radios\" [s.json:10:42, particles.0.spheres.0]: write \"radius\"");
  EXPECT_EQ(refusalOf("    \"stiffness\": \"5 kN/m\",\n", ""),
            "the key \"stiffness\" is missing [s.json:3:14, contact]: give it a value");
  EXPECT_EQ(refusalOf("0.1}", "0.1, \"time\": 3}"),
            "the key \"time\" is there twice [s.json:14:41]: leave one of them out");
  EXPECT_NE(refusalOf("\"steps\": {\"dt\": 1e-4},", "\"steps\": {\"dt\": 1e-4}").find("[s.json:14:"),
            std::string::npos);
}

TEST(SceneReader, UnknownKeysAreToldBeforeValuesAreLookedAt) {
  const std::string both = replaced(replaced(smallScene, "\"5 kN/m\"", "\"five\""), "\"walls\"", "\"wals\"");
  EXPECT_EQ(refusal(both), "there is no key \"wals\" [s.json:12:3]: write \"walls\"");
}

TEST(SceneReader, ValuesInPlaceOfObjectsAreToldTheirKeys) {
  const auto refused = [](const char* setting) { return refusal(smallScene, {setting}); };
  EXPECT_NE(refused("contact=3").find("an object is expected [s.json, contact]: write {\"law\": …}"), std::string::npos)
      << refused("contact=3");
  EXPECT_NE(refused("particles=[{\"from\": \"packing\", \"radius\": 3}]")
                .find("particles.0.radius]: write {\"smallest\": …, \"largest\": …}"),
            std::string::npos)
      << refused("particles=[{\"from\": \"packing\", \"radius\": 3}]");
  EXPECT_NE(refused("stages=[3]").find("stages.0]: write {\"do\": …}"), std::string::npos) << refused("stages=[3]");
}

TEST(SceneReader, KeysUnlikeAnyAreToldAllOfTheObject) {
  EXPECT_NE(refusal(smallScene, {"contact.E=3"}).find("write one of \"law\", \"stiffness\", "), std::string::npos)
      << refusal(smallScene, {"contact.E=3"});
}

TEST(SceneReader, ControlCharactersAreRefused) {
  for (const char* text : {"a\\u0000b", "a\\nb", "\\u007f"}) {
    EXPECT_NE(refusal(replaced(smallScene, "linear", text)).find("control character [s.json:4:12]"), std::string::npos);
    EXPECT_NE(refusal(replaced(smallScene, "gravity", text)).find("control character [s.json:2:3]"), std::string::npos);
  }
}

TEST(SceneReader, CommentsAreAllowed) {
  EXPECT_EQ(refusal("// one\n" + replaced(smallScene, "\"law\"", "/* two */ \"law\"")), "");
}

TEST(SceneReader, ParametersServeEveryNumberAndCanBeSet) {
  if (!WITH_EXPRESSIONS) GTEST_SKIP();
  const std::string text = replaced(replaced(smallScene, "{\n", "{\n\"let\": {\"r\": \"2 cm\", \"d\": \"2*r\"},\n"),
                                    "\"1 cm\"", "\"sqrt(d^2)\"");
  const auto radius = [&](const std::vector<std::string>& settings) {
    const Scene scene = sceneFromText(text, "s.json", SCENES, settings);
    return std::get<SphereList>(scene.particles[0].from).spheres[0].radius;
  };
  EXPECT_EQ(radius({}), 0.04);
  EXPECT_EQ(radius({"r=1 mm"}), 0.002);
  EXPECT_EQ(radius({"particles.0.spheres.0.radius=0.5"}), 0.5);
  EXPECT_EQ(refusal(text, {"quux=1"}).find("there is no key \"quux\" [s.json]: "), 0U);
  EXPECT_EQ(refusal(text, {"domain={\"box\": [[0, 0, 0], [1, 1, 1]]}"}), "");
  EXPECT_EQ(refusal(text, {"output.series=1 ms"}), "");
  EXPECT_NE(refusal(text, {"particles.7.density=1"}).find("no item \"7\""), std::string::npos);
  EXPECT_NE(refusal(text, {"r"}).find("write --set key=value"), std::string::npos);
  EXPECT_NE(refusal(text, {"r=2*w"}).find("Unexpected token \"w\""), std::string::npos);
}

/// 2.4/0.1 is 23.999999999999996.
TEST(SceneReader, ExpressionsAreWholeUpToRoundOff) {
  if (!WITH_EXPRESSIONS) GTEST_SKIP();
  const std::string text = replaced(smallScene, "{\n", "{\n\"let\": {\"w\": 2.4, \"h\": 0.1},\n");
  const auto perMacroStep = [&](const std::string& value) {
    return sceneFromText(text, "s.json", SCENES, {"steps.per_macro_step=" + value}).steps.stepsPerMacroStep;
  };
  EXPECT_EQ(perMacroStep("w/h"), 24);
  EXPECT_EQ(perMacroStep("24*h/w"), 1);
  EXPECT_NE(refusal(text, {"steps.per_macro_step=w/h + 1e-9"}).find("write a whole number"), std::string::npos);
  EXPECT_NE(refusal(text, {"steps.per_macro_step=w/h - 24"}).find("write one"), std::string::npos);
}

/// "2*h" is twice the parameter where there is one, "2 h" is two hours everywhere.
TEST(SceneReader, RefusalsOfNumbersGuessWhatWasMeant) {
  if (!WITH_EXPRESSIONS) GTEST_SKIP();
  const auto withLet = [](const std::string& let) {
    return test::replaced(test::smallScene, "\"gravity\"", "\"let\": {" + let + "},\n  \"gravity\"");
  };
  const std::string unit = test::refusal(withLet(R"("E": "2 Mpa")"));
  EXPECT_NE(unit.find("\"2 MPa\""), std::string::npos) << unit;
  const std::string below = test::refusal(withLet(R"("b": "2*a", "a": 1)"));
  EXPECT_NE(below.find("put the parameter \"a\" above"), std::string::npos) << below;
  const std::string constant = test::refusal(withLet(R"("pi": 3)"));
  EXPECT_NE(constant.find("\"pi\""), std::string::npos) << constant;
  EXPECT_NE(constant.find("another name"), std::string::npos) << constant;
  const std::string sum(100000, '+');
  for (const std::string& text : {"1" + sum, "1*" + std::string(100000, 'q'), "(" + sum + ")"}) {
    const std::string message = test::refusal(withLet("\"a\": \"" + text + "\""));
    EXPECT_FALSE(message.empty());
    EXPECT_LT(message.size(), 2000u);
  }
}

TEST(SceneReader, ParametersMayBeNamedLikeUnits) {
  if (!WITH_EXPRESSIONS) GTEST_SKIP() << "products are expressions";
  const auto time = [](const std::string& let, const std::string& value) {
    const std::string text = replaced(smallScene, "\"time\": 0.1", "\"time\": " + value);
    return std::get<RunFor>(
               sceneFromText(replaced(text, "{", "{\"let\": " + let + ","), "s.json", SCENES).stages[0].kind)
        .time;
  };
  EXPECT_EQ(time(R"({"h": 0.25})", R"("2*h")"), 0.5);
  EXPECT_EQ(time(R"({"h": 0.25})", R"("2 h")"), 7200.0);
  EXPECT_EQ(time(R"({"a": 0.25})", R"("2*h")"), 7200.0);
  EXPECT_EQ(time(R"({"s": 4})", R"("2/s")"), 0.5);
  EXPECT_EQ(time(R"({"h": 0.25, "a": "2*h"})", R"("a")"), 0.5);
  const std::string below = replaced(smallScene, "{", R"({"let": {"a": "2*h", "h": 0.25},)");
  EXPECT_NE(refusal(below).find("as an expression"), std::string::npos) << refusal(below);
}

TEST(SceneReader, DeepAndOddDocumentsAreRefused) {
  EXPECT_NE(refusal(std::string(100000, '[')).find("64 levels"), std::string::npos);
  for (const char* text : {"", " ", "null", "[]", "3", "\"a\"", "{", "{}", "{}{}", "{\"stages\": []}", "\xff",
                           "{\"a\": \"\xff\"}", "{\"gravity\": [0, 0, 1e999]}", "{\"gravity\": [NaN, 0, 0]}"})
    EXPECT_NE(refusal(text), "") << text;
}

}  // namespace
}  // namespace dovetail::scene::test
