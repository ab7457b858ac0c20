#include <gtest/gtest.h>

#include <cmath>

#include "dovetail/picture/colours.hpp"
#include "dovetail/picture/legend.hpp"

namespace dovetail::picture {
namespace {

constexpr Colour paper{255, 255, 255}, ink{0, 0, 0};

double inkOf(const Image& image) {
  double sum = 0.0;
  for (const Colour c : image.pixels) sum += (255 - c.green) / 255.0;
  return sum;
}

double inkOfText(const std::string& text, double x, double y, double size) {
  Image image(300, 100, paper);
  write(image, x, y, text, size, ink);
  return inkOf(image);
}

TEST(Text, TakesTheSameInkWhereverItStandsAndInkGrowsWithTheSquareOfItsSize) {
  const double once = inkOfText("8 m²", 20.0, 60.0, 30.0);
  EXPECT_NEAR(inkOfText("8 m²", 20.37, 60.81, 30.0), once, 0.01 * once);
  EXPECT_NEAR(inkOfText("8 m²", 20.0, 60.0, 60.0), 4.0 * once, 0.01 * 4.0 * once);
  // The outline of | is a rectangle of 43 × 512 units.
  EXPECT_NEAR(inkOfText("|", 50.0, 60.0, 51.2), 4.3 * 51.2, 0.03 * 4.3 * 51.2);
}

TEST(Text, WidthsAddUpAndSidesAreKept) {
  EXPECT_DOUBLE_EQ(widthOf("ab", 20.0), widthOf("a", 20.0) + widthOf("b", 20.0));
  EXPECT_GT(widthOf("☃", 20.0), 0.0);  // an empty box
  Image image(200, 60, paper);
  write(image, 150.0, 40.0, "right", 20.0, ink, Side::right);
  for (int x = 150; x < 200; ++x)
    for (int y = 0; y < 60; ++y) EXPECT_EQ(image.at(x, y), paper);
  EXPECT_GT(inkOf(image), 50.0);
  write(image, -30.0, -5.0, "cut off by the border of the picture, on both sides", 20.0, ink);
}

TEST(Legend, StaysInItsRoomAndItsPartsInTheirColumns) {
  Bar bar{"a title that is much too long for the column in which it has to stand", coloursOf(Palette::cold), {}};
  for (int k = 0; k <= 20; ++k) bar.ticks.emplace_back(k / 20.0, std::to_string(1000 * k));
  Legend legend{"t = 1 s", {bar, bar}, "10 mm", 80.0, true, ink};
  for (const auto& [width, height] : {std::pair{700, 500}, {400, 700}, {1600, 300}}) {
    Image image(width, height, paper);
    const auto [top, bottom] = roomOf(legend, width, height);
    write(image, legend, {});
    for (int y = top; y < height - bottom; ++y)
      for (int x = 0; x < width; ++x) ASSERT_EQ(image.at(x, y), paper) << x << ' ' << y;
    // Between the two bars a gap is left over the whole height.
    int gaps = 0;
    bool wasEmpty = false;
    for (int x = 0; x < width; ++x) {
      bool empty = true;
      for (int y = height - bottom; y < height; ++y) empty = empty && image.at(x, y) == paper;
      gaps += empty && !wasEmpty ? 1 : 0;
      wasEmpty = empty;
    }
    EXPECT_GE(gaps, 4);  // at the borders, and between the axes, both bars and the scale bar
  }
}

TEST(Legend, TheScaleBarIsAsLongAsItSays) {
  Image image(400, 300, paper);
  Legend legend{"", {}, "x", 90.0, false, ink};
  write(image, legend, {});
  int longest = 0;
  for (int y = 0; y < 300; ++y) {
    int dark = 0;
    for (int x = 0; x < 400; ++x) dark += image.at(x, y).green < 128 ? 1 : 0;
    longest = std::max(longest, dark);
  }
  EXPECT_NEAR(longest, 90, 2);
}

}  // namespace
}  // namespace dovetail::picture
