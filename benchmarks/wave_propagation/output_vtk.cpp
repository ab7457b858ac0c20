#include <algorithm>
#include <optional>

#include "dovetail/io_vtk/vtu_series.hpp"
#include "output.hpp"

namespace dovetail::wave {

namespace {

class VtuWriter : public FrameWriter {
public:
  VtuWriter(const std::filesystem::path& folder, const Settings& settings)
      : particles_(folder, "particles", provenanceOf(settings)) {
    if (!settings.fullDem) solid_.emplace(folder, "solid", provenanceOf(settings));
  }

  void write(const Frame& frame) override {
    if (solid_ && frame.bar.solid) writeSolid(frame);
    const dem::Particles& p = frame.bar.run->grains.particles;
    share_.resize(p.size());
    for (std::size_t i = 0; i < p.size(); ++i) share_[i] = p.weightOf(i);
    particles_.write(frame.time, io::ParticleFrame{p.x, p.radius, p.v, p.f, {}, {}, {{"particles_share", share_}}});
  }

private:
  void writeSolid(const Frame& frame) {
    const fem::Nodes& nodes = frame.bar.solid->nodes();
    const fem::SolidMesh& mesh = frame.bar.mesh;
    points_.resize(nodes.X.size());
    for (std::size_t i = 0; i < points_.size(); ++i) points_[i] = nodes.X[i] + nodes.u[i];
    cells_.resize(mesh.elementCount());
    for (std::size_t e = 0; e < cells_.size(); ++e)
      std::ranges::copy(arlequin::cellOf(mesh, static_cast<int>(e)).node, cells_[e].begin());
    io::HexFrame picture{points_, cells_, {}, {}, {}};
    picture.pointVectors = {{"displacement_m", nodes.u}, {"velocity_m_per_s", nodes.v}};
    picture.pointScalars = {{"particles_share", frame.bar.tie->overlap().nodalWeight}};
    solid_->write(frame.time, picture);
  }

  io::VtuSeries particles_;
  std::optional<io::VtuSeries> solid_;
  std::vector<Vec3> points_;
  std::vector<std::array<int, 8>> cells_;
  std::vector<double> share_;
};

}  // namespace

std::unique_ptr<FrameWriter> makeFrameWriter(const std::filesystem::path& folder, const Settings& settings) {
  return std::make_unique<VtuWriter>(folder, settings);
}

}  // namespace dovetail::wave
