#include <algorithm>

#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"
#include "dovetail/grain_io/grain_files.hpp"
#include "dovetail/io/provenance.hpp"

namespace dovetail::grain_io {

namespace {

void requireLength(std::size_t length, const GrainFile& grains, const char* what, bool needed = false) {
  if (length == grains.size() || (length == 0 && !needed)) return;
  throw InputError(
      "there are " + std::to_string(length) + " " + what + " of " + std::to_string(grains.size()) + " spheres",
      "LAMMPS data", std::string("give ") + what + " to all");
}

void requireWhole(const GrainFile& grains) {
  requireLength(grains.radius.size(), grains, "radii", true);
  requireLength(grains.density.size(), grains, "densities", true);
  requireLength(grains.velocity.size(), grains, "velocities");
  requireLength(grains.spin.size(), grains, "spins");
  requireLength(grains.id.size(), grains, "ids");
  requireLength(grains.type.size(), grains, "types");
}

geometry::Box boxOf(const GrainFile& grains) {
  if (grains.box) return *grains.box;
  geometry::Box box{grains.position.front(), grains.position.front()};
  for (std::size_t i = 0; i < grains.size(); ++i)
    for (int c = 0; c < 3; ++c) {
      box.lower[c] = std::min(box.lower[c], grains.position[i][c] - grains.radius[i]);
      box.upper[c] = std::max(box.upper[c], grains.position[i][c] + grains.radius[i]);
    }
  return box;
}

void append(std::string& text, const Vec3& v) {
  for (int c = 0; c < 3; ++c) text += ' ' + formatNumber(v[c]);
}

bool anyMoves(const std::vector<Vec3>& vectors) {
  return std::any_of(vectors.begin(), vectors.end(), [](const Vec3& v) { return norm(v) > 0.0; });
}

/// LAMMPS counts ids from 1.
std::int64_t shiftOf(const std::vector<std::int64_t>& numbers) {
  return numbers.empty() ? 0 : std::max<std::int64_t>(0, 1 - *std::min_element(numbers.begin(), numbers.end()));
}

}  // namespace

std::string lammpsText(const GrainFile& grains) {
  if (grains.size() == 0) throw InputError("there are no spheres", "LAMMPS data", "give some");
  requireWhole(grains);
  const std::int64_t idShift = shiftOf(grains.id), typeShift = shiftOf(grains.type);
  const auto idOf = [&](std::size_t i) {
    return std::to_string(grains.id.empty() ? static_cast<std::int64_t>(i) + 1 : grains.id[i] + idShift);
  };
  const auto typeOf = [&](std::size_t i) { return grains.type.empty() ? 1 : grains.type[i] + typeShift; };
  std::int64_t types = 1;
  for (std::size_t i = 0; i < grains.size(); ++i) types = std::max(types, typeOf(i));
  std::string text = "spheres, written by dovetail " + io::buildInfo().version + ", units = si\n\n" +
                     std::to_string(grains.size()) + " atoms\n" + std::to_string(types) + " atom types\n\n";
  const geometry::Box box = boxOf(grains);
  for (int c = 0; c < 3; ++c) {
    const std::string axis(1, "xyz"[c]);
    text += formatNumber(box.lower[c]) + ' ' + formatNumber(box.upper[c]) + ' ' + axis + "lo " + axis + "hi\n";
  }
  text += "\nAtoms # sphere\n\n";
  for (std::size_t i = 0; i < grains.size(); ++i) {
    text += idOf(i) + ' ' + std::to_string(typeOf(i)) + ' ' + formatNumber(2.0 * grains.radius[i]) + ' ' +
            formatNumber(grains.density[i]);
    append(text, grains.position[i]);
    text += '\n';
  }
  if (!anyMoves(grains.velocity) && !anyMoves(grains.spin)) return text;
  text += "\nVelocities\n\n";
  for (std::size_t i = 0; i < grains.size(); ++i) {
    text += idOf(i);
    append(text, grains.velocity.empty() ? Vec3{} : grains.velocity[i]);
    append(text, grains.spin.empty() ? Vec3{} : grains.spin[i]);
    text += '\n';
  }
  return text;
}

}  // namespace dovetail::grain_io
