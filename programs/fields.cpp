// dovetail fields: coarse-grained fields of a saved run.
#include <iostream>
#include <map>
#include <memory>

#include "dovetail/scene/grid_fields.hpp"
#include "verbs.hpp"

namespace dovetail::program {

namespace {
struct Options {
  std::string run, file;
  scene::GridOptions settings;
  std::vector<double> box;
};
}  // namespace

Verb addFields(CLI::App& app) {
  CLI::App* const verb =
      app.add_subcommand("fields", "density, velocity, stress … of a run's last checkpoint on a grid, as a VTI file");
  const auto options = std::make_shared<Options>();
  const std::map<std::string, cg::KernelShape> shapes{{"lucy", cg::KernelShape::lucy},
                                                      {"gauss", cg::KernelShape::gauss}};
  verb->add_option("RUN", options->run, "folder of a run with a checkpoint")->required();
  verb->add_option("--out", options->file, "file; RUN/fields.vti if not given");
  verb->add_option("--kernel", options->settings.shape, "lucy or gauss")->transform(CLI::CheckedTransformer(shapes));
  CLI::Option* const width =
      verb->add_option("--width", options->settings.width, "of the kernel, m; 1.5 mean diameters if not given");
  verb->add_flag("--advise-width", options->settings.advisesWidth,
                 "take the width on which density and velocity depend least; prints how flat that optimum is")
      ->excludes(width);
  verb->add_option("--spacing", options->settings.spacing, "of the points, m; half the width if not given");
  verb->add_option("--box", options->box,
                   "x y z of the lower and of the upper corner, m; around all grains if not given")
      ->expected(6);
  return {verb, [options] {
            scene::GridOptions settings = options->settings;
            const std::vector<double>& b = options->box;
            if (!b.empty()) settings.box = geometry::Box{{b[0], b[1], b[2]}, {b[3], b[4], b[5]}};
            settings.file = options->file.empty() ? std::filesystem::path(options->run) / "fields.vti"
                                                  : std::filesystem::path(options->file);
            scene::writeGridFields(options->run, settings, std::cout);
            return 0;
          }};
}

}  // namespace dovetail::program
