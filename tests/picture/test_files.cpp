#include <gtest/gtest.h>
#include <zlib.h>

#include <cstdlib>
#include <random>

#include "dovetail/core/error.hpp"
#include "dovetail/picture/image.hpp"

namespace dovetail::picture {
namespace {

int byteAt(const std::string& bytes, std::size_t k) { return static_cast<unsigned char>(bytes.at(k)); }

std::size_t bigEndian(const std::string& bytes, std::size_t at) {
  std::size_t value = 0;
  for (std::size_t k = 0; k < 4; ++k) value = value << 8 | static_cast<std::size_t>(byteAt(bytes, at + k));
  return value;
}

/// The content of a chunk, whose check sum must be right.
std::string chunkOf(const std::string& png, const std::string& type) {
  for (std::size_t at = 8; at + 12 <= png.size();) {
    const std::size_t size = bigEndian(png, at);
    const std::string body = png.substr(at + 4, 4 + size);
    EXPECT_EQ(crc32(0, reinterpret_cast<const Bytef*>(body.data()), static_cast<uInt>(body.size())),
              bigEndian(png, at + 8 + size));
    if (body.starts_with(type)) return body.substr(4);
    at += 12 + size;
  }
  return {};
}

/// Reads a PNG of three bytes per pixel as its specification says.
Image readPng(const std::string& png) {
  const std::string head = chunkOf(png, "IHDR"), packed = chunkOf(png, "IDAT");
  Image image(static_cast<int>(bigEndian(head, 0)), static_cast<int>(bigEndian(head, 4)), {});
  const std::size_t row = 3 * static_cast<std::size_t>(image.width);
  std::string bytes((row + 1) * static_cast<std::size_t>(image.height), '\0');
  uLongf size = bytes.size();
  EXPECT_EQ(uncompress(reinterpret_cast<Bytef*>(bytes.data()), &size, reinterpret_cast<const Bytef*>(packed.data()),
                       packed.size()),
            Z_OK);
  EXPECT_EQ(size, bytes.size());
  std::vector<int> before(row), now(row);
  for (int y = 0; y < image.height; ++y) {
    const std::size_t at = static_cast<std::size_t>(y) * (row + 1);
    for (std::size_t k = 0; k < row; ++k) {
      const int a = k < 3 ? 0 : now[k - 3], b = before[k], c = k < 3 ? 0 : before[k - 3], p = a + b - c;
      const int pa = std::abs(p - a), pb = std::abs(p - b), pc = std::abs(p - c);
      const int paeth = pa <= pb && pa <= pc ? a : pb <= pc ? b : c;
      const int guess[] = {0, a, b, (a + b) / 2, paeth};
      now[k] = (byteAt(bytes, at + 1 + k) + guess[byteAt(bytes, at)]) & 255;
    }
    for (int x = 0; x < image.width; ++x) {
      const auto value = [&](int c) { return static_cast<std::uint8_t>(now[static_cast<std::size_t>(3 * x + c)]); };
      image.at(x, y) = {value(0), value(1), value(2)};
    }
    before = now;
  }
  return image;
}

/// All images of a GIF file, as a player shows them.
std::vector<Image> readGif(const std::string& gif, int& hundredths) {
  const auto word = [&](std::size_t at) { return byteAt(gif, at) | byteAt(gif, at + 1) << 8; };
  EXPECT_EQ(gif.substr(0, 6), "GIF89a");
  const auto colour = [&](int k) {
    const auto channel = [&](int c) {
      return static_cast<std::uint8_t>(byteAt(gif, static_cast<std::size_t>(13 + 3 * k + c)));
    };
    return Colour{channel(0), channel(1), channel(2)};
  };
  Image shown(word(6), word(8), {});
  std::vector<Image> all;
  int clear = -1;
  for (std::size_t at = 13 + 768; byteAt(gif, at) != 0x3B;) {
    const auto blocks = [&](std::size_t from) {
      std::string data;
      for (; byteAt(gif, from) != 0; from += 1 + static_cast<std::size_t>(byteAt(gif, from)))
        data += gif.substr(from + 1, static_cast<std::size_t>(byteAt(gif, from)));
      at = from + 1;
      return data;
    };
    if (byteAt(gif, at) == 0x21) {
      const int label = byteAt(gif, at + 1);
      const std::string data = blocks(at + 2);
      if (label != 0xF9) continue;
      clear = data[0] & 1 ? static_cast<unsigned char>(data[3]) : -1;
      hundredths = static_cast<unsigned char>(data[1]) | static_cast<unsigned char>(data[2]) << 8;
      continue;
    }
    const int left = word(at + 1), top = word(at + 3), width = word(at + 5), height = word(at + 7);
    const std::string data = blocks(at + 11);
    std::vector<std::vector<int>> words;
    std::vector<int> pixels, before;
    int length = 9;
    std::size_t bit = 0;
    for (;;) {
      int code = 0;
      for (int k = 0; k < length; ++k, ++bit) code |= (byteAt(data, bit / 8) >> (bit % 8) & 1) << k;
      if (code == 257) break;
      if (code == 256) {
        words.clear();
        for (int k = 0; k < 258; ++k) words.push_back({k});
        before.clear();
        length = 9;
        continue;
      }
      std::vector<int> now = code < static_cast<int>(words.size()) ? words[static_cast<std::size_t>(code)] : before;
      if (code >= static_cast<int>(words.size())) now.push_back(before.at(0));
      if (!before.empty() && words.size() < 4096) {
        words.push_back(before);
        words.back().push_back(now[0]);
      }
      if (words.size() == (1U << length) && length < 12) ++length;
      pixels.insert(pixels.end(), now.begin(), now.end());
      before = now;
    }
    EXPECT_EQ(pixels.size(), static_cast<std::size_t>(width * height));
    for (std::size_t k = 0; k < pixels.size(); ++k)
      if (pixels[k] != clear)
        shown.at(left + static_cast<int>(k) % width, top + static_cast<int>(k) / width) = colour(pixels[k]);
    all.push_back(shown);
  }
  return all;
}

Image noise(int width, int height, unsigned seed, int steps) {
  std::mt19937 random(seed);
  Image image(width, height, {});
  const auto channel = [&] {
    return static_cast<std::uint8_t>(255 * (static_cast<int>(random() % static_cast<unsigned>(steps))) / (steps - 1));
  };
  for (Colour& c : image.pixels) c = {channel(), channel(), channel()};
  return image;
}

TEST(Png, ReadsBackAsItWas) {
  for (const int steps : {2, 256}) {
    Image image = noise(37, 21, 3, steps);
    for (int x = 0; x < 37; ++x)
      for (int y = 8; y < 16; ++y)
        image.at(x, y) = {static_cast<std::uint8_t>(5 * x), static_cast<std::uint8_t>(9 * y), 7};
    EXPECT_EQ(readPng(pngOf(image, "dovetail 0.1.0 abc", "")).pixels, image.pixels);
  }
  const std::string png = pngOf(Image(3, 2, {}), "dovetail 0.1.0 abc", "t = 1 s");
  EXPECT_EQ(png.substr(50, 14), "dovetail 0.1.0");
  EXPECT_EQ(chunkOf(png.substr(0), "tEXt"), std::string("Software") + '\0' + "dovetail 0.1.0 abc");
  EXPECT_NE(png.find("t = 1 s"), std::string::npos);
}

TEST(Gif, ReadsBackAsItWasWhereItsColoursSuffice) {
  // Enough noise for tables of codes to fill up and begin anew.
  std::vector<Image> images{noise(150, 140, 1, 2), noise(150, 140, 2, 2)};
  images.push_back(images[1]);
  images[2].at(70, 80) = images[2].at(70, 80) == Colour{255, 0, 0} ? Colour{0, 255, 0} : Colour{255, 0, 0};
  images.push_back(images[2]);  // nothing changes
  int hundredths = 0;
  const std::string gif = gifOf(images, 0.12, "dovetail 0.1.0 abc");
  const std::vector<Image> read = readGif(gif, hundredths);
  EXPECT_EQ(hundredths, 12);
  EXPECT_EQ(gif.substr(784, 14), "dovetail 0.1.0");
  ASSERT_EQ(read.size(), images.size());
  for (std::size_t k = 0; k < images.size(); ++k) EXPECT_TRUE(read[k].pixels == images[k].pixels) << k;
}

TEST(Gif, MeansOfShadesAreKeptWithoutBands) {
  // A ramp of more shades than there are colours: what the eye sees, the mean over a few pixels, stays.
  Image ramp(512, 64, {});
  for (int x = 0; x < 512; ++x)
    for (int y = 0; y < 64; ++y)
      ramp.at(x, y) = {static_cast<std::uint8_t>(60 + x / 4), static_cast<std::uint8_t>(70 + x / 8 + y),
                       static_cast<std::uint8_t>(200 - y)};
  int hundredths = 0;
  const Image read = readGif(gifOf({ramp}, 0.1, "dovetail 0"), hundredths).at(0);
  double worst = 0.0;
  for (int x = 0; x + 8 <= 512; x += 8)
    for (int y = 0; y + 8 <= 64; y += 8) {
      double difference = 0.0;
      for (int k = 0; k < 64; ++k)
        difference += read.at(x + k % 8, y + k / 8).green - ramp.at(x + k % 8, y + k / 8).green;
      worst = std::max(worst, std::abs(difference) / 64.0);
    }
  EXPECT_LT(worst, 6.0);
}

TEST(Gif, ImagesOfSeveralSizesAreRefused) {
  EXPECT_THROW(gifOf({}, 0.1, "x"), InputError);
  EXPECT_THROW(gifOf({Image(2, 2, {}), Image(2, 3, {})}, 0.1, "x"), InputError);
}

}  // namespace
}  // namespace dovetail::picture
