// Names that are safe as a file name, an XML attribute, a CSV field and an HDF5 link.
#pragma once

#include <algorithm>
#include <string>

#include "dovetail/core/error.hpp"
#include "dovetail/io/plain_text.hpp"

namespace dovetail::io {

/// Whether `name` holds only ASCII letters, digits, '_', '-' and '.' and starts with a letter.
inline bool isPlainName(const std::string& name) {
  const auto isLetter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); };
  const auto isAllowed = [&](char c) {
    return isLetter(c) || (c >= '0' && c <= '9') || c == '_' || c == '-' || c == '.';
  };
  return !name.empty() && isLetter(name.front()) && std::all_of(name.begin(), name.end(), isAllowed);
}

/// @throws InputError unless isPlainName
inline void requirePlainName(const std::string& name, const std::string& where) {
  if (!isPlainName(name))
    throw InputError(name.empty() ? "a name is empty" : "the name " + shown(name) + " cannot be used", where,
                     "use letters, digits, '_', '-' and '.', with a letter first");
}

}  // namespace dovetail::io
