// dovetail picture
#include "dovetail/scene/picture.hpp"

#include <iostream>
#include <sstream>

#include "program/options.hpp"
#include "verbs.hpp"

namespace dovetail::program {

namespace {

scene::ColourRange rangeIn(const std::string& text, const std::string& name) {
  std::istringstream words(text);
  std::string low, high;
  words >> low >> high;
  return {numberFrom<double>(low, name), numberFrom<double>(high, name)};
}

void takeCut(const std::string& text, scene::PictureOptions& settings) {
  std::istringstream words(text);
  std::string axis, at;
  words >> axis >> at;
  settings.cutAxis = axis;
  settings.cutAt = numberFrom<double>(at, "--cut");
}

void takeSize(const std::string& text, scene::PictureOptions& settings) {
  std::istringstream words(text);
  std::string width, height;
  words >> width >> height;
  settings.width = numberFrom<int>(width, "--size");
  settings.height = numberFrom<int>(height, "--size");
}

}  // namespace

bool drawRun(int argc, char** argv) {
  std::string run, file;
  bool uncut = false;
  int mode = 0;
  scene::PictureOptions settings;
  Options options("dovetail picture", "Draws a frame of a run as a PNG file, or all frames as a film, a GIF file.");
  options.text("RUN", run, "folder of a run with frames").require();
  options.flag("--film", settings.film, "all frames, as film.gif");
  options.integer("--frame N", settings.frame, -1000000, 1000000, "from 0; -1 is the last");
  options.integer("--mode K", mode, 0, 1000,
                  "a natural mode of the solids, from 1, in place of a frame; films show all");
  options.text("--cell NAME", settings.cell, "the grains of a cell of \"output\" of the scene");
  options.text("--out FILE", file, "RUN/picture.png or RUN/film.gif if not given");
  options.group("view");
  const Range turn = between(-360.0, 360.0), height = between(-90.0, 90.0);
  options.number(
      "--azimuth A", settings.azimuth, turn,
      "of the viewer about the vertical, degrees: 0 looks along y, 90 against x; chosen by the shape if not given");
  options.number("--elevation E", settings.elevation, height,
                 "of the viewer, degrees; chosen by the shape if not given");
  options.add("--cut AXIS X",
              "leaves out what lies before a plane, such as --cut y 0.1; in overlaps the middle if not given",
              [&](const std::string& text) { takeCut(text, settings); }, {});
  options.flag("--uncut", uncut, "no section where grains and solids overlap");
  options.number("--warp F", settings.warp, notNegative("0 or a positive number"),
                 "displacements are drawn so many times as large");
  options.add("--size W H", "pixels; 1200 wide and as high as the scene needs if not given",
              [&](const std::string& text) { takeSize(text, settings); }, {});
  options.text("--background COLOUR", settings.background, "white, black, or one such as #e8eef4");
  options.group("colours");
  options.text("--grains FIELD", settings.grains,
               "speed, radius, force, spin, weight …, or none: no grains; speed if not given");
  options.text(
      "--solids FIELD", settings.solids,
      "von_mises, pressure, displacement, speed, plastic_strain, solid_weight …, or none; von_mises if not given");
  options.word("--lines", settings.lines, "none|contacts|bonds", "forces as rods through pale grains");
  options.add("--grain-range A B", "ends of the grains' colours, SI units",
              [&](const std::string& text) { settings.grainRange = rangeIn(text, "--grain-range"); }, {});
  options.add("--solid-range A B", "ends of the solids' colours, SI units",
              [&](const std::string& text) { settings.solidRange = rangeIn(text, "--solid-range"); }, {});
  if (!options.parse(argc, argv)) return true;
  if (mode > 0) {
    settings.mode = mode;
    options.refuseIdle("--frame", "with --mode", "leave one of them out");
  }
  if (settings.film) options.refuseIdle("--frame", "with --film", "leave one of them out");
  options.refuseBoth("--cut", "--uncut");
  options.refuseBoth("--mode", "--cell");
  if (uncut) settings.cutAxis = "none";
  settings.file = file;
  scene::writePicture(run, settings, std::cout);
  return true;
}

}  // namespace dovetail::program
