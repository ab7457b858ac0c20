#include "dovetail/report/text.hpp"
#include "map_text.hpp"

namespace dovetail::report {

const char* wordOf(Map::Outcome outcome) {
  switch (outcome) {
    case Map::Outcome::survived:
      return "survived";
    case Map::Outcome::refused:
      return "refused";
    case Map::Outcome::failed:
      return "failed";
    case Map::Outcome::none:
      break;
  }
  return "";
}

namespace {

std::string heading(const Map& map, std::size_t row, std::size_t column) {
  return map.y + " " + map.rows[row] + ", " + map.x + " " + map.columns[column];
}

std::string cellOf(const Map::Cell& cell, const std::string& title, const std::string& id) {
  if (cell.outcome == Map::Outcome::none) return "<td></td>";
  const std::string word = wordOf(cell.outcome);
  return "<td class=\"" + word + "\"><button popovertarget=\"" + id + "\" title=\"" + word + "\">" +
         escaped(cell.value.empty() ? word : cell.value) + "</button><div popover id=\"" + id + "\"><b>" +
         escaped(title) + ": " + word + "</b><pre>" + escaped(cell.detail) + "</pre></div></td>";
}

}  // namespace

std::string htmlOf(const Map& map, int number) {
  std::string text =
      "<figure class=\"map\"><figcaption>" + escaped(map.title) + "</figcaption><div class=\"table\"><table>\n";
  text += "<tr><th></th><th colspan=\"" + std::to_string(map.columns.size()) + "\">" + escaped(map.x) +
          "</th></tr>\n<tr><th>" + escaped(map.y) + "</th>";
  for (const std::string& column : map.columns) text += "<th>" + escaped(column) + "</th>";
  text += "</tr>\n";
  for (std::size_t r = 0; r < map.rows.size(); ++r) {
    text += "<tr><th>" + escaped(map.rows[r]) + "</th>";
    for (std::size_t c = 0; c < map.columns.size(); ++c)
      text += cellOf(map.cells[r][c], heading(map, r, c), format("map%d-%zu-%zu", number, r, c));
    text += "</tr>\n";
  }
  return text + "</table></div></figure>\n";
}

std::string markdownOf(const Map& map) {
  Table table{{map.y + " / " + map.x}, {}};
  table.head.insert(table.head.end(), map.columns.begin(), map.columns.end());
  std::string details;
  for (std::size_t r = 0; r < map.rows.size(); ++r) {
    table.rows.push_back({map.rows[r]});
    for (std::size_t c = 0; c < map.columns.size(); ++c) {
      const Map::Cell& cell = map.cells[r][c];
      table.rows.back().push_back(cell.value + (cell.value.empty() ? "" : " ") + wordOf(cell.outcome));
      if (cell.outcome != Map::Outcome::none) details += "- " + plain(heading(map, r, c) + ": " + cell.detail) + "\n";
    }
  }
  return plain(map.title) + ":\n\n" + markdownOf(table) + "\n" + details + "\n";
}

std::string mapStyle() {
  return R"(
.map{margin:1rem 0}
.map figcaption{font-weight:600}
.map table{border-spacing:2px;border-collapse:separate;font-size:.85rem}
.map th{border:0;padding:.2rem .5rem;white-space:nowrap}
.map td,.map td:last-child:not(.n){border:0;padding:0;min-width:4.2rem}
.map td:first-child{min-width:0}
.map td button{all:unset;box-sizing:border-box;display:block;width:100%;padding:.35rem .4rem;text-align:center;cursor:pointer}
.map td button:focus-visible{outline:2px solid var(--ink)}
.map .survived{background:#cfe8d5}.map .refused{background:#f3e2b3}.map .failed{background:#e9a8a0}
.map .refused button::after{content:" \2298"}.map .failed button::after{content:" \2717"}
[popover]{max-width:min(46rem,92vw);border:1px solid var(--line);border-radius:6px;padding:.7rem 1rem}
[popover] pre{white-space:pre-wrap;overflow-wrap:anywhere}
@media (prefers-color-scheme:dark){.map .survived{background:#1f4a2c}.map .refused{background:#5a4a16}
.map .failed{background:#7a2a22}[popover]{background:var(--soft);color:var(--ink)}}
)";
}

}  // namespace dovetail::report
