// Maps as HTML and Markdown.
#pragma once

#include <string>

#include "dovetail/report/page.hpp"

namespace dovetail::report {

/// A table of coloured cells, each with a window of its own that opens when it is pressed. @param number  of the map on
/// its page
std::string htmlOf(const Map& map, int number);
/// A table, and a list of the details of all cells.
std::string markdownOf(const Map& map);
/// CSS of the maps' classes, for light and dark.
std::string mapStyle();

/// Text in which what has a meaning in tables of Markdown is written so that it has none.
std::string plain(const std::string& text);

}  // namespace dovetail::report
