// How many numbers the arrays of VTK's XML files hold, of which its readers take as many as the piece says and leave
// out what is more.
#pragma once

#include <cstdint>
#include <optional>

#include "vtk_xml_tags.hpp"

namespace dovetail::io::detail {

inline std::size_t bytesOf(std::string_view type) {
  return type.ends_with("64") ? 8 : type.ends_with("32") ? 4 : type.ends_with("16") ? 2 : 1;
}

inline std::size_t countWords(std::string_view text) {
  std::size_t count = 0;
  bool before = true;
  for (const char c : text) {
    const bool blank = c == ' ' || c == '\t' || c == '\r' || c == '\n';
    count += before && !blank;
    before = blank;
  }
  return count;
}

/// The first bytes of a text in Base64, up to a sign that is none of its.
inline std::string fromBase64(std::string_view text, std::size_t most) {
  constexpr std::string_view signs = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string bytes;
  std::uint32_t bits = 0;
  int held = 0;
  for (const char c : text) {
    const std::size_t value = signs.find(c);
    if (value == std::string_view::npos || bytes.size() == most) break;
    bits = bits << 6 | static_cast<std::uint32_t>(value);
    held += 6;
    if (held < 8) continue;
    held -= 8;
    bytes += static_cast<char>(bits >> held & 0xFFu);
  }
  return bytes;
}

class ArraySizes {
public:
  ArraySizes(std::string_view bytes, const std::filesystem::path& path) : bytes_(bytes), path_(path) {}

  /// Keeps in mind what the root, a piece and a section say of the arrays in them.
  void enter(std::string_view tag) {
    const std::string_view name = tag.substr(1, tag.find_first_of(" \t\r\n/", 1) - 1);
    if (name == "VTKFile") root_ = tag;
    if (name == "Piece") piece_ = tag;
    for (const char* section : {"Points", "PointData", "CellData", "Cells", "Verts", "Lines", "Strips", "Polys"})
      if (name == section) section_ = name;
    const bool ends = tag.starts_with("</") && tag.substr(2).starts_with(section_);
    if (ends || name == "FieldData") section_ = "";
  }

  /// @param tag, content  of a DataArray
  /// @throws InputError if it holds more numbers than its piece says
  void requireFitting(std::string_view tag, std::string_view content) const {
    const std::optional<double> tuples = tuplesOf(attribute(tag, "Name", ""));
    const std::optional<double> held = tuples ? numbersIn(tag, content) : std::nullopt;
    double components = section_ == "Points" ? 3.0 : 1.0;
    isNumber(attribute(tag, "NumberOfComponents", ""), components);
    if (!held || *held <= *tuples * components) return;
    const std::string name(section_ == "Points" ? "Points" : attribute(tag, "Name", ""));
    refuseVtk(path_, "",
              "the array \"" + name + "\" holds " + whole(*held) + " numbers, of which its piece has " +
                  whole(*tuples * components),
              "give a complete file whose counts are right");
  }

private:
  static std::string whole(double number) { return std::to_string(static_cast<std::int64_t>(number)); }
  std::optional<double> counted(std::string_view name) const {
    double count = 0.0;
    return isNumber(attribute(piece_, name, ""), count) ? std::optional(count) : std::nullopt;
  }

  std::optional<double> tuplesOf(std::string_view array) const {
    if (section_ == "Points" || section_ == "PointData") return counted("NumberOfPoints");
    if (section_ == "CellData") return cells();
    if (section_.empty() || (array != "offsets" && array != "types")) return {};
    return counted("NumberOf" + std::string(section_));
  }
  std::optional<double> cells() const {
    if (const auto all = counted("NumberOfCells")) return all;
    double sum = 0.0;
    for (const char* kind : {"NumberOfVerts", "NumberOfLines", "NumberOfStrips", "NumberOfPolys"})
      sum += counted(kind).value_or(0.0);
    return counted("NumberOfPolys") ? std::optional(sum) : std::nullopt;
  }

  std::optional<double> numbersIn(std::string_view tag, std::string_view content) const {
    const std::string_view format = attribute(tag, "format", "ascii");
    if (format == "ascii") return static_cast<double>(countWords(content));
    const auto bytes = bytesSaid(format == "appended" ? appended(tag) : fromBase64(trimmed(content), mostHeader));
    return bytes ? std::optional(*bytes / static_cast<double>(bytesOf(attribute(tag, "type", "")))) : std::nullopt;
  }
  static std::string_view trimmed(std::string_view text) {
    return text.substr(std::min(text.size(), text.find_first_not_of(" \t\r\n")));
  }
  /// The first bytes of an array behind the tags.
  std::string appended(std::string_view tag) const {
    const std::size_t begin = std::min(bytes_.find("<AppendedData"), bytes_.size()), end = endOfTag(bytes_, begin);
    const std::size_t mark = bytes_.find('_', end);
    std::size_t offset = 0;
    if (mark == std::string_view::npos || !isNumber(attribute(tag, "offset", ""), offset)) return "";
    if (offset >= bytes_.size() - mark) return "";
    const bool raw = attribute(bytes_.substr(begin, end - begin), "encoding", "") == "raw";
    const std::string_view data = bytes_.substr(mark + 1 + offset);
    return raw ? std::string(data.substr(0, mostHeader)) : fromBase64(data, mostHeader);
  }
  /// By the words before the data: their bytes, or if they are compressed the number of blocks, the bytes of each, and
  /// those of the last if it has fewer.
  std::optional<double> bytesSaid(const std::string& header) const {
    const std::size_t size = attribute(root_, "header_type", "UInt32") == "UInt64" ? 8 : 4;
    const bool compressed = !attribute(root_, "compressor", "").empty();
    if (header.size() < (compressed ? 3 : 1) * size) return {};
    const auto word = [&](std::size_t k) {
      double value = 0.0;
      const bool big = attribute(root_, "byte_order", "LittleEndian") == "BigEndian";
      for (std::size_t b = 0; b < size; ++b)
        value = 256.0 * value + static_cast<unsigned char>(header[k * size + (big ? b : size - 1 - b)]);
      return value;
    };
    if (!compressed || word(0) == 0.0) return word(0);
    return word(0) * word(1) - (word(2) > 0.0 ? word(1) - word(2) : 0.0);
  }

  static constexpr std::size_t mostHeader = 24;
  std::string_view bytes_;
  const std::filesystem::path& path_;
  std::string_view root_, piece_, section_;
};

}  // namespace dovetail::io::detail
