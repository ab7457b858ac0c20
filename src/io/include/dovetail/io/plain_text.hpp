// Marks and line ends that editors and old machines put into texts.
#pragma once

#include <string>
#include <string_view>

namespace dovetail::io {

/// The text behind a byte-order mark of UTF-8, if there is one.
/// @throws InputError, naming `where`, for the marks of UTF-16 and UTF-32
std::string_view withoutByteOrderMark(std::string_view text, const std::string& where);

/// In a text without any LF, every CR becomes one: lines of old Macintoshes.
void endLinesWithLf(std::string& text);

}  // namespace dovetail::io
