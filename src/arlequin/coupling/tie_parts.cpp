#include "tie_parts.hpp"

#include <algorithm>
#include <limits>
#include <string>
#include <utility>

#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"
#include "dovetail/core/parallel.hpp"
#include "dovetail/dem/model/loads.hpp"
#include "dovetail/fem/elements/solid.hpp"
#include "dovetail/fem/laws/material_probe.hpp"

namespace dovetail::arlequin {

namespace {

/// By rows for the local map and for the nodal form; wide kernels at the particles need the metric of their rows.
bool penaltyIsLocal(const CouplingOptions& options) {
  return options.projection.width == 0.0 || options.form == GapForm::nodal;
}

/// Dashpots and penalties per node or element of the mesh are scaled by volumes of the rows.
bool needsVolumes(const CouplingOptions& o) {
  if (o.constraint != ConstraintKind::penalty) return o.constraint == ConstraintKind::dashpot;
  return penaltyIsLocal(o) && (o.form == GapForm::nodal || o.projection.perElement);
}

std::unique_ptr<Constraint> penalty(const TieSetting& setting, const Overlap& overlap, const TieParts& parts) {
  const CouplingOptions& o = setting.options;
  if (!penaltyIsLocal(o)) return makeMetricPenalty(parts.gap, parts.stiffness, 1.0);
  if (o.form == GapForm::atParticles && !o.projection.perElement)
    return makePenalty(sumsAtRows(parts.gap, overlap, setting.mesh, parts.stiffness));
  std::vector<double> stiffness = parts.gap.volume;
  double largest = 0.0;
  for (const int e : overlap.elements) largest = std::max(largest, setting.penalty[static_cast<std::size_t>(e)]);
  for (double& value : stiffness) value *= largest;
  return makePenalty(std::move(stiffness));
}

}  // namespace

std::vector<double> penaltyOfElements(const fem::SolidMesh& mesh, const fem::Model& solid, const CouplingOptions& o) {
  if (o.constraint == ConstraintKind::multiplier) return std::vector<double>(mesh.elementCount(), 0.0);
  if (o.penalty > 0.0 || o.constraint == ConstraintKind::dashpot)
    return std::vector<double>(mesh.elementCount(), requirePositive(o.penalty, "penalty"));
  std::vector<double> p(mesh.elementCount(), 0.0);
  for (const auto& term : solid.terms)
    if (const auto* const elements = dynamic_cast<const fem::Solid*>(term.get())) {
      if (elements->material() == nullptr)
        throw InputError("\"" + elements->name() + "\" is a field of points, whose modulus is unknown", "penalty",
                         "give the penalty, about 20 E/h² of the element size h");
      const double young = fem::youngsModulus(*elements->material());
      for (std::size_t e = 0; e < elements->size(); ++e)
        p[static_cast<std::size_t>(elements->number(e))] =
            automaticPenalty(young, elementSize(mesh, elements->number(e)));
    }
  return p;
}

double bulkDensityOf(const Overlap& overlap, const fem::SolidMesh& mesh, const dem::Particles& particles) {
  std::vector<double> mass(mesh.elementCount(), 0.0), density;
  for (std::size_t k = 0; k < overlap.size(); ++k)
    if (overlap.place[k].element >= 0)
      mass[static_cast<std::size_t>(overlap.place[k].element)] +=
          particles.mass[static_cast<std::size_t>(overlap.particle[k])];
  for (const int e : overlap.elements)
    if (std::ranges::all_of(cellOf(mesh, e).corner(),
                            [&](int n) { return overlap.nodalWeight[static_cast<std::size_t>(n)] > 0.0; }))
      density.push_back(mass[static_cast<std::size_t>(e)] / cellVolume(mesh, e));
  if (density.empty())
    for (const int e : overlap.elements) density.push_back(mass[static_cast<std::size_t>(e)] / cellVolume(mesh, e));
  const auto middle = density.begin() + static_cast<std::ptrdiff_t>(density.size() / 2);
  std::nth_element(density.begin(), middle, density.end());
  return *middle;
}

namespace {

/// Hats of a member at the corners of its element.
template <class Visit>
void eachCorner(const TieSetting& setting, const fem::CellPlace& place, Visit&& visit) {
  if (place.element < 0) return;
  const Cell cell = cellOf(setting.mesh, place.element);
  const std::vector<double> vertexShape = vertexShapes(cell.shape, place.xi);
  for (std::size_t a = 0; a < vertexShape.size(); ++a)
    visit(static_cast<std::size_t>(cell.corner()[a]), vertexShape[a]);
}

/// Members that are lost among others: the finest hundredth of the mass at all corners of their elements, where sizes
/// differ by more than four. A mean by mass does not hold such a speck, but would throw it by its weight of λ if
/// nothing else holds it.
std::vector<char> specksOf(const TieSetting& setting, const Overlap& overlap, const dem::Particles& particles) {
  constexpr double few = 0.01, alike = 4.0;
  std::vector<char> isSpeck(overlap.size(), 0);
  const auto radius = [&](std::size_t k) { return particles.radius[static_cast<std::size_t>(overlap.particle[k])]; };
  double least = std::numeric_limits<double>::infinity(), most = 0.0;
  for (std::size_t k = 0; k < overlap.size(); ++k) least = std::min(least, radius(k)), most = std::max(most, radius(k));
  if (!(most > alike * least)) return isSpeck;
  std::vector<std::vector<std::pair<double, double>>> finer(
      setting.mesh.X.size());  // radius; mass, then that of all finer
  for (std::size_t k = 0; k < overlap.size(); ++k)
    eachCorner(setting, overlap.place[k], [&](std::size_t n, double vertexShape) {
      finer[n].emplace_back(radius(k), vertexShape * particles.mass[static_cast<std::size_t>(overlap.particle[k])]);
    });
  for (auto& node : finer) {
    std::ranges::sort(node);
    for (std::size_t j = 1; j < node.size(); ++j) node[j].second += node[j - 1].second;
  }
  for (std::size_t k = 0; k < overlap.size(); ++k) {
    bool isLost = alike * radius(k) < most && overlap.place[k].element >= 0;
    eachCorner(setting, overlap.place[k], [&](std::size_t n, double) {
      const auto next =
          std::ranges::upper_bound(finer[n], radius(k), {}, [](const auto& entry) { return entry.first; });
      isLost = isLost && std::prev(next)->second < few * finer[n].back().second;
    });
    isSpeck[k] = isLost ? 1 : 0;
  }
  return isSpeck;
}

}  // namespace

TieParts makeParts(const TieSetting& setting, const Overlap& overlap, const dem::Model& m) {
  constexpr double hardly = 1e-6;  // of a speck's mass counts
  TieParts parts;
  std::vector<double> mass = m.particles.mass;
  const std::vector<char> isSpeck = specksOf(setting, overlap, m.particles);
  for (std::size_t k = 0; k < overlap.size(); ++k) {
    const auto i = static_cast<std::size_t>(overlap.particle[k]);
    if (isSpeck[k]) mass[i] *= hardly;
    const int element = overlap.place[k].element;
    const double p = element < 0 ? 0.0 : setting.penalty[static_cast<std::size_t>(element)];
    parts.stiffness.push_back(p * mass[i] / setting.bulkDensity);
  }
  parts.gap = makeGapOperator(overlap, setting.mesh, mass, setting.options.form, setting.options.projection, {},
                              needsVolumes(setting.options) ? RowVolumes::integrated : RowVolumes::leftOut);
  const cg::Projection& members = parts.gap.particles;
  for (int r = 0; r < members.rows(); ++r) {
    double length = 0.0;
    for (int e = members.offsets[r]; e < members.offsets[r + 1]; ++e) {
      const int particle = overlap.particle[static_cast<std::size_t>(members.column[e])];
      length += members.weight[e] * slipLengthOf(m.particles.radius[static_cast<std::size_t>(particle)]);
    }
    parts.slipLength.push_back(length);
  }
  return parts;
}

void addConstraint(const TieSetting& setting, const Overlap& overlap, const dem::Model& m,
                   const coupling::SolidSide& side, TieParts& parts, std::unique_ptr<Constraint> before) {
  const CouplingOptions& o = setting.options;
  switch (o.constraint) {
    case ConstraintKind::penalty:
      parts.constraint = penalty(setting, overlap, parts);
      break;
    case ConstraintKind::dashpot:
      parts.constraint = makeDashpot(parts.gap, o.penalty, o.consistentDashpot);
      break;
    case ConstraintKind::multiplier:
      if (side.mass == nullptr)
        throw InputError("the solid \"" + side.name + "\" has no mass yet", "overlap",
                         "set the mass of its side first");
      parts.constraint = makeMultiplier(parts.gap, overlap, yieldingMasses(m), *side.mass, std::move(before));
      break;
  }
  if (!(o.absorberRate > 0.0)) return;
  std::vector<double> mass(m.particles.size());
  for (std::size_t i = 0; i < mass.size(); ++i) mass[i] = m.particles.weightOf(i) * m.particles.mass[i];
  parts.absorber = std::make_unique<Absorber>(overlap, parts.gap, interpolationAtParticles(overlap, setting.mesh), mass,
                                              o.absorberRate);
}

std::vector<double> yieldingMasses(const dem::Model& m) {
  std::vector<double> mass(m.particles.size());
  parallelFor(mass.size(), 4096, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) mass[i] = m.particles.weightOf(i) * m.particles.mass[i];
  });
  for (const auto* drive : m.terms.all<dem::DriveTerm>())
    for (const std::int64_t id : drive->ids())
      if (const int i = dem::find(m.particles, id); i >= 0)
        mass[static_cast<std::size_t>(i)] = std::numeric_limits<double>::infinity();
  return mass;
}

}  // namespace dovetail::arlequin
