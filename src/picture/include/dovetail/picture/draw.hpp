// Spheres, triangles and rods as a parallel projection, without a graphics card or display.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "dovetail/core/vec3.hpp"
#include "dovetail/picture/image.hpp"

namespace dovetail::picture {

/// How something is coloured: by the values of its parts, 0 … 1, over these colours; one colour for all.
struct Paint {
  std::vector<Colour> colours;
  double opacity = 1.0;  ///< of triangles
  double shading = 1.0;  ///< how much the light tells: with 0 the colours are those of the paint
};

/// @name What is drawn: places in m; `paint` numbers the paints of the drawing
///@{
struct Ball {
  Vec3 centre;
  double radius = 0.0;
  float value = 0.0F;
  std::uint8_t paint = 0;
};
struct Triangle {
  std::array<Vec3, 3> corner;
  std::array<float, 3> value{};
  std::uint8_t paint = 0;
  std::uint8_t edges = 0;  ///< bit k: a line is drawn from corner k to corner k + 1
};
/// Drawn over everything else, as if it could be looked through.
struct Rod {
  Vec3 from, to;
  double radius = 0.0;
  float value = 0.0F;
  std::uint8_t paint = 0;
};
///@}

struct Drawing {
  std::vector<Paint> paints;
  std::vector<Ball> balls;
  std::vector<Triangle> triangles;  ///< those of a paint that is not opaque are laid over the rest, the farthest first
  std::vector<Rod> rods;
};

/// A view from far away. `right`, `up` and `back` (towards the viewer) are orthonormal.
struct Camera {
  Vec3 right{1, 0, 0}, up{0, 0, 1}, back{0, -1, 0};
  Vec3 centre;                  ///< m, in the middle of the picture
  double metresPerPixel = 1.0;  ///< of the picture
};

struct Look {
  Colour background{255, 255, 255};
  int samples = 3;            ///< per pixel and direction
  double crevice = 0.0;       ///< m: places this near darken one another where little light reaches; 0: nothing does
  double edgeDarkness = 0.5;  ///< of the lines of triangles
};

/// The drawing, the same to the last bit for any number of threads. Lines are a pixel wide. What is smaller than a
/// sample is drawn as one.
Image draw(const Drawing& drawing, const Camera& camera, int width, int height, const Look& look);

}  // namespace dovetail::picture
