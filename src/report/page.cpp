#include "dovetail/report/page.hpp"

#include <algorithm>
#include <cstdlib>

#include "dovetail/io/output_folder.hpp"
#include "dovetail/io/provenance.hpp"
#include "map_text.hpp"

namespace dovetail::report {

namespace {

bool isNumber(const std::string& text) {
  char* end = nullptr;
  std::strtod(text.c_str(), &end);
  return !text.empty() && (end == text.c_str() + text.size() || std::string(end) == " %");
}

/// Whether all that stands in a column is numbers: these are set to the right.
std::vector<bool> numbersIn(const Table& table) {
  std::vector<bool> numbers;
  for (const auto& cells : table.rows) {
    numbers.resize(std::max(numbers.size(), cells.size()), true);
    for (std::size_t k = 0; k < cells.size(); ++k) numbers[k] = numbers[k] && (cells[k].empty() || isNumber(cells[k]));
  }
  return numbers;
}

const char* const style = R"(
:root{color-scheme:light dark;--ink:#222;--paper:#fff;--line:#ddd;--soft:#f5f5f3}
@media (prefers-color-scheme:dark){:root{--ink:#ddd;--paper:#181a1b;--line:#3a3d3f;--soft:#222526}}
*{box-sizing:border-box}
body{margin:0 auto;padding:1rem;max-width:76rem;font:16px/1.5 system-ui,sans-serif}
body{color:var(--ink);background:var(--paper)}
h1{font-size:1.5rem;line-height:1.25;margin:.5rem 0}
h2{font-size:1.15rem;margin:2rem 0 .5rem;border-bottom:1px solid var(--line)}
p{margin:.5rem 0;overflow-wrap:anywhere}
.figures{display:grid;grid-template-columns:repeat(auto-fill,minmax(min(100%,26rem),1fr));gap:1rem}
.photo{margin:.5rem 0}
.photo img{display:block;width:100%;max-width:52rem;height:auto;border-radius:4px}
.photo figcaption{font-size:.85rem;opacity:.8;margin-top:.3rem}
.table{overflow-x:auto;margin:.5rem 0}
table{border-collapse:collapse;font-size:.9rem}
th,td{padding:.2rem .7rem .2rem 0;text-align:left;vertical-align:top;border-bottom:1px solid var(--line)}
td:first-child{min-width:9em}
td:last-child:not(.n){overflow-wrap:anywhere;min-width:12em}
.n{text-align:right;font-variant-numeric:tabular-nums}
td.n{white-space:nowrap}
@media (max-width:30rem){table{font-size:.78rem}th,td{padding-right:.4rem}td:first-child{min-width:6em}}
details{margin:.5rem 0;background:var(--soft);padding:.4rem .7rem;border-radius:4px}
summary{cursor:pointer}
pre{overflow-x:auto;font-size:.8rem;line-height:1.35}
)";

/// Bytes as text (RFC 4648).
std::string base64(const std::string& bytes) {
  const char* const letters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t k = 0; k < bytes.size(); k += 3) {
    unsigned word = 0;
    for (std::size_t m = k; m < k + 3; ++m)
      word = word << 8 | (m < bytes.size() ? static_cast<unsigned char>(bytes[m]) : 0U);
    for (std::size_t m = 0; m < 4; ++m) text += k + m <= bytes.size() ? letters[word >> (18 - 6 * m) & 63] : '=';
  }
  return text;
}

class Html {
public:
  std::string text;

  void operator()(const Paragraph& p) { close(), text += "<p>" + escaped(p.text) + "</p>\n"; }
  void operator()(const Figure& figure) {
    if (!inFigures_) text += "<div class=\"figures\">\n";
    inFigures_ = true;
    text += svgOf(figure);
  }
  void operator()(const Table& table) {
    close();
    text += "<div class=\"table\"><table>\n";
    const std::vector<bool> numbers = numbersIn(table);
    if (!table.head.empty()) line(table.head, "th", numbers);
    for (const auto& cells : table.rows) line(cells, "td", numbers);
    text += "</table></div>\n";
  }
  void operator()(const Listing& listing) {
    close();
    text += "<details><summary>" + escaped(listing.title) + "</summary><pre>" + escaped(listing.text) +
            "</pre></details>\n";
  }
  void operator()(const Map& map) {
    close();
    text += htmlOf(map, maps_++);
  }
  void operator()(const Photo& photo) {
    close();
    text += "<figure class=\"photo\"><img alt=\"" + escaped(photo.title) + "\" src=\"data:image/png;base64," +
            base64(photo.png) + "\"><figcaption>" + escaped(photo.title) + "</figcaption></figure>\n";
  }
  void close() {
    if (inFigures_) text += "</div>\n";
    inFigures_ = false;
  }

private:
  void line(const std::vector<std::string>& cells, const std::string& tag, const std::vector<bool>& numbers) {
    text += "<tr>";
    for (std::size_t k = 0; k < cells.size(); ++k)
      text +=
          "<" + tag + (k < numbers.size() && numbers[k] ? " class=\"n\">" : ">") + escaped(cells[k]) + "</" + tag + ">";
    text += "</tr>\n";
  }
  bool inFigures_ = false;
  int maps_ = 0;
};

}  // namespace

std::string plain(const std::string& text) {
  std::string out;
  for (const char c : text)
    if (c == '|')
      out += "\\|";
    else if (c == '\n')
      out += ' ';
    else if (c == '<')
      out += "&lt;";
    else
      out += c;
  return out;
}

namespace {

struct Markdown {
  std::string text, figureFile;

  void operator()(const Paragraph& p) { text += plain(p.text) + "\n\n"; }
  void operator()(const Figure& f) { text += "![" + plain(f.title) + "](" + figureFile + f.name + ".svg)\n\n"; }
  void operator()(const Photo& p) {
    text += "![" + plain(p.title) + "](" + figureFile + p.name + ".png)\n\n" + plain(p.title) + "\n\n";
  }
  void operator()(const Table& table) { text += markdownOf(table) + "\n"; }
  void operator()(const Map& map) { text += markdownOf(map); }
  void operator()(const Listing& l) {
    text += plain(l.title) + ":\n\n````\n" + l.text + (l.text.ends_with("\n") ? "" : "\n") + "````\n\n";
  }
};

}  // namespace

std::string htmlOf(const Page& page, const std::string& mark) {
  Html html;
  html.text = "<!doctype html>\n<!-- " + mark + " -->\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n" +
              "<meta name=\"viewport\" content=\"width=device-width,initial-scale=1\">\n<title>" + escaped(page.title) +
              "</title>\n<style>" + style + figureStyle() + mapStyle() + "</style>\n</head>\n<body>\n<h1>" +
              escaped(page.title) + "</h1>\n";
  for (const Section& section : page.sections) {
    if (section.blocks.empty()) continue;
    html.text += "<h2>" + escaped(section.heading) + "</h2>\n";
    for (const Block& block : section.blocks) std::visit(html, block);
    html.close();
  }
  return html.text + "</body>\n</html>\n";
}

std::string markdownOf(const Table& table) {
  const auto line = [](const std::vector<std::string>& cells) {
    std::string text = "|";
    for (const std::string& cell : cells) text += " " + plain(cell) + " |";
    return text + "\n";
  };
  const std::size_t columns = table.head.empty() && !table.rows.empty() ? table.rows.front().size() : table.head.size();
  std::string rule = "|";
  const std::vector<bool> numbers = numbersIn(table);
  for (std::size_t k = 0; k < columns; ++k) rule += k < numbers.size() && numbers[k] ? "---:|" : "---|";
  std::string text = line(table.head.empty() ? std::vector<std::string>(columns) : table.head) + rule + "\n";
  for (const auto& cells : table.rows) text += line(cells);
  return text;
}

std::string markdownOf(const Page& page, const std::string& figureFile) {
  Markdown markdown{"# " + plain(page.title) + "\n\n", figureFile};
  for (const Section& section : page.sections) {
    if (section.blocks.empty()) continue;
    markdown.text += "## " + plain(section.heading) + "\n\n";
    for (const Block& block : section.blocks) std::visit(markdown, block);
  }
  return markdown.text;
}

namespace {

template <class Kind>
std::vector<const Kind*> blocksOf(const Page& page) {
  std::vector<const Kind*> found;
  for (const Section& section : page.sections)
    for (const Block& block : section.blocks)
      if (const auto* const one = std::get_if<Kind>(&block)) found.push_back(one);
  return found;
}

}  // namespace

std::vector<const Figure*> figuresOf(const Page& page) { return blocksOf<Figure>(page); }
std::vector<const Photo*> photosOf(const Page& page) { return blocksOf<Photo>(page); }

std::filesystem::path writePage(const std::filesystem::path& folder, const Page& page) {
  const std::string mark = "dovetail " + io::buildInfo().version;
  const auto figureFile = [&](const Figure& figure) { return folder / ("report_" + figure.name + ".svg"); };
  for (const char* const name : {"report.md", "report.html"}) io::requireFreeOrOurs(folder / name);
  for (const Figure* const figure : figuresOf(page)) io::requireFreeOrOurs(figureFile(*figure));
  const auto photoFile = [&](const Photo& one) { return folder / ("report_" + one.name + ".png"); };
  for (const Photo* const one : photosOf(page)) io::requireFreeOrOurs(photoFile(*one));
  io::removeReport(folder);
  io::writeFileAtomically(folder / "report.html", htmlOf(page, mark));
  io::writeFileAtomically(folder / "report.md", "<!-- " + mark + " -->\n\n" + markdownOf(page, "report_"));
  for (const Figure* const figure : figuresOf(page))
    io::writeFileAtomically(figureFile(*figure), "<!-- " + mark + " -->\n" + svgFileOf(*figure));
  for (const Photo* const one : photosOf(page)) io::writeFileAtomically(photoFile(*one), one->png);
  return folder / "report.html";
}

}  // namespace dovetail::report
