// Pages of text, tables and figures, as HTML and Markdown.
#pragma once

#include <filesystem>
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
/// What came out at every pair of two values, coloured by its outcome.
struct Map {
  enum class Outcome { none, survived, refused, failed };
  struct Cell {
    Outcome outcome = Outcome::none;
    std::string value;   ///< short: text of the cell
    std::string detail;  ///< opened by the cell: what happened, and the command that repeats it
  };
  std::string title, x, y;                 ///< what the columns and the rows are
  std::vector<std::string> columns, rows;  ///< their values
  std::vector<std::vector<Cell>> cells;    ///< [row][column]
};
/// "survived"; "" for none.
const char* wordOf(Map::Outcome outcome);

/// A picture in pixels.
struct Photo {
  std::string name;   ///< of its file: letters, digits, '_' and '-'
  std::string title;  ///< what it shows
  std::string png;    ///< bytes of a PNG file
};

using Block = std::variant<Paragraph, Table, Figure, Listing, Map, Photo>;

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

/// Markdown. @param figureFile  what stands before a figure's name in the name of its file, to which ".svg" is added,
/// or
///   ".png" for pictures
std::string markdownOf(const Page& page, const std::string& figureFile);
/// A table alone.
std::string markdownOf(const Table& table);

/// Writes report.html, which needs no other file, and report.md with a file report_<name>.svg per figure into a folder,
/// in place of an earlier report of ours.
/// @return the HTML file. @throws InputError if a name is taken by a file that is not ours
std::filesystem::path writePage(const std::filesystem::path& folder, const Page& page);

/// All figures of the page in their order.
std::vector<const Figure*> figuresOf(const Page& page);
std::vector<const Photo*> photosOf(const Page& page);

}  // namespace dovetail::report
