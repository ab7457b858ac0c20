// Keys of the structures of a file: each structure has one function describe(Fields&, Structure&), and classes that
// read, write or document files derive from Fields. Scenes are such files; other modules have their own.
#pragma once

#include <cmath>
#include <functional>
#include <span>
#include <string>
#include <type_traits>

#include "dovetail/scene/basics.hpp"
#include "dovetail/scene/units.hpp"

namespace dovetail::scene {

/// What a number may be.
struct Limits {
  Dimension dimension{};
  double least = -std::numeric_limits<double>::infinity(), most = std::numeric_limits<double>::infinity();
  bool openBelow = false, openAbove = false;  ///< the bound itself is not allowed
};
constexpr Limits any(Dimension d) { return {d}; }
constexpr Limits positive(Dimension d) { return {d, 0.0, std::numeric_limits<double>::infinity(), true}; }
constexpr Limits notNegative(Dimension d) { return {d, 0.0}; }
constexpr Limits between(double least, double most, bool openBelow = false, bool openAbove = false) {
  return {unit::none, least, most, openBelow, openAbove};
}

struct Key {
  const char* name;
  const char* help;
  bool ofPlace = false;  ///< of functions: they may use the place too
};
using Words = std::span<const char* const>;

/// Numbers and vectors that are `required` (NaN) and texts and lists that are `needed` must be given.
class Fields {
public:
  virtual ~Fields() = default;

  virtual void number(Key key, double& value, const Limits& limits) = 0;
  virtual void number(Key key, std::optional<double>& value, const Limits& limits) = 0;
  virtual void numberOrWord(Key key, NumberOrWord& value, const Limits& limits, Words words) = 0;
  /// A number of any unit.
  virtual void quantity(Key key, Quantity& value) = 0;
  virtual void integer(Key key, std::int64_t& value, std::int64_t least, std::int64_t most) = 0;
  virtual void vector(Key key, Vec3& value, const Dimension& dimension) = 0;
  virtual void vector(Key key, std::optional<Vec3>& value, const Dimension& dimension) = 0;
  virtual void box(Key key, geometry::Box& value) = 0;
  virtual void box(Key key, std::optional<geometry::Box>& value) = 0;
  /// A value that may be a function of time.
  virtual void function(Key key, TimeValue& value, const Limits& limits) = 0;
  virtual void functions(Key key, TimeVector& value, const Dimension& dimension) = 0;
  virtual void functions(Key key, std::optional<TimeVector>& value, const Dimension& dimension) = 0;
  virtual void cells(Key key, std::array<int, 3>& value) = 0;
  virtual void flag(Key key, bool& value) = 0;
  virtual void flag(Key key, std::optional<bool>& value) = 0;
  virtual void text(Key key, std::string& value, bool needed) = 0;
  virtual void file(Key key, std::string& value, bool needed = true) = 0;
  virtual void fileList(Key key, std::vector<std::string>& values) = 0;
  /// A name, or the number of an item of a list, counted from 0.
  virtual void nameOrNumber(Key key, std::string& value) = 0;
  virtual void word(Key key, std::string& value, Words words) = 0;
  /// Several of the words, each at most once.
  virtual void wordList(Key key, std::vector<std::string>& value, Words words, bool needed) = 0;
  /// The words of those flags that are true.
  void axes(Key key, std::array<bool, 3>& value, bool needed);
  /// Position of the structure in its file; no key.
  virtual void where(std::string& value) = 0;
  /// The parameters of expressions.
  virtual void parameters(Key key, Parameters& values) = 0;
  /// Included scenes, which have been merged into this one before (include.hpp).
  virtual void includes(Key key) = 0;

  template <class T>
  void integer(Key key, T& value, std::int64_t least, std::int64_t most) {
    std::int64_t wide = value;
    integer(key, wide, least, most);
    value = static_cast<T>(wide);
  }
  /// An enumeration or number by the place of its word.
  template <class T>
  void choice(Key key, T& value, Words words) {
    std::string text = words[static_cast<std::size_t>(value)];
    word(key, text, words);
    for (std::size_t k = 0; k < words.size(); ++k)
      if (text == words[k]) value = static_cast<T>(k);
  }
  /// Which alternative a variant holds; its keys are in the same object.
  /// @param needed  false: the key may be left out, and the variant then holds what it does
  template <class... Kinds>
  void oneOf(Key key, std::variant<Kinds...>& value, Words names, bool needed = true) {
    const std::size_t kind = kindOf(key, value.index(), names, needed);
    if (kind != value.index()) emplace(value, kind);
    std::visit([&](auto& alternative) { describe(*this, alternative); }, value);
  }
  template <class T>
  void object(Key key, T& value) {
    part(key, true, [&](Fields& fields) { describe(fields, value); });
  }
  template <class T>
  void object(Key key, std::optional<T>& value) {
    if (!optionalPart(key, value.has_value())) return;
    if (!value) value.emplace();
    part(key, false, [&](Fields& fields) { describe(fields, *value); });
  }
  template <class T>
  void list(Key key, std::vector<T>& value, bool needed = false) {
    value.resize(sizeOf(key, value.size(), needed));
    parts(key, value.size(), [&](Fields& fields, std::size_t k) { describe(fields, value[k]); });
  }

protected:
  virtual std::size_t kindOf(Key key, std::size_t now, Words names, bool needed) = 0;
  /// @param always  whether the structure exists even if it is not written
  virtual void part(Key key, bool always, const std::function<void(Fields&)>& describePart) = 0;
  virtual bool optionalPart(Key key, bool there) = 0;
  virtual std::size_t sizeOf(Key key, std::size_t now, bool needed) = 0;
  virtual void parts(Key key, std::size_t count, const std::function<void(Fields&, std::size_t)>& describePart) = 0;

private:
  template <class... Kinds>
  static void emplace(std::variant<Kinds...>& value, std::size_t kind) {
    std::size_t k = 0;
    ((k++ == kind ? static_cast<void>(value = Kinds{}) : static_cast<void>(0)), ...);
  }
};

}  // namespace dovetail::scene
