#include "program/options.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <iostream>
#include <sstream>

#include "dovetail/core/finite.hpp"

namespace dovetail::program {

namespace {

template <class Number>
Number numberFrom(const std::string& text, const std::string& name, const char* kind) {
  Number value{};
  const auto [rest, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || rest != text.data() + text.size())
    throw InputError("'" + text + "' is no " + kind, name, std::string("give a ") + kind);
  return value;
}

void requireIn(const Range& range, double value, const std::string& name) {
  const bool enough = range.lowToo ? value >= range.low : value > range.low;
  const bool notTooMuch = range.highToo ? value <= range.high : value < range.high;
  if (!std::isfinite(value) || !enough || !notTooMuch)
    throw InputError("the value " + formatNumber(value) + " is not possible", name, "give " + range.words);
}

}  // namespace

Range between(double low, double high, const std::string& words) {
  return {low, high, true, true,
          words.empty() ? "a number from " + formatNumber(low) + " to " + formatNumber(high) : words};
}
Range positive(const std::string& words, double most) { return {0.0, most, false, true, words}; }
Range notNegative(const std::string& words, double most) { return {0.0, most, true, true, words}; }

Option& Options::add(const std::string& name, const std::string& help, std::function<void(const std::string&)> read,
                     std::function<std::string()> text) {
  Option option;
  option.name = plainName(name);
  option.letter = name.find(' ') == std::string::npos ? "" : name.substr(name.find(' ') + 1);
  option.help = help;
  option.group = group_;
  if (told_ && text) option.key = option.name.substr(option.name.starts_with("--") ? 2 : 0);
  for (char& c : option.key) c = c == '-' ? '_' : static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  option.read = std::move(read);
  option.text = std::move(text);
  all_.push_back(std::move(option));
  return all_.back();
}

Option& Options::number(const std::string& name, double& value, const Range& range, const std::string& help) {
  Option& option = add(
      name, help,
      [&value, plain = plainName(name)](const std::string& text) { value = numberFrom<double>(text, plain, "number"); },
      [&value] { return formatNumber(value); });
  option.check = [&value, range, plain = option.name] { requireIn(range, value, plain); };
  return option;
}

Option& Options::number(const std::string& name, std::optional<double>& value, const Range& range,
                        const std::string& without, const std::string& help) {
  Option& option = add(
      name, help,
      [&value, plain = plainName(name)](const std::string& text) { value = numberFrom<double>(text, plain, "number"); },
      [&value, without] { return value ? formatNumber(*value) : without; });
  option.check = [&value, range, plain = option.name] {
    if (value) requireIn(range, *value, plain);
  };
  return option;
}

Option& Options::integer(const std::string& name, int& value, int low, int high, const std::string& help) {
  Option& option = add(
      name, help,
      [&value, plain = plainName(name)](const std::string& text) {
        value = numberFrom<int>(text, plain, "whole number");
      },
      [&value] { return std::to_string(value); });
  option.check = [&value, low, high, plain = option.name] {
    requireIn(between(low, high, "a whole number from " + std::to_string(low) + " to " + std::to_string(high)), value,
              plain);
  };
  return option;
}

Option& Options::text(const std::string& name, std::string& value, const std::string& help) {
  return add(
      name, help, [&value](const std::string& text) { value = text; }, [&value] { return value; });
}

Option& Options::texts(const std::string& name, std::vector<std::string>& values, const std::string& help) {
  Option& option = add(
      name, help, [&values](const std::string& text) { values.push_back(text); },
      [&values] {
        std::string all;
        for (const std::string& value : values) all += (all.empty() ? "" : " ") + value;
        return all;
      });
  option.many = true;
  return option;
}

Option& Options::flag(const std::string& name, bool& value, const std::string& help, bool given) {
  Option& option = add(
      name, help, [&value, given](const std::string&) { value = given; },
      [&value] { return std::string(value ? "yes" : "no"); });
  option.flag = true;
  return option;
}

std::string Options::wordAt(const std::string& words, std::size_t place) {
  std::size_t begin = 0;
  for (; place > 0; --place) begin = words.find('|', begin) + 1;
  return words.substr(begin, words.find('|', begin) - begin);
}

std::size_t Options::placeOf(const std::string& text, const std::string& words, const std::string& name) {
  const auto count = static_cast<std::size_t>(1 + std::count(words.begin(), words.end(), '|'));
  for (std::size_t place = 0; place < count; ++place)
    if (wordAt(words, place) == text) return place;
  throw InputError("there is no '" + text + "'", name, "take one of " + words);
}

Option& Options::word(const std::string& name, std::string& value, const std::string& words, const std::string& help) {
  return add(
      name + " " + words, help,
      [&value, words, name](const std::string& text) { value = wordAt(words, placeOf(text, words, name)); },
      [&value] { return value; });
}

bool Options::parse(int argc, char** argv, const std::function<void()>& between) {
  CLI::App app(about_, program_);
  app.get_formatter()->column_width(42);
  for (Option& option : all_) {
    if (option.name.empty()) continue;  // told in files alone
    CLI::Option* const row =
        option.flag ? app.add_flag_function(
                          option.name, [&option](std::int64_t) { option.written = {"yes"}; }, option.help)
                    : app.add_option(option.name, option.written, option.help)->expected(1)->option_text(option.letter);
    if (!option.group.empty()) row->group(option.group);
    if (option.needed) row->required();
    if (option.many) row->take_all();
  }
  try {
    app.parse(argc, argv);
  } catch (const CLI::CallForHelp&) {
    std::cout << app.help();
    return false;
  } catch (const CLI::ParseError& error) {
    std::string text = error.what();
    std::replace(text.begin(), text.end(), '\n', ' ');
    throw InputError(text, "command line", "see " + program_ + " --help for the options and their values");
  }
  for (int time = 0; time < 2; ++time) {
    for (const Option& option : all_)
      for (const std::string& value : option.written) {
        if (value.empty()) throw InputError("the value is empty", option.name, "give one, or leave the option out");
        if (time == 0 || !option.many) option.read(value);
      }
    if (time == 0) between();
  }
  check();
  return true;
}

void Options::check() const {
  for (const Option& option : all_) option.check();
}

const Option& Options::find(const std::string& name) const {
  for (const Option& option : all_)
    if (option.name == name || option.name == "--" + name) return option;
  throw InputError("there is no option " + name, program_, "see " + program_ + " --help");
}

bool Options::given(const std::string& name) const { return !find(name).written.empty(); }

io::KeyValues Options::written() const {
  io::KeyValues all;
  for (const Option& option : all_)
    for (const std::string& value : option.written) all.emplace_back(option.name, option.flag ? "true" : value);
  return all;
}

io::KeyValues Options::described() const {
  io::KeyValues rows;
  for (const Option& option : all_)
    if (!option.key.empty()) rows.emplace_back(option.key, option.text());
  return rows;
}

void Options::refuseIdle(const std::string& names, const std::string& when, const std::string& remedy) const {
  std::istringstream words(names);
  for (std::string name; words >> name;)
    if (given(name)) throw InputError("the option does nothing " + when, name, remedy);
}

void Options::refuseBoth(const std::string& one, const std::string& other) const {
  if (given(one) && given(other))
    throw InputError(one + " and " + other + " exclude one another", "command line", "leave out one of them");
}

}  // namespace dovetail::program
