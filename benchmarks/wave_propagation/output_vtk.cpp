#include <algorithm>
#include <optional>

#include "dovetail/io/provenance.hpp"
#include "dovetail/io_vtk/vtu_series.hpp"
#include "output.hpp"

namespace dovetail::wave {

namespace {

class VtuWriter : public FrameWriter {
public:
  VtuWriter(const std::filesystem::path& folder, const Settings& settings)
      : particleMass_(particleMass(settings)), particles_(folder, "particles", io::provenance(describe(settings))) {
    if (!settings.fullDem) solid_.emplace(folder, "solid", io::provenance(describe(settings)));
  }

  void write(const Frame& frame) override {
    if (solid_ && frame.model.solid) writeSolid(frame);
    const dem::Particles& p = frame.model.discrete.particles;
    share_.resize(p.size());
    for (std::size_t i = 0; i < p.size(); ++i) share_[i] = p.mass[i] / particleMass_;
    particles_.write(frame.time, io::ParticleFrame{p.x, p.radius, p.v, p.f, {}, {}, {{"particles_share", share_}}});
  }

private:
  void writeSolid(const Frame& frame) {
    const arlequin::Solid& solid = *frame.model.solid;
    points_.resize(solid.nodes().X.size());
    for (std::size_t i = 0; i < points_.size(); ++i) points_[i] = solid.nodes().X[i] + solid.nodes().u[i];
    cells_.resize(solid.mesh.elementCount());
    for (std::size_t e = 0; e < cells_.size(); ++e)
      std::ranges::copy(arlequin::cellOf(solid.mesh, static_cast<int>(e)).node, cells_[e].begin());
    io::HexFrame picture{points_, cells_, {}, {}, {}};
    picture.pointVectors = {{"displacement_m", solid.nodes().u}, {"velocity_m_per_s", solid.nodes().v}};
    picture.pointScalars = {{"particles_share", frame.model.coupling->overlap.nodalWeight}};
    solid_->write(frame.time, picture);
  }

  double particleMass_;
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
