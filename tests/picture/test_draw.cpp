#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "../threads.hpp"
#include "dovetail/core/error.hpp"
#include "dovetail/picture/colours.hpp"
#include "dovetail/picture/draw.hpp"

namespace dovetail::picture {
namespace {

constexpr Colour red{255, 0, 0}, blue{0, 0, 255}, white{255, 255, 255};

/// Looks along y: a pixel is 1 m.
Camera camera() { return {}; }

Drawing withFlatPaints() {
  Drawing drawing;
  drawing.paints = {{{red}, 1.0, 0.0}, {{blue}, 1.0, 0.0}};
  return drawing;
}

/// Sum over pixels of how far they are from white to red: the area of what is red.
double redArea(const Image& image) {
  double sum = 0.0;
  for (const Colour c : image.pixels) sum += (255 - c.blue) / 255.0;
  return sum;
}

TEST(Draw, ABallCoversTheAreaOfItsCircle) {
  Drawing drawing = withFlatPaints();
  drawing.balls = {{{3.3, 7.0, -2.1}, 40.0, 0.0F, 0}};
  const Image image = draw(drawing, camera(), 120, 100, {});
  EXPECT_NEAR(redArea(image), M_PI * 1600.0, 0.002 * M_PI * 1600.0);
  EXPECT_EQ(image.at(63, 52), red);    // x to the right, z upwards from the middle
  EXPECT_EQ(image.at(63, 94), white);  // 40 below the middle, which is 2 below that of the picture
  EXPECT_EQ(image.at(63, 12 + 2), red);
}

TEST(Draw, TrianglesThatShareAnEdgeLeaveNoGapAndEndWhereTheyShould) {
  Drawing drawing = withFlatPaints();
  const Vec3 a{-20, 0, -10}, b{20, 5, -10}, c{20, -5, 10}, d{-20, 0, 10};
  drawing.triangles = {{{a, b, c}, {}, 0, 0}, {{a, c, d}, {}, 0, 0}};
  EXPECT_DOUBLE_EQ(redArea(draw(drawing, camera(), 100, 60, {})), 800.0);
}

TEST(Draw, TheNearerHidesTheFartherInAnyOrder) {
  for (const bool swapped : {false, true}) {
    Drawing drawing = withFlatPaints();
    drawing.balls = {{{0, -5, 0}, 4.0, 0.0F, 0}, {{0, 5, 0}, 8.0, 0.0F, 1}};  // red is nearer to the viewer at −y
    if (swapped) std::swap(drawing.balls[0], drawing.balls[1]);
    const Image image = draw(drawing, camera(), 40, 40, {});
    EXPECT_EQ(image.at(20, 20), red);
    EXPECT_EQ(image.at(26, 20), blue);
    // A wall through the middle of the blue ball shows half of it, and none of what lies behind.
    drawing.triangles = {{{Vec3{-90, 5, -90}, Vec3{90, 5, -90}, Vec3{0, 5, 90}}, {}, 0, 0}};
    EXPECT_EQ(draw(drawing, camera(), 40, 40, {}).at(26, 20), blue);
    drawing.triangles[0].corner = {Vec3{-90, -4, -90}, Vec3{90, -4, -90}, Vec3{0, -4, 90}};
    EXPECT_EQ(draw(drawing, camera(), 40, 40, {}).at(26, 20), red);
  }
}

TEST(Draw, ClearTrianglesAreLaidOverTheRestAndRodsOverAll) {
  Drawing drawing = withFlatPaints();
  drawing.paints.push_back({{Colour{0, 0, 0}}, 0.25, 0.0});
  drawing.balls = {{{0, 0, 0}, 10.0, 0.0F, 0}};
  drawing.triangles = {{{Vec3{-90, -30, -90}, Vec3{90, -30, -90}, Vec3{0, -30, 90}}, {}, 2, 0},
                       {{Vec3{-90, -20, -90}, Vec3{90, -20, -90}, Vec3{0, -20, 90}}, {}, 2, 0},
                       {{Vec3{-90, 30, -90}, Vec3{90, 30, -90}, Vec3{0, 30, 90}}, {}, 2, 0}};
  const Image image = draw(drawing, camera(), 40, 40, {});
  EXPECT_NEAR(image.at(20, 20).red, 255.0 * 0.75 * 0.75, 1.5);  // the third is behind the ball
  EXPECT_NEAR(image.at(34, 20).red, 255.0 * 0.75 * 0.75 * 0.75, 2.0);
  drawing.rods = {{{-15, 50, 0}, {15, 50, 0}, 2.0, 0.0F, 1}};
  EXPECT_EQ(draw(drawing, camera(), 40, 40, {}).at(20, 20), blue);
}

TEST(Draw, ValuesRunOverTheColoursAndLinesAlongMarkedEdges) {
  Drawing drawing;
  drawing.paints = {{coloursOf(Palette::cold), 1.0, 0.0}};
  drawing.triangles = {{{Vec3{-20, 0, -10}, Vec3{20, 0, -10}, Vec3{0, 0, 15}}, {0.0F, 1.0F, 0.5F}, 0, 0}};
  const Image plain = draw(drawing, camera(), 60, 40, {});
  EXPECT_EQ(plain.at(30, 20), coloursOf(Palette::cold)[static_cast<std::size_t>(256 * (20.5 / 40.0))]);
  drawing.triangles[0].edges = 1;
  Look look;
  look.edgeDarkness = 1.0;
  const Image lined = draw(drawing, camera(), 60, 40, look);
  int changed = 0;
  for (int x = 0; x < 60; ++x) changed += lined.at(x, 29) != plain.at(x, 29) ? 1 : 0;
  EXPECT_GE(changed, 38);
  EXPECT_EQ(lined.at(30, 20), plain.at(30, 20));
}

TEST(Draw, CrevicesAreDarkAndOpenPlacesAreNot) {
  Drawing drawing = withFlatPaints();
  drawing.triangles = {{{Vec3{-500, 0, -500}, Vec3{500, 0, -500}, Vec3{0, 0, 900}}, {}, 0, 0}};
  drawing.balls = {{{0, 0, 0}, 20.0, 0.0F, 0}};
  Look look;
  look.crevice = 40.0;
  const Image image = draw(drawing, camera(), 200, 100, look);
  EXPECT_EQ(image.at(2, 50), red);
  EXPECT_EQ(image.at(100, 50), red);
  EXPECT_LT(image.at(100 + 22, 50).red, 235);
}

TEST(Draw, IsTheSameForAnyNumberOfThreads) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> place(-60.0, 60.0);
  Drawing drawing;
  drawing.paints = {{coloursOf(Palette::warm)}, {coloursOf(Palette::signs), 0.4}};
  const auto point = [&] { return Vec3{place(random), place(random), place(random)}; };
  for (int k = 0; k < 200; ++k) {
    drawing.balls.push_back({point(), 6.0, static_cast<float>(k) / 200.0F, 0});
    drawing.triangles.push_back({{point(), point(), point()}, {0.1F, 0.5F, 0.9F}, static_cast<std::uint8_t>(k % 2), 7});
    drawing.rods.push_back({point(), point(), 1.0, 0.3F, 0});
  }
  Look look;
  look.crevice = 10.0;
  const auto pixels = [&] { return draw(drawing, camera(), 150, 130, look).pixels; };
  EXPECT_EQ(onThreads(1, pixels), onThreads(3, pixels));
}

TEST(Draw, APictureWithoutSizeIsRefused) { EXPECT_THROW(draw({}, camera(), 0, 10, {}), InputError); }

TEST(Colours, LightnessRisesOrFallsSteadily) {
  const auto lightness = [](Colour c) { return 0.2126 * c.red + 0.7152 * c.green + 0.0722 * c.blue; };
  for (std::size_t k = 1; k < 256; ++k) {
    EXPECT_GE(lightness(coloursOf(Palette::cold)[k]), lightness(coloursOf(Palette::cold)[k - 1]) - 0.5);
    EXPECT_LE(lightness(coloursOf(Palette::warm)[k]), lightness(coloursOf(Palette::warm)[k - 1]) + 0.5);
    const bool rises = k < 128;
    const double step = lightness(coloursOf(Palette::signs)[k]) - lightness(coloursOf(Palette::signs)[k - 1]);
    EXPECT_GE(rises ? step : -step, -0.5);
  }
}

}  // namespace
}  // namespace dovetail::picture
