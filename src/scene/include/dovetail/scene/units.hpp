// Numbers with units.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace dovetail::scene {

/// Exponents of m, kg, s and rad.
struct Dimension {
  int metre = 0, kilogram = 0, second = 0, radian = 0;
  friend bool operator==(const Dimension&, const Dimension&) = default;
};

namespace unit {
inline constexpr Dimension none{}, length{1, 0, 0}, time{0, 0, 1}, velocity{1, 0, -1}, acceleration{1, 0, -2},
    density{-3, 1, 0}, stiffness{0, 1, -2}, pressure{-1, 1, -2}, angle{0, 0, 0, 1}, spin{0, 0, -1, 1}, rate{0, 0, -1},
    massRate{0, 1, -1}, penalty{-3, 1, -2}, force{1, 1, -2}, pressurePerLength{-2, 1, -2}, torque{2, 1, -2},
    area{2, 0, 0}, mass{0, 1, 0}, inertia{2, 1, 0}, volume{3, 0, 0};
}

/// "m", "kg/m3", "Pa", …; empty without a unit.
std::string siName(const Dimension& dimension);

struct Quantity {
  double value;  ///< SI
  Dimension dimension;
  bool joined = false;  ///< by "*" or "/" behind the number, as an expression would be
};

/// "5 mm", "2e6 Pa", "9.81 m/s2", "30 deg", "7": a number and a product of units, each with an exponent, such behind a
/// "/" in the denominator. Empty if the text does not begin with a number, or goes on with what is no unit.
std::optional<Quantity> quantityOf(const std::string& text);

/// What a number with an unknown unit may have been meant to be: "2 Mpa" gives "2 MPa" and "2 mPa".
std::vector<std::string> likelyQuantities(const std::string& text);

}  // namespace dovetail::scene
