#include "stress.hpp"

#include <algorithm>
#include <cmath>

#include "dovetail/cg/averages.hpp"
#include "dovetail/dem/model/sample.hpp"
#include "dovetail/fem/elements/solid.hpp"

namespace dovetail::disordered_overlap {

namespace {

/// Weight of a layer that lies below a height.
double fractionBelow(double z, double lower, double upper) {
  return std::clamp((z - lower) / (upper - lower), 0.0, 1.0);
}

/// −∫ P_zz (1 − w) dV over the layer of elements that begins at the reference height, N m; the volumes of the points
/// are those of the solid's weight.
double pushOfSolid(const fem::Solid::Sample& sample, const SolidPlace& place, double Z) {
  double sum = 0.0;
  for (std::size_t q = 0; q < sample.X.size(); ++q)
    if (sample.X[q].z > Z && sample.X[q].z < Z + place.element) sum -= sample.P[9 * q + 8] * sample.volume[q];
  return sum;
}

}  // namespace

double weightAbove(const dem::Particles& p, double width, double lower, double upper) {
  double weight = 0.0;
  for (std::size_t i = 0; i < p.size(); ++i)
    weight += standardGravity * p.weightOf(i) * p.mass[i] * fractionBelow(p.x[i].z, lower, upper);
  return weight / (width * width);
}

std::vector<LayerStress> layersOf(JoinedColumn& column, const SolidPlace& place) {
  const dem::Model& grains = column.run.grains;
  const fem::Model& solid = *column.run.solid(0).model;
  const double area = place.width * place.width;
  const dem::ContactSample contacts = dem::sampleContacts(grains);
  auto& elements = dynamic_cast<fem::Solid&>(*solid.terms.front());
  const fem::Solid::Sample sample = elements.sample(solid.nodes, {.t = solid.t});
  const auto heightOf = [&](double Z) {
    for (std::size_t n = 0; n < solid.nodes.X.size(); ++n)
      if (std::abs(solid.nodes.X[n].z - Z) < 0.01 * place.element) return Z + solid.nodes.u[n].z;
    return Z;
  };
  std::vector<LayerStress> layers;
  for (double Z = place.border; Z < place.top - 0.5 * place.element; Z += place.element) {
    LayerStress layer{
        .lower = heightOf(Z), .upper = heightOf(Z + place.element), .grains = 0.0, .solid = 0.0, .above = 0.0};
    // Wide enough for branches that hang over the sides.
    const cg::AverageBox box{{-place.width, -place.width, layer.lower},
                             {2 * place.width, 2 * place.width, layer.upper}};
    layer.grains = -9.0 * cg::loveWeberStress({contacts.from, contacts.to, contacts.force}, {}, box).contact(2, 2);
    layer.solid = pushOfSolid(sample, place, Z) / (area * (layer.upper - layer.lower));
    layer.above = weightAbove(grains.particles, place.width, layer.lower, layer.upper);
    for (std::size_t n = 0; n < solid.nodes.X.size(); ++n)
      layer.above += standardGravity * solid.nodes.mass[n] / area *
                     fractionBelow(solid.nodes.X[n].z + solid.nodes.u[n].z, layer.lower, layer.upper);
    layers.push_back(layer);
  }
  return layers;
}

}  // namespace dovetail::disordered_overlap
