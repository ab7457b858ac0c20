// dovetail compare: two runs side by side.
#include "dovetail/scene/compare.hpp"

#include <iostream>
#include <memory>

#include "dovetail/core/finite.hpp"
#include "verbs.hpp"

namespace dovetail::program {

namespace {
struct Options {
  std::string first, second;
  double tolerance = 1e-9;
  std::size_t rows = 20;
};
}  // namespace

Verb addCompare(CLI::App& app) {
  CLI::App* const verb =
      app.add_subcommand("compare", "compares two runs, or two series, frames or states; exit code 1 if they differ");
  const auto options = std::make_shared<Options>();
  verb->add_option("A", options->first, "folder of a run, or file")->required();
  verb->add_option("B", options->second, "of the same kind")->required();
  verb->add_option("--tolerance", options->tolerance, "of differences over the scale of their quantity")
      ->capture_default_str();
  verb->add_option("--rows", options->rows, "of the table, at most")->capture_default_str();
  return {verb, [options] {
            requireNonNegative(options->tolerance, "--tolerance");
            const scene::Comparison comparison = scene::compare(options->first, options->second);
            scene::print(comparison, options->tolerance, options->rows, std::cout);
            return comparison.within(options->tolerance) ? 0 : 1;
          }};
}

}  // namespace dovetail::program
