#include <zlib.h>

#include <array>
#include <cstdlib>
#include <stdexcept>

#include "dovetail/core/error.hpp"
#include "dovetail/picture/image.hpp"

namespace dovetail::picture {

namespace {

std::string bigEndian(std::size_t value) {
  std::string bytes;
  for (int shift = 24; shift >= 0; shift -= 8) bytes += static_cast<char>((value >> shift) & 0xFF);
  return bytes;
}

std::string chunk(const std::string& type, const std::string& data) {
  const std::string body = type + data;
  const uLong check = crc32(0, reinterpret_cast<const Bytef*>(body.data()), static_cast<uInt>(body.size()));
  return bigEndian(data.size()) + body + bigEndian(check);
}

int paeth(int left, int above, int aboveLeft) {
  const int guess = left + above - aboveLeft;
  const int a = std::abs(guess - left), b = std::abs(guess - above), c = std::abs(guess - aboveLeft);
  return a <= b && a <= c ? left : b <= c ? above : aboveLeft;
}

/// A row behind one of the five filters of PNG; `above` is the row before.
std::string filtered(int filter, const std::string& row, const std::string& above) {
  std::string out(1, static_cast<char>(filter));
  const auto byte = [](const std::string& bytes, std::size_t k) {
    return static_cast<int>(static_cast<unsigned char>(bytes[k]));
  };
  for (std::size_t k = 0; k < row.size(); ++k) {
    const int left = k < 3 ? 0 : byte(row, k - 3), up = byte(above, k), corner = k < 3 ? 0 : byte(above, k - 3);
    const std::array<int, 5> guess{0, left, up, (left + up) / 2, paeth(left, up, corner)};
    out += static_cast<char>(byte(row, k) - guess[static_cast<std::size_t>(filter)]);
  }
  return out;
}

/// The filter that leaves the smallest numbers is likely to be compressed best.
std::string bestFiltered(const std::string& row, const std::string& above) {
  std::string best;
  long least = -1;
  for (int filter = 0; filter < 5; ++filter) {
    std::string tried = filtered(filter, row, above);
    long sum = 0;
    for (std::size_t k = 1; k < tried.size(); ++k)
      sum += std::abs(static_cast<int>(static_cast<signed char>(tried[k])));
    if (least < 0 || sum < least) {
      least = sum;
      best = std::move(tried);
    }
  }
  return best;
}

std::string compressed(const std::string& bytes) {
  uLongf size = compressBound(static_cast<uLong>(bytes.size()));
  std::string out(size, '\0');
  if (compress2(reinterpret_cast<Bytef*>(out.data()), &size, reinterpret_cast<const Bytef*>(bytes.data()),
                static_cast<uLong>(bytes.size()), 9) != Z_OK)
    throw Error("the picture cannot be compressed", "PNG", "");
  out.resize(size);
  return out;
}

}  // namespace

std::string pngOf(const Image& image, const std::string& program, const std::string& comment) {
  std::string data, above(3 * static_cast<std::size_t>(image.width), '\0');
  for (int y = 0; y < image.height; ++y) {
    std::string row;
    for (int x = 0; x < image.width; ++x) {
      const Colour c = image.at(x, y);
      row += {static_cast<char>(c.red), static_cast<char>(c.green), static_cast<char>(c.blue)};
    }
    data += bestFiltered(row, above);
    above = std::move(row);
  }
  std::string header =
      bigEndian(static_cast<std::size_t>(image.width)) + bigEndian(static_cast<std::size_t>(image.height));
  header += std::string("\x08\x02\x00\x00\x00", 5);  // 8 bits, red green blue
  std::string file = "\x89PNG\r\n\x1a\n" + chunk("IHDR", header);
  file += chunk("tEXt", std::string("Software") + '\0' + program);
  if (!comment.empty()) file += chunk("tEXt", std::string("Comment") + '\0' + comment);
  return file + chunk("IDAT", compressed(data)) + chunk("IEND", "");
}

}  // namespace dovetail::picture
