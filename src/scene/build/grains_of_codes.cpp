#include "grains_of_codes.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "dovetail/core/finite.hpp"
#include "parts.hpp"

namespace dovetail::scene {

namespace {

void noteOnce(std::vector<std::string>& notes, const std::string& note) {
  if (std::find(notes.begin(), notes.end(), note) == notes.end()) notes.push_back(note);
}

std::string listOf(const std::map<std::int64_t, std::size_t>& types) {
  std::string text;
  for (const auto& [type, count] : types) {
    if (!text.empty()) text += ", ";
    text += std::to_string(type) + " (" + std::to_string(count) + " spheres)";
  }
  return text;
}

void requireType(const GrainsOfCode& wanted, const grain_io::GrainFile& file, std::vector<std::string>& notes) {
  std::map<std::int64_t, std::size_t> types;
  for (const std::int64_t type : file.type) ++types[type];
  if (wanted.type >= 0 && !types.contains(wanted.type))
    throw InputError("the file has no spheres of type " + std::to_string(wanted.type), wanted.file,
                     types.empty() ? "leave out \"type\": the file has none" : "it has the types " + listOf(types));
  if (wanted.type < 0 && types.size() > 1)
    noteOnce(notes, wanted.file + " has spheres of the types " + listOf(types) +
                        ": all are one group; several items with \"type\" make groups of their own.");
}

double densityOf(const GrainsOfCode& wanted, const grain_io::GrainFile& file) {
  if (wanted.density.has_value() != file.density.empty())
    throw InputError(wanted.density ? "the file has densities of its own" : "the file has no densities", wanted.file,
                     wanted.density ? "leave out \"density\"" : "write \"density\", in kg/m³");
  return wanted.density.value_or(0.0);
}

bool sameAlong(std::size_t axis, const geometry::Box& a, const geometry::Box& b) {
  const int c = static_cast<int>(axis);
  const double close = 1e-9 * (a.upper[c] - a.lower[c]);
  return std::abs(a.lower[c] - b.lower[c]) <= close && std::abs(a.upper[c] - b.upper[c]) <= close;
}

/// Whether the scene has these periods, and no others.
bool hasPeriods(const Scene& scene, const geometry::Box& box, const std::array<bool, 3>& axes) {
  for (std::size_t a = 0; a < 3; ++a) {
    const bool has = scene.periodic && scene.periodic->axes[a];
    if (has != axes[a] || (has && !sameAlong(a, box, scene.periodic->box))) return false;
  }
  return true;
}

void noteOnSpace(const GroupTarget& to, const GrainsOfCode& wanted, const grain_io::GrainFile& file) {
  if (!file.box) return;
  if (file.periodic) {
    if (hasPeriods(to.scene, *file.box, *file.periodic)) return;
    const bool any = (*file.periodic)[0] || (*file.periodic)[1] || (*file.periodic)[2];
    noteOnce(to.notes, "WARNING: " + wanted.file +
                           (any ? " is of another periodic space than the scene: write " +
                                      periodicKey(*file.box, *file.periodic) + "."
                                : " is of a space that is not periodic, as the scene is."));
    return;
  }
  const std::array<bool, 3> axes = to.scene.periodic ? to.scene.periodic->axes : std::array{true, true, true};
  if (hasPeriods(to.scene, *file.box, axes)) return;
  noteOnce(to.notes, wanted.file + " does not tell whether its box is periodic: if so, write " +
                         periodicKey(*file.box, axes) + " with the axes of LAMMPS' command boundary.");
}

}  // namespace

std::string periodicKey(const geometry::Box& box, const std::array<bool, 3>& axes) {
  const auto corner = [](const Vec3& x) {
    return "[" + formatNumber(x.x) + ", " + formatNumber(x.y) + ", " + formatNumber(x.z) + "]";
  };
  std::string names;
  for (std::size_t a = 0; a < 3; ++a) {
    if (!axes[a]) continue;
    if (!names.empty()) names += ", ";
    names += std::string("\"") + "xyz"[a] + '"';
  }
  return "\"periodic\": {\"box\": [" + corner(box.lower) + ", " + corner(box.upper) + "], \"axes\": [" + names + "]}";
}

void addGrainsOfCode(const GroupTarget& to, const GrainsOfCode& wanted, const grain_io::GrainFile& file) {
  requireMemory(static_cast<double>(file.size()), "spheres", BytesPer::grain, "take a smaller file");
  requireType(wanted, file, to.notes);
  const double density = densityOf(wanted, file);
  dem::Particles& particles = to.grains.particles;
  for (std::size_t i = 0; i < file.size(); ++i) {
    if (wanted.type >= 0 && file.type[i] != wanted.type) continue;
    const Vec3 velocity = file.velocity.empty() ? Vec3{} : file.velocity[i];
    dem::addParticle(particles, file.position[i], to.group.velocity + velocity, file.radius[i],
                     dem::Density{file.density.empty() ? density : file.density[i]});
    if (file.spin.empty() || norm(file.spin[i]) == 0.0) continue;
    dem::switchOnRotation(particles);
    particles.omega.back() = file.spin[i];
  }
  for (const std::string& note : file.notes) noteOnce(to.notes, note);
  noteOnSpace(to, wanted, file);
}

}  // namespace dovetail::scene
