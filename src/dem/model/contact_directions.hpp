// Contacts that act along their normals alone.
#pragma once

#include <array>
#include <vector>

#include "dovetail/dem/model/contact_step.hpp"
#include "dovetail/dem/particles/particles.hpp"

namespace dovetail::dem {

/// Contacts that act along their normals alone pull at others of their particles by the cosine between the two. What
/// may be taken off the sums of their stiffness and damping: for one of them, and for whatever acts in all directions.
class Directions {
public:
  using Slopes = std::array<double, 2>;

  Directions(const ContactDemand& demand, const Particles& p) : demand_(demand), first_(p.size() + 1, 0) {
    normal_.resize(demand.links.size());
    for (std::size_t l = 0; l < normal_.size(); ++l) {
      normal_[l] = normalOf(demand.links[l], p);
      if (normal_[l] == Vec3{}) continue;
      for (const int k : {demand.links[l].particle, demand.links[l].partner}) ++first_[static_cast<std::size_t>(k) + 1];
    }
    for (std::size_t i = 0; i < p.size(); ++i) first_[i + 1] += first_[i];
    links_.resize(first_.back());
    std::vector<std::size_t> next = first_;
    for (std::size_t l = 0; l < normal_.size(); ++l)
      if (normal_[l] != Vec3{})
        for (const int k : {demand.links[l].particle, demand.links[l].partner})
          links_[next[static_cast<std::size_t>(k)]++] = l;
  }

  Slopes spared(std::size_t link, std::size_t particle) const {
    const Vec3& n = normal_[link];
    Slopes sum{};
    std::array<Vec3, 2> along;
    for (std::size_t q = first_[particle]; q < first_[particle + 1]; ++q) {
      const auto& other = demand_.links[links_[q]];
      const Vec3& m = normal_[links_[q]];
      const Slopes slopes{other.stiffness, other.shiftingDamping};
      for (std::size_t s = 0; s < 2; ++s)
        if (n == Vec3{}) {
          sum[s] += slopes[s];
          along[s] += slopes[s] * Vec3{std::abs(m.x), std::abs(m.y), std::abs(m.z)};
        } else {
          sum[s] += slopes[s] * (1.0 - std::min(1.0, std::abs(dot(n, m))));
        }
    }
    return {sum[0] - norm(along[0]), sum[1] - norm(along[1])};
  }

private:
  /// Zero where it acts across, or reaches across a period.
  static Vec3 normalOf(const ContactDemand::Link& link, const Particles& p) {
    if (link.partner < 0 || link.owner != StepOwner::contact || link.turning > 0.0 || link.turningDamping > 0.0)
      return {};
    const auto i = static_cast<std::size_t>(link.particle), j = static_cast<std::size_t>(link.partner);
    const Vec3 d = p.x[i] - p.x[j];
    const double length = norm(d);
    return length > 0.0 && length < 1.5 * (p.radius[i] + p.radius[j]) ? d / length : Vec3{};
  }

  const ContactDemand& demand_;
  std::vector<Vec3> normal_;                // of links
  std::vector<std::size_t> first_, links_;  // of particles: theirs
};

}  // namespace dovetail::dem
