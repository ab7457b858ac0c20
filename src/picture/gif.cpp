#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <unordered_map>

#include "dovetail/core/error.hpp"
#include "dovetail/core/parallel.hpp"
#include "dovetail/picture/image.hpp"

namespace dovetail::picture {

namespace {

constexpr std::size_t colourCount = 255;
constexpr std::uint8_t clear = 255;  // the number that leaves what the image before has there

struct Counted {
  std::array<int, 3> channel;
  std::uint32_t count;
};

/// Colours of all images in steps of 4, with their numbers.
std::vector<Counted> countColours(const std::vector<Image>& images) {
  std::vector<std::uint32_t> count(1U << 18);
  for (const Image& image : images)
    for (const Colour c : image.pixels)
      ++count[static_cast<std::size_t>(c.red >> 2 << 12 | c.green >> 2 << 6 | c.blue >> 2)];
  std::vector<Counted> all;
  for (std::uint32_t k = 0; k < count.size(); ++k) {
    const auto spread = [](std::uint32_t v) { return static_cast<int>((v & 63) * 255 / 63); };
    if (count[k] > 0) all.push_back({{spread(k >> 12), spread(k >> 6), spread(k)}, count[k]});
  }
  return all;
}

/// Colours from begin to end, whose spread is largest along an axis.
struct Group {
  std::size_t begin, end, axis = 0;
  double spread = 0.0;
};

/// Means of a channel over a group, and the sum of squared distances from it.
std::pair<double, double> momentsOf(const std::vector<Counted>& all, const Group& group, std::size_t channel) {
  double sum = 0.0, squares = 0.0, count = 0.0;
  for (std::size_t k = group.begin; k < group.end; ++k) {
    // Rare colours must not be lost among the many of the background.
    const double weight = std::sqrt(static_cast<double>(all[k].count)), value = all[k].channel[channel];
    sum += weight * value;
    squares += weight * value * value;
    count += weight;
  }
  return {sum / count, squares - sum * sum / count};
}

void measure(const std::vector<Counted>& all, Group& group) {
  group.spread = 0.0;
  for (std::size_t channel = 0; channel < 3; ++channel)
    if (const double spread = momentsOf(all, group, channel).second; spread > group.spread) {
      group.spread = spread;
      group.axis = channel;
    }
}

/// Halves the group of the largest spread at its mean, until there are as many groups as colours.
std::vector<Colour> tableOf(std::vector<Counted> all) {
  std::vector<Group> groups{{0, all.size()}};
  measure(all, groups[0]);
  while (groups.size() < colourCount) {
    auto widest = std::max_element(groups.begin(), groups.end(),
                                   [](const Group& a, const Group& b) { return a.spread < b.spread; });
    if (widest->spread <= 1e-9) break;
    const auto at = [&](std::size_t k) { return all.begin() + static_cast<std::ptrdiff_t>(k); };
    const double mean = momentsOf(all, *widest, widest->axis).first;
    const std::size_t axis = widest->axis;
    const auto middle = std::stable_partition(at(widest->begin), at(widest->end),
                                              [&](const Counted& c) { return c.channel[axis] <= mean; });
    Group second{static_cast<std::size_t>(middle - all.begin()), widest->end};
    widest->end = second.begin;
    measure(all, *widest);
    measure(all, second);
    groups.push_back(second);
  }
  std::vector<Colour> table;
  for (const Group& group : groups) {
    const auto mean = [&](std::size_t c) {
      return static_cast<std::uint8_t>(std::lround(momentsOf(all, group, c).first));
    };
    table.push_back({mean(0), mean(1), mean(2)});
  }
  return table;
}

std::uint8_t nearestIn(const std::vector<Colour>& table, int red, int green, int blue) {
  std::size_t best = 0;
  int least = 1 << 30;
  for (std::size_t k = 0; k < table.size(); ++k) {
    const int r = red - table[k].red, g = green - table[k].green, b = blue - table[k].blue;
    if (const int distance = 2 * r * r + 4 * g * g + b * b; distance < least) {
      least = distance;
      best = k;
    }
  }
  return static_cast<std::uint8_t>(best);
}

/// Thresholds −0.5 … 0.5 that mix two colours of the table in a pattern of 8 × 8 pixels (Bayer 1973).
double threshold(int x, int y) {
  int value = 0;
  for (int bit = 0; bit < 3; ++bit) value = value << 2 | ((x >> bit ^ y >> bit) & 1) << 1 | (y >> bit & 1);
  return (value + 0.5) / 64.0 - 0.5;
}

/// Numbers of an image's colours in the table.
std::vector<std::uint8_t> numbersOf(const Image& image, const std::vector<Colour>& table) {
  std::vector<std::uint8_t> numbers(image.pixels.size());
  constexpr double reach = 12.0;  // about the distance of neighbouring colours of the table
  parallelFor(static_cast<std::size_t>(image.height), 16, [&](std::size_t begin, std::size_t end) {
    std::unordered_map<std::uint32_t, std::uint8_t> known;
    for (std::size_t y = begin; y < end; ++y)
      for (int x = 0; x < image.width; ++x) {
        const Colour c = image.at(x, static_cast<int>(y));
        // Paper and ink have numbers of their own: a pattern on them would be seen.
        const bool plain = (c.red > 250 && c.green > 250 && c.blue > 250) || c.red + c.green + c.blue < 60;
        const int push = plain ? 0 : static_cast<int>(std::lround(reach * threshold(x, static_cast<int>(y))));
        const auto moved = [&](std::uint8_t v) { return std::clamp(v + push, 0, 255); };
        const int red = moved(c.red), green = moved(c.green), blue = moved(c.blue);
        const auto word = static_cast<std::uint32_t>(red << 16 | green << 8 | blue);
        auto found = known.find(word);
        if (found == known.end()) found = known.emplace(word, nearestIn(table, red, green, blue)).first;
        numbers[image.place(x, static_cast<int>(y))] = found->second;
      }
  });
  return numbers;
}

std::string littleEndian(int value) { return {static_cast<char>(value & 0xFF), static_cast<char>(value >> 8 & 0xFF)}; }

/// Codes of growing length, put together to bytes from the lowest bit.
class Bits {
public:
  void add(std::uint32_t code, int length) {
    held_ |= code << count_;
    for (count_ += length; count_ >= 8; count_ -= 8, held_ >>= 8) bytes_ += static_cast<char>(held_ & 0xFF);
  }
  std::string end() {
    if (count_ > 0) bytes_ += static_cast<char>(held_ & 0xFF);
    return std::move(bytes_);
  }

private:
  std::string bytes_;
  std::uint32_t held_ = 0;
  int count_ = 0;
};

/// LZW of GIF (specification 89a, appendix F) for numbers of 8 bits.
std::string packed(const std::vector<std::uint8_t>& numbers) {
  constexpr std::uint32_t restart = 256, last = 257, most = 4096;
  Bits bits;
  std::vector<std::uint16_t> next(most * 256);
  std::uint32_t free = last + 1;
  int length = 9;
  bits.add(restart, length);
  std::uint32_t now = numbers.at(0);
  for (std::size_t k = 1; k < numbers.size(); ++k) {
    std::uint16_t& longer = next[now * 256 + numbers[k]];
    if (longer != 0) {
      now = longer;
      continue;
    }
    bits.add(now, length);
    if (free < most) {
      if (free == (1U << length)) ++length;
      longer = static_cast<std::uint16_t>(free++);
    } else {
      bits.add(restart, length);
      std::fill(next.begin(), next.end(), std::uint16_t{0});
      free = last + 1;
      length = 9;
    }
    now = numbers[k];
  }
  bits.add(now, length);
  if (free < most && free == (1U << length)) ++length;
  bits.add(last, length);
  return bits.end();
}

struct Window {
  int left, top, right, bottom;  // without the last column and row
};

/// Where numbers differ; a single pixel where none does.
Window changed(const std::vector<std::uint8_t>& now, const std::vector<std::uint8_t>& before, int width) {
  Window window{width, 1 << 30, 0, 0};
  for (std::size_t k = 0; k < now.size(); ++k) {
    if (now[k] == before[k]) continue;
    const int x = static_cast<int>(k % static_cast<std::size_t>(width)),
              y = static_cast<int>(k / static_cast<std::size_t>(width));
    window = {std::min(window.left, x), std::min(window.top, y), std::max(window.right, x + 1),
              std::max(window.bottom, y + 1)};
  }
  return window.right > 0 ? window : Window{0, 0, 1, 1};
}

/// The part of an image that changes. @param before  empty for the first
std::string imageBlock(const std::vector<std::uint8_t>& now, const std::vector<std::uint8_t>& before, int width,
                       int hundredths) {
  const int height = static_cast<int>(now.size() / static_cast<std::size_t>(width));
  const Window window = before.empty() ? Window{0, 0, width, height} : changed(now, before, width);
  std::vector<std::uint8_t> part;
  for (int y = window.top; y < window.bottom; ++y)
    for (int x = window.left; x < window.right; ++x) {
      const std::size_t k = static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
      part.push_back(!before.empty() && before[k] == now[k] ? clear : now[k]);
    }
  std::string block = std::string("\x21\xF9\x04\x05", 4) + littleEndian(hundredths) + static_cast<char>(clear) + '\0';
  block += std::string(",") + littleEndian(window.left) + littleEndian(window.top) +
           littleEndian(window.right - window.left) + littleEndian(window.bottom - window.top) + '\0' + '\x08';
  const std::string data = packed(part);
  for (std::size_t k = 0; k < data.size(); k += 255) {
    const std::string piece = data.substr(k, 255);
    block += static_cast<char>(piece.size()) + piece;
  }
  return block + '\0';
}

}  // namespace

std::string gifOf(const std::vector<Image>& images, double seconds, const std::string& program) {
  if (images.empty()) throw InputError("there is no image", "GIF", "give at least one");
  for (const Image& image : images)
    if (image.width != images[0].width || image.height != images[0].height)
      throw InputError("the images have several sizes", "GIF", "give images of one size");
  const std::vector<Colour> table = tableOf(countColours(images));
  std::string file =
      "GIF89a" + littleEndian(images[0].width) + littleEndian(images[0].height) + std::string("\xF7\0\0", 3);
  for (std::size_t k = 0; k < 256; ++k) {
    const Colour c = k < table.size() ? table[k] : Colour{};
    file += {static_cast<char>(c.red), static_cast<char>(c.green), static_cast<char>(c.blue)};
  }
  const std::string name = program.substr(0, 255);
  file += std::string("\x21\xFE", 2) + static_cast<char>(name.size()) + name + '\0';
  file += std::string("\x21\xFF\x0B") + "NETSCAPE2.0" + std::string("\x03\x01\0\0\0", 5);
  const int hundredths = std::max(2, static_cast<int>(std::lround(100.0 * seconds)));
  std::vector<std::uint8_t> before;
  for (const Image& image : images) {
    std::vector<std::uint8_t> now = numbersOf(image, table);
    file += imageBlock(now, before, image.width, hundredths);
    before = std::move(now);
  }
  return file + ";";
}

}  // namespace dovetail::picture
