// dovetail fields: coarse-grained fields of a saved run.
#include <iostream>
#include <sstream>

#include "dovetail/scene/grid_fields.hpp"
#include "program/options.hpp"
#include "verbs.hpp"

namespace dovetail::program {

namespace {

geometry::Box boxIn(const std::string& text) {
  std::istringstream words(text);
  geometry::Box box;
  std::string word;
  for (Vec3* const corner : {&box.lower, &box.upper})
    for (int k = 0; k < 3 && words >> word; ++k) (*corner)[k] = numberFrom<double>(word, "--box");
  return box;
}

}  // namespace

bool writeFields(int argc, char** argv) {
  std::string run, file, axis;
  scene::GridOptions settings;
  const Range length = positive("a positive length in metres");
  Options options("dovetail fields",
                  "Density, velocity, stress … of a run's last checkpoint on a grid, as a VTI file.");
  options.text("RUN", run, "folder of a run with a checkpoint").require();
  options.text("--out FILE", file, "RUN/fields.vti, or RUN/profile_z.csv, if not given");
  options.choice("--kernel", settings.shape, "lucy|gauss", "its shape");
  options.number("--width W", settings.width, length, "of the kernel, m; 1.5 mean diameters if not given");
  options.flag("--advise-width", settings.advisesWidth,
               "take the width on which density and velocity depend least; prints how flat that optimum is");
  options.number("--spacing H", settings.spacing, length, "of the points, m; half the width if not given");
  options.add("--box X Y Z X Y Z", "lower and upper corner, m; around all grains if not given",
              [&](const std::string& text) { settings.box = boxIn(text); }, {});
  options.word("--profile", axis, "x|y|z", "means over layers across this axis, with standard errors, as a CSV file");
  if (!options.parse(argc, argv)) return true;
  options.refuseBoth("--width", "--advise-width");
  if (!axis.empty()) settings.profile = axis[0] - 'x';
  const std::string name = axis.empty() ? "fields.vti" : "profile_" + axis + ".csv";
  settings.file = file.empty() ? std::filesystem::path(run) / name : std::filesystem::path(file);
  scene::writeGridFields(run, settings, std::cout);
  return true;
}

}  // namespace dovetail::program
