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

}  // namespace dovetail::surface
