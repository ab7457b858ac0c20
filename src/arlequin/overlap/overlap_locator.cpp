#include "overlap_locator.hpp"

namespace dovetail::arlequin {

namespace {

/// The point, and its images one period away.
std::vector<Vec3> imagesOf(const Vec3& x, const geometry::Periodicity& space) {
  std::vector<Vec3> images{x};
  for (int k = 0; k < 3; ++k) {
    if (!space.axes[static_cast<std::size_t>(k)]) continue;
    for (std::size_t known = images.size(), i = 0; i < known; ++i)
      for (const double side : {-1.0, 1.0}) {
        images.push_back(images[i]);
        images.back()[k] += side * space.length(k);
      }
  }
  return images;
}

}  // namespace

FoundParticle OverlapLocator::find(const Vec3& x, double radius) const {
  constexpr double touching = 1.0 - 1e-9;
  const std::vector<Vec3> images = imagesOf(x, space_);
  for (const Vec3& image : images)
    if (auto place = cells_.find(image)) {
      const double weight = weightAt(mesh_, *place, weight_);
      return {std::move(*place), image, weight};
    }
  for (const Vec3& image : images)
    if (auto place = cells_.findNear(image, touching * radius))
      if (const double weight = weightAt(mesh_, *place, weight_); weight > 0.0)
        return {std::move(*place), image, weight};
  return {{}, x, 1.0};
}

std::optional<double> OverlapLocator::weightWithin(const Vec3& x) const {
  for (const Vec3& image : imagesOf(x, space_))
    if (const auto place = cells_.find(image)) return weightAt(mesh_, *place, weight_);
  return std::nullopt;
}

}  // namespace dovetail::arlequin
