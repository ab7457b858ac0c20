// How far the nodes give way under contacts.
#include <algorithm>
#include <cmath>

#include "carrier.hpp"
#include "dovetail/dem/model/contact_step.hpp"
#include "dovetail/surface/surface_coupler.hpp"

namespace dovetail::surface {

namespace {

/// Bézier points of the spline's two pieces over a face, as weights of its four control points in a row: every point of
/// the piece lies among its Bézier points.
constexpr std::array<std::array<double, 4>, 5> bezier{{{0.125, 0.75, 0.125, 0.0},
                                                       {0.0, 0.75, 0.25, 0.0},
                                                       {0.0, 0.5, 0.5, 0.0},
                                                       {0.0, 0.25, 0.75, 0.0},
                                                       {0.0, 0.125, 0.75, 0.125}}};

double rowMobility(const cg::Projection& carrier, int row, std::span<const double> inverseMass) {
  double sum = 0.0;
  for (std::size_t k = 0; k < carrier.rowColumns(row).size(); ++k)
    sum += carrier.rowWeights(row)[k] * carrier.rowWeights(row)[k] * inverseMass[carrier.rowColumns(row)[k]];
  return sum;
}

/// √Σ (armLength)²/m of each patch, 1/(m √kg).
std::vector<double> rootArmMobility(const PatchOffsets& offsets, std::span<const double> inverseMass) {
  std::vector<double> roots;
  for (const PatchFrame& frame : offsets.frames) {
    double sum = 0.0;
    for (std::size_t k = 0; k < frame.node.size(); ++k)
      sum += armLength(frame, k) * armLength(frame, k) * inverseMass[frame.node[k]];
    roots.push_back(std::sqrt(sum));
  }
  return roots;
}

double squared(double x) { return x * x; }

/// The masses of a demand that the points of a carrier go with: nodes, and patches that nodes turn.
class CarriedMasses {
public:
  CarriedMasses(const Carrier& carrier, dem::ContactDemand& demand, int side)
      : carrier_(carrier),
        demand_(demand),
        firstNode_(static_cast<int>(demand.sides[static_cast<std::size_t>(side)].first)),
        firstPatch_(static_cast<int>(demand.masses.size())) {
    if (carrier.offsets().empty()) return;
    for (const PatchFrame& frame : carrier.offsets().frames) {
      fractions_.clear();
      for (std::size_t k = 0; k < frame.node.size(); ++k)
        fractions_.push_back({firstNode_ + frame.node[k], armLength(frame, k)});
      demand.masses.push_back({.carriedBy = demand.add(fractions_)});
    }
  }

  /// @param points  of the carrier, and how fast they go along
  dem::ContactDemand::Range follow(std::span<const std::pair<int, double>> points) {
    fractions_.clear();
    for (const auto& [point, weight] : points) {
      const auto node = carrier_.map().rowColumns(point);
      for (std::size_t k = 0; k < node.size(); ++k)
        add(firstNode_ + node[k], weight * std::abs(carrier_.map().rowWeights(point)[k]));
      if (carrier_.offsets().empty()) continue;
      const auto p = static_cast<std::size_t>(point);
      add(firstPatch_ + carrier_.offsets().patch[p], weight * norm(carrier_.offsets().offset[p]));
    }
    return demand_.add(fractions_);
  }

private:
  void add(int mass, double fraction) {
    if (fraction > 0.0) fractions_.push_back({mass, fraction});
  }

  const Carrier& carrier_;
  dem::ContactDemand& demand_;
  int firstNode_, firstPatch_;
  std::vector<dem::ContactDemand::Fraction> fractions_;
};

}  // namespace

void SurfaceCoupler::addDemand(dem::ContactDemand& demand, const dem::Particles& particles,
                               const dem::ContactLaws& laws, int side) const {
  const std::size_t first = demand.links.size();
  laws.addDemand(demand, particles, carrier_->wall(), contacts_);
  CarriedMasses masses(*carrier_, demand, side);
  std::vector<std::pair<int, double>> points;
  for (std::size_t l = first; l < demand.links.size(); ++l) {
    dem::ContactDemand::Link& link = demand.links[l];
    const auto contact = static_cast<std::size_t>(link.contact);
    link.side = side;
    points.clear();
    carrier_->follow(contacts_, contact, points);
    link.shifted = masses.follow(points);
    if (!(link.turning > 0.0 || link.turningDamping > 0.0)) continue;
    points.clear();
    carrier_->turnWith(contacts_, contact, points);
    for (auto& [point, rate] : points) rate *= particles.radius[static_cast<std::size_t>(link.particle)];
    link.turned = masses.follow(points);
  }
}

double SurfaceCoupler::largestMobility(std::span<const double> inverseMass) const {
  const PatchOffsets& offsets = carrier_->offsets();
  const std::vector<double> turning = rootArmMobility(offsets, inverseMass);
  const auto ofOffsets = [&](std::size_t point) {
    return offsets.empty() ? 0.0
                           : norm(offsets.offset[point]) * turning[static_cast<std::size_t>(offsets.patch[point])];
  };
  double largest = 0.0;
  if (carrier_->smooth()) {
    for (std::size_t c = 0; c < offsets.offset.size(); ++c) largest = std::max(largest, ofOffsets(c));
    return squared(std::sqrt(surface::largestMobility(*carrier_->smooth(), inverseMass)) + largest);
  }
  for (int row = 0; row < carrier_->map().rows(); ++row)
    largest = std::max(largest, squared(std::sqrt(rowMobility(carrier_->map(), row, inverseMass)) +
                                        ofOffsets(static_cast<std::size_t>(row))));
  return largest;
}

double largestMobility(const SmoothSurface& surface, std::span<const double> inverseMass) {
  double largest = 0.0;
  std::vector<double> weight(inverseMass.size(), 0.0);
  std::vector<int> touched;
  for (const auto& control : surface.control)
    for (const auto& along : bezier)
      for (const auto& across : bezier) {
        for (std::size_t k = 0; k < 16; ++k) {
          const double fraction = along[k % 4] * across[k / 4];
          if (fraction == 0.0) continue;
          for (std::size_t i = 0; i < surface.carrier.rowColumns(control[k]).size(); ++i) {
            const int node = surface.carrier.rowColumns(control[k])[i];
            touched.push_back(node);
            weight[node] += fraction * surface.carrier.rowWeights(control[k])[i];
          }
        }
        double mobility = 0.0;
        for (int node : touched) {  // the second time round a node has weight zero
          mobility += weight[node] * weight[node] * inverseMass[node];
          weight[node] = 0.0;
        }
        touched.clear();
        largest = std::max(largest, mobility);
      }
  return largest;
}

}  // namespace dovetail::surface
