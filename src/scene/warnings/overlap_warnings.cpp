// What does not go together in an overlap.
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <span>

#include "build/parts.hpp"
#include "dovetail/arlequin/arlequin_coupling.hpp"
#include "dovetail/arlequin/cells.hpp"
#include "dovetail/arlequin/constraint.hpp"
#include "dovetail/arlequin/coupling_options.hpp"
#include "dovetail/core/finite.hpp"
#include "dovetail/fem/mesh/mesh_quality.hpp"
#include "warnings.hpp"

namespace dovetail::scene {

namespace {

/// Bulk modulus of grains in a packing of this solid fraction, Pa: φ Z k/(3π d), six contacts each (those of a cubic
/// lattice, exactly). Walton, J. Mech. Phys. Solids 35 (1987), for springs.
double bulkModulusOf(const LinearContact& contact, double diameter, double solidFraction) {
  return solidFraction * 6.0 * contact.stiffness / (3.0 * std::numbers::pi * diameter);
}
double bulkModulusOf(const SolidMaterial& material) {
  return *youngsModulusOf(material) / (3.0 * (1.0 - 2.0 * poissonRatioOf(material)));
}

/// What lies between the borders of an overlap.
struct Shared {
  double mass = 0.0, volumeOfGrains = 0.0, diameter = 0.0;  ///< kg, m³, m (mean)
  double volume = 0.0, elementSize = 0.0;                   ///< m³; m, mean across the borders
  std::size_t grains = 0, elements = 0;
  std::size_t first = 0;  ///< number of one of the elements
};

/// Between the planes, or the boxes where they are nearest; m.
double thicknessOf(const Overlap& overlap) {
  if (!overlap.solidBox) return std::abs(*overlap.solidBorder - *overlap.particleBorder);
  double least = std::numeric_limits<double>::infinity();
  for (int axis = 0; axis < 3; ++axis)
    for (const double side : {overlap.solidBox->lower[axis] - overlap.particleBox->lower[axis],
                              overlap.particleBox->upper[axis] - overlap.solidBox->upper[axis]})
      if (side > 0.0) least = std::min(least, side);
  return least;
}

/// @param places    of the nodes, as overlapPlaces
/// @param byVolume  whether sizes are those of cubes of the same volume
void addElements(Shared& shared, const fem::SolidMesh& mesh, std::span<const double> places, double thickness,
                 bool byVolume) {
  const fem::MeshQuality quality = fem::measureQuality(mesh, 0);
  constexpr double margin = 1e-6;
  std::size_t number = 0;
  for (const fem::ElementGroup& group : mesh.groups) {
    const auto corners = static_cast<std::size_t>(fem::nodesOf(group.shape));
    for (std::size_t e = 0; e < group.size(); ++e, ++number) {
      double least = std::numeric_limits<double>::infinity(), most = -least;
      for (std::size_t a = 0; a < corners; ++a) {
        const double place = places[static_cast<std::size_t>(group.node[corners * e + a])];
        least = std::min(least, place), most = std::max(most, place);
      }
      if (least < -margin || most > 1.0 + margin) continue;
      if (shared.elements++ == 0) shared.first = number;
      shared.volume += quality.element[number].volume;
      shared.elementSize += byVolume ? std::cbrt(quality.element[number].volume) : thickness * (most - least);
    }
  }
  shared.elementSize /= static_cast<double>(std::max<std::size_t>(1, shared.elements));
}

double valueAt(const fem::SolidMesh& mesh, const fem::CellPlace& place, std::span<const double> nodal) {
  const arlequin::Cell cell = arlequin::cellOf(mesh, place.element);
  double sum = 0.0;
  for (std::size_t a = 0; a < cell.node.size(); ++a)
    sum += place.shape[a] * nodal[static_cast<std::size_t>(cell.node[a])];
  return sum;
}

Shared sharedPart(const Built& built, const arlequin::ArlequinCoupling& tie, const fem::SolidMesh& mesh,
                  const Overlap& overlap) {
  Shared shared;
  const dem::Particles& p = built.run->grains.particles;
  const std::vector<double> places = overlapPlaces(overlap, mesh.X);
  for (std::size_t k = 0; k < tie.overlap().size(); ++k) {
    const fem::CellPlace& host = tie.overlap().place[k];
    const double place = host.element < 0 ? -1.0 : valueAt(mesh, host, places);
    if (place < 0.0 || place > 1.0) continue;
    const auto i = static_cast<std::size_t>(tie.overlap().particle[k]);
    const double r = p.radius[i];
    ++shared.grains;
    shared.mass += p.mass[i];
    shared.volumeOfGrains += 4.0 / 3.0 * std::numbers::pi * r * r * r;
    shared.diameter += 2.0 * r;
  }
  shared.diameter /= static_cast<double>(std::max<std::size_t>(1, shared.grains));
  addElements(shared, mesh, places, thicknessOf(overlap), overlap.solidBox.has_value());
  return shared;
}

}  // namespace

std::string rounded(double value) {
  const double scale = std::pow(10.0, 2.0 - std::floor(std::log10(std::abs(value))));
  return formatNumber(value == 0.0 ? 0.0 : std::round(value * scale) / scale);
}

namespace {

void lookAtBorder(const fem::SolidMesh& mesh, const Overlap& overlap, const std::string& name, Lines& lines) {
  if (overlap.solidBox) return;
  const double border = *overlap.solidBorder;
  const auto along = [&](const Vec3& X) { return X[overlap.axis]; };
  const auto [first, last] = std::ranges::minmax(mesh.X, {}, along);
  const double lower = first[overlap.axis], upper = last[overlap.axis], margin = 0.1 * (upper - lower);
  if (border < lower - margin || border > upper + margin)
    lines.push_back("solid_border of " + name + " is " + rounded(border) + " m, and the solid reaches from " +
                    rounded(lower) + " to " + rounded(upper) + " m along " + "xyz"[overlap.axis] +
                    ": give the coordinate at which the solid ends within the grains.");
}

/// The solid ends at its border.
void lookBeyondBorder(const fem::SolidMesh& mesh, const Overlap& overlap, const std::string& name, Lines& lines) {
  if (overlap.solidBox) return;
  const auto count = std::ranges::count_if(overlapPlaces(overlap, mesh.X), [](double place) { return place < -0.5; });
  if (count > 0)
    lines.push_back(std::to_string(count) + " nodes lie beyond solid_border of " + name + " along " +
                    "xyz"[overlap.axis] + ", where the solid has no weight: swap the two borders, or check the axis.");
}

/// The hole of the solid is the box at which it ends.
void lookAtHole(const fem::SolidMesh& mesh, const Overlap& overlap, const std::string& name, Lines& lines) {
  if (!overlap.solidBox) return;
  constexpr double margin = 1e-6;
  const std::vector<double> places = overlapPlaces(overlap, mesh.X);
  const auto hole = mesh.nodeSets.find("hole");
  const bool isThere = hole != mesh.nodeSets.end();
  if (const auto count = std::ranges::count_if(places, [](double s) { return s < -margin; }); count > 0)
    lines.push_back(std::to_string(count) + " nodes lie in solid_box of " + name + ", where the solid has no weight: " +
                    (isThere ? "put the box on faces of elements." : "give its mesh this box as \"hole\"."));
  double farthest = 0.0;
  for (const int n : isThere ? hole->second : std::vector<int>{})
    if (const double s = places[static_cast<std::size_t>(n)]; s < 1.0) farthest = std::max(farthest, s);
  if (farthest > margin)
    lines.push_back("The hole of the solid ends outside of solid_box of " + name + ", by up to " + rounded(farthest) +
                    " of the way to particle_box, so that the weight of grains jumps there: put both on the same faces "
                    "of elements.");
}

void lookAtPenalty(const Overlap& overlap, const SolidMaterial& material, double elementSize, const std::string& name,
                   Lines& lines) {
  const double advised = arlequin::automaticPenalty(*youngsModulusOf(material), elementSize);
  if (overlap.penalty.word.empty() && overlap.penalty.number < 1e-4 * advised)
    lines.push_back("The penalty of " + name + " is " + rounded(overlap.penalty.number) +
                    " Pa/m2, too low to hold the gap: write \"auto\", or about " + rounded(advised) + " Pa/m2.");
}

}  // namespace

void lookAtOverlap(const Built& built, const Scene& scene, std::size_t solid, const Overlap& overlap, Lines& lines) {
  const auto ties = std::as_const(built.run->grains).terms.all<arlequin::ArlequinCoupling>();
  const auto found =
      std::find_if(ties.begin(), ties.end(), [&](const auto* tie) { return &tie->side() == &built.run->solid(solid); });
  if (found == ties.end()) return;
  const Solid& file = scene.solids[solid];
  lookAtBorder(built.meshes[solid], overlap, "the overlap with " + quoted(file.name), lines);
  lookBeyondBorder(built.meshes[solid], overlap, "the overlap with " + quoted(file.name), lines);
  lookAtHole(built.meshes[solid], overlap, "the overlap with " + quoted(file.name), lines);
  const Shared shared = sharedPart(built, **found, built.meshes[solid], overlap);
  const std::string name = "the overlap with " + quoted(file.name);
  if (shared.grains == 0 || shared.elements == 0) {
    lines.push_back("Between the borders of " + name +
                    " there is no whole element, or no grain: move them to where there are both.");
    return;
  }
  const SolidMaterial& material = *materialsOf(file)[materialByElement(file, built.meshes[solid])[shared.first]];
  const double thickness = thicknessOf(overlap);
  if (thickness < 1.99 * shared.elementSize || thickness < 2.9 * shared.diameter)
    lines.push_back(name + " is " + rounded(thickness) + " m thick, with elements of " + rounded(shared.elementSize) +
                    " m and grains of " + rounded(shared.diameter) +
                    " m: make it at least two elements and three grains thick.");
  if (overlap.constraint == static_cast<int>(arlequin::ConstraintKind::penalty))
    lookAtPenalty(overlap, material, shared.elementSize, name, lines);
  if (overlap.kernel > thickness)
    lines.push_back("The kernel of " + name + " is wider than the overlap is thick: take a width below " +
                    rounded(thickness) + " m.");
  if (const std::size_t voids = (*found)->state().voids; voids > 0)
    lines.push_back(std::to_string(voids) + " elements within " + name +
                    " hold no grain: take larger elements, or smaller grains.");
  const double bulk = shared.mass / shared.volume;
  if (std::abs(bulk / material.density - 1.0) > 0.15)
    lines.push_back("In " + name + " grains have " + rounded(bulk) + " kg/m3 and the solid " +
                    rounded(material.density) + ": give the solid the density " + rounded(bulk) + ".");
  const auto* const linear = scene.contact ? std::get_if<LinearContact>(&scene.contact->normal) : nullptr;
  if (!linear) return;
  const double grains = bulkModulusOf(*linear, shared.diameter, shared.volumeOfGrains / shared.volume);
  const double ratio = bulkModulusOf(material) / grains;
  if (ratio > 4.0 || ratio < 0.25)
    lines.push_back("In " + name + " the bulk modulus of the solid is " + rounded(ratio) +
                    " times that of the grains, about " + rounded(grains) +
                    " Pa, so that waves are reflected: bring youngs_modulus and stiffness closer.");
}

Lines strangersIn(const Built& built) {
  Lines lines;
  for (const auto* tie : std::as_const(built.run->grains).terms.all<arlequin::ArlequinCoupling>()) {
    const arlequin::OverlapState state = tie->state();
    if (state.strangers == 0) continue;
    const Vec3& x = state.strangerAt;
    lines.push_back(
        std::to_string(state.strangers) + " grains entered " + scene::quoted(tie->side().name) +
        " where its overlap does not constrain them, as clumps or beyond the border of the particles; the first is " +
        std::to_string(state.firstStranger) + ", seen at (" + rounded(x.x) + ", " + rounded(x.y) + ", " + rounded(x.z) +
        ") m: give the sides of the solid a surface coupling, and fill the overlap.");
  }
  return lines;
}

}  // namespace dovetail::scene
