#include "program/options.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <iostream>
#include <sstream>

#include "dovetail/core/finite.hpp"
#include "dovetail/core/nearest.hpp"

namespace dovetail::program {

Range between(double low, double high, const std::string& words) {
  return {low, high, true, true,
          words.empty() ? "a number from " + formatNumber(low) + " to " + formatNumber(high) : words};
}
Range positive(const std::string& words, double most) { return {0.0, most, false, true, words}; }
Range notNegative(const std::string& words, double most) { return {0.0, most, true, true, words}; }

void requireIn(const Range& range, double value, const std::string& name) {
  const bool enough = range.lowToo ? value >= range.low : value > range.low;
  const bool notTooMuch = range.highToo ? value <= range.high : value < range.high;
  if (!std::isfinite(value) || !enough || !notTooMuch)
    throw InputError("the value " + formatNumber(value) + " is not possible", name, "give " + range.words);
}

Option& Options::add(const std::string& name, const std::string& help, std::function<void(const std::string&)> read,
                     std::function<std::string()> text) {
  Option option;
  const std::size_t blank = std::min(name.find(' '), name.size());
  option.name = name.substr(0, blank);
  option.value = name.substr(std::min(blank + 1, name.size()));
  option.help = help;
  option.group = group_;
  if (told_ && text) option.key = option.name.substr(option.isArgument() ? 0 : std::min<std::size_t>(2, blank));
  for (char& c : option.key) c = c == '-' ? '_' : static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  option.read = std::move(read);
  option.text = std::move(text);
  all_.push_back(std::move(option));
  return all_.back();
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
  return add(
      name, help, [&value, given](const std::string&) { value = given; },
      [&value] { return std::string(value ? "yes" : "no"); });
}

std::string Options::wordAt(const std::string& words, std::size_t place) {
  std::size_t begin = 0;
  for (; place > 0; --place) begin = words.find('|', begin) + 1;
  return words.substr(begin, words.find('|', begin) - begin);
}

std::size_t Options::placeOf(const std::string& text, const std::string& words, const std::string& name) {
  std::vector<std::string> all;
  std::istringstream parts(words);
  for (std::string word; std::getline(parts, word, '|'); all.push_back(word))
    if (word == text) return all.size();
  const std::string near = nearest(text, all);
  throw InputError("there is no '" + text + "'", name,
                   near.empty() ? "take one of " + words : "write " + near + ", or another of " + words);
}

Option& Options::word(const std::string& name, std::string& value, const std::string& words, const std::string& help) {
  return add(
      name + " " + words, help,
      [&value, words, name](const std::string& text) { value = wordAt(words, placeOf(text, words, name)); },
      [&value] { return value; });
}

bool Options::parse(int argc, char** argv, const std::function<void()>& between) {
  const std::vector<std::string> words(argv + 1, argv + argc);
  if (std::ranges::any_of(words, [](const std::string& word) { return word == "--help" || word == "-h"; }))
    return printHelp(std::cout), false;
  take(words);
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

void Options::take(const std::vector<std::string>& words) {
  for (std::size_t k = 0; k < words.size(); ++k) {
    const std::string& word = words[k];
    const bool named = word.size() > 1 && word[0] == '-' && std::isdigit(static_cast<unsigned char>(word[1])) == 0;
    const std::size_t equals = named ? word.find('=') : std::string::npos;
    Option& option = rowOf(word.substr(0, equals), !named);
    if (option.isFlag() && equals != std::string::npos) refuse(option.name + " takes no value");
    if (!option.isFlag() && !option.many && !option.written.empty()) refuse("there are two values of " + option.name);
    if (!named || option.isFlag() || equals != std::string::npos) {
      option.written.push_back(option.isFlag() ? "yes" : word.substr(named ? equals + 1 : 0));
      continue;
    }
    std::string value;
    for (auto more = 1 + std::ranges::count(option.value, ' '); more > 0; --more) {
      if (++k == words.size() || words[k].starts_with("--")) refuse(option.name + " lacks its value " + option.value);
      value += (value.empty() ? "" : " ") + words[k];
    }
    option.written.push_back(value);
  }
  for (const Option& option : all_)
    if (option.needed && option.written.empty())
      refuse(option.name + " is missing",
             option.value.find('|') == std::string::npos ? "" : "take one of " + option.value + ", or ");
}

Option& Options::rowOf(const std::string& word, bool argument) {
  std::vector<std::string> names;
  for (Option& option : all_) {
    if (argument ? option.isArgument() && (option.many || option.written.empty()) : option.name == word) return option;
    if (option.name.starts_with("--")) names.push_back(option.name);
  }
  if (argument) refuse("the argument '" + word + "' is one too many");
  const std::string near = nearest(word, names);
  refuse("there is no option " + word, near.empty() ? "" : "write " + near + ", or ");
}

void Options::refuse(const std::string& problem, const std::string& advice) const {
  throw InputError(problem, "command line", advice + "see " + program_ + " --help");
}

namespace {

/// Letters as they are seen: UTF-8 has more bytes.
std::size_t widthOf(const std::string& text) {
  return static_cast<std::size_t>(std::ranges::count_if(text, [](char c) { return (c & 0xC0) != 0x80; }));
}

/// Goes on at column `at`; further lines begin at `indent`.
void wrap(const std::string& text, std::size_t at, std::size_t indent, std::ostream& out) {
  std::istringstream words(text);
  for (std::string word; words >> word; at += widthOf(word)) {
    if (at + 1 + widthOf(word) > 100)
      out << '\n' << std::string(at = indent, ' ');
    else if (at > indent)
      out << ' ', ++at;
    out << word;
  }
  out << '\n';
}

/// Whether the words that a value may be stand behind the help: of arguments, and where they are many.
bool listsWords(const Option& option) {
  return option.value.find('|') != std::string::npos && (option.isArgument() || option.value.size() > 60);
}

std::string nameOf(const Option& option) {
  return option.isFlag() ? option.name : option.name + (listsWords(option) ? " WORD" : " " + option.value);
}

std::string helpOf(const Option& option) {
  std::string text = option.help;
  if (listsWords(option)) text += ": ";
  if (listsWords(option))
    for (const char c : option.value) text += c == '|' ? std::string(", ") : std::string(1, c);
  if (option.many) text += "; may be given several times";
  if (option.needed && !option.isArgument()) text += " (needed)";
  if (!option.text || option.isFlag() || option.isArgument() || !option.hasDefault) return text;
  if (text.find("default") != std::string::npos || option.text().empty()) return text;
  return text + " (default " + option.text() + ")";
}

}  // namespace

void printColumns(const io::KeyValues& rows, std::ostream& out) {
  constexpr std::size_t indent = 32;
  for (const auto& [left, right] : rows) {
    const std::size_t end = 2 + widthOf(left);
    out << "  " << left << (end + 2 > indent ? "\n" + std::string(indent, ' ') : std::string(indent - end, ' '));
    wrap(right, indent, indent, out);
  }
}

void Options::printHelp(std::ostream& out) const {
  std::string arguments;
  io::KeyValues rows;
  for (const Option& option : all_)
    if (option.isArgument()) {
      arguments += option.needed ? option.name + " " : "[" + option.name + "] ";
      rows.emplace_back(option.name, helpOf(option));
    }
  wrap(about_, 0, 0, out);
  out << "\nusage: " << program_ << ' ' << arguments << "[options]\n";
  printColumns(rows, out);
  std::string title;
  for (const Option& option : all_) {
    if (!option.name.starts_with("--")) continue;
    if (option.group != title) out << '\n' << (title = option.group) << ":\n";
    printColumns({{nameOf(option), helpOf(option)}}, out);
  }
  printColumns({{"--help", "prints this"}}, out);
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
    for (const std::string& value : option.written) all.emplace_back(option.name, option.isFlag() ? "true" : value);
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
