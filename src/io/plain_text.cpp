#include "dovetail/io/plain_text.hpp"

#include <algorithm>

#include "dovetail/core/error.hpp"

namespace dovetail::io {

std::string_view withoutByteOrderMark(std::string_view text, const std::string& where) {
  using namespace std::string_view_literals;
  if (text.starts_with("\xEF\xBB\xBF"sv)) return text.substr(3);
  if (text.starts_with("\xFF\xFE"sv) || text.starts_with("\xFE\xFF"sv) || text.starts_with("\0\0\xFE\xFF"sv))
    throw InputError("the text is in UTF-16 or UTF-32, as its byte-order mark says", where, "save it as UTF-8");
  return text;
}

void endLinesWithLf(std::string& text) {
  if (text.find('\n') == std::string::npos) std::replace(text.begin(), text.end(), '\r', '\n');
}

}  // namespace dovetail::io
