// Frames of grains and solids in VTU files.
#include "dovetail/fem/model/model.hpp"
#include "dovetail/io_vtk/vtu_series.hpp"
#include "dovetail/solid_io_vtk/solid_vtu.hpp"
#include "outputs.hpp"

namespace dovetail::scene {

struct Frames::Impl {
  io::KeyValues provenance;
  std::vector<double> times;
  io::VtuSeries grains;
  std::vector<io::VtuSeries> solids{};
};

Frames::Frames(const Built& built, const std::filesystem::path& folder, const io::KeyValues& provenance,
               const std::vector<double>& times)
    : impl_(std::make_unique<Impl>(Impl{provenance, times, io::VtuSeries(folder, "grains", provenance, times)})) {
  for (std::size_t s = 0; s < built.meshes.size(); ++s)
    impl_->solids.emplace_back(folder, "solid_" + built.run->solid(s).name, provenance, times);
}
Frames::~Frames() = default;

std::vector<double> Frames::times() const { return impl_->times; }

void Frames::add(const Built& built) {
  const double time = built.run->time();
  const dem::Particles& particles = built.run->grains.particles;
  impl_->grains.write(time, {.position = particles.x,
                             .radius = particles.radius,
                             .velocity = particles.v,
                             .force = particles.f,
                             .id = particles.id,
                             .vectors = {},
                             .scalars = {}});
  for (std::size_t s = 0; s < built.meshes.size(); ++s) {
    const fem::Nodes& nodes = built.run->solid(s).nodes();
    const std::span<const double> velocity(&nodes.v[0].x, 3 * nodes.v.size());
    impl_->solids[s].write(
        time, solid_io::vtuText(built.meshes[s], {.perPoint = {{"velocity", velocity, 3}}, .displacement = nodes.u},
                                io::withMark(impl_->provenance)));
  }
  impl_->times.push_back(time);
}

}  // namespace dovetail::scene
