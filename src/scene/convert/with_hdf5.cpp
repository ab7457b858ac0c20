// Series of frames of grains in one file.
#include "dovetail/io_hdf5/vtkhdf.hpp"
#include "grain_sources.hpp"

namespace dovetail::scene {

void writeGrainSeries(const std::filesystem::path& to, const std::vector<grain_io::GrainFile>& frames) {
  std::vector<io::HdfPoints> points;
  for (const grain_io::GrainFile& grains : frames) {
    const auto flat = [](const std::vector<Vec3>& vectors) {
      return vectors.empty() ? std::span<const double>{} : std::span<const double>{&vectors[0].x, 3 * vectors.size()};
    };
    io::HdfPoints& one = points.emplace_back(io::HdfPoints{grains.time.value_or(0.0), grains.position, {}, {}});
    one.fields.push_back({"radius", grains.radius, 1});
    if (!grains.velocity.empty()) one.fields.push_back({"velocity", flat(grains.velocity), 3});
    if (!grains.spin.empty()) one.fields.push_back({"spin", flat(grains.spin), 3});
    if (!grains.density.empty()) one.fields.push_back({"density", grains.density, 1});
    if (!grains.id.empty()) one.integers.push_back({"id", grains.id});
    if (!grains.type.empty()) one.integers.push_back({"type", grains.type});
  }
  io::writeVtkHdfSeries(to, points, io::provenance());
}

}  // namespace dovetail::scene
