#include "dovetail/scene/grid_fields.hpp"

#include <ostream>

#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"
#include "dovetail/io/output_folder.hpp"
#include "dovetail/io_vtk/vtu_series.hpp"
#include "dovetail/scene/execute.hpp"
#include "field_profile.hpp"
#include "run/checkpoints.hpp"

namespace dovetail::scene {

namespace {

std::string textOf(const SampledFields& sample, const io::KeyValues& provenance) {
  io::GridFrame frame{sample.grid.lower, sample.grid.spacing, sample.grid.count, {}};
  const std::vector<NamedField> fields = namedFields(sample.fields);
  for (const NamedField& field : fields) frame.fields.push_back({field.name, field.values, field.components});
  return io::vtiText(sample.time, frame, provenance);
}

}  // namespace

void writeGridFields(const std::filesystem::path& folder, const GridOptions& settings, std::ostream& log) {
  const char* const ending = settings.profile ? ".csv" : ".vti";
  if (settings.file.extension() != ending)
    throw InputError(settings.profile ? "profiles are CSV files" : "fields on a grid are written as a VTI file",
                     settings.file.string(), std::string("give a name that ends in ") + ending);
  io::requireFreeOrOurs(settings.file);
  const SampledFields sample = sampleFields(folder, settings, log);
  const cg::Grid& grid = sample.grid;
  const double width = sample.kernel.width;
  const io::KeyValues provenance =
      io::provenance({{"scene", hashOf(identityOf(readRun(folder)))},
                      {"kernel", settings.shape == cg::KernelShape::lucy ? "lucy" : "gauss"},
                      {"width", formatNumber(width) + " m"}});
  if (settings.profile)
    io::writeCsv(settings.file, profileOf(grid, sample.fields, *settings.profile, width), provenance);
  else
    io::writeFileAtomically(settings.file, textOf(sample, provenance));
  log << grid.count[0] << " x " << grid.count[1] << " x " << grid.count[2] << " points of " << grid.spacing.x
      << " m, kernel of " << width << " m, t = " << sample.time << " s: " << settings.file.string() << '\n';
}

}  // namespace dovetail::scene
