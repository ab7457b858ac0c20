// A scene in full.
#include <nlohmann/json.hpp>

#include "dovetail/scene/files.hpp"
#include "dovetail/scene/read.hpp"
#include "keys/fields.hpp"

namespace dovetail::scene {

namespace {

using Json = nlohmann::ordered_json;

Json listOf(const Vec3& v) { return Json::array({v.x, v.y, v.z}); }
Json jsonOf(const TimeValue& v) { return v.expression.empty() ? Json(v.number) : Json(v.expression); }
Json listOf(const TimeVector& v) { return Json::array({jsonOf(v[0]), jsonOf(v[1]), jsonOf(v[2])}); }

class Writer final : public Fields {
public:
  Json json = Json::object();

  void number(Key key, double& value, const Limits&) override { json[key.name] = value; }
  void number(Key key, std::optional<double>& value, const Limits&) override {
    if (value) json[key.name] = *value;
  }
  void numberOrWord(Key key, NumberOrWord& value, const Limits&, Words) override {
    json[key.name] = value.word.empty() ? Json(value.number) : Json(value.word);
  }
  void quantity(Key key, Quantity& value) override { json[key.name] = value.value; }
  void integer(Key key, std::int64_t& value, std::int64_t, std::int64_t) override { json[key.name] = value; }
  void vector(Key key, Vec3& value, const Dimension&) override { json[key.name] = listOf(value); }
  void vector(Key key, std::optional<Vec3>& value, const Dimension&) override {
    if (value) json[key.name] = listOf(*value);
  }
  void box(Key key, geometry::Box& value) override {
    json[key.name] = Json::array({listOf(value.lower), listOf(value.upper)});
  }
  void box(Key key, std::optional<geometry::Box>& value) override {
    if (value) box(key, *value);
  }
  void function(Key key, TimeValue& value, const Limits&) override { json[key.name] = jsonOf(value); }
  void functions(Key key, TimeVector& value, const Dimension&) override { json[key.name] = listOf(value); }
  void functions(Key key, std::optional<TimeVector>& value, const Dimension&) override {
    if (value) json[key.name] = listOf(*value);
  }
  void cells(Key key, std::array<int, 3>& value) override { json[key.name] = value; }
  void flag(Key key, bool& value) override { json[key.name] = value; }
  void flag(Key key, std::optional<bool>& value) override {
    if (value) json[key.name] = *value;
  }
  void text(Key key, std::string& value, bool) override {
    if (!value.empty()) json[key.name] = value;
  }
  void file(Key key, std::string& value, bool needed) override {
    if (needed || !value.empty()) json[key.name] = value;
  }
  void fileList(Key key, std::vector<std::string>& values) override {
    if (!values.empty()) json[key.name] = values;
  }
  void nameOrNumber(Key key, std::string& value) override {
    const bool isNumber = !value.empty() && value.find_first_not_of("0123456789") == std::string::npos;
    json[key.name] = isNumber ? Json(std::stoi(value)) : Json(value);
  }
  void word(Key key, std::string& value, Words) override { json[key.name] = value; }
  void wordList(Key key, std::vector<std::string>& value, Words, bool) override { json[key.name] = value; }
  void where(std::string&) override {}
  void includes(Key) override {}  // what they say is here
  /// Those of functions of time; the values of all others are in the numbers.
  void parameters(Key key, Parameters& values) override {
    if (!values.empty()) json[key.name] = values;
  }

protected:
  std::size_t kindOf(Key key, std::size_t now, Words names, bool) override {
    json[key.name] = names[now];
    return now;
  }
  bool optionalPart(Key, bool there) override { return there; }
  void part(Key key, bool, const std::function<void(Fields&)>& describePart) override {
    Writer writer;
    describePart(writer);
    json[key.name] = std::move(writer.json);
  }
  std::size_t sizeOf(Key, std::size_t now, bool) override { return now; }
  void parts(Key key, std::size_t count, const std::function<void(Fields&, std::size_t)>& describePart) override {
    if (count == 0) return;
    Json list = Json::array();
    for (std::size_t k = 0; k < count; ++k) {
      Writer writer;
      describePart(writer, k);
      list.push_back(std::move(writer.json));
    }
    json[key.name] = std::move(list);
  }
};

}  // namespace

std::string textOf(const std::function<void(Fields&)>& describeFile) {
  Writer writer;
  describeFile(writer);
  return writer.json.dump(2) + "\n";
}

std::string sceneText(const Scene& scene) {
  Scene copy = scene;
  return textOf([&](Fields& fields) { describe(fields, copy); });
}

}  // namespace dovetail::scene
