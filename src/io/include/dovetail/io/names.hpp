// Names that are safe as a file name, an XML attribute, a CSV field and an HDF5 link.
#pragma once

#include <algorithm>
#include <string>

#include "dovetail/core/error.hpp"

namespace dovetail::io {

/// @throws InputError unless `name` holds only ASCII letters, digits, '_', '-' and '.' and starts with a letter
inline void requirePlainName(const std::string& name, const std::string& where) {
  const auto isLetter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); };
  const auto isAllowed = [&](char c) {
    return isLetter(c) || (c >= '0' && c <= '9') || c == '_' || c == '-' || c == '.';
  };
  if (name.empty() || !isLetter(name.front()) || !std::all_of(name.begin(), name.end(), isAllowed))
    throw InputError("the name '" + name + "' cannot be used", where,
                     "use letters, digits, '_', '-' and '.', with a letter first");
}

}  // namespace dovetail::io
