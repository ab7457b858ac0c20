// What scenes pay in bytes, time and libraries.
#include "dovetail/report/text.hpp"
#include "results.hpp"

namespace dovetail::atlas {

namespace {

using report::format, report::Json;

void addHandLoop(const Json& hand, report::Section& section) {
  section.blocks.push_back(
      report::Paragraph{format("The barest scene, %.0f frictionless spheres on a lattice: %.2f ns per grain step, "
                               "where a loop written by hand over "
                               "the same pairs takes %.2f. Ratio, median of turns: %.3f (quartiles %.3f and %.3f); "
                               "asked: at most 1.05. Positions "
                               "of both differ by %.1e m at the end.",
                               numberOf(hand, "grains"), numberOf(hand, "ns"), numberOf(hand, "hand_ns"),
                               numberOf(hand, "ratio"), numberOf(hand, "ratio_lower_quartile"),
                               numberOf(hand, "ratio_upper_quartile"), numberOf(hand, "largest_difference_m"))});
}

void addIdle(const Json& rows, report::Section& section) {
  report::Table table{
      {"there, but not used", "time, % (median)", "lower quartile", "upper quartile", "bytes per grain"}, {}};
  for (const Json& row : rows)
    table.rows.push_back({wordOf(row, "feature"), format("%+.2f", 100.0 * numberOf(row, "cost_share")),
                          format("%+.2f", 100.0 * numberOf(row, "lower_quartile")),
                          format("%+.2f", 100.0 * numberOf(row, "upper_quartile")),
                          format("%+.2f", numberOf(row, "bytes_per_grain"))});
  section.blocks.push_back(
      report::Paragraph{"What is there and not used, over the barest scene, turn by turn; asked: at most 1 % and no "
                        "byte. \"nothing\" is the "
                        "same scene twice, and tells what the machine's noise is."});
  section.blocks.push_back(std::move(table));
}

void addLadder(const Json& rows, report::Section& section) {
  report::Table table{{"scene", "grains", "ns per grain step", "bytes per grain", "libraries of the project"}, {}};
  report::Figure time{"ladder", "Time of a rung", {"", false}, {"ns per grain step", false}, {}, {}};
  for (const Json& row : rows) {
    const double each = numberOf(row, "ns_per_grain_step");
    table.rows.push_back({wordOf(row, "rung"), format("%.0f", numberOf(row, "grains")), format("%.1f", each),
                          format("%.0f", numberOf(row, "bytes_per_grain")), wordOf(row, "components")});
    time.bars.emplace_back(wordOf(row, "rung"), each);
  }
  section.blocks.push_back(report::Paragraph{
      "Each rung has all that the rungs above it in the table have (the plate takes the place of the lower wall, the "
      "far "
      "field that of the upper one). Bytes are all that the scene has allocated, over its grains; one thread."});
  section.blocks.push_back(std::move(table));
  section.blocks.push_back(std::move(time));
}

void addPrograms(const Result& programs, Chapter& chapter) {
  report::Table table{{"program", "what it does", "size, MB", "shared libraries", "of them numerical or graphical"},
                      {}};
  for (const Json& row : programs.content) {
    table.rows.push_back({wordOf(row, "program"), wordOf(row, "does"), format("%.2f", 1e-6 * numberOf(row, "bytes")),
                          format("%.0f", numberOf(row, "libraries")), wordOf(row, "packages")});
    chapter.rows.push_back(row);
  }
  chapter.sections.back().blocks.push_back(report::Paragraph{"What programs link, as ldd lists it:"});
  chapter.sections.back().blocks.push_back(std::move(table));
}

}  // namespace

Chapter pricesOf(const std::vector<Result>& results) {
  Chapter chapter;
  const Result* const ladder = find(results, "ladder");
  if (!ladder) return chapter;
  report::Section section{"What a scene pays", {}};
  addHandLoop(ladder->content["by_hand"], section);
  addIdle(ladder->content["idle"], section);
  addLadder(ladder->content["ladder"], section);
  for (const char* part : {"by_hand", "idle", "ladder"}) {
    const Json rows = ladder->content[part].is_array() ? ladder->content[part] : Json::array({ladder->content[part]});
    for (Json row : rows) {
      row["part"] = part;
      chapter.rows.push_back(std::move(row));
    }
  }
  chapter.sections.push_back(std::move(section));
  if (const Result* const programs = find(results, "programs")) addPrograms(*programs, chapter);
  return chapter;
}

}  // namespace dovetail::atlas
