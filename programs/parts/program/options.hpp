// The options of a program in one table: name, word for the value, help, default. The command line, its refusals and
// --help, the settings in files and the axes of studies follow from it.
#pragma once

#include <charconv>
#include <deque>
#include <functional>
#include <iosfwd>
#include <optional>
#include <string>
#include <type_traits>
#include <vector>

#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"
#include "dovetail/io/provenance.hpp"

namespace dovetail::program {

/// Numbers that an option takes, and the words that say so: "give …".
struct Range {
  double low, high;
  bool lowToo, highToo;
  std::string words;
};
Range between(double low, double high, const std::string& words = {});  ///< both included
Range positive(const std::string& words = "a positive number", double most = 1e300);
Range notNegative(const std::string& words, double most = 1e300);
/// @throws InputError under the option's name
void requireIn(const Range& range, double value, const std::string& name);

/// The number that a value is. @throws InputError under the option's name
template <class Number>
Number numberFrom(const std::string& text, const std::string& name) {
  Number value{};
  const char* const kind = std::is_integral_v<Number> ? "whole number" : "number";
  const auto [rest, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || rest != text.data() + text.size())
    throw InputError("'" + text + "' is no " + kind, name, std::string("give a ") + kind);
  return value;
}

/// A row of the table. What it sets is changed as the text of a value is read.
struct Option {
  std::string name, value, help, group;  ///< "--cg-width", "X"; several words take as many values
  std::string key;                       ///< in files; empty: not listed there
  std::function<void(const std::string&)> read;
  std::function<std::string()> text;
  std::function<void()> check = [] {};  ///< @throws InputError if the value is out of range
  bool needed = false, many = false, hasDefault = true;
  std::vector<std::string> written;  ///< on the command line

  bool isArgument() const { return !name.empty() && !name.starts_with("--"); }
  bool isFlag() const { return name.starts_with("--") && value.empty(); }

  /// Adds the unit to the key: "width_m".
  Option& in(const std::string& unit) { return key += "_" + unit, *this; }
  Option& require() { return needed = true, *this; }
  /// The value in files, where it is not what was written.
  Option& reportAs(std::function<std::string()> newText) { return text = std::move(newText), *this; }
};

/// Names "--word VALUE" are options, "--word" alone is a flag, "WORD" alone an argument by its place; rows without a
/// name are told in files alone.
class Options {
public:
  Options(std::string program, std::string about) : program_(std::move(program)), about_(std::move(about)) {}

  /// Options added from now on stand below this title in the help, and are told in files or not: under their names, "_"
  /// for "-".
  void group(const std::string& title, bool told = true) {
    group_ = title;
    told_ = told;
  }

  /// @param Value  a number, or an optional of one; then files say `without` where there is none
  template <class Value>
  Option& number(const std::string& name, Value& value, const Range& range, const std::string& help,
                 const std::string& without = "none");
  template <class Value>
  Option& integer(const std::string& name, Value& value, int low, int high, const std::string& help) {
    const std::string words = "a whole number from " + std::to_string(low) + " to " + std::to_string(high);
    return number(name, value, between(low, high, words), help);
  }
  Option& text(const std::string& name, std::string& value, const std::string& help);
  Option& texts(const std::string& name, std::vector<std::string>& values, const std::string& help);
  Option& flag(const std::string& name, bool& value, const std::string& help, bool given = true);
  /// @param words  "a|b|c", in the order of the enumerators
  template <class Value>
  Option& choice(const std::string& name, Value& value, const std::string& words, const std::string& help) {
    return add(
        name + " " + words, help,
        [&value, words, name](const std::string& text) { value = static_cast<Value>(placeOf(text, words, name)); },
        [&value, words] { return wordAt(words, static_cast<std::size_t>(value)); });
  }
  /// The value is one of the words.
  Option& word(const std::string& name, std::string& value, const std::string& words, const std::string& help);
  /// An option of another kind. @param read  @throws InputError
  Option& add(const std::string& name, const std::string& help, std::function<void(const std::string&)> read,
              std::function<std::string()> text);

  /// Reads the command line twice, in the order of the table, and calls `between` after the first time: what it sets
  /// gives way to what was written. Prints the help and returns false for --help.
  /// @throws InputError in one line for unknown options, values that cannot be read or are empty, and arguments that
  /// lack
  bool parse(
      int argc, char** argv, const std::function<void()>& between = [] {});
  void check() const;
  bool given(const std::string& name) const;

  /// What was written on the command line: names and values, "true" for flags.
  io::KeyValues written() const;
  /// Keys and values for files, in the order of the table.
  io::KeyValues described() const;

  /// Refuses what was written but would do nothing. @param names  with blanks between them @param when  that which
  /// makes it so, such as "with --full-dem"
  /// @throws InputError naming the first of the options that was given
  void refuseIdle(const std::string& names, const std::string& when, const std::string& remedy) const;
  /// @throws InputError if both were written
  void refuseBoth(const std::string& one, const std::string& other) const;
  const std::string& program() const { return program_; }

private:
  static std::size_t placeOf(const std::string& text, const std::string& words, const std::string& name);
  static std::string wordAt(const std::string& words, std::size_t place);
  const Option& find(const std::string& name) const;
  void printHelp(std::ostream& out) const;
  void take(const std::vector<std::string>& words);
  Option& rowOf(const std::string& word, bool argument);
  [[noreturn]] void refuse(const std::string& problem, const std::string& advice = {}) const;

  std::string program_, about_, group_ = "options";
  bool told_ = true;
  std::deque<Option> all_;
};

/// Two columns in lines of at most 100 characters.
void printColumns(const io::KeyValues& rows, std::ostream& out);

template <class Value>
Option& Options::number(const std::string& name, Value& value, const Range& range, const std::string& help,
                        const std::string& without) {
  const auto now = [&value] { return std::optional(value); };
  using Number = typename decltype(now())::value_type;
  Option& option = add(name, help, {}, [now, without] {
    if (!now()) return without;
    return std::is_integral_v<Number> ? std::to_string(*now()) : formatNumber(static_cast<double>(*now()));
  });
  option.read = [&value, plain = option.name](const std::string& text) { value = numberFrom<Number>(text, plain); };
  option.check = [now, range, plain = option.name] {
    if (now()) requireIn(range, static_cast<double>(*now()), plain);
  };
  option.hasDefault = std::is_arithmetic_v<Value>;
  return option;
}

}  // namespace dovetail::program
