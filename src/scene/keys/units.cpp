#include "dovetail/scene/units.hpp"

#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <numbers>
#include <string_view>
#include <utility>

namespace dovetail::scene {

namespace {

struct Unit {
  std::string_view name;
  double factor;
  Dimension dimension;
  bool takesPrefix;
};

constexpr std::array units = {Unit{"m", 1.0, unit::length, true},
                              Unit{"g", 1e-3, {0, 1, 0}, true},
                              Unit{"t", 1e3, {0, 1, 0}, false},
                              Unit{"s", 1.0, unit::time, true},
                              Unit{"min", 60.0, unit::time, false},
                              Unit{"h", 3600.0, unit::time, false},
                              Unit{"N", 1.0, {1, 1, -2}, true},
                              Unit{"Pa", 1.0, unit::pressure, true},
                              Unit{"bar", 1e5, unit::pressure, false},
                              Unit{"J", 1.0, {2, 1, -2}, true},
                              Unit{"W", 1.0, {2, 1, -3}, true},
                              Unit{"Hz", 1.0, unit::rate, true},
                              Unit{"rad", 1.0, unit::angle, false},
                              Unit{"deg", std::numbers::pi / 180.0, unit::angle, false},
                              Unit{"rpm", std::numbers::pi / 30.0, unit::spin, false},
                              Unit{"%", 0.01, unit::none, false}};
constexpr std::array<std::pair<std::string_view, double>, 8> prefixes = {
    {{"n", 1e-9}, {"u", 1e-6}, {"µ", 1e-6}, {"μ", 1e-6}, {"m", 1e-3}, {"c", 1e-2}, {"k", 1e3}, {"M", 1e6}}};
constexpr std::pair<std::string_view, double> giga{"G", 1e9};

std::optional<std::pair<double, Dimension>> unitNamed(std::string_view name) {
  for (const Unit& u : units)
    if (name == u.name) return std::pair{u.factor, u.dimension};
  for (const Unit& u : units) {
    if (!u.takesPrefix || !name.ends_with(u.name)) continue;
    const std::string_view prefix = name.substr(0, name.size() - u.name.size());
    if (prefix == giga.first) return std::pair{giga.second * u.factor, u.dimension};
    for (const auto& [text, factor] : prefixes)
      if (prefix == text) return std::pair{factor * u.factor, u.dimension};
  }
  return {};
}

void skipBlanks(std::string_view& text) {
  while (!text.empty() && text.front() == ' ') text.remove_prefix(1);
}

/// An optional exponent: "2", "^2", "^-1".
std::optional<int> takeExponent(std::string_view& text) {
  const bool marked = text.starts_with('^');
  if (marked) text.remove_prefix(1);
  int exponent = 1;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), exponent);
  if (error != std::errc{}) return marked ? std::nullopt : std::optional<int>(1);
  text.remove_prefix(static_cast<std::size_t>(end - text.data()));
  return std::abs(exponent) <= 9 ? std::optional<int>(exponent) : std::nullopt;
}

bool takeFactor(std::string_view& text, bool divides, Quantity& quantity) {
  const std::size_t length = text.find_first_of(" */^-0123456789");
  const auto found = unitNamed(text.substr(0, length));
  if (!found) return false;
  text.remove_prefix(std::min(length, text.size()));
  const auto exponent = takeExponent(text);
  if (!exponent) return false;
  const int power = divides ? -*exponent : *exponent;
  quantity.value *= std::pow(found->first, power);
  quantity.dimension.metre += power * found->second.metre;
  quantity.dimension.kilogram += power * found->second.kilogram;
  quantity.dimension.second += power * found->second.second;
  quantity.dimension.radian += power * found->second.radian;
  return true;
}

}  // namespace

std::optional<Quantity> quantityOf(const std::string& whole) {
  std::string_view text(whole);
  skipBlanks(text);
  if (text.starts_with('+') && !text.starts_with("+-")) text.remove_prefix(1);
  Quantity quantity{0.0, {}};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), quantity.value);
  if (error != std::errc{} || !std::isfinite(quantity.value)) return {};
  text.remove_prefix(static_cast<std::size_t>(end - text.data()));
  bool divides = false;
  skipBlanks(text);
  quantity.joined = text.starts_with('*') || text.starts_with('/');
  for (; !text.empty(); skipBlanks(text)) {
    if (text.front() == '/' || text.front() == '*') {
      divides = text.front() == '/';
      text.remove_prefix(1);
      skipBlanks(text);
    }
    if (!takeFactor(text, divides, quantity)) return {};
  }
  return quantity;
}

std::vector<std::string> likelyQuantities(const std::string& whole) {
  std::string_view text(whole);
  skipBlanks(text);
  double number = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc{}) return {};
  const auto length = static_cast<std::size_t>(end - text.data());
  std::string_view word = text.substr(length);
  skipBlanks(word);
  const auto lower = [](std::string_view from) {
    std::string to(from);
    for (char& c : to) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return to;
  };
  const std::string wanted = lower(word);
  std::vector<std::string> likely;
  const auto look = [&](const std::string& unit) {
    if (lower(unit) == wanted) likely.push_back(std::string(text.substr(0, length)) + " " + unit);
  };
  for (const Unit& u : units) {
    look(std::string(u.name));
    if (!u.takesPrefix) continue;
    for (const auto& [prefix, factor] : prefixes) look(std::string(prefix).append(u.name));
    look(std::string(giga.first).append(u.name));
  }
  for (const auto& [other, unit] :
       {std::pair{"sec", "s"}, std::pair{"second", "s"}, std::pair{"seconds", "s"}, std::pair{"meter", "m"},
        std::pair{"metre", "m"}, std::pair{"degrees", "deg"}, std::pair{"°", "deg"}, std::pair{"percent", "%"}})
    if (word == other) likely.push_back(std::string(text.substr(0, length)) + " " + unit);
  return likely;
}

std::string siName(const Dimension& d) {
  constexpr std::array<std::pair<Dimension, const char*>, 7> named = {{{unit::pressure, "Pa"},
                                                                       {unit::force, "N"},
                                                                       {unit::torque, "N m"},
                                                                       {unit::pressurePerLength, "Pa/m"},
                                                                       {unit::stiffness, "N/m"},
                                                                       {unit::penalty, "Pa/m2"},
                                                                       {unit::massRate, "kg/s"}}};
  for (const auto& [dimension, name] : named)
    if (d == dimension) return name;
  std::string above, below;
  const std::array<std::pair<int, const char*>, 4> parts = {
      {{d.kilogram, "kg"}, {d.metre, "m"}, {d.radian, "rad"}, {d.second, "s"}}};
  for (const auto& [power, name] : parts) {
    std::string& side = power > 0 ? above : below;
    if (power == 0) continue;
    if (!side.empty()) side += ' ';
    side += name;
    if (std::abs(power) > 1) side += std::to_string(std::abs(power));
  }
  if (below.empty()) return above;
  if (above.empty()) above.push_back('1');
  return above.append("/").append(below);
}

}  // namespace dovetail::scene
