#include <algorithm>

#include "dovetail/io_vtk/vtu_series.hpp"
#include "output.hpp"

namespace dovetail::cantilever {

namespace {

class VtuWriter : public FrameWriter {
public:
  VtuWriter(const std::filesystem::path& folder, const Settings& settings)
      : beam_(folder, "beam", provenanceOf(settings)), particles_(folder, "particles", provenanceOf(settings)) {}

  void write(const Frame& frame) override {
    points_.resize(frame.nodes.X.size());
    for (std::size_t i = 0; i < points_.size(); ++i) points_[i] = frame.nodes.X[i] + frame.nodes.u[i];
    const std::vector<int>& node = frame.mesh.groups.front().node;
    bricks_.resize(node.size() / 8);
    for (std::size_t e = 0; e < bricks_.size(); ++e) std::copy_n(&node[8 * e], 8, bricks_[e].begin());
    io::HexFrame beam{points_, bricks_, {}, {}, {}};
    beam.pointVectors = {
        {"displacement_m", frame.nodes.u}, {"velocity_m_per_s", frame.nodes.v}, {"contact_load_N", frame.contactLoad}};
    beam.cellScalars = {{"strain_energy_J", frame.elementEnergy}};
    beam_.write(frame.time, beam);
    const dem::Particles& p = frame.particles;
    particles_.write(frame.time, io::ParticleFrame{p.x, p.radius, p.v, p.f, {}, {}, {}});
  }

private:
  io::VtuSeries beam_, particles_;
  std::vector<Vec3> points_;
  std::vector<std::array<int, 8>> bricks_;
};

}  // namespace

std::unique_ptr<FrameWriter> makeFrameWriter(const std::filesystem::path& folder, const Settings& settings) {
  return std::make_unique<VtuWriter>(folder, settings);
}

}  // namespace dovetail::cantilever
