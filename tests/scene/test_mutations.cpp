// Scenes with one fault each: every one is refused in one line, none crashes.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "refusal.hpp"

namespace dovetail::scene::test {
namespace {

using Json = nlohmann::ordered_json;

/// All places of a document, root first.
void visit(const Json& value, const Json::json_pointer& place, std::vector<Json::json_pointer>& places) {
  places.push_back(place);
  if (value.is_structured())
    for (const auto& [key, inner] : value.items())
      visit(inner, value.is_array() ? place / static_cast<std::size_t>(std::stoul(key)) : place / key, places);
}

Json scene() { return Json::parse(sceneText(readScene(starter("footing")))); }

void expectRefused(const std::string& text, const std::string& what) {
  const std::string message = refusal(text);
  EXPECT_NE(message, "") << what;
  EXPECT_EQ(message.find('\n'), std::string::npos) << message;
  EXPECT_NE(message.find("s.json"), std::string::npos) << message;
}

class Mutations : public testing::Test {
protected:
  void SetUp() override {
    if (!WITH_EXPRESSIONS) GTEST_SKIP() << "the starter scenes have expressions";
    whole = scene();
    visit(whole, Json::json_pointer{}, places);
    ASSERT_EQ(refusal(whole.dump(1)), "");
  }
  Json whole;
  std::vector<Json::json_pointer> places;
};

TEST_F(Mutations, WrongTypesAreRefused) {
  int count = 0;
  for (const auto& place : places)
    for (const Json& wrong : {Json(nullptr), Json(Json::object({{"a", 1}})), Json("no such thing"), Json("5 parsec")}) {
      Json mutant = whole;
      if (mutant[place].is_string() && wrong.is_string() &&
          (place.back() == "title" || place.back() == "name" || place.back() == "solid" || place.back() == "on"))
        continue;  // any text will do there
      mutant[place] = wrong;
      expectRefused(mutant.dump(1), place.to_string() + " = " + wrong.dump());
      ++count;
    }
  EXPECT_GT(count, 300);
}

TEST_F(Mutations, MisspeltAndForeignKeysAreRefused) {
  for (const auto& place : places) {
    if (!whole[place].is_object()) continue;
    Json more = whole;
    more[place]["comment"] = "x";
    expectRefused(more.dump(1), place.to_string() + " + comment");
    for (const auto& [key, value] : whole[place].items()) {
      Json renamed = whole;
      renamed[place].erase(key);
      renamed[place][key + "s"] = value;
      expectRefused(renamed.dump(1), place.to_string() + "/" + key + "s");
    }
  }
}

TEST_F(Mutations, TruncatedTextIsRefused) {
  const std::string text = whole.dump(1);
  for (std::size_t k = 0; k < 200; ++k) expectRefused(text.substr(0, k * (text.size() - 1) / 200), "cut");
}

TEST_F(Mutations, NumbersOutOfRangeAreRefused) {
  for (const auto& [place, value] : {std::pair{"/contact/stiffness", Json(0)},
                                     {"/contact/stiffness", Json("0*1")},
                                     {"/contact/restitution", Json(1.1)},
                                     {"/contact/friction", Json(-0.1)},
                                     {"/particles/0/solid_fraction", Json(0.74)},
                                     {"/particles/0/seed", Json(1.5)},
                                     {"/particles/0/box/1/2", Json(0)},
                                     {"/particles/0/box/1", Json::array({1, 2})},
                                     {"/solids/0/cells/0", Json(0)},
                                     {"/solids/0/cells/0", Json(1e9)},
                                     {"/solids/0/material/poisson_ratio", Json(0.5)},
                                     {"/steps/dt", Json(-1)},
                                     {"/steps/dt", Json("1/0")},
                                     {"/steps/dt", Json("0/0")},
                                     {"/steps/per_macro_step", Json(0)},
                                     {"/steps/threads", Json(-1)},
                                     {"/stages/0/time", Json(0)},
                                     {"/output/series", Json("1 mm")},
                                     {"/walls/0/open/0", Json("z")},
                                     {"/walls/0/open/0", Json("z+")},
                                     {"/clumps/0/spheres", Json::array()}}) {
    Json mutant = whole;
    mutant[Json::json_pointer(place)] = value;
    expectRefused(mutant.dump(1), std::string(place) + " = " + value.dump());
  }
}

}  // namespace
}  // namespace dovetail::scene::test
