// Pages of text, tables and figures, as HTML and Markdown.
#pragma once

#include <string>
#include <variant>
#include <vector>

#include "dovetail/report/figure.hpp"

namespace dovetail::report {

struct Paragraph {
  std::string text;
};
/// Columns of numbers are set to the right.
struct Table {
  std::vector<std::string> head;
  std::vector<std::vector<std::string>> rows;
};
/// Text in lines, folded up on HTML pages below its title.
struct Listing {
  std::string title, text;
};
using Block = std::variant<Paragraph, Table, Figure, Listing>;

struct Section {
  std::string heading;
  std::vector<Block> blocks;
};
struct Page {
  std::string title;
  std::vector<Section> sections;  ///< those without blocks are left out
};

/// One file that needs no other, readable on a telephone, light and dark. @param mark  goes into a comment at the top
std::string htmlOf(const Page& page, const std::string& mark);

/// Markdown. @param figureFile  what stands before a figure's name in the name of its file, to which ".svg" is added
std::string markdownOf(const Page& page, const std::string& figureFile);
/// A table alone.
std::string markdownOf(const Table& table);

/// All figures of the page in their order.
std::vector<const Figure*> figuresOf(const Page& page);

}  // namespace dovetail::report
