#include "quantities.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace dovetail::scene {

namespace {

const std::array hues{
    Hue{"speed", "speed", "m/s"},
    Hue{"radius", "radius", "m"},
    Hue{"force", "force", "N"},
    Hue{"spin", "spin", "rad/s"},
    Hue{"weight", "weight of the grains", ""},
    Hue{"solid_weight", "weight of the solid", ""},
    Hue{"von_mises", "von Mises stress", "Pa"},
    Hue{"pressure", "pressure", "Pa", true},
    Hue{"traction", "traction", "Pa"},
    Hue{"displacement", "displacement", "m"},
    Hue{"plastic_strain", "plastic strain", ""},
    Hue{"shear_strain", "shear strain", ""},
    Hue{"volume_strain", "volume strain", "", true},
    Hue{"turn", "turn", "rad"},
    Hue{"void_ratio", "void ratio", ""},
    Hue{"coordination", "contacts per grain", ""},
    Hue{"sliding", "fraction of sliding contacts", ""},
    Hue{"normal_force", "normal force", "N"},
    Hue{"utilised", "stress over strength", ""},
};

/// The next of 1, 1.2, 1.5, 2 … times a power of ten away from 0.
double roundedOut(double value) {
  if (value == 0.0) return 0.0;
  const double unit = std::pow(10.0, std::floor(std::log10(std::abs(value)) + 1e-12));
  for (const double step : {1.0, 1.2, 1.5, 2.0, 2.5, 3.0, 4.0, 5.0, 6.0, 8.0, 10.0})
    if (std::abs(value) <= step * unit * (1.0 + 1e-9)) return std::copysign(step * unit, value);
  return value;
}

}  // namespace

std::pair<double, std::string> prefixed(double size, const std::string& unit) {
  if (unit != "m" && unit != "m/s" && unit != "Pa" && unit != "N" && unit != "s") return {1.0, unit};
  const bool large = unit == "Pa" || unit == "N";
  size = std::abs(size);
  if (size == 0.0) return {1.0, unit};
  if (large && size >= 1e9) return {1e-9, "G" + unit};
  if (large && size >= 1e6) return {1e-6, "M" + unit};
  if (large && size >= 1e3) return {1e-3, "k" + unit};
  if (size >= 0.1) return {1.0, unit};
  if (size >= 1e-4) return {1e3, "m" + unit};
  return {1e6, "µ" + unit};
}

Hue quantityNamed(const std::string& name) {
  for (const Hue& hue : hues)
    if (hue.name == name) return hue;
  std::string title = name;
  std::replace(title.begin(), title.end(), '_', ' ');
  return {name, title, "", false};
}

std::vector<std::string> fieldsOf(const io::FrameContent& frame) {
  std::vector<std::string> names;
  for (const io::FrameArray& array : frame.arrays) {
    const std::string name = array.name == "velocity" ? "speed" : array.name;
    if (name != "stress" && name != "strain" && name != "fabric" &&
        std::find(names.begin(), names.end(), name) == names.end())
      names.push_back(name);
  }
  return names;
}

std::vector<double> valuesAt(const io::FrameContent& frame, const std::string& name, bool perCell) {
  const io::FrameArray* const array = frame.find(name == "speed" ? "velocity" : name, perCell);
  if (!array) return {};
  const auto n = static_cast<std::size_t>(array->components);
  if (n == 1) return array->values;
  std::vector<double> values;
  for (std::size_t k = 0; k + n <= array->values.size(); k += n) {
    double sum = 0.0;
    for (std::size_t c = 0; c < n; ++c) sum += array->values[k + c] * array->values[k + c];
    values.push_back(std::sqrt(sum));
  }
  return values;
}

void Spread::add(std::vector<double> values) {
  std::erase_if(values, [](double value) { return !std::isfinite(value); });
  if (values.empty()) return;
  std::sort(values.begin(), values.end());
  const std::size_t rare = values.size() / 1000;
  least_ = std::min(least_, values.front());
  most_ = std::max(most_, values.back());
  low_ = std::min(low_, values[rare]);
  high_ = std::max(high_, values[values.size() - 1 - rare]);
}

ColourRange Spread::range(bool signs) const {
  if (isEmpty()) return {};
  if (signs && low_ < 0.0 && high_ > 0.0) {
    const double most = roundedOut(std::max(-low_, high_));
    return {-most, most};
  }
  // As good as the same: the value stands in the middle.
  const double size = std::max(std::abs(low_), std::abs(high_));
  if (high_ - low_ <= 1e-3 * size)
    return size == 0.0 ? ColourRange{0.0, 1.0} : ColourRange{low_ - 0.1 * size, low_ + 0.1 * size};
  if (low_ >= 0.0 && low_ < 0.4 * high_) return {0.0, roundedOut(high_)};
  if (high_ <= 0.0 && high_ > 0.4 * low_) return {roundedOut(low_), 0.0};
  const double step = std::pow(10.0, std::floor(std::log10(high_ - low_))) * 0.5;
  return {std::floor(low_ / step + 1e-9) * step, std::ceil(high_ / step - 1e-9) * step};
}

}  // namespace dovetail::scene
