// Tags and numbers in the text of VTK's XML files.
#pragma once

#include <algorithm>
#include <filesystem>
#include <string>
#include <string_view>

#include "dovetail/core/error.hpp"
#include "dovetail/io/text_source.hpp"

namespace dovetail::io {

[[noreturn]] inline void refuseVtk(const std::filesystem::path& path, const std::string& place,
                                   const std::string& problem, const std::string& remedy) {
  throw InputError(problem, place.empty() ? path.string() : path.string() + ", " + place, remedy);
}

namespace detail {

/// Where a tag or comment that begins at `at` ends: at its last '>'. npos if it does not.
inline std::size_t endOfTag(std::string_view text, std::size_t at) {
  if (text.substr(at).starts_with("<!--")) {
    const std::size_t end = text.find("-->", at);
    return end == std::string_view::npos ? end : end + 2;
  }
  for (char quote = 0; at < text.size(); ++at) {
    const char c = text[at];
    if (quote == 0 && c == '>') return at;
    if (quote == 0 && (c == '"' || c == '\''))
      quote = c;
    else if (c == quote)
      quote = 0;
  }
  return std::string_view::npos;
}

/// The value of an attribute within a tag, `otherwise` if it is not there.
inline std::string_view attribute(std::string_view tag, std::string_view name, std::string_view otherwise) {
  constexpr std::string_view blanks = " \t\r\n";
  for (std::size_t at = tag.find(name); at != std::string_view::npos; at = tag.find(name, at + 1)) {
    const std::size_t equal = tag.find_first_not_of(blanks, at + name.size());
    if (at == 0 || tag[at - 1] > ' ' || equal == std::string_view::npos || tag[equal] != '=') continue;
    const std::size_t quote = tag.find_first_not_of(blanks, equal + 1);
    if (quote == std::string_view::npos || (tag[quote] != '"' && tag[quote] != '\'')) continue;
    return tag.substr(quote + 1, std::min(tag.find(tag[quote], quote + 1), tag.size()) - quote - 1);
  }
  return otherwise;
}

}  // namespace detail

}  // namespace dovetail::io
