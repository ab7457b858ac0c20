// The JSON Schema of scenes, and the reference of their keys.
#include <nlohmann/json.hpp>
#include <sstream>

#include "dovetail/core/finite.hpp"
#include "dovetail/scene/files.hpp"
#include "dovetail/scene/read.hpp"
#include "fields.hpp"

namespace dovetail::scene {

namespace {

using Json = nlohmann::ordered_json;

Json schemaOf(const std::function<void(Fields&)>& describePart);

/// The schema of an object, with alternative number `kind` of what it has alternatives of.
class Schema final : public Fields {
public:
  explicit Schema(std::size_t kind) : kind_(kind) {}
  std::size_t kinds = 1;
  Json json = {{"type", "object"}, {"additionalProperties", false}, {"properties", Json::object()}};

  void number(Key key, double& value, const Limits& limits) override {
    Json& entry = add(key, numberSchema(limits), std::isnan(value));
    if (std::isfinite(value)) entry["default"] = value;
  }
  void number(Key key, std::optional<double>&, const Limits& limits) override { add(key, numberSchema(limits), false); }
  void numberOrWord(Key key, NumberOrWord& value, const Limits& limits, Words words) override {
    Json schema = numberSchema(limits);
    schema["words"] = listOf(words);
    add(key, std::move(schema), false)["default"] = value.word.empty() ? Json(value.number) : Json(value.word);
  }
  void quantity(Key key, Quantity& value) override {
    add(key, {{"type", Json::array({"number", "string"})}}, std::isnan(value.value));
  }
  void integer(Key key, std::int64_t& value, std::int64_t least, std::int64_t most) override {
    Json& entry =
        add(key, {{"type", Json::array({"integer", "string"})}, {"minimum", least}, {"maximum", most}}, value < least);
    if (value >= least) entry["default"] = value;
  }
  void vector(Key key, Vec3& value, const Dimension& dimension) override {
    Json& entry = add(key, listSchema(numberSchema(any(dimension)), 3), std::isnan(value.x));
    if (!std::isnan(value.x)) entry["default"] = Json::array({value.x, value.y, value.z});
  }
  void vector(Key key, std::optional<Vec3>&, const Dimension& dimension) override {
    add(key, listSchema(numberSchema(any(dimension)), 3), false);
  }
  void function(Key key, TimeValue& value, const Limits& limits) override {
    Json& entry = add(key, numberSchema(limits), std::isnan(value.number));
    if (!std::isnan(value.number)) entry["default"] = value.number;
  }
  void functions(Key key, TimeVector& value, const Dimension& dimension) override {
    const bool needed = std::isnan(value[0].number);
    Json& entry = add(key, listSchema(numberSchema(any(dimension)), 3), needed);
    if (!needed) entry["default"] = Json::array({value[0].number, value[1].number, value[2].number});
  }
  void functions(Key key, std::optional<TimeVector>&, const Dimension& dimension) override {
    add(key, listSchema(numberSchema(any(dimension)), 3), false);
  }
  void box(Key key, geometry::Box& value) override {
    add(key, listSchema(listSchema(numberSchema(any(unit::length)), 3), 2), std::isnan(value.lower.x));
  }
  void cells(Key key, std::array<int, 3>& value) override {
    add(key, listSchema({{"type", Json::array({"integer", "string"})}, {"minimum", 1}}, 3), value[0] < 1);
  }
  void flag(Key key, bool& value) override { add(key, {{"type", "boolean"}}, false)["default"] = value; }
  void text(Key key, std::string& value, bool needed) override {
    Json& entry = add(key, {{"type", "string"}, {"minLength", 1}}, needed);
    if (!value.empty()) entry["default"] = value;
  }
  void file(Key key, std::string&) override { add(key, {{"type", "string"}, {"minLength", 1}}, true); }
  void word(Key key, std::string& value, Words words) override {
    add(key, {{"enum", listOf(words)}}, false)["default"] = value;
  }
  void wordList(Key key, std::vector<std::string>& value, Words words, bool needed) override {
    Json& entry = add(key, {{"type", "array"}, {"items", {{"enum", listOf(words)}}}, {"uniqueItems", true}}, needed);
    if (needed)
      entry["minItems"] = 1;
    else
      entry["default"] = value;
  }
  void where(std::string&) override {}
  void includes(Key key) override {
    add(key, {{"type", "array"}, {"items", {{"type", "string"}, {"minLength", 1}}}, {"uniqueItems", true}}, false);
  }
  void parameters(Key key, Parameters&) override {
    add(key,
        {{"type", "object"},
         {"propertyNames", {{"pattern", "^[A-Za-z][A-Za-z0-9_]{0,98}$"}}},
         {"additionalProperties", {{"type", Json::array({"number", "string"})}}}},
        false);
  }

protected:
  std::size_t kindOf(Key key, std::size_t, Words names) override {
    kinds = names.size();
    add(key, {{"const", names[kind_]}}, true);
    return kind_;
  }
  bool optionalPart(Key, bool) override { return true; }
  void part(Key key, bool always, const std::function<void(Fields&)>& describePart) override {
    Json schema = schemaOf(describePart);
    // One that is always there must be given if one of its keys must.
    const bool needed = always && (schema.contains("required") || schema.contains("oneOf"));
    add(key, std::move(schema), needed);
  }
  std::size_t sizeOf(Key, std::size_t, bool needed) override {
    needed_ = needed;
    return 1;
  }
  void parts(Key key, std::size_t, const std::function<void(Fields&, std::size_t)>& describePart) override {
    Json list = {{"type", "array"}, {"items", schemaOf([&](Fields& fields) { describePart(fields, 0); })}};
    if (needed_) list["minItems"] = 1;
    add(key, std::move(list), needed_);
  }

private:
  Json& add(Key key, Json schema, bool needed) {
    if (needed) json["required"].push_back(key.name);
    schema["description"] = key.help;
    return json["properties"][key.name] = std::move(schema);
  }
  static Json listOf(Words words) {
    Json list = Json::array();
    for (const char* const word : words) list.push_back(word);
    return list;
  }
  static Json listSchema(Json items, int count) {
    return {{"type", "array"}, {"items", std::move(items)}, {"minItems", count}, {"maxItems", count}};
  }
  static Json numberSchema(const Limits& limits) {
    Json schema = {{"type", Json::array({"number", "string"})}};
    if (std::isfinite(limits.least)) schema[limits.openBelow ? "exclusiveMinimum" : "minimum"] = limits.least;
    if (std::isfinite(limits.most)) schema[limits.openAbove ? "exclusiveMaximum" : "maximum"] = limits.most;
    if (const std::string name = siName(limits.dimension); !name.empty()) schema["unit"] = name;
    return schema;
  }

  std::size_t kind_;
  bool needed_ = false;
};

Json schemaOf(const std::function<void(Fields&)>& describePart) {
  Json alternatives = Json::array();
  for (std::size_t kind = 0, kinds = 1; kind < kinds; ++kind) {
    Schema schema(kind);
    describePart(schema);
    kinds = schema.kinds;
    alternatives.push_back(std::move(schema.json));
  }
  return alternatives.size() == 1 ? alternatives[0] : Json{{"oneOf", std::move(alternatives)}};
}

Json wholeSchema(const std::string& kind, const std::function<void(Fields&)>& describeFile) {
  Json whole = {{"$schema", "https://json-schema.org/draft/2020-12/schema"}, {"title", "Dovetail " + kind}};
  whole.update(schemaOf(describeFile));
  return whole;
}

void describeScene(Fields& fields) {
  Scene scene;
  describe(fields, scene);
}

std::string valueText(const Json& key) {
  if (key.contains("const")) return "`" + key["const"].get<std::string>() + "`";
  const auto words = [](const Json& list) {
    std::string text;
    for (const Json& word : list) text += (text.empty() ? "`" : ", `") + word.get<std::string>() + "`";
    return text;
  };
  if (key.contains("enum")) return words(key["enum"]);
  if (key.contains("oneOf") || key["type"] == "object") return "object";
  std::string text;
  if (key["type"] == "array") {
    const std::string inner = valueText(key["items"]);
    return "list of " + (key.contains("maxItems") ? key["maxItems"].dump() + " × " : std::string()) + inner;
  }
  if (key["type"].is_string()) return key["type"].get<std::string>();
  text = key["type"][0].get<std::string>();
  if (key.contains("unit")) text += ", " + key["unit"].get<std::string>();
  for (const auto& [name, sign] :
       {std::pair{"minimum", "≥"}, {"exclusiveMinimum", ">"}, {"maximum", "≤"}, {"exclusiveMaximum", "<"}})
    if (key.contains(name) && std::abs(key[name].get<double>()) < 1e9)
      text += ", " + std::string(sign) + " " + formatNumber(key[name].get<double>());
  if (key.contains("words")) text += ", or " + words(key["words"]);
  return text;
}

/// @param kind  of the file: the title of its outermost table
void writeTables(const std::string& kind, const std::string& title, const Json& schema, std::ostream& out) {
  if (schema.contains("oneOf")) {
    for (const Json& alternative : schema["oneOf"])
      for (const auto& [name, key] : alternative["properties"].items())
        if (key.contains("const"))
          writeTables(kind, title + ", `" + name + "`: `" + key["const"].get<std::string>() + "`", alternative, out);
    return;
  }
  if (!schema.contains("properties")) return;
  out << "\n## " << title << "\n\n| key | value | default | |\n|---|---|---|---|\n";
  const Json needed = schema.value("required", Json::array());
  for (const auto& [name, key] : schema["properties"].items()) {
    const bool must = std::find(needed.begin(), needed.end(), name) != needed.end();
    out << "| `" << name << "` | " << valueText(key) << " | "
        << (must                      ? "**needed**"
            : key.contains("default") ? "`" + key["default"].dump() + "`"
                                      : "")
        << " | " << key["description"].get<std::string>() << " |\n";
  }
  for (const auto& [name, key] : schema["properties"].items()) {
    const std::string inner = title == kind ? "`" + name + "`" : title + " → `" + name + "`";
    writeTables(kind, inner, key.contains("items") ? key["items"] : key, out);
  }
}

}  // namespace

std::string schemaText(const std::string& kind, const std::function<void(Fields&)>& describeFile) {
  return wholeSchema(kind, describeFile).dump(2) + "\n";
}
std::string schemaText() { return schemaText("scene", describeScene); }

std::string referenceText(const std::string& kind, const std::function<void(Fields&)>& describeFile) {
  std::ostringstream out;
  writeTables(kind, kind, wholeSchema(kind, describeFile), out);
  return out.str();
}
std::string referenceText() {
  return "# Keys of a scene file\n\nMade by `dovetail schema --markdown`.\n" + referenceText("scene", describeScene);
}

}  // namespace dovetail::scene
