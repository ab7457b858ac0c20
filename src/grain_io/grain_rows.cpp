#include "grain_rows.hpp"

#include <cmath>
#include <numbers>

#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"

namespace dovetail::grain_io {

std::vector<std::string_view> wordsOf(std::string_view line) {
  constexpr const char* blanks = " \t\r\v\f\n";
  std::vector<std::string_view> words;
  for (std::size_t begin = line.find_first_not_of(blanks); begin != std::string_view::npos;
       begin = line.find_first_not_of(blanks, begin)) {
    const std::size_t end = std::min(line.find_first_of(blanks, begin), line.size());
    words.push_back(line.substr(begin, end - begin));
    begin = end;
  }
  return words;
}

double densityOf(double mass, double radius) {
  return mass / (4.0 / 3.0 * std::numbers::pi * radius * radius * radius);
}

void GrainRows::requireSound(const Row& row) const {
  constexpr double farthest = 1e15;  // m, as of dem::addParticle
  for (int c = 0; c < 3; ++c)
    if (!(std::abs(row.position[c] * scale_.length) <= farthest))
      source_.refuse("a sphere lies at " + formatNumber(row.position[c]), "give coordinates within 1e15 m");
  if (!(row.radius * scale_.length > 0.0 && std::isfinite(row.radius * scale_.length)))
    source_.refuse("a radius is " + formatNumber(row.radius), "give one that is > 0; points have no contacts");
  if (row.density && !(*row.density > 0.0 && std::isfinite(*row.density)))
    source_.refuse("a density is " + formatNumber(*row.density), "give spheres a mass > 0");
}

void GrainRows::add(const Row& row) {
  requireSound(row);
  if (row.id && !byId_.try_emplace(*row.id, file.size()).second)
    source_.refuse("the id " + std::to_string(*row.id) + " occurs twice", "give every sphere its own");
  const double length = scale_.length;
  file.position.push_back(length * row.position);
  file.radius.push_back(length * row.radius);
  if (row.density) file.density.push_back(*row.density * (scale_.mass / (length * length * length)));
  if (row.velocity) file.velocity.push_back(length / scale_.time * *row.velocity);
  if (row.spin) file.spin.push_back(1.0 / scale_.time * *row.spin);
  if (row.id) file.id.push_back(*row.id);
  if (row.type) file.type.push_back(*row.type);
}

void GrainRows::setMotion(std::int64_t id, const Vec3& velocity, const Vec3& spin) {
  const auto found = byId_.find(id);
  if (found == byId_.end()) source_.refuse("there is no sphere of id " + std::to_string(id), "correct the id");
  moves_.resize(file.size(), 0);
  file.velocity.resize(file.size());
  file.spin.resize(file.size());
  if (moves_[found->second]++)
    source_.refuse("the velocity of id " + std::to_string(id) + " is given twice", "give it once");
  file.velocity[found->second] = scale_.length / scale_.time * velocity;
  file.spin[found->second] = 1.0 / scale_.time * spin;
}

GrainFile GrainRows::finish() {
  if (file.size() == 0)
    throw InputError("the file has no spheres", source_.name(), "give one with spheres, or leave it out");
  return std::move(file);
}

std::size_t frameAt(std::int64_t frame, std::size_t count, const std::string& where) {
  const auto all = static_cast<std::int64_t>(count), place = frame < 0 ? all + frame : frame;
  if (place < 0 || place >= all)
    throw InputError(
        "there is no frame " + std::to_string(frame), where,
        "the file has " + std::to_string(count) + ": give 0 to " + std::to_string(all - 1) + ", or −1 for the last");
  return static_cast<std::size_t>(place);
}

}  // namespace dovetail::grain_io
