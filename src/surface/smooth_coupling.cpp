#include "dovetail/surface/smooth_coupling.hpp"

#include <algorithm>
#include <numeric>

#include "dovetail/core/finite.hpp"
#include "dovetail/geometry/hierarchical_grid.hpp"
#include "travel.hpp"

namespace dovetail::surface {

namespace {

constexpr double tolerance = 1e-13;  // of the radius
constexpr int largestIterations = 200;

double rowGain(const cg::Projection& map) {
  double gain = 0.0;
  for (int row = 0; row < map.rows(); ++row) {
    double sum = 0.0;
    for (double weight : map.rowWeights(row)) sum += std::abs(weight);
    gain = std::max(gain, sum);
  }
  return gain;
}

void sortUnique(std::vector<int>& values) {
  std::sort(values.begin(), values.end());
  values.erase(std::unique(values.begin(), values.end()), values.end());
}

/// A B-spline patch lies in the box of its control points.
geometry::Box controlBox(const SmoothSurface& surface, int face, double margin) {
  geometry::Box box{surface.x[surface.control[face][0]], surface.x[surface.control[face][0]]};
  for (int c : surface.control[face])
    for (int k = 0; k < 3; ++k) {
      box.lower[k] = std::min(box.lower[k], surface.x[c][k]);
      box.upper[k] = std::max(box.upper[k], surface.x[c][k]);
    }
  const Vec3 inflate{margin, margin, margin};
  return {box.lower - inflate, box.upper + inflate};
}

void placeAll(SmoothSurface& surface, std::span<const Vec3> u, std::span<const Vec3> v) {
  std::vector<int> all(surface.X.size());
  std::iota(all.begin(), all.end(), 0);
  place(surface, u, v, all);
}

}  // namespace

void SmoothContacts::clear() {
  particle.clear();
  face.clear();
  weight.clear();
  normal.clear();
  overlap.clear();
  engagement.clear();
  force.clear();
}

SmoothCoupling::SmoothCoupling(SmoothSurface surface, double margin)
    : surface_(std::move(surface)),
      margin_(margin),
      load_(static_cast<std::size_t>(surface_.carrier.columns)),
      surfaceNodes_(surface_.carrier.column),
      gain_(rowGain(surface_.carrier)) {
  requireNonNegative(margin, "the candidate margin");
  sortUnique(surfaceNodes_);
}

void SmoothCoupling::locate(const dem::Particles& particles, std::span<const Vec3> u, std::span<const Vec3> v) {
  if (particlesAtBuild_.size() == particles.size() && !nodesAtBuild_.empty()) {
    const double travel =
        largestTravel(particles.x, particlesAtBuild_) + gain_ * largestTravel(u, surfaceNodes_, nodesAtBuild_);
    if (travel <= margin0_) return;
  }
  requireFinite(particles.x, "particle", "position", "contact search with the smooth surface");
  requireFinite(u, "node", "displacement", "contact search with the smooth surface");
  margin0_ = margin_;
  if (margin0_ == 0.0 && particles.size() > 0)
    margin0_ = 0.5 * *std::min_element(particles.radius.begin(), particles.radius.end());
  placeAll(surface_, u, v);

  geometry::HierarchicalGrid grid;
  grid.build(particles.x, particles.radius);
  std::vector<std::vector<int>> facesOf(particles.size());
  for (std::size_t face = 0; face < surface_.control.size(); ++face)
    grid.query(controlBox(surface_, static_cast<int>(face), margin0_),
               [&](int particle) { facesOf[particle].push_back(static_cast<int>(face)); });
  offsets_.assign(1, 0);
  candidate_.clear();
  active_.clear();
  for (const auto& faces : facesOf) {
    candidate_.insert(candidate_.end(), faces.begin(), faces.end());
    offsets_.push_back(static_cast<int>(candidate_.size()));
    for (int face : faces) active_.insert(active_.end(), surface_.control[face].begin(), surface_.control[face].end());
  }
  sortUnique(active_);
  start_.assign(candidate_.size(), {0.5, 0.5});
  particlesAtBuild_ = particles.x;
  nodesAtBuild_.clear();
  for (int node : surfaceNodes_) nodesAtBuild_.push_back(u[node]);
}

/// Patches closer than reach, the nearest first.
void SmoothCoupling::findHits(const Vec3& x, double radius, double reach, std::span<const int> faces) {
  hits_.clear();
  auto* start = start_.data() + (faces.data() - candidate_.data());
  for (std::size_t k = 0; k < faces.size(); ++k) {
    const PatchPoint at = closestPointOnPatch(surface_, faces[k], x, start[k]);
    start[k] = at.parameter;
    if (!(at.squaredDistance < reach * reach)) continue;
    // The search ran into a side that another face continues: the true foot lies there.
    if (at.edge >= 0 && surface_.across[faces[k]][at.edge] >= 0 && leavesThrough(surface_, faces[k], at, x)) continue;
    const double distance = std::sqrt(at.squaredDistance);
    const Vec3 normal = distance > 1e-12 * radius ? (x - at.point) / distance : patchNormal(surface_, faces[k], at);
    hits_.push_back({faces[k], at, normal, radius - distance, radius - distance, {}});
  }
  std::stable_sort(hits_.begin(), hits_.end(), [](const Hit& a, const Hit& b) { return a.overlap > b.overlap; });
}

/// A patch as seen from y: δ = R − n·(x − c). The foot may have moved on to a neighbour.
void SmoothCoupling::lookFrom(const Vec3& x, double radius, Hit& hit) const {
  const Vec3 y = x + hit.position;
  hit.at = closestPointOnPatch(surface_, hit.face, y, hit.at.parameter);
  for (int hop = 0; hop < 4; ++hop) {
    const int edge = hit.at.edge;
    if (edge < 0 || surface_.across[hit.face][edge] < 0 || !leavesThrough(surface_, hit.face, hit.at, y)) break;
    hit.face = surface_.across[hit.face][edge];
    hit.at = closestPointOnPatch(surface_, hit.face, y, {0.5, 0.5});
  }
  const double distance = std::sqrt(hit.at.squaredDistance);
  if (distance > 1e-12 * radius) hit.normal = (y - hit.at.point) / distance;
  hit.overlap = radius - dot(hit.normal, x - hit.at.point);
}

/// yᵢ = x + Σ s′(nᵢ·nⱼ) λⱼ nⱼ; returns the largest change where a contact is active, m.
double SmoothCoupling::moveHits() {
  double largest = 0.0;
  for (std::size_t i = 0; i < hits_.size(); ++i) {
    hits_[i].share = shares_[i].carried;
    Vec3 position;
    for (const dem::Share& other : shares_)
      if (other.carried > 0.0)
        position += dem::couplingSlope(dot(shares_[i].normal, other.normal)) * other.carried * other.normal;
    if (hits_[i].share > 0.0) largest = std::max(largest, squaredNorm(position - hits_[i].position));
    hits_[i].position = position;
  }
  return std::sqrt(largest);
}

/// The potential of dem::projectWallContacts with patches in place of facets.
void SmoothCoupling::shareOverlap(const Vec3& x, double radius) {
  const Vec3 step = hits_[0].overlap * hits_[0].normal;
  for (Hit& hit : hits_) hit.position = dot(hit.normal, step) >= 0.0 ? step : Vec3{};
  for (int iteration = 0; iteration < largestIterations; ++iteration) {
    shares_.clear();
    for (Hit& hit : hits_) {
      lookFrom(x, radius, hit);
      shares_.push_back({hit.normal, hit.overlap, 0.0});
    }
    solver_.solve(shares_, tolerance * radius);
    if (moveHits() <= tolerance * radius) break;
  }
}

void SmoothCoupling::findContacts(const dem::Particles& particles) {
  contacts_.clear();
  for (std::size_t p = 0; p < particles.size(); ++p) {
    const std::span<const int> faces{candidate_.data() + offsets_[p],
                                     static_cast<std::size_t>(offsets_[p + 1] - offsets_[p])};
    const Vec3& x = particles.x[p];
    const double radius = particles.radius[p];
    findHits(x, radius, radius, faces);
    if (hits_.size() > 1) {
      findHits(x, radius, radius + hits_[0].overlap, faces);
      shareOverlap(x, radius);
    }
    for (const Hit& hit : hits_) {
      if (!(hit.share > 0.0)) continue;
      contacts_.particle.push_back(static_cast<int>(p));
      contacts_.face.push_back(hit.face);
      contacts_.weight.push_back(hit.at.weight);
      contacts_.normal.push_back(hit.normal);
      contacts_.overlap.push_back(hit.share);
      contacts_.engagement.push_back(std::min(1.0, hit.share / hit.overlap));
      contacts_.force.emplace_back();
    }
  }
}

void SmoothCoupling::placeSurface(std::span<const Vec3> u, std::span<const Vec3> v) {
  if (!booksWork_) return place(surface_, u, v, active_);
  placeAll(surface_, u, v);
  if (previous_.empty()) previous_ = surface_.x;
  wallWork_ += 0.5 * contactWorkSinceLast();
}

void SmoothCoupling::bookNewContacts() {
  if (!booksWork_) return;
  wallWork_ += 0.5 * contactWorkSinceLast();
  previous_ = surface_.x;
}

double SmoothCoupling::contactWorkSinceLast() const {
  double work = 0.0;
  for (std::size_t c = 0; c < contacts_.size(); ++c)
    for (std::size_t k = 0; k < 16; ++k) {
      const int control = surface_.control[contacts_.face[c]][k];
      work -= contacts_.weight[c][k] * dot(contacts_.force[c], surface_.x[control] - previous_[control]);
    }
  return work;
}

void SmoothCoupling::transfer() {
  load_.clear();
  for (std::size_t c = 0; c < contacts_.size(); ++c)
    for (std::size_t k = 0; k < 16; ++k) {
      const int control = surface_.control[contacts_.face[c]][k];
      const auto column = surface_.carrier.rowColumns(control);
      const auto share = surface_.carrier.rowWeights(control);
      const Vec3 force = -contacts_.weight[c][k] * contacts_.force[c];
      for (std::size_t i = 0; i < column.size(); ++i) load_.add(column[i], share[i] * force);
    }
}

}  // namespace dovetail::surface
