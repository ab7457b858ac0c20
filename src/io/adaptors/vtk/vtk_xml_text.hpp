// The text of VTK's XML files, looked at before VTK reads them.
#pragma once

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <string_view>

#include "dovetail/core/atomic_file.hpp"
#include "dovetail/core/error.hpp"
#include "vtk_array_sizes.hpp"

namespace dovetail::io {

namespace detail {

/// Whether VTK's streams read the word as a number of the type; not "nan".
inline bool isNumberOf(std::string_view type, std::string_view word) {
  double real = 0.0;
  long long whole = 0;
  unsigned long long positive = 0;
  if (type.starts_with("Float")) return isNumber(word, real) && real - real == 0.0;
  if (type == "UInt64") return isNumber(word, positive);
  if (!isNumber(word, whole)) return false;
  if (type == "Int64") return true;
  const int bits = type.ends_with("32") ? 32 : type.ends_with("16") ? 16 : 8;
  const long long most = 1ll << (type.starts_with("U") ? bits : bits - 1);
  return whole < most && whole >= (type.starts_with("U") ? 0 : -most);
}

/// Counts that no file of that size could fill: zlib packs a thousand bytes into one at most.
inline void requirePlausibleCounts(std::string_view tag, std::size_t fileSize, const std::filesystem::path& path) {
  for (std::size_t at = tag.find("NumberOf"); at != std::string_view::npos; at = tag.find("NumberOf", at + 1)) {
    const std::string_view name = tag.substr(at, tag.find_first_of("= \t\r\n", at) - at);
    const std::string_view value = attribute(tag, name, "0");
    std::size_t count = 0;
    if (!isNumber(value, count) || count > 1032 * fileSize)
      refuseVtk(path, "", "it has " + std::string(name) + "=\"" + std::string(value.substr(0, 24)) + "\"",
                "give a complete file");
  }
}

inline void requireKnownType(std::string_view type, const std::filesystem::path& path) {
  for (const char* known :
       {"Int8", "UInt8", "Int16", "UInt16", "Int32", "UInt32", "Int64", "UInt64", "Float32", "Float64"})
    if (type == known) return;
  refuseVtk(path, "", "an array is of type \"" + std::string(type.substr(0, 24)) + "\"",
            "give Int8 to UInt64, Float32 or Float64");
}

/// Compressed blocks are read by what the root says of their headers.
inline void requireKnownRoot(std::string_view tag, const std::filesystem::path& path) {
  std::size_t known = 0;
  for (const char* name : {"type", "version", "byte_order", "header_type", "compressor"})
    known += attribute(tag, name, "").empty() ? 0 : 1;
  const auto given = static_cast<std::size_t>(std::count(tag.begin(), tag.end(), '='));
  if (given != known)
    refuseVtk(path, "", "the root element has attributes that are not known",
              "give type, version, byte_order, header_type and compressor");
}

inline void requireNumbers(std::string_view type, std::string_view content, const std::filesystem::path& path) {
  constexpr std::string_view blanks = " \t\r\n";
  for (std::size_t at = content.find_first_not_of(blanks); at != std::string_view::npos;) {
    const std::size_t end = std::min(content.find_first_of(blanks, at), content.size());
    if (!isNumberOf(type, content.substr(at, end - at))) {
      std::string problem(content.substr(at, std::min<std::size_t>(end - at, 24)));
      problem.append(" is no ").append(type);
      refuseVtk(path, "", problem, "give finite numbers of the array's type");
    }
    at = content.find_first_not_of(blanks, end);
  }
}

/// Looks at the counts of all tags, at the numbers of all arrays in ASCII, and at how many of them there are.
inline void requireReadable(const std::filesystem::path& path) {
  std::ifstream file = openFile(path, std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(file), {}};
  const std::string_view text = std::string_view(bytes).substr(0, bytes.find("<AppendedData"));
  ArraySizes sizes(bytes, path);
  for (std::size_t at = text.find('<'); at != std::string_view::npos;) {
    const std::size_t end = endOfTag(text, at);
    if (end == std::string_view::npos) return;
    const std::string_view tag = text.substr(at, end - at);
    at = text.find('<', end);
    requirePlausibleCounts(tag, bytes.size(), path);
    if (tag.starts_with("<VTKFile")) requireKnownRoot(tag, path);
    sizes.enter(tag);
    if (tag.starts_with("<Array") && attribute(tag, "type", "") != "String")
      requireKnownType(attribute(tag, "type", ""), path);
    if (!tag.starts_with("<DataArray")) continue;
    requireKnownType(attribute(tag, "type", ""), path);
    const std::string_view content =
        tag.ends_with('/') ? "" : text.substr(end + 1, std::min(at, text.size()) - end - 1);
    if (attribute(tag, "format", "ascii") == "ascii") requireNumbers(attribute(tag, "type", ""), content, path);
    sizes.requireFitting(tag, content);
  }
}

}  // namespace detail

}  // namespace dovetail::io
