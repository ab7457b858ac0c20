#include "grain_sources.hpp"

#include <numbers>
#include <sstream>

#include "build/sphere_table.hpp"
#include "dovetail/dem/model/checkpoint.hpp"
#include "dovetail/io/plain_text.hpp"
#include "run/checkpoints.hpp"

namespace dovetail::scene {

namespace {

namespace fs = std::filesystem;
using grain_io::GrainFile;

GrainFile grainsOfTable(const fs::path& file) {
  GrainFile grains;
  for (const SphereOfTable& sphere : spheresOfTable(file.string())) {
    grains.position.push_back(sphere.at);
    grains.radius.push_back(sphere.radius);
    grains.velocity.push_back(sphere.velocity);
    grains.spin.push_back(sphere.spin);
  }
  return grains;
}

double volumeOf(double radius) { return 4.0 / 3.0 * std::numbers::pi * radius * radius * radius; }

GrainFile grainsOfState(const Checkpoint& checkpoint, const fs::path& file) {
  const dem::Model content = dem::contentOf(coupling::particlesOf(checkpoint.state), file.string());
  const dem::Particles& particles = content.particles;
  GrainFile grains;
  std::size_t members = 0;
  for (std::size_t i = 0; i < particles.size(); ++i) {
    if (particles.isOfSolid(i)) continue;
    members += particles.isMember(i);
    grains.position.push_back(particles.x[i]);
    grains.radius.push_back(particles.radius[i]);
    grains.density.push_back(particles.mass[i] / volumeOf(particles.radius[i]));
    grains.velocity.push_back(particles.v[i]);
    if (particles.rotates()) grains.spin.push_back(particles.omega[i]);
    grains.id.push_back(particles.id[i]);
    grains.type.push_back(particles.material.empty() ? 0 : particles.material[i]);
  }
  if (members > 0)
    grains.notes.push_back("WARNING: " + std::to_string(members) +
                           " spheres are parts of clumps: they are written as single ones.");
  if (const geometry::Periodicity& space = content.pairs.periodicity(); space.any()) {
    grains.box = space.box;
    grains.periodic = space.axes;
  }
  grains.time = checkpoint.time;
  return grains;
}

GrainFile grainsOfSeries(const fs::path& series, std::int64_t frame) {
  const auto frames = framesOf(series);
  const auto all = static_cast<std::int64_t>(frames.size()), place = frame < 0 ? all + frame : frame;
  if (place < 0 || place >= all)
    throw InputError("there is no frame " + std::to_string(frame), series.string(),
                     "the series has " + std::to_string(all) + ", from 0");
  const auto& [time, file] = frames[static_cast<std::size_t>(place)];
  GrainFile grains = grainsOfFrame(file);
  grains.time = time;
  return grains;
}

GrainFile grainsOfCode(const fs::path& from, const ConvertOptions& settings) {
  const std::int64_t frame = settings.frame.value_or(-1);
  switch (grain_io::codeOf(io::readWhole(from, "a file"), from.string())) {
    case grain_io::Code::lammps:
      return grain_io::readLammps(from, settings.units, frame);
    case grain_io::Code::mercury:
      return grain_io::readMercury(from, frame);
    default:
      return grain_io::readYade(from);
  }
}

GrainFile readGrains(const fs::path& from, const ConvertOptions& settings) {
  const std::string ending = io::lower(from.extension().string());
  std::error_code error;
  if (fs::is_directory(from, error)) {
    if (settings.frame) return grainsOfSeries(from / "grains.pvd", *settings.frame);
    std::ostringstream told;
    GrainFile grains = grainsOfState(lastCheckpoint(from, told, Damaged::isLeft), from / "checkpoint.state");
    return grains;
  }
  if (ending == ".pvd") return grainsOfSeries(from, settings.frame.value_or(-1));
  if (ending == ".vtu" || ending == ".vtp" || ending == ".csv" || ending == ".state") {
    if (settings.frame) throw InputError("the file has one frame", from.string(), "leave out --frame");
    if (ending == ".state") return grainsOfState(loadCheckpoint(from), from);
    return ending == ".csv" ? grainsOfTable(from) : grainsOfFrame(from);
  }
  return grainsOfCode(from, settings);
}

}  // namespace

GrainFile grainsFrom(const fs::path& from, const ConvertOptions& settings) {
  GrainFile grains = readGrains(from, settings);
  if (settings.density) {
    if (!grains.density.empty())
      throw InputError("the file has densities of its own", from.string(), "leave out --density");
    grains.density.assign(grains.size(), *settings.density);
  }
  return grains;
}

}  // namespace dovetail::scene
