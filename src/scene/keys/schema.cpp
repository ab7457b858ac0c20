// The JSON Schema of scenes, and the reference of their keys.
#include <cctype>
#include <map>
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
  void box(Key key, std::optional<geometry::Box>&) override {
    add(key, listSchema(listSchema(numberSchema(any(unit::length)), 3), 2), false);
  }
  void cells(Key key, std::array<int, 3>& value) override {
    add(key, listSchema({{"type", Json::array({"integer", "string"})}, {"minimum", 1}}, 3), value[0] < 1);
  }
  void flag(Key key, bool& value) override { add(key, {{"type", "boolean"}}, false)["default"] = value; }
  void flag(Key key, std::optional<bool>&) override { add(key, {{"type", "boolean"}}, false); }
  void text(Key key, std::string& value, bool needed) override {
    Json& entry = add(key, {{"type", "string"}, {"minLength", 1}}, needed);
    if (!value.empty()) entry["default"] = value;
  }
  void file(Key key, std::string&, bool needed) override { add(key, {{"type", "string"}, {"minLength", 1}}, needed); }
  void fileList(Key key, std::vector<std::string>&) override {
    add(key, {{"type", "array"}, {"items", {{"type", "string"}, {"minLength", 1}}}}, false);
  }
  void nameOrNumber(Key key, std::string&) override {
    add(key, {{"type", Json::array({"string", "integer"})}, {"minLength", 1}}, true);
  }
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
  std::size_t kindOf(Key key, std::size_t now, Words names, bool needed) override {
    kinds = names.size();
    const bool spared = !needed && kind_ == now;
    Json& entry = add(key, {{"const", names[kind_]}}, !spared);
    if (spared) entry["default"] = names[kind_];
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

std::string listed(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text.append(text.empty() ? "`" : ", `").append(word).append("`");
  return text;
}

std::string valueText(const Json& key) {
  if (key.contains("enum")) return listed(key["enum"]);
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
  if (key.contains("words")) text += ", or " + listed(key["words"]);
  return text;
}

/// A key of a part, and the kinds of the part that have it.
struct Row {
  std::string name;
  Json key;
  bool needed;
  std::vector<std::string> kinds;
};

std::string kindOf(const Json& part) {
  for (const Json& key : part["properties"])
    if (key.contains("const")) return key["const"];
  return {};
}

Json alternativesOf(const Json& part) { return part.contains("oneOf") ? part["oneOf"] : Json::array({part}); }

/// A row for each key, once where several kinds of the part have it alike.
std::vector<Row> rowsOf(const Json& part) {
  std::vector<Row> rows;
  for (const Json& alternative : alternativesOf(part)) {
    const Json needed = alternative.value("required", Json::array());
    auto next = rows.begin();
    for (const auto& [name, key] : alternative["properties"].items()) {
      const bool must = std::find(needed.begin(), needed.end(), name) != needed.end();
      auto row = std::find_if(rows.begin(), rows.end(), [&, &name = name, &key = key](const Row& one) {
        return one.name == name &&
               ((one.needed == must && one.key == key) || (one.key.contains("const") && key.contains("const")));
      });
      if (row == rows.end()) {
        while (next != rows.end() && alternative["properties"].value(next->name, Json()) != next->key) ++next;
        row = rows.insert(next, {name, key, must, {}});
      }
      row->kinds.push_back(kindOf(alternative));
      next = row + 1;
    }
  }
  return rows;
}

/// As GitHub makes it of a heading.
std::string anchorOf(const std::string& title) {
  std::string anchor;
  for (const char c : title)
    if (c == ' ' || c == '-' || c == '_' || (c > 0 && std::isalnum(c)))
      anchor += c == ' ' ? '-' : static_cast<char>(std::tolower(c));
  return anchor;
}

/// Tables of all parts. A part that stands at several places has its table at the first, and the others refer to it.
class Reference {
public:
  Reference(const std::string& kind, std::ostream& out) : kind_(kind), out_(out) {}

  void write(const std::string& title, const Json& part) {
    const std::size_t kinds = alternativesOf(part).size();
    std::vector<std::pair<std::string, Json>> inner;
    out_ << "\n## " << title << "\n\n| key |" << (kinds > 1 ? " of |" : "") << " value | default | |\n"
         << "|---|---|---|---|" << (kinds > 1 ? "---|\n" : "\n");
    for (const Row& row : rowsOf(part)) {
      out_ << "| `" << row.name << "` |";
      if (kinds > 1) out_ << ' ' << (row.kinds.size() < kinds ? listed(row.kinds) + " |" : "|");
      out_ << ' ' << (row.key.contains("const") ? listed(row.kinds) : valueText(row.key));
      if (const Json& content = row.key.contains("items") ? row.key["items"] : row.key; isPart(content)) {
        const std::string name = title == kind_ ? "`" + row.name + "`" : title + " → `" + row.name + "`";
        const auto [place, isNew] = titles_.try_emplace(withoutHelp(content), name);
        if (isNew) inner.emplace_back(name, content);
        out_ << ": [" << place->second << "](#" << anchorOf(place->second) << ')';
      }
      out_ << " | " << defaultText(row) << " | " << row.key["description"].get<std::string>() << " |\n";
    }
    for (const auto& [name, content] : inner) write(name, content);
  }

private:
  static bool isPart(const Json& schema) { return schema.contains("oneOf") || schema.contains("properties"); }
  static std::string withoutHelp(Json part) {
    part.erase("description");
    return part.dump();
  }
  static std::string defaultText(const Row& row) {
    if (row.needed) return "**needed**";
    return row.key.contains("default") ? "`" + row.key["default"].dump() + "`" : "";
  }

  const std::string& kind_;
  std::ostream& out_;
  std::map<std::string, std::string> titles_;  ///< by what parts are
};
}  // namespace

std::string schemaText(const std::string& kind, const std::function<void(Fields&)>& describeFile) {
  return wholeSchema(kind, describeFile).dump(2) + "\n";
}
std::string schemaText() { return schemaText("scene", describeScene); }

std::string referenceText(const std::string& kind, const std::function<void(Fields&)>& describeFile) {
  std::ostringstream out;
  Reference(kind, out).write(kind, wholeSchema(kind, describeFile));
  return out.str();
}
std::string referenceText() {
  return "# Keys of a scene file\n\nMade by `dovetail schema --markdown`. An object that stands at several places has "
         "its "
         "table at the first.\nColumn `of`: kinds of the object that have the key; empty: all of them.\n" +
         referenceText("scene", describeScene);
}

}  // namespace dovetail::scene
