#include "dovetail/io/plain_text.hpp"

#include <algorithm>

#include "dovetail/core/atomic_file.hpp"
#include "dovetail/core/error.hpp"

namespace dovetail::io {

namespace {

/// The text before the Ctrl-Z with which DOS ended files, if nothing but blanks follows it.
std::string_view withoutEndMark(std::string_view text) {
  const std::size_t last = text.find_last_not_of(" \t\r\n\x1A");
  return text.substr(0, text.find('\x1A', last == std::string_view::npos ? 0 : last));
}

}  // namespace

std::string readWhole(const std::filesystem::path& path, const std::string& what) {
  std::ifstream file = openFile(path, std::ios::binary);
  if (!file) throw InputError(what + " cannot be read", path.string(), "give a file that exists and may be read");
  file.seekg(0, std::ios::end);
  std::string text(static_cast<std::size_t>(std::max<std::streamoff>(file.tellg(), 0)), '\0');
  file.seekg(0);
  file.read(text.data(), static_cast<std::streamsize>(text.size()));
  if (static_cast<std::size_t>(file.gcount()) != text.size())
    throw InputError("reading " + what + " broke off", path.string(), "check the disk");
  return text;
}

std::string_view withoutByteOrderMark(std::string_view text, const std::string& where) {
  using namespace std::string_view_literals;
  if (text.starts_with("\xEF\xBB\xBF"sv)) return text.substr(3);
  if (text.starts_with("\xFF\xFE"sv) || text.starts_with("\xFE\xFF"sv) || text.starts_with("\0\0\xFE\xFF"sv))
    throw InputError("the text is in UTF-16 or UTF-32, as its byte-order mark says", where, "save it as UTF-8");
  return text;
}

std::string_view plainText(std::string_view bytes, const std::string& where, std::string& room) {
  const std::string_view text = withoutEndMark(withoutByteOrderMark(bytes, where));
  if (text.find('\n') != std::string_view::npos) return text;
  room = text;
  std::replace(room.begin(), room.end(), '\r', '\n');
  return room;
}

std::string shown(std::string_view word) {
  if (word.empty()) return "nothing";
  std::string text = "'";
  for (const char c : word.substr(0, 24)) text += c >= ' ' && c <= '~' ? c : '?';
  return text + (word.size() > 24 ? "…'" : "'");
}

std::string lower(std::string_view word) {
  std::string text(word);
  for (char& c : text)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return text;
}

}  // namespace dovetail::io
