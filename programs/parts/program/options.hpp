// The options of a program in one table: name, unit, range and help. The command line, the settings in files and the
// axes of studies follow from it.
#pragma once

#include <deque>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "dovetail/core/error.hpp"
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

/// A row of the table. What it sets is changed as the text of a value is read.
struct Option {
  std::string name, letter, help, group;  ///< "--cg-width", "X"
  std::string key;                        ///< in files; empty: not told there
  std::function<void(const std::string&)> read;
  std::function<std::string()> text;
  std::function<void()> check = [] {};  ///< @throws InputError if the value is out of range
  bool flag = false, needed = false, many = false;
  std::vector<std::string> written;  ///< on the command line

  /// Adds the unit to the key: "width_m".
  Option& in(const std::string& unit) { return key += "_" + unit, *this; }
  Option& require() { return needed = true, *this; }
  /// The value in files, where it is not what was written.
  Option& reportAs(std::function<std::string()> newText) { return text = std::move(newText), *this; }
};

/// Names "--word LETTER" are options, "WORD" alone is an argument by its place; rows without a name are told in
/// files alone.
class Options {
public:
  Options(std::string program, std::string about) : program_(std::move(program)), about_(std::move(about)) {}

  /// Options added from now on stand below this title in the help, and are told in files or not: under their names, "_"
  /// for "-".
  void group(const std::string& title, bool told = true) {
    group_ = title;
    told_ = told;
  }

  Option& number(const std::string& name, double& value, const Range& range, const std::string& help);
  Option& integer(const std::string& name, int& value, int low, int high, const std::string& help);
  Option& text(const std::string& name, std::string& value, const std::string& help);
  Option& texts(const std::string& name, std::vector<std::string>& values, const std::string& help);
  Option& flag(const std::string& name, bool& value, const std::string& help, bool given = true);
  /// @param without  what files say where there is no value
  Option& number(const std::string& name, std::optional<double>& value, const Range& range, const std::string& without,
                 const std::string& help);
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

private:
  static std::string plainName(const std::string& name) { return name.substr(0, name.find(' ')); }
  static std::size_t placeOf(const std::string& text, const std::string& words, const std::string& name);
  static std::string wordAt(const std::string& words, std::size_t place);
  const Option& find(const std::string& name) const;

  std::string program_, about_, group_;
  bool told_ = true;
  std::deque<Option> all_;
};

}  // namespace dovetail::program
