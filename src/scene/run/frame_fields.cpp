#include "frame_fields.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "build/parts.hpp"
#include "cell_fields.hpp"
#include "dovetail/dem/model/loads.hpp"
#include "dovetail/dem/model/sample.hpp"
#include "dovetail/dem/walls/facet_tractions.hpp"
#include "dovetail/fem/elements/solid.hpp"
#include "dovetail/rve/contact_sample.hpp"

namespace dovetail::scene {

namespace {

bool hasWord(const std::vector<std::string>& contents, const char* word) {
  return std::find(contents.begin(), contents.end(), word) != contents.end();
}
std::vector<double> flat(const std::vector<Vec3>& vectors) {
  return std::vector<double>(&vectors[0].x, &vectors[0].x + 3 * vectors.size());
}

void addLine(ForceLines& lines, const Vec3& from, const Vec3& to, const Vec3& normal, const Vec3& force) {
  const int next = static_cast<int>(lines.ends.size());
  lines.ends.insert(lines.ends.end(), {from, to});
  lines.line.push_back({next, next + 1});
  const double push = dot(force, normal);
  lines.force.push_back(force);
  lines.normal.push_back(push);
  lines.tangential.push_back(norm(force - push * normal));
}

}  // namespace

std::vector<double> fractionOf(const fem::Model& model) {
  for (const auto& term : model.terms)
    if (const auto* const solid = dynamic_cast<const fem::Solid*>(term.get()))
      if (const auto fraction = solid->fraction(); !fraction.empty()) return {fraction.begin(), fraction.end()};
  return {};
}

namespace {

/// Calls take(field, volumes) for what the words give at the points.
template <class Take>
void eachField(const Points& points, const Solid& solid, const std::vector<std::string>& contents, Take&& take) {
  if (hasWord(contents, "stress")) take(stressAt(points), Volumes::present);
  const auto takeAll = [&](const std::vector<MeshField>& fields) {
    for (const MeshField& field : fields) take(field, Volumes::reference);
  };
  if (hasWord(contents, "strain")) takeAll(strainsAt(points));
  if (hasWord(contents, "cells")) takeAll(cellsAt(points));
  if (hasWord(contents, "history")) takeAll(historyAt(points, solid));
}

void add(std::vector<MeshField>& fields, MeshField field) {
  const bool isStress = field.name == "stress";
  fields.push_back(std::move(field));
  if (!isStress) return;
  for (MeshField& invariant : invariantsOf(fields.back())) fields.push_back(std::move(invariant));
}

}  // namespace

namespace {

std::vector<MeshField> bodyFields(const mpm::PointSolid& body, const fem::Model& model, const Solid& solid,
                                  const std::vector<std::string>& contents) {
  std::vector<MeshField> fields{{"displacement", flat(displacementsOf(body, model.nodes)), 3, false},
                                {"velocity", flat(velocitiesOf(body, model.nodes)), 3, false},
                                {"radius", radiiOf(body, std::get<PointMesh>(solid.mesh)), 1, false}};
  eachField(pointsOf(model), solid, contents, [&](MeshField field, Volumes) { add(fields, std::move(field)); });
  return fields;
}

}  // namespace

std::vector<MeshField> solidFields(const fem::Model& model, std::size_t elements, const Solid& solid,
                                   const std::vector<std::string>& contents) {
  if (const auto* const body = materialPoints(model)) return bodyFields(*body, model, solid, contents);
  std::vector<MeshField> fields{{"displacement", flat(model.nodes.u), 3, false},
                                {"velocity", flat(model.nodes.v), 3, false}};
  const bool asksPoints = std::ranges::any_of(std::array{"stress", "strain", "cells", "history"},
                                              [&](const char* word) { return hasWord(contents, word); });
  if (asksPoints) {
    const Points points = pointsOf(model);
    eachField(points, solid, contents,
              [&](const MeshField& field, Volumes volumes) { add(fields, meansOf(points, field, elements, volumes)); });
  }
  if (hasWord(contents, "weights"))
    if (std::vector<double> fraction = fractionOf(model); !fraction.empty())
      fields.push_back({"solid_weight", std::move(fraction), 1, false});
  return fields;
}

std::vector<MeshField> pointFields(const Points& points, const Solid& solid, const std::vector<std::string>& contents) {
  std::vector<MeshField> fields{deformationAt(points)};
  eachField(points, solid, contents, [&](MeshField field, Volumes) { add(fields, std::move(field)); });
  return fields;
}

std::vector<std::string> notesOnSetNames(const Built& built, const Scene& scene) {
  const std::vector<std::string>& contents = scene.output.contents;
  std::vector<std::string> notes;
  if (!scene.output.frames || !hasWord(contents, "solids")) return notes;
  for (std::size_t s = 0; s < built.meshes.size(); ++s) {
    const fem::SolidMesh& mesh = built.meshes[s];
    const coupling::SolidSide& side = built.run->solid(s);
    for (const MeshField& field : solidFields(*side.model, mesh.elementCount(), scene.solids[s], contents))
      if (field.perCell ? mesh.elementSets.contains(field.name) : mesh.nodeSets.contains(field.name))
        notes.push_back("In frames of \"" + side.name + "\" the " + (field.perCell ? "element" : "node") + " set \"" +
                        field.name + "\" is \"" + field.name + " (set)\", since a field has its name.");
  }
  return notes;
}

dem::Particles grainsAlone(const dem::Particles& particles) {
  dem::Particles own;
  const auto take = [&](auto& to, const auto& from) {
    for (std::size_t i = 0; i < from.size(); ++i)
      if (!particles.isOfSolid(i)) to.push_back(from[i]);
  };
  take(own.id, particles.id);
  take(own.x, particles.x);
  take(own.v, particles.v);
  take(own.f, particles.f);
  take(own.radius, particles.radius);
  take(own.omega, particles.omega);
  take(own.weight, particles.weight);
  return own;
}

ForceLines contactLines(const dem::Model& grains) {
  const dem::ContactSample sample = dem::sampleContacts(grains);
  const auto idOf = [&](int i) -> std::int64_t {
    const auto number = static_cast<std::size_t>(i);
    return i < 0 || grains.particles.isOfSolid(number) ? -1 : grains.particles.id[number];
  };
  ForceLines lines;
  for (std::size_t c = 0; c < sample.size(); ++c) {
    addLine(lines, sample.from[c], sample.to[c], sample.normal[c], sample.force[c]);
    lines.first.push_back(idOf(sample.first[c]));
    lines.second.push_back(idOf(sample.second[c]));
  }
  return lines;
}

ForceLines bondLines(const dem::Model& grains) {
  const std::vector<std::int64_t>& id = grains.particles.id;
  ForceLines lines;
  for (const auto* const term : grains.terms.all<dem::BondTerm>()) {
    const dem::BondSample sample = dem::sampleBonds(grains.particles, term->bonds, grains.pairs.periodicity());
    for (std::size_t b = 0; b < sample.size(); ++b) {
      const Vec3 along = sample.from[b] - sample.to[b];
      addLine(lines, sample.from[b], sample.to[b], 1.0 / norm(along) * along, sample.force[b]);
      lines.first.push_back(id[static_cast<std::size_t>(sample.first[b])]);
      lines.second.push_back(id[static_cast<std::size_t>(sample.second[b])]);
      lines.utilised.push_back(sample.utilised[b]);
    }
  }
  return lines;
}

CellGrains grainsOf(const rve::Rve& cell) {
  const rve::CellState& s = cell.state;
  const auto vectorsOf = [&](const rve::Components& c) {
    std::vector<Vec3> vectors(cell.size());
    for (int axis = 0; axis < 3; ++axis)
      for (std::size_t i = 0; i < c[static_cast<std::size_t>(axis)].size(); ++i)
        vectors[i][axis] = c[static_cast<std::size_t>(axis)][i];
    return vectors;
  };
  CellGrains grains{vectorsOf(s.x), vectorsOf(s.v), vectorsOf(s.spin), {}};
  const std::array<Vec3, 3> rows = geometry::inverse(s.lattice);
  for (Vec3& x : grains.x) x -= s.lattice.shift(geometry::periodOf(s.lattice, rows, x));
  const rve::ContactSample sample = rve::sampleContacts(cell);
  for (std::size_t c = 0; c < sample.size(); ++c) {
    const Vec3 &from = grains.x[static_cast<std::size_t>(sample.first[c])], &b = sample.branch[c];
    addLine(grains.contacts, from, from + b, -1.0 / norm(b) * b, sample.force[c]);
    grains.contacts.first.push_back(sample.first[c]);
    grains.contacts.second.push_back(sample.second[c]);
    grains.contacts.sliding.push_back(sample.slides[c]);
  }
  return grains;
}

WallFacets wallFacets(const dem::MeshWall& mesh) {
  dem::FacetTractions gathered;
  dem::gatherTractions(gathered, mesh.wall, mesh.contacts, 1.0);
  WallFacets facets{dem::meanTractions(gathered, mesh.wall), {}};
  for (std::size_t k = 0; k < facets.traction.size(); ++k) {
    const geometry::Facet& facet = mesh.wall.facets[k];
    const auto corner = [&](std::size_t c) { return mesh.wall.x[static_cast<std::size_t>(facet[c])]; };
    const Vec3 area = cross(corner(1) - corner(0), corner(2) - corner(0));
    const double length = norm(area);
    facets.pressure.push_back(length > 0.0 ? -dot(area, facets.traction[k]) / length : 0.0);
  }
  return facets;
}

}  // namespace dovetail::scene
