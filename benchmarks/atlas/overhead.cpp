// What scenes pay in bytes, time and libraries.
#include "dovetail/report/text.hpp"
#include "results.hpp"

namespace dovetail::atlas {

namespace {

using report::format, report::Json;

std::string percent(const Json& row, const std::string& key) { return format("%+.2f", 100.0 * numberOf(row, key)); }

/// "12 / 9", each of them times a factor.
std::string pairOf(const char* pattern, double factor, const Json& row, const std::string& scene,
                   const std::string& program) {
  return format(pattern, factor * numberOf(row, scene)) + " / " + format(pattern, factor * numberOf(row, program));
}

void addHandLoop(const Json& hand, report::Section& section) {
  section.blocks.push_back(report::Paragraph{
      format("The barest scene, %.0f frictionless spheres on a lattice: %.2f ns per grain step, where a loop written "
             "by hand over the same pairs takes %.2f. Ratio, median of turns: %.3f (quartiles %.3f and %.3f); target: "
             "at most 1.05. Positions of both differ by %.1e m at the end.",
             numberOf(hand, "grains"), numberOf(hand, "ns"), numberOf(hand, "hand_ns"), numberOf(hand, "ratio"),
             numberOf(hand, "ratio_lower_quartile"), numberOf(hand, "ratio_upper_quartile"),
             numberOf(hand, "largest_difference_m"))});
}

void addFeatures(const Json& rows, report::Section& section) {
  const std::vector<std::string> head{"ns per grain step", "over the barest scene, %", "lower quartile",
                                      "upper quartile", "bytes per grain"};
  report::Table idle{head, {}}, used{head, {}};
  idle.head.insert(idle.head.begin(), "there, but not used");
  used.head.insert(used.head.begin(), "used");
  for (const Json& row : rows)
    (row.value("used", false) ? used : idle)
        .rows.push_back({wordOf(row, "feature"), format("%.1f", numberOf(row, "ns")), percent(row, "cost_fraction"),
                         percent(row, "lower_quartile"), percent(row, "upper_quartile"),
                         format("%+.1f", numberOf(row, "bytes_per_grain"))});
  section.blocks.push_back(report::Paragraph{
      "Single features over the barest scene, in alternation, medians and quartiles; target for unused features: at "
      "most 1 % and no byte. \"nothing\" is the same scene twice, and shows the noise of the machine."});
  section.blocks.push_back(std::move(idle));
  section.blocks.push_back(std::move(used));
}

std::string profileOf(const Json& rows) {
  std::string text;
  for (const Json& row : rows)
    text += (text.empty() ? "" : ", ") + wordOf(row, "part") + format(" %.0f", 100.0 * numberOf(row, "fraction"));
  return text;
}

void addParts(const Json& content, report::Section& section) {
  const std::string unit = wordOf(content, "unit");
  report::Table links{{"parts", "program, MB", "libraries", "start-up, ms", "bytes each"}, {}};
  report::Table steps{{"parts", "grains", "elements", "steps, " + unit, "scene costs, %"}, {}};
  report::Table profiles{{"parts", "where a scene's steps go, %"}, {}};
  for (const Json& row : content["parts"]) {
    const std::string part = wordOf(row, "part");
    links.rows.push_back({part, format("%.1f", 1e-6 * numberOf(row, "bytes")), std::to_string(row["libraries"].size()),
                          pairOf("%.0f", 1e3, row, "start_scene_s", "start_program_s"),
                          pairOf("%.0f", 1.0, row, "bytes_each_scene", "bytes_each_program")});
    steps.rows.push_back({part, format("%.0f", numberOf(row, "grains")), format("%.0f", numberOf(row, "elements")),
                          pairOf("%.3g", 1.0, row, "cost_scene", "cost_program"),
                          format("%+.1f", 100.0 * numberOf(row, "cost_fraction"))});
    profiles.rows.push_back({part, profileOf(row["profile"])});
  }
  section.blocks.push_back(report::Paragraph{format(
      "The same scenes by dovetail and by C++ programs that link no more than they use (scene / program): size without "
      "symbols, libraries beside the system's, start-up, growth of the peak of memory per grain or element, %.0f "
      "steps, one thread. dovetail itself: %.1f MB, %zu libraries.",
      numberOf(content["parts"][0], "steps"), 1e-6 * numberOf(content["dovetail"], "bytes"),
      content["dovetail"]["libraries"].size())});
  for (report::Table* const table : {&links, &steps, &profiles}) section.blocks.push_back(std::move(*table));
}

/// The numbers alone: lists become what they count or say.
void addRows(const Json& content, Chapter& chapter) {
  for (const char* part : {"by_hand", "features", "parts", "dovetail"}) {
    const Json rows = content[part].is_array() ? content[part] : Json::array({content[part]});
    for (Json row : rows) {
      if (row.contains("libraries")) row["libraries"] = row["libraries"].size();
      if (row.contains("profile")) row["profile"] = profileOf(row["profile"]);
      row["table"] = part;
      chapter.rows.push_back(std::move(row));
    }
  }
}

}  // namespace

Chapter overheadOf(const std::vector<Result>& results) {
  Chapter chapter;
  const Result* const overhead = find(results, "overhead");
  if (!overhead) return chapter;
  report::Section section{"What a scene pays", {}};
  addHandLoop(overhead->content["by_hand"], section);
  addFeatures(overhead->content["features"], section);
  addParts(overhead->content, section);
  addRows(overhead->content, chapter);
  chapter.sections.push_back(std::move(section));
  return chapter;
}

}  // namespace dovetail::atlas
