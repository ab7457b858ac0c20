#include "dovetail/surface/coupling.hpp"

#include <algorithm>
#include <cmath>

#include "dovetail/core/finite.hpp"
#include "travel.hpp"

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
  if (particles.revision != candidates_.particleRevision) return true;
  const double travel =
      largestTravel(particles.x, particlesAtBuild_) + gain_ * largestTravel(u, surfaceNodes_, nodesAtBuild_);
  return !(travel <= candidates_.margin);  // so that a NaN asks for a new search, which names the culprit
}

void Coupling::locate(const dem::Particles& particles, std::span<const Vec3> u, std::span<const Vec3> v) {
  if (candidates_.builds > 0 && !marginUsed(particles, u)) return;
  requireFinite(u, "node", "displacement", "contact search with the skin");
  place(skin_, u, v);
  double margin = options_.margin;
  if (margin == 0.0 && particles.size() > 0)
    margin = 0.5 * *std::min_element(particles.radius.begin(), particles.radius.end());
  dem::findWallCandidates(particles, skin_.wall, margin, candidates_);
  particlesAtBuild_ = particles.x;
  nodesAtBuild_.clear();
  for (int node : surfaceNodes_) nodesAtBuild_.push_back(u[node]);
  active_.clear();
  for (int facet : candidates_.facet)
    active_.insert(active_.end(), skin_.wall.facets[facet].begin(), skin_.wall.facets[facet].end());
  active_ = sortedUnique(std::move(active_));
}

void Coupling::placeSkin(std::span<const Vec3> u, std::span<const Vec3> v) {
  if (!booksWork_) return place(skin_, u, v, active_);
  place(skin_, u, v);
  if (previous_.empty()) previous_ = skin_.wall.x;
  wallWork_ += 0.5 * contactWorkSinceLast();
}

void Coupling::bookNewContacts() {
  if (!booksWork_) return;
  wallWork_ += 0.5 * contactWorkSinceLast();
  previous_ = skin_.wall.x;
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
