// dovetail report
#include <iostream>

#include "dovetail/report/run_report.hpp"
#include "dovetail/scene/picture.hpp"
#include "program/options.hpp"
#include "verbs.hpp"

namespace dovetail::program {

bool reportRun(int argc, char** argv) {
  Options options("dovetail report",
                  "Writes report.html, which needs no other file, and report.md into a run's folder, with the picture "
                  "of its last frame.");
  std::string folder;
  options.text("FOLDER", folder, "that the run wrote into").require();
  if (!options.parse(argc, argv)) return true;
  const scene::ShownRun shown = scene::showRun(folder);
  if (shown.png.empty() && !shown.caption.empty())
    std::cerr << "dovetail report: no picture: " << shown.caption << '\n';
  std::cout << report::writeRunReport(folder, {"picture", shown.caption, shown.png}).string() << '\n';
  return true;
}

}  // namespace dovetail::program
