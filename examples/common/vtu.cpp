#include "common/report.hpp"
#include "dovetail/io_vtk/vtu_series.hpp"

namespace dovetail::example {

void writeVtu(const std::filesystem::path& folder, const std::string& name, double time,
              const dem::Particles& particles, const io::KeyValues& provenance) {
  io::VtuSeries series(folder, name, provenance);
  series.write(time, io::frameOf(particles));
}

}  // namespace dovetail::example
