// Files as one text, marks and line ends that editors and old machines put into them, and words of them in messages.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace dovetail::io {

/// The bytes of a regular file.
/// @param what  is read, for the message: "a mesh"
/// @throws InputError if it is no file, or cannot be read
std::string readWhole(const std::filesystem::path& path, const std::string& what);

/// The text behind a byte-order mark of UTF-8, if there is one.
/// @throws InputError, naming `where`, for the marks of UTF-16 and UTF-32
std::string_view withoutByteOrderMark(std::string_view text, const std::string& where);

/// A text without a byte-order mark and an end mark, its lines ending with LF: in one without any LF, every CR becomes
/// one, as old Macintoshes wrote them. @param room  for the text where it is changed
/// @throws InputError as withoutByteOrderMark
std::string_view plainText(std::string_view bytes, const std::string& where, std::string& room);

/// A word for an error message: short, printable, in quotes.
std::string shown(std::string_view word);

/// Lower case, ASCII only.
std::string lower(std::string_view word);

}  // namespace dovetail::io
