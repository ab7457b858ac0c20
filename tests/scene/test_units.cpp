#include <gtest/gtest.h>

#include "dovetail/scene/units.hpp"

namespace dovetail::scene {

TEST(Units, APlusSignIsTakenOnce) {
  ASSERT_TRUE(quantityOf("+1.0e-01 m"));
  EXPECT_EQ(quantityOf("+1.0e-01 m")->value, 0.1);
  EXPECT_FALSE(quantityOf("+-1 m"));
}

TEST(Units, QuantitiesAreInSi) {
  const auto expect = [](const char* text, double value, Dimension dimension) {
    const auto found = quantityOf(text);
    ASSERT_TRUE(found) << text;
    EXPECT_NEAR(found->value, value, 1e-14 * std::abs(value)) << text;
    EXPECT_EQ(found->dimension, dimension) << text;
  };
  expect("5 mm", 5e-3, unit::length);
  expect("2MPa", 2e6, unit::pressure);
  expect("30 deg", 0.52359877559829887, unit::angle);
  expect("9.81 m/s2", 9.81, unit::acceleration);
  expect("9.81 m/s^2", 9.81, unit::acceleration);
  expect("9.81 m s^-2", 9.81, unit::acceleration);
  expect("2.5 g/cm3", 2500.0, unit::density);
  expect("50 kN/m", 5e4, unit::stiffness);
  expect("60 rpm", 6.283185307179586, unit::spin);
  expect("3 min", 180.0, unit::time);
  expect("2 ms", 2e-3, unit::time);
  expect("7", 7.0, unit::none);
  expect("-1e-3 kg/s", -1e-3, unit::massRate);
  expect("40 %", 0.4, unit::none);
  expect("1 N s/m2", 1.0, {-1, 1, -1});
}

TEST(Units, OtherTextIsNoQuantity) {
  for (const char* text :
       {"", "mm", "5 mn", "5 mm mmm", "5 m^", "5 m^99", "2*a", "nan", "inf", "5 /", "1e999 m", "5 mmm"})
    EXPECT_FALSE(quantityOf(text)) << text;
}

TEST(Units, BothSignsForMicroAreRead) {
  for (const char* const text : {"3 us", "3 \u00b5s", "3 \u03bcs"}) {
    const auto found = quantityOf(text);
    ASSERT_TRUE(found) << text;
    EXPECT_NEAR(found->value, 3e-6, 1e-20) << text;
  }
}

TEST(Units, UnknownUnitsHaveLikelyOnes) {
  using Texts = std::vector<std::string>;
  EXPECT_EQ(likelyQuantities("2 Mpa"), (Texts{"2 mPa", "2 MPa"}));
  EXPECT_EQ(likelyQuantities("5 Mm"), (Texts{"5 mm", "5 Mm"}));
  EXPECT_EQ(likelyQuantities("1 sec"), Texts{"1 s"});
  EXPECT_EQ(likelyQuantities("1e3 KG"), Texts{"1e3 kg"});
  for (const char* const text : {"2 parsec", "Mpa", "", "2*a"}) EXPECT_TRUE(likelyQuantities(text).empty()) << text;
}

TEST(Units, NamesReadBack) {
  for (const Dimension& d :
       {unit::length, unit::time, unit::velocity, unit::acceleration, unit::density, unit::stiffness, unit::pressure,
        unit::angle, unit::spin, unit::rate, unit::massRate, unit::penalty}) {
    const std::string name = siName(d);
    const auto found = quantityOf(name.starts_with("1/") ? "3 /" + name.substr(2) : "3 " + name);
    ASSERT_TRUE(found) << name;
    EXPECT_EQ(found->value, 3.0) << name;
    EXPECT_EQ(found->dimension, d) << name;
  }
}

}  // namespace dovetail::scene
