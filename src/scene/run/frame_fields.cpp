#include "frame_fields.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include "build/parts.hpp"
#include "cell_fields.hpp"
#include "dovetail/dem/model/loads.hpp"
#include "dovetail/dem/model/sample.hpp"
#include "dovetail/dem/walls/facet_tractions.hpp"
#include "dovetail/fem/elements/solid.hpp"
#include "dovetail/fem/laws/plasticity.hpp"
#include "dovetail/fem/laws/viscosity.hpp"
#include "point_means.hpp"

namespace dovetail::scene {

namespace {

double determinant(const double* F) {
  return F[0] * (F[4] * F[8] - F[5] * F[7]) - F[1] * (F[3] * F[8] - F[5] * F[6]) + F[2] * (F[3] * F[7] - F[4] * F[6]);
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

CellStress cellStress(const fem::Model& model, std::size_t elements) {
  Means means(elements, 9);
  forEachSolid(model, [&](const fem::Solid&, const fem::Solid::Sample& sample) {
    for (std::size_t q = 0; q < sample.element.size(); ++q) {
      const double *F = &sample.F[9 * q], *P = &sample.P[9 * q], J = determinant(F);
      double sigma[9];
      for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = 0; j < 3; ++j)
          sigma[3 * i + j] = (P[3 * i] * F[3 * j] + P[3 * i + 1] * F[3 * j + 1] + P[3 * i + 2] * F[3 * j + 2]) / J;
      means.add(sample.element[q], J * sample.volume[q], sigma);
    }
  });
  CellStress stress{means.take(), {}, {}};
  for (std::size_t e = 0; e < elements; ++e) {
    const double* s = &stress.cauchy[9 * e];
    const double p = -(s[0] + s[4] + s[8]) / 3.0;
    double norm2 = 0.0;
    for (std::size_t k = 0; k < 9; ++k) {
      const double deviator = s[k] + (k % 4 == 0 ? p : 0.0);
      norm2 += deviator * deviator;
    }
    stress.pressure.push_back(p);
    stress.vonMises.push_back(std::sqrt(1.5 * norm2));
  }
  return stress;
}

std::vector<MeshField> cellHistory(const fem::Model& model, std::size_t elements, const Solid& file) {
  std::size_t size = 0;
  bool flows = false;
  const auto forEachHistory = [&](auto&& act) {
    forEachSolid(model, [&](const fem::Solid& solid, const fem::Solid::Sample& sample) {
      if (sample.element.empty() || sample.history.empty()) return;
      const SolidMaterial& material = materialOf(file, solid.name());
      const std::size_t own = sample.history.size() / sample.element.size();
      const std::size_t skipped = material.dampingTime > 0.0 ? fem::viscousHistory : 0;
      for (std::size_t q = 0; q < sample.element.size(); ++q)
        act(material, sample.element[q], sample.volume[q],
            std::span<const double>(&sample.history[own * q], own).subspan(skipped));
    });
  };
  forEachHistory([&](const SolidMaterial& material, int, double, std::span<const double> history) {
    if (yields(material))
      flows = true;
    else
      size = std::max(size, history.size());
  });
  Means strain(elements, 1), volume(elements, 1), all(elements, size);
  std::vector<double> others(size, 0.0);
  forEachHistory([&](const SolidMaterial& material, int element, double weight, std::span<const double> history) {
    if (!yields(material)) {
      std::copy(history.begin(), history.end(), others.begin());
      if (size > 0) all.add(element, weight, others.data());
      return;
    }
    const double a = fem::plasticStrain(history), v = fem::plasticVolume(history);
    strain.add(element, weight, &a);
    volume.add(element, weight, &v);
  });
  std::vector<MeshField> fields;
  if (flows) fields = {{"plastic_strain", strain.take()}, {"plastic_volume", volume.take()}};
  if (size > 0) fields.push_back({"history", all.take(), static_cast<int>(size)});
  return fields;
}

std::vector<double> fractionOf(const fem::Model& model) {
  for (const auto& term : model.terms)
    if (const auto* const solid = dynamic_cast<const fem::Solid*>(term.get()))
      if (const auto fraction = solid->fraction(); !fraction.empty()) return {fraction.begin(), fraction.end()};
  return {};
}

std::vector<MeshField> solidFields(const fem::Model& model, std::size_t elements, const Solid& solid,
                                   const std::vector<std::string>& contents) {
  const auto has = [&](const char* word) {
    return std::find(contents.begin(), contents.end(), word) != contents.end();
  };
  const auto flat = [](const std::vector<Vec3>& vectors) {
    return std::vector<double>(&vectors[0].x, &vectors[0].x + 3 * vectors.size());
  };
  std::vector<MeshField> fields{{"displacement", flat(model.nodes.u), 3, false},
                                {"velocity", flat(model.nodes.v), 3, false}};
  if (has("stress")) {
    CellStress stress = cellStress(model, elements);
    fields.push_back({"stress", std::move(stress.cauchy), 9});
    fields.push_back({"von_mises", std::move(stress.vonMises)});
    fields.push_back({"pressure", std::move(stress.pressure)});
  }
  if (has("strain"))
    for (MeshField& field : elementStrains(model, elements)) fields.push_back(std::move(field));
  if (has("cells"))
    for (MeshField& field : elementCells(model, elements)) fields.push_back(std::move(field));
  if (has("history"))
    for (MeshField& field : cellHistory(model, elements, solid)) fields.push_back(std::move(field));
  if (has("weights"))
    if (std::vector<double> fraction = fractionOf(model); !fraction.empty())
      fields.push_back({"solid_weight", std::move(fraction), 1, false});
  return fields;
}

std::vector<std::string> notesOnSetNames(const Built& built, const Scene& scene) {
  const std::vector<std::string>& contents = scene.output.contents;
  std::vector<std::string> notes;
  if (!scene.output.frames || std::find(contents.begin(), contents.end(), "solids") == contents.end()) return notes;
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

ForceLines contactLines(const dem::Model& grains) {
  const dem::ContactSample sample = dem::sampleContacts(grains);
  const std::vector<std::int64_t>& id = grains.particles.id;
  ForceLines lines;
  for (std::size_t c = 0; c < sample.size(); ++c) {
    addLine(lines, sample.from[c], sample.to[c], sample.normal[c], sample.force[c]);
    lines.first.push_back(id[static_cast<std::size_t>(sample.first[c])]);
    lines.second.push_back(sample.second[c] < 0 ? -1 : id[static_cast<std::size_t>(sample.second[c])]);
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
