// Writes the atlas: one page of error, stability and cost from what the studies have left in a folder.
#include <iostream>

#include "dovetail/io/output_folder.hpp"
#include "dovetail/report/text.hpp"
#include "program/options.hpp"
#include "program/run.hpp"
#include "results.hpp"

namespace {

using namespace dovetail;
using namespace dovetail::atlas;
namespace fs = std::filesystem;

report::Section studiesOf(const std::vector<Result>& results, const io::KeyValues& provenance) {
  report::Table table{{"study", "seconds", "exit status", "command"}, {}};
  double seconds = 0.0;
  for (const Result& r : results) {
    table.rows.push_back({r.id, report::format("%.1f", r.seconds), std::to_string(r.status), r.command});
    seconds += r.seconds;
  }
  std::string origin;
  for (const auto& [key, value] : provenance) origin += key + ": " + value + "\n";
  return {
      "How it was made",
      {report::Paragraph{report::format("%zu studies in %.0f s. Commands are those of the project's root; numbers are "
                                        "in atlas.json, atlas_fronts.csv, atlas_map.csv and atlas_overhead.csv beside "
                                        "this page.",
                                        results.size(), seconds)},
       std::move(table), report::Listing{"Where these numbers come from", origin}}};
}

void write(const fs::path& folder) {
  const std::vector<Result> results = readResults(folder);
  const io::KeyValues provenance = io::provenance({{"program", "atlas"}});
  const Chapter fronts = frontsOf(results), maps = mapsOf(results), overhead = overheadOf(results);
  report::Page page{"Atlas of error, time and stability", {}};
  report::Json json{{"provenance", report::objectOf(provenance)}};
  for (const auto& [name, chapter] :
       {std::pair{"fronts", &fronts}, std::pair{"map", &maps}, std::pair{"overhead", &overhead}}) {
    page.sections.insert(page.sections.end(), chapter->sections.begin(), chapter->sections.end());
    json[name] = chapter->rows;
    io::writeFileAtomically(folder / (std::string("atlas_") + name + ".csv"), report::csvOf(chapter->rows, provenance));
  }
  page.sections.push_back(studiesOf(results, provenance));
  io::writeFileAtomically(folder / "atlas.json", json.dump(2) + "\n");
  io::writeFileAtomically(folder / "atlas.html", report::htmlOf(page, provenance.front().second));
}

}  // namespace

/// Exit code 0: done; 2: the request was refused.
int main(int argc, char** argv) {
  return program::runProgram("atlas_page", [&] {
    std::string folder;
    program::Options o("atlas_page", "Writes atlas.html and its numbers from the studies that scripts/atlas has run.");
    o.text("FOLDER", folder, "in which runs.json and the results of the studies are").require();
    if (!o.parse(argc, argv)) return true;
    io::prepareOutputFolder(folder,
                            {"atlas.html", "atlas.json", "atlas_fronts.csv", "atlas_map.csv", "atlas_overhead.csv"});
    write(folder);
    std::cout << (fs::path(folder) / "atlas.html").string() << '\n';
    return true;
  });
}
