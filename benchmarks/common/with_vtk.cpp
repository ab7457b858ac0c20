#include <algorithm>

#include "common/outputs.hpp"
#include "dovetail/io_vtk/vtu_series.hpp"

namespace dovetail::benchmark {

namespace {

class VtuWriter : public FrameWriter {
public:
  VtuWriter(const std::filesystem::path& folder, const std::string& solid, const io::KeyValues& provenance)
      : particles_(folder, "particles", provenance) {
    if (!solid.empty()) solid_.emplace(folder, solid, provenance);
  }

  void write(const Frame& frame) override {
    if (solid_ && frame.nodes) writeSolid(frame);
    const dem::Particles& p = frame.particles;
    particles_.write(frame.time, io::ParticleFrame{p.x, p.radius, p.v, p.f, {}, {}, named(frame.particleScalars)});
  }

private:
  static std::vector<io::ScalarField> named(const Fields<double>& fields) {
    std::vector<io::ScalarField> named;
    for (const auto& [name, values] : fields) named.push_back({name, values});
    return named;
  }
  void writeSolid(const Frame& frame) {
    const fem::Nodes& nodes = *frame.nodes;
    points_.resize(nodes.X.size());
    for (std::size_t i = 0; i < points_.size(); ++i) points_[i] = nodes.X[i] + nodes.u[i];
    const std::vector<int>& node = frame.mesh->groups.front().node;
    bricks_.resize(node.size() / 8);
    for (std::size_t e = 0; e < bricks_.size(); ++e) std::copy_n(&node[8 * e], 8, bricks_[e].begin());
    io::HexFrame picture{points_, bricks_, {}, named(frame.nodeScalars), named(frame.cellScalars)};
    picture.pointVectors = {{"displacement_m", nodes.u}, {"velocity_m_per_s", nodes.v}};
    for (const auto& [name, values] : frame.nodeVectors) picture.pointVectors.push_back({name, values});
    solid_->write(frame.time, picture);
  }

  io::VtuSeries particles_;
  std::optional<io::VtuSeries> solid_;
  std::vector<Vec3> points_;
  std::vector<std::array<int, 8>> bricks_;
};

}  // namespace

std::unique_ptr<FrameWriter> makeFrameWriter(const std::filesystem::path& folder, const std::string& solid,
                                             const io::KeyValues& provenance) {
  return std::make_unique<VtuWriter>(folder, solid, provenance);
}

}  // namespace dovetail::benchmark
