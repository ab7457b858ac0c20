#include "dovetail/surface/coupling.hpp"

#include <algorithm>
#include <cmath>

#include "dovetail/core/finite.hpp"

namespace dovetail::surface {

namespace {

std::vector<int> sortedUnique(std::vector<int> values) {
  std::sort(values.begin(), values.end());
  values.erase(std::unique(values.begin(), values.end()), values.end());
  return values;
}

}  // namespace

Coupling::Coupling(Skin skin, const CouplingOptions& options)
    : skin_(std::move(skin)),
      options_(options),
      load_(static_cast<std::size_t>(skin_.carrier.columns)),
      surfaceNodes_(sortedUnique(skin_.carrier.column)),
      gain_(carrierGain(skin_)) {
  requireNonNegative(options.margin, "the candidate margin");
}

bool Coupling::marginUsed(const dem::Particles& particles, std::span<const Vec3> u) const {
  if (particles.size() != candidates_.particleAtBuild.size()) return true;
  double particleTravel = 0.0, nodeTravel = 0.0;
  for (std::size_t i = 0; i < particles.size(); ++i)
    particleTravel = std::max(particleTravel, squaredNorm(particles.x[i] - candidates_.particleAtBuild[i]));
  for (std::size_t k = 0; k < surfaceNodes_.size(); ++k)
    nodeTravel = std::max(nodeTravel, squaredNorm(u[surfaceNodes_[k]] - nodesAtBuild_[k]));
  return std::sqrt(particleTravel) + gain_ * std::sqrt(nodeTravel) > candidates_.skin;
}

void Coupling::locate(const dem::Particles& particles, std::span<const Vec3> u, std::span<const Vec3> v) {
  if (candidates_.builds > 0 && !marginUsed(particles, u)) return;
  place(skin_, u, v);
  double margin = options_.margin;
  if (margin == 0.0 && particles.size() > 0)
    margin = 0.5 * *std::min_element(particles.radius.begin(), particles.radius.end());
  dem::findWallCandidates(particles, skin_.wall, margin, candidates_);
  if (candidates_.particleAtBuild.size() != particles.size()) candidates_.particleAtBuild = particles.x;
  nodesAtBuild_.clear();
  for (int node : surfaceNodes_) nodesAtBuild_.push_back(u[node]);
  active_.clear();
  for (int facet : candidates_.facet)
    active_.insert(active_.end(), skin_.wall.facets[facet].begin(), skin_.wall.facets[facet].end());
  active_ = sortedUnique(std::move(active_));
}

void Coupling::placeActive(std::span<const Vec3> u, std::span<const Vec3> v) {
  place(skin_, u, v, active_);
  if (booksWork_) wallWork_ += 0.5 * contactWorkSinceLast();
}

void Coupling::bookNewContacts() {
  if (booksWork_) wallWork_ += 0.5 * contactWorkSinceLast();
}

double Coupling::contactWorkSinceLast() const {
  double work = 0.0;
  for (std::size_t c = 0; c < contacts_.size(); ++c)
    for (int k = 0; k < 3; ++k) {
      const int vertex = skin_.wall.facets[contacts_.facet[c]][k];
      work -= contacts_.weight[c][k] * dot(contacts_.force[c], skin_.wall.x[vertex] - previous_[vertex]);
    }
  return work;
}

}  // namespace dovetail::surface
