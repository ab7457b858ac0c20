#include <bit>
#include <cmath>
#include <limits>

#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"
#include "dovetail/geometry/triangle.hpp"
#include "dovetail/io/output_folder.hpp"
#include "dovetail/io/provenance.hpp"
#include "dovetail/mesh_io/surface_files.hpp"
#include "little_endian.hpp"

namespace dovetail::mesh_io {

namespace {

std::uint32_t floatBits(double value, const std::string& where) {
  if (!(std::abs(value) <= static_cast<double>(std::numeric_limits<float>::max())))
    throw InputError("a coordinate is " + formatNumber(value), where, "give numbers that 32-bit numbers can hold");
  return std::bit_cast<std::uint32_t>(static_cast<float>(value));
}

}  // namespace

void writeStl(const std::filesystem::path& path, std::span<const Vec3> x, std::span<const geometry::Facet> facets) {
  geometry::makeTopology(facets, static_cast<int>(x.size()));
  if (facets.empty() || facets.size() > std::numeric_limits<std::uint32_t>::max())
    throw InputError("a surface has " + std::to_string(facets.size()) + " facets", path.string(),
                     "give at least one and at most 4294967295");
  std::string bytes = "binary STL, " + io::withMark({})[0].second;
  bytes.resize(80, ' ');
  appendLittleEndian(bytes, facets.size(), 4);
  for (std::size_t f = 0; f < facets.size(); ++f) {
    const std::string where = "vertex of facet " + std::to_string(f);
    std::array<Vec3, 3> corner;
    for (std::size_t k = 0; k < 3; ++k) corner[k] = x[static_cast<std::size_t>(facets[f][k])];
    std::array<std::uint32_t, 9> number{};
    for (std::size_t k = 0; k < 9; ++k) number[k] = floatBits(corner[k / 3][static_cast<int>(k % 3)], where);
    const Vec3 normal = geometry::triangleNormal(corner[0], corner[1], corner[2]);
    for (int k = 0; k < 3; ++k) appendLittleEndian(bytes, floatBits(isFinite(normal) ? normal[k] : 0.0, where), 4);
    for (const std::uint32_t n : number) appendLittleEndian(bytes, n, 4);
    appendLittleEndian(bytes, 0, 2);
  }
  io::writeFileAtomically(path, bytes);
}

}  // namespace dovetail::mesh_io
