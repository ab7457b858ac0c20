// Numbers as they lie in a little-endian file, on any machine.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace dovetail::mesh_io {

/// An unsigned number of `size` ≤ 8 bytes.
inline std::uint64_t littleEndian(std::string_view bytes, std::size_t at, std::size_t size) {
  std::uint64_t value = 0;
  for (std::size_t k = 0; k < size; ++k)
    value |= static_cast<std::uint64_t>(static_cast<unsigned char>(bytes[at + k])) << (8 * k);
  return value;
}

inline float floatAt(std::string_view bytes, std::size_t at) {
  return std::bit_cast<float>(static_cast<std::uint32_t>(littleEndian(bytes, at, 4)));
}
inline double doubleAt(std::string_view bytes, std::size_t at) {
  return std::bit_cast<double>(littleEndian(bytes, at, 8));
}

inline void appendLittleEndian(std::string& bytes, std::uint64_t value, std::size_t size) {
  for (std::size_t k = 0; k < size; ++k) bytes += static_cast<char>((value >> (8 * k)) & 0xFFu);
}

}  // namespace dovetail::mesh_io
