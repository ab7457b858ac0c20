// The unit cube in every format, and a bumpy ball with coordinates of all sizes.
#pragma once

#include <bit>
#include <cstdint>
#include <cstdio>
#include <sstream>
#include <string>

#include "../io/scratch_folder.hpp"
#include "dovetail/geometry/triangle_mesh.hpp"

namespace dovetail::mesh_io::test {

using io::test::messageOf;
using io::test::readText;
using io::test::ScratchFolder;
using io::test::writeText;

/// Corner c has coordinate k = bit k of c.
inline Vec3 corner(int c) { return {double(c & 1), double(c >> 1 & 1), double(c >> 2 & 1)}; }

/// Quadrilaterals, counter-clockwise from outside.
inline constexpr int cubeFaces[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                                        {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};

inline geometry::TriangleMesh cube() {
  geometry::TriangleMesh mesh;
  for (int c = 0; c < 8; ++c) mesh.x.push_back(corner(c));
  for (const auto& f : cubeFaces) {
    mesh.facets.push_back({f[0], f[1], f[2]});
    mesh.facets.push_back({f[0], f[2], f[3]});
  }
  return mesh;
}

inline std::string asciiStl(const geometry::TriangleMesh& mesh) {
  std::ostringstream text;
  text.precision(17);
  text << "solid a cube with a name\n";
  for (const auto& f : mesh.facets) {
    text << "  facet normal 0 0 0\n    outer loop\n";
    for (const int v : f)
      text << "      vertex " << mesh.x[v].x << " " << mesh.x[v].y << "  " << std::showpos << mesh.x[v].z
           << std::noshowpos << "\r\n";
    text << "    endloop\n  endfacet\n";
  }
  text << "endsolid\n";
  return text.str();
}

inline std::string cubeObj() {
  std::ostringstream text;
  text << "# a cube\nmtllib none.mtl\no cube\n";
  for (int c = 0; c < 8; ++c) text << "v " << corner(c).x << " " << corner(c).y << " " << corner(c).z << " 1.0\n";
  text << "vt 0 0\nvn 0 0 1\ng all\ns off\nusemtl none\n";
  const char* const forms[] = {"", "/1", "//1", "/1/1"};
  for (int f = 0; f < 6; ++f) {
    text << "f";
    for (int k = 0; k < 4; ++k) {
      if (k == 2) text << " \\\n";
      const int number = f % 2 == 0 ? cubeFaces[f][k] + 1 : cubeFaces[f][k] - 8;
      text << " " << number << forms[f % 4];
    }
    text << "  # face\n";
  }
  return text.str();
}

inline std::string plyHeader(const std::string& format, const std::string& coordinate) {
  return "ply\nformat " + format + " 1.0\ncomment a cube\nelement vertex 8\nproperty uchar red\nproperty " +
         coordinate + " x\nproperty " + coordinate + " y\nproperty " + coordinate +
         " z\nelement nothing 1\nproperty list uchar short some\nelement face 6\nproperty list uchar int "
         "vertex_indices\nproperty float quality\nend_header\n";
}

inline std::string asciiPly() {
  std::ostringstream text;
  text << plyHeader("ascii", "double");
  for (int c = 0; c < 8; ++c) text << "255 " << corner(c).x << " " << corner(c).y << " " << corner(c).z << "\n";
  text << "2 -1 7\n";
  for (const auto& f : cubeFaces) text << "4 " << f[0] << " " << f[1] << " " << f[2] << " " << f[3] << " 0.5\n";
  return text.str();
}

template <class Value>
void append(std::string& bytes, Value value) {
  std::uint64_t raw = 0;
  if constexpr (sizeof(Value) == 8)
    raw = std::bit_cast<std::uint64_t>(value);
  else if constexpr (sizeof(Value) == 4)
    raw = std::bit_cast<std::uint32_t>(value);
  else
    raw = static_cast<std::uint64_t>(value);
  for (std::size_t k = 0; k < sizeof(Value); ++k) bytes += static_cast<char>(raw >> (8 * k) & 0xFFu);
}

inline std::string binaryPly() {
  std::string bytes = plyHeader("binary_little_endian", "float");
  for (int c = 0; c < 8; ++c) {
    append(bytes, std::uint8_t{255});
    for (int k = 0; k < 3; ++k) append(bytes, static_cast<float>(corner(c)[k]));
  }
  append(bytes, std::uint8_t{2});
  append(bytes, std::uint16_t{0xFFFF});
  append(bytes, std::uint16_t{7});
  for (const auto& f : cubeFaces) {
    append(bytes, std::uint8_t{4});
    for (const int v : f) append(bytes, v);
    append(bytes, 0.5f);
  }
  return bytes;
}

}  // namespace dovetail::mesh_io::test
