// Values of a scene file, with refusals that name their place.
#pragma once

#include <filesystem>
#include <optional>
#include <set>
#include <string>

#include "dovetail/scene/fields.hpp"
#include "read/json_tree.hpp"
#include "read/parameters.hpp"

namespace dovetail::scene {

/// What all objects of a file share.
struct Document {
  std::string name;
  std::filesystem::path folder;
  std::set<std::string> names{};  ///< of all parameters
  Parameters parameters{};        ///< those that have a value so far
  std::string functionsOfTime{};  ///< all expressions of t, one after the other
  std::set<std::string> files{};  ///< that are named, absolute
  bool keysOnly = false;          ///< values are not looked at: keys are checked before any value
};

/// Names and numbers within an expression.
std::set<std::string> wordsIn(const std::string& expression);

/// Values within one object. All but the constructor throw InputError with the place of what they refuse.
class Values {
protected:
  /// @param path  of the object, "walls.0"
  Values(Document& document, std::string path) : document_(document), path_(std::move(path)) {}

  /// "scene.json:3:14, walls.0"
  std::string placeOf(const Place& place) const;
  [[noreturn]] void refuse(const Node& node, const std::string& problem, const std::string& remedy) const;

  std::string textOf(const Node& node, Key key) const;
  std::string wordOf(const Node& node, Key key, Words words) const;
  /// A number, a quantity, or an expression, whose dimension nobody knows.
  struct AnyNumber {
    double value;
    std::optional<Dimension> dimension;
  };
  /// @param otherwise  what may be written in place of a number
  std::string guessAt(const std::string& text) const;
  AnyNumber anyNumberOf(const Node& node, Key key, const std::string& otherwise = "") const;
  double numberOf(const Node& node, Key key, const Limits& limits, const std::string& otherwise = "") const;
  double within(const Node& node, Key key, double value, const Limits& limits) const;
  double wholeOf(const Node& node, Key key, double least, double most) const;
  TimeValue timeValueOf(const Node& node, Key key, const Limits& limits);
  TimeVector timeVectorOf(const Node& node, Key key, const Dimension& dimension);
  Vec3 vectorOf(const Node& node, Key key, const Dimension& dimension) const;

  static std::string named(Key key) { return std::string("\"").append(key.name).append("\""); }
  static std::string listOf(Words words);

private:
  /// "2*h" is no quantity where there is a parameter h, "2 h" is two hours everywhere.
  std::optional<Quantity> quantityIn(const std::string& text) const;
  void requireThree(const Node& node, Key key) const;

  Document& document_;

protected:
  std::string path_;
  Place absentAt_;  ///< of the object that should hold this one, if there is none
};

}  // namespace dovetail::scene
