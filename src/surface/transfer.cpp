#include "dovetail/surface/coupling.hpp"
#include "dovetail/surface/spread_load.hpp"
#include "face_cut.hpp"

namespace dovetail::surface {

namespace {

cg::SurfacePoints gaussPoints(std::span<const Vec3> X, const Skin& skin, std::span<const fem::Face> faces) {
  std::vector<int> patchOfFace(faces.size());
  for (std::size_t t = 0; t < skin.facetFace.size(); ++t) patchOfFace[skin.facetFace[t]] = skin.patchOfFacet[t];
  return cg::gaussPointsOnQuads(X, quadsOf(faces, "SpreadLoad"), patchOfFace);
}

}  // namespace

SpreadLoad::SpreadLoad(const cg::SurfaceKernel& kernel, std::span<const Vec3> X, const Skin& skin,
                       std::span<const fem::Face> faces)
    : quadrature_(kernel, gaussPoints(X, skin, faces)) {}

void SpreadLoad::add(const Skin& skin, int facet, const std::array<double, 3>& weight, const Vec3& onParticle,
                     coupling::NodalLoad& load) {
  const auto& vertex = skin.wall.facets[facet];
  Vec3 centre;
  for (int k = 0; k < 3; ++k) centre += weight[k] * skin.X[vertex[k]];
  localColumn_.clear();
  localWeight_.clear();
  column_.clear();
  weight_.clear();
  cg::localRow(skin.localMap, vertex, weight, localColumn_, localWeight_);
  quadrature_.row(centre, skin.patchOfFacet[facet], localColumn_, localWeight_, column_, weight_);
  for (std::size_t k = 0; k < column_.size(); ++k) load.add(column_[k], -weight_[k] * onParticle);
}

void Coupling::transfer() {
  load_.clear();
  for (std::size_t c = 0; c < contacts_.size(); ++c) {
    const int facet = contacts_.facet[c];
    const auto& weight = contacts_.weight[c];
    const Vec3& force = contacts_.force[c];
    if (spread_) {
      spread_->add(skin_, facet, weight, force, load_);
      continue;
    }
    for (int k = 0; k < 3; ++k) {
      const Vec3 onVertex = -weight[k] * force;
      const int vertex = skin_.wall.facets[facet][k];
      const auto column = skin_.carrier.rowColumns(vertex);
      const auto share = skin_.carrier.rowWeights(vertex);
      for (std::size_t i = 0; i < column.size(); ++i) load_.add(column[i], share[i] * onVertex);
    }
  }
}

}  // namespace dovetail::surface
