#include "plausible.hpp"

#include <cmath>
#include <numbers>
#include <string_view>

#include "dovetail/core/finite.hpp"
#include "keys/keys.hpp"

namespace dovetail::scene {

namespace {

/// What is usual for a key.
struct Plausible {
  std::string_view within;  ///< the list or object of the scene in which it stands; empty: anywhere
  std::string_view key;
  double least, most;                             ///< SI
  std::array<std::string_view, 3> unitsMeant{};   ///< units whose number may stand there without them
  std::string (*remedy)(double value) = nullptr;  ///< in place of such a unit
};

std::string tangentOf(double value) {
  if (value > 89.0) return "write Coulomb's coefficient, which is the tangent of the angle of friction";
  return "write " + rounded(std::tan(value * std::numbers::pi / 180.0)) + " if an angle of " + formatNumber(value) +
         " deg is meant";
}

constexpr std::array grainLengths = {std::string_view("mm"), std::string_view("um"), std::string_view("nm")};
constexpr std::array ranges = {
    Plausible{"", "density", 20.0, 3e4, {"g/cm3", "g/mm3"}},
    Plausible{"", "youngs_modulus", 100.0, 2e12, {"GPa", "MPa", "kPa"}},
    Plausible{"bonds", "youngs_modulus", 1e4, 2e12, {"MPa", "GPa", "kPa"}},
    Plausible{"", "stiffness_ratio", 1e-6, 1e3},
    Plausible{"", "yield_stress", 1.0, 2e11, {"GPa", "MPa", "kPa"}},
    Plausible{"", "hardening", 0.1, 2e12, {"GPa", "MPa", "kPa"}},
    Plausible{"", "cohesion", 1e-3, 2e11, {"GPa", "MPa", "kPa"}},
    Plausible{"", "tensile_strength", 200.0, 2e11, {"MPa", "GPa", "kPa"}},
    Plausible{"", "shear_strength", 200.0, 2e11, {"MPa", "GPa", "kPa"}},
    Plausible{"", "pressure", 0.01, 1e12, {"MPa", "kPa"}},
    Plausible{"", "traction", 0.01, 1e12, {"MPa", "kPa"}},
    Plausible{"", "friction", 1e-6, 5.0, {}, tangentOf},
    Plausible{"", "friction_angle", 0.01, 1.4, {"rad"}},
    Plausible{"", "stiffness", 1e-2, 1e16},
    Plausible{"", "tangential_stiffness", 1e-3, 1e13},
    Plausible{"", "tangential_damping_ratio", 1e-6, 20.0},
    Plausible{"", "gravity", 1e-5, 5e3, {"mm/s2"}},
    Plausible{"", "velocity", 1e-12, 8e3, {"mm/s", "um/s"}},
    Plausible{"", "spin", 1e-9, 1e6, {"deg/s"}},
    Plausible{"", "angular_velocity", 1e-9, 1e6, {"deg/s"}},
    Plausible{"particles", "radius", 1e-8, 1e3, grainLengths},
    Plausible{"clumps", "radius", 1e-8, 1e3, grainLengths},
    Plausible{"", "smallest", 1e-8, 1e3, grainLengths},
    Plausible{"", "largest", 1e-8, 1e3, grainLengths},
    Plausible{"", "at", 1e-15, 1e5, {"mm"}},
    Plausible{"", "point", 1e-15, 1e5, {"mm"}},
    Plausible{"", "centre", 1e-15, 1e5, {"mm"}},
    Plausible{"", "box", 1e-15, 1e5, {"mm"}},
    Plausible{"", "region", 1e-15, 1e5, {"mm"}},
    Plausible{"", "radius_ratio", 1e-3, 10.0},
    Plausible{"", "scale", 1e-9, 1e3},
    Plausible{"", "damping_time", 1e-12, 10.0, {"ms", "us"}},
    Plausible{"", "number_per_second", 1e-4, 1e8},
    Plausible{"", "mass_per_second", 1e-12, 1e6, {"g/s", "mg/s"}},
    Plausible{"stages", "time", 1e-9, 1e7},
    Plausible{"steps", "dt", 1e-12, 10.0},
};

bool isIn(const Plausible& range, double value) { return value >= range.least && value <= range.most; }

/// "2 mPa" for 2 MPa is so common that its number is told as it was meant.
std::string inUnit(double value, std::string_view unit) {
  const bool milli = unit == "GPa" && std::abs(value) < 1.0;
  return milli ? formatNumber(1e3 * value) + " MPa" : formatNumber(value) + " " + std::string(unit);
}

std::string remedyFor(const Plausible& range, double value) {
  if (range.remedy) return range.remedy(value);
  for (const std::string_view unit : range.unitsMeant) {
    const auto quantity = quantityOf(formatNumber(value) + " " + std::string(unit));
    if (!unit.empty() && quantity && isIn(range, std::abs(quantity->value)))
      return "write \"" + inUnit(value, unit) + "\" if that is meant";
  }
  return "check its unit";
}

/// Goes through all numbers that have a value; zeros switch things off.
class Examiner final : public Fields {
public:
  Examiner(std::string path, Lines& lines) : path_(std::move(path)), lines_(lines) {}

  void number(Key key, double& value, const Limits& limits) override { look(key, value, limits.dimension); }
  void number(Key key, std::optional<double>& value, const Limits& limits) override {
    if (value) look(key, *value, limits.dimension);
  }
  void numberOrWord(Key key, NumberOrWord& value, const Limits& limits, Words) override {
    if (value.word.empty()) look(key, value.number, limits.dimension);
  }
  void quantity(Key, Quantity&) override {}
  void integer(Key, std::int64_t&, std::int64_t, std::int64_t) override {}
  void vector(Key key, Vec3& value, const Dimension& dimension) override { look(key, value, dimension); }
  void vector(Key key, std::optional<Vec3>& value, const Dimension& dimension) override {
    if (value) look(key, *value, dimension);
  }
  void box(Key key, geometry::Box& value) override {
    look(key, value.lower, unit::length);
    look(key, value.upper, unit::length);
  }
  void box(Key key, std::optional<geometry::Box>& value) override {
    if (value) box(key, *value);
  }
  void function(Key key, TimeValue& value, const Limits& limits) override {
    if (value.expression.empty()) look(key, value.number, limits.dimension);
  }
  void functions(Key key, TimeVector& value, const Dimension& dimension) override {
    Vec3 constant;
    for (int k = 0; k < 3; ++k)
      if (const TimeValue& one = value[static_cast<std::size_t>(k)]; one.expression.empty()) constant[k] = one.number;
    look(key, constant, dimension);
  }
  void functions(Key key, std::optional<TimeVector>& value, const Dimension& dimension) override {
    if (value) functions(key, *value, dimension);
  }
  void cells(Key, std::array<int, 3>&) override {}
  void flag(Key, bool&) override {}
  void flag(Key, std::optional<bool>&) override {}
  void text(Key, std::string&, bool) override {}
  void fileList(Key, std::vector<std::string>&) override {}
  void nameOrNumber(Key, std::string&) override {}
  void file(Key, std::string&, bool) override {}
  void word(Key, std::string&, Words) override {}
  void wordList(Key, std::vector<std::string>&, Words, bool) override {}
  void where(std::string&) override {}
  void includes(Key) override {}
  void parameters(Key, Parameters&) override {}

protected:
  std::size_t kindOf(Key, std::size_t now, Words, bool) override { return now; }
  bool optionalPart(Key, bool there) override { return there; }
  std::size_t sizeOf(Key, std::size_t now, bool) override { return now; }
  void part(Key key, bool, const std::function<void(Fields&)>& describePart) override {
    Examiner within(path_ + key.name + ".", lines_);
    describePart(within);
  }
  void parts(Key key, std::size_t count, const std::function<void(Fields&, std::size_t)>& describePart) override {
    for (std::size_t k = 0; k < count; ++k) {
      Examiner within(path_ + key.name + "." + std::to_string(k) + ".", lines_);
      describePart(within, k);
    }
  }

private:
  void look(Key key, const Vec3& value, const Dimension& dimension) {
    const double most = std::max({value.x, value.y, value.z}), least = std::min({value.x, value.y, value.z});
    const double along = std::abs(least) > most ? least : most;
    const double size = std::hypot(value.x, value.y, value.z);
    look(key, size > std::abs(along) ? size : along, dimension);
  }
  void look(Key key, double value, const Dimension& dimension) {
    if (value == 0.0) return;
    for (const Plausible& range : ranges)
      if (range.key == key.name && path_.starts_with(range.within) && !isIn(range, std::abs(value))) {
        const std::string unit = siName(dimension), of = unit.empty() ? "" : " " + unit;
        lines_.push_back(path_ + key.name + " is " + formatNumber(value) + of + ", far from what is usual, " +
                         formatNumber(range.least) + " to " + formatNumber(range.most) + of + ": " +
                         remedyFor(range, value) + ".");
      }
  }

  std::string path_;
  Lines& lines_;
};

}  // namespace

void lookAtNumbers(const Scene& scene, Lines& lines) {
  Scene copy = scene;
  Examiner all("", lines);
  describe(all, copy);
}

}  // namespace dovetail::scene
