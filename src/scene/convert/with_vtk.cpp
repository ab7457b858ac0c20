// Grains and meshes of frames.
#include "build/parts.hpp"
#include "dovetail/core/error.hpp"
#include "dovetail/io/output_folder.hpp"
#include "dovetail/io_vtk/frame_reader.hpp"
#include "dovetail/io_vtk/vtu_series.hpp"
#include "dovetail/solid_io_vtk/solid_vtu.hpp"
#include "grain_sources.hpp"

namespace dovetail::scene {

using grain_io::GrainFile;

namespace {

std::vector<Vec3> vectorsOf(const io::FrameContent& frame, const char* name) {
  const io::FrameArray* const array = frame.find(name, false);
  if (!array || array->components != 3) return {};
  std::vector<Vec3> vectors;
  for (std::size_t k = 0; k + 2 < array->values.size(); k += 3)
    vectors.push_back({array->values[k], array->values[k + 1], array->values[k + 2]});
  return vectors;
}

}  // namespace

GrainFile grainsOfFrame(const std::filesystem::path& file) {
  GrainFile grains;
  for (const MovingSphere& sphere : readSpheres(file.string())) {
    grains.position.push_back(sphere.at);
    grains.radius.push_back(sphere.radius);
    grains.velocity.push_back(sphere.velocity);
  }
  const io::FrameContent frame = io::readFrame(file);
  grains.spin = vectorsOf(frame, "spin");
  for (const Vec3& spin : grains.spin)
    if (!isFinite(spin)) throw InputError("a spin is not finite", file.string(), "give numbers");
  if (const io::FrameArray* const id = frame.find("id", false); id && id->components == 1)
    for (const double value : id->values) grains.id.push_back(static_cast<std::int64_t>(value));
  grains.time = frame.time;
  return grains;
}

std::vector<std::pair<double, std::filesystem::path>> framesOf(const std::filesystem::path& series) {
  auto frames = io::readPvd(series);
  if (frames.empty()) throw InputError("the series has no frames", series.string(), "give one with some");
  return frames;
}

void writeGrainFrame(const std::filesystem::path& to, const GrainFile& grains) {
  io::ParticleFrame frame{.position = grains.position,
                          .radius = grains.radius,
                          .velocity = grains.velocity,
                          .force = {},
                          .id = grains.id,
                          .vectors = {},
                          .scalars = {}};
  if (!grains.spin.empty()) frame.vectors.push_back({"spin", grains.spin});
  io::writeFileAtomically(to, io::vtuText(grains.time.value_or(0.0), frame, io::withMark(io::provenance())));
}

void writeMeshFrame(const std::filesystem::path& to, const fem::SolidMesh& mesh) {
  solid_io::writeVtu(to, mesh, {}, io::provenance());
}

}  // namespace dovetail::scene
