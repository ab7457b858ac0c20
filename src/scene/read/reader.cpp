// From JSON to the structures of a scene, strictly.
#include <algorithm>
#include <optional>
#include <set>
#include <utility>

#include "dovetail/core/error.hpp"
#include "dovetail/scene/files.hpp"
#include "dovetail/scene/read.hpp"
#include "include.hpp"
#include "json_tree.hpp"
#include "keys/advice.hpp"
#include "keys/fields.hpp"
#include "keys/known_version.hpp"
#include "keys/settings.hpp"
#include "keys/values.hpp"

namespace dovetail::scene {

namespace {

class Reader final : public Fields, Values {
public:
  Reader(Document& document, const Node& node, std::string path)
      : Values(document, std::move(path)), document_(document), node_(node) {}

  /// @throws InputError for keys that nobody asked for, or that were asked for and are not there
  void finish() const {
    if (node_.kind != Node::Kind::object) refuseAsNoObject();
    for (const Node::Member& member : node_.members)
      if (std::find(known_.begin(), known_.end(), member.key) == known_.end())
        throw InputError("there is no key \"" + member.key.substr(0, 80) + "\"", placeOf(member.place),
                         adviceOn(member.key));
    if (!missing_.empty())
      throw InputError("the key \"" + missing_.front() + "\" is missing", placeOf(node_.place), "give it a value");
  }

  void number(Key key, double& value, const Limits& limits) override {
    if (const Node* node = take(key, std::isnan(value))) value = numberOf(*node, key, limits);
  }
  void number(Key key, std::optional<double>& value, const Limits& limits) override {
    if (const Node* node = take(key, false)) value = numberOf(*node, key, limits);
  }
  void numberOrWord(Key key, NumberOrWord& value, const Limits& limits, Words words) override {
    const Node* node = take(key, false);
    if (!node) return;
    if (node->kind == Node::Kind::text)
      for (const char* const known : words)
        if (node->text == known) {
          value = {0.0, node->text};
          return;
        }
    value = {numberOf(*node, key, limits, listOf(words)), ""};
  }
  void quantity(Key key, Quantity& value) override {
    const Node* node = take(key, std::isnan(value.value));
    if (!node) return;
    const AnyNumber number = anyNumberOf(*node, key);
    if (!std::isfinite(number.value)) refuse(*node, named(key) + " is not finite", "write a finite number");
    value = {number.value, number.dimension.value_or(unit::none)};
  }
  void integer(Key key, std::int64_t& value, std::int64_t least, std::int64_t most) override {
    const Node* node = take(key, value < least);
    if (!node) return;
    value = static_cast<std::int64_t>(wholeOf(*node, key, static_cast<double>(least), static_cast<double>(most)));
  }
  void vector(Key key, Vec3& value, const Dimension& dimension) override {
    const Node* node = take(key, std::isnan(value.x));
    if (node) value = vectorOf(*node, key, dimension);
  }
  void vector(Key key, std::optional<Vec3>& value, const Dimension& dimension) override {
    if (const Node* node = take(key, false)) value = vectorOf(*node, key, dimension);
  }
  void box(Key key, geometry::Box& value) override {
    if (const Node* node = take(key, std::isnan(value.lower.x))) value = boxOf(*node, key);
  }
  void box(Key key, std::optional<geometry::Box>& value) override {
    if (const Node* node = take(key, false)) value = boxOf(*node, key);
  }
  void function(Key key, TimeValue& value, const Limits& limits) override {
    if (const Node* node = take(key, std::isnan(value.number))) value = timeValueOf(*node, key, limits);
  }
  void functions(Key key, TimeVector& value, const Dimension& dimension) override {
    if (const Node* node = take(key, std::isnan(value[0].number))) value = timeVectorOf(*node, key, dimension);
  }
  void functions(Key key, std::optional<TimeVector>& value, const Dimension& dimension) override {
    if (const Node* node = take(key, false)) value = timeVectorOf(*node, key, dimension);
  }
  void cells(Key key, std::array<int, 3>& value) override {
    const Node* node = take(key, value[0] < 1);
    if (!node) return;
    if (node->kind != Node::Kind::list || node->items.size() != 3)
      refuse(*node, named(key) + " is " + nameOf(*node), "write three counts: [4, 4, 2]");
    for (std::size_t k = 0; k < 3; ++k) value[k] = static_cast<int>(wholeOf(node->items[k], key, 1.0, 1e4));
  }
  void flag(Key key, bool& value) override {
    const Node* node = take(key, false);
    if (!node) return;
    if (node->kind != Node::Kind::boolean) refuse(*node, named(key) + " is " + nameOf(*node), "write true or false");
    value = node->boolean;
  }
  void flag(Key key, std::optional<bool>& value) override {
    bool given = false;
    flag(key, given);
    if (!document_.keysOnly && node_.find(key.name)) value = given;
  }
  void text(Key key, std::string& value, bool needed) override {
    if (const Node* node = take(key, needed)) value = textOf(*node, key);
  }
  void file(Key key, std::string& value, bool needed) override {
    if (const Node* node = take(key, needed)) value = fileOf(*node, key);
  }
  void fileList(Key key, std::vector<std::string>& values) override {
    const Node* node = take(key, false);
    if (!node) return;
    if (node->kind != Node::Kind::list)
      refuse(*node, named(key) + " is " + nameOf(*node), "write a list of names of files");
    values.clear();
    for (const Node& item : node->items) values.push_back(fileOf(item, key));
  }
  void nameOrNumber(Key key, std::string& value) override {
    const Node* node = take(key, true);
    if (!node) return;
    value = node->kind == Node::Kind::number ? std::to_string(static_cast<int>(wholeOf(*node, key, 0.0, 1e6)))
                                             : textOf(*node, key);
  }
  void word(Key key, std::string& value, Words words) override {
    if (const Node* node = take(key, false)) value = wordOf(*node, key, words);
  }
  void wordList(Key key, std::vector<std::string>& value, Words words, bool needed) override {
    const Node* node = take(key, needed);
    if (!node) return;
    if (node->kind != Node::Kind::list || (needed && node->items.empty()))
      refuse(*node, named(key) + " is " + nameOf(*node), "write a list of " + listOf(words));
    value.clear();
    for (const Node& item : node->items) {
      const std::string text = wordOf(item, key, words);
      if (std::find(value.begin(), value.end(), text) != value.end())
        refuse(item, "\"" + text + "\" is there twice in " + named(key), "leave one of them out");
      value.push_back(text);
    }
  }
  void where(std::string& value) override { value = placeOf(node_.place); }
  void includes(Key) override {}  // is in the node already
  void parameters(Key key, Parameters& values) override {
    const Node* node = take(key, false);
    if (!node) return;
    if (node->kind != Node::Kind::object)
      refuse(*node, named(key) + " is " + nameOf(*node), "write { \"name\": value }");
    for (const Node::Member& member : node->members) document_.names.insert(member.key);
    for (const Node::Member& member : node->members) {
      requireParameterName(member);
      const Key own{member.key.c_str(), ""};
      document_.parameters[member.key] = anyNumberOf(member.value[0], own).value;
    }
    values = document_.parameters;
  }

protected:
  std::size_t kindOf(Key key, std::size_t now, Words names, bool needed) override {
    take(key, false);
    const Node* node = node_.find(key.name);
    if (!node && !needed) return now;
    if (node_.kind != Node::Kind::object) refuseAsNoObject();
    if (!node) {  // without it all other keys would look unknown
      for (const Node::Member& member : node_.members)
        if (const std::string near = nearest(member.key, {key.name}); !near.empty())
          throw InputError("there is no key \"" + member.key + "\"", placeOf(member.place), "write \"" + near + "\"");
      throw InputError(std::string("the key ").append(named(key)).append(" is missing"), placeOf(node_.place),
                       "give it one of " + listOf(names));
    }
    const std::string text = wordOf(*node, key, names);
    for (std::size_t k = 0; k < names.size(); ++k)
      if (text == names[k]) return k;
    return now;
  }
  bool optionalPart(Key key, bool) override {
    known_.push_back(key.name);
    return node_.find(key.name) != nullptr;
  }
  void part(Key key, bool, const std::function<void(Fields&)>& describePart) override {
    if (std::find(known_.begin(), known_.end(), key.name) == known_.end()) known_.push_back(key.name);
    static const Node none = [] {
      Node node;
      node.kind = Node::Kind::object;
      return node;
    }();
    const Node* node = node_.find(key.name);
    Reader reader(document_, node ? *node : none, path_ + (path_.empty() ? "" : ".") + key.name);
    if (!node) reader.absentAt_ = node_.place;
    describePart(reader);
    if (!node && !reader.missing_.empty())
      missing_.push_back(key.name);
    else
      reader.finish();
  }
  std::size_t sizeOf(Key key, std::size_t now, bool needed) override {
    take(key, needed);
    const Node* node = node_.find(key.name);
    if (!node) return now;
    if (node->kind != Node::Kind::list) refuse(*node, named(key) + " is " + nameOf(*node), "write a list: [ … ]");
    if (needed && node->items.empty()) refuse(*node, named(key) + " is empty", "give one at least");
    return node->items.size();
  }
  void parts(Key key, std::size_t count, const std::function<void(Fields&, std::size_t)>& describePart) override {
    const Node* node = node_.find(key.name);
    for (std::size_t k = 0; node && k < count; ++k) {
      Reader reader(document_, node->items[k], path_ + (path_.empty() ? "" : ".") + key.name + "." + std::to_string(k));
      describePart(reader, k);
      reader.finish();
    }
  }

private:
  /// Once the keys are known that it should have.
  [[noreturn]] void refuseAsNoObject() const {
    std::string keys;
    for (const std::string& key : missing_.empty() ? known_ : missing_)
      if (keys.size() < 60) keys += (keys.empty() ? "\"" : ", \"") + key + "\": …";
    refuse(node_, nameOf(node_) + " where an object is expected", "write {" + keys + "}");
  }
  const Node* take(Key key, bool needed) {
    known_.push_back(key.name);
    const Node* node = node_.find(key.name);
    if (!node && needed) missing_.push_back(key.name);
    return document_.keysOnly ? nullptr : node;
  }
  geometry::Box boxOf(const Node& node, Key key) const {
    if (node.kind != Node::Kind::list || node.items.size() != 2)
      refuse(node, named(key) + " is " + nameOf(node), "write two corners: [[0, 0, 0], [1, 1, 1]]");
    const geometry::Box box{vectorOf(node.items[0], key, unit::length), vectorOf(node.items[1], key, unit::length)};
    for (int k = 0; k < 3; ++k)
      if (!(box.lower[k] < box.upper[k]))
        refuse(node, named(key) + " has no width along " + std::string(1, "xyz"[k]),
               "write the lower corner first, each of its coordinates below that of the upper one");
    return box;
  }
  std::string adviceOn(const std::string& unknown) const {
    const std::vector<std::string> others = absent();
    if (nearest(unknown, others).empty())
      if (const std::string near = nearest(unknown, known_); !near.empty())
        return "leave it out: \"" + near + "\" is there already";
    // What is there already tells the right name of another quantity: youngs_modulus for E.
    std::vector<std::string> all;
    for (const std::string& name : known_)
      if (std::find(all.begin(), all.end(), name) == all.end()) all.push_back(name);
    return adviceFor(unknown, nearest(unknown, others).empty() ? all : others);
  }
  std::vector<std::string> absent() const {
    std::vector<std::string> names;
    for (const std::string& name : known_)
      if (!node_.find(name)) names.push_back(name);
    return names;
  }
  void requireParameterName(const Node::Member& member) const {
    const auto isLetter = [](char c) { return std::isalpha(static_cast<unsigned char>(c)) != 0; };
    constexpr std::size_t mostCharacters = 100;  // muParser reads no longer ones
    const bool fits = !member.key.empty() && member.key.size() < mostCharacters && isLetter(member.key.front()) &&
                      std::all_of(member.key.begin(), member.key.end(), [&](char c) {
                        return isLetter(c) || c == '_' || std::isdigit(static_cast<unsigned char>(c));
                      });
    if (!fits)
      throw InputError("\"" + member.key + "\" cannot name a parameter", placeOf(member.place),
                       "use letters, digits and '_', with a letter first, less than 100 in all");
    static const std::set<std::string> taken = {"t",    "pi",   "sin",  "cos",   "tan",   "asin",  "acos", "atan",
                                                "sinh", "cosh", "tanh", "asinh", "acosh", "atanh", "log2", "log10",
                                                "log",  "ln",   "exp",  "sqrt",  "sign",  "rint",  "abs",  "min",
                                                "max",  "sum",  "avg",  "atan2", "fmod"};
    if (taken.contains(member.key))
      throw InputError("\"" + member.key + "\" cannot name a parameter", placeOf(member.place),
                       "take another name: expressions have " +
                           std::string(member.key == "t" ? "the time" : "a function or constant") + " of this one");
  }
  std::string fileOf(const Node& node, Key key) const {
    const std::filesystem::path path = folderOf(node) / textOf(node, key);
    std::error_code error;
    if (std::filesystem::is_directory(path, error))
      refuse(node, path.string() + " is a folder", "give the name of a file in it");
    if (std::filesystem::exists(path, error) && !std::filesystem::is_regular_file(path, error))
      refuse(node, path.string() + " is a pipe or a device", "give the name of a file");
    if (!std::filesystem::is_regular_file(path, error))
      refuse(node, "there is no file " + path.string(), "correct the name, which is relative to the scene's folder");
    const std::string name = std::filesystem::absolute(path).lexically_normal().string();
    document_.files.insert(name);
    return name;
  }
  const std::filesystem::path folderOf(const Node& node) const {
    return node.place.file ? node.place.file->parent_path() : document_.folder;
  }

  Document& document_;
  const Node& node_;
  std::vector<std::string> known_, missing_;
};

void addWords(const Node& node, std::set<std::string>& words) {
  if (node.kind == Node::Kind::text) words.merge(wordsIn(node.text));
  for (const Node& item : node.items) addWords(item, words);
  for (const Node::Member& member : node.members) addWords(member.value.front(), words);
}

/// Included files may be collections, of which a scene uses some.
std::vector<std::string> unusedIn(const Node& root) {
  const Node* let = root.find("let");
  std::set<std::string> words;
  addWords(root, words);
  std::vector<std::string> unused;
  if (let)
    for (const Node::Member& member : let->members)
      if (!member.place.file && !words.contains(member.key)) unused.push_back(member.key);
  return unused;
}

/// Leaves parameters out that no function of time names.
void keepUsed(Parameters& parameters, const std::string& expressions) {
  const std::set<std::string> words = wordsIn(expressions);
  std::erase_if(parameters, [&](const auto& one) { return !words.contains(one.first); });
}

}  // namespace

ReadFields readFields(const FileText& file, const std::vector<std::string>& settings,
                      const std::function<void(Fields&)>& describeFile) {
  Node root = parseJson(file.text, file.name);
  requireKnownVersion(root, file.name);
  const auto includes = [](const std::string& setting) {
    return setting.starts_with("include=") || setting.starts_with("include.");
  };
  for (const std::string& setting : settings)
    if (includes(setting)) applySetting(root, setting);
  root = withIncludes(std::move(root), file.name, file.folder);
  for (const std::string& setting : settings)
    if (!includes(setting)) applySetting(root, setting);
  Document document{file.name, file.folder};
  document.files.insert(file.name);
  forEachPlace(root, [&](const Place& place) {
    if (place.file) document.files.insert(place.file->string());
  });
  for (const bool keysOnly : {true, false}) {
    document.keysOnly = keysOnly;
    Reader reader(document, root, "");
    describeFile(reader);
    reader.finish();
  }
  return {document.functionsOfTime, {document.files.begin(), document.files.end()}, unusedIn(root)};
}

Scene sceneFromText(const std::string& text, const std::string& name, const std::filesystem::path& folder,
                    const std::vector<std::string>& settings) {
  std::optional<Scene> scene;
  const ReadFields read =
      readFields({text, name, folder}, settings, [&](Fields& fields) { describe(fields, scene.emplace()); });
  keepUsed(scene->parameters, read.functionsOfTime);
  scene->files = read.files;
  scene->unusedParameters = read.unused;
  return std::move(*scene);
}

FileText textOfFile(const std::filesystem::path& file) {
  return {textOfScene(file, file.string()), file.string(), file.parent_path()};
}

Scene readScene(const std::filesystem::path& file, const std::vector<std::string>& settings) {
  const FileText text = textOfFile(file);
  return sceneFromText(text.text, text.name, text.folder, settings);
}

}  // namespace dovetail::scene
