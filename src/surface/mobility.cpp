// How far the nodes give way under contacts, and what that asks of the time step.
#include <algorithm>
#include <cmath>

#include "carrier.hpp"
#include "dovetail/dem/model/contact_step.hpp"
#include "dovetail/surface/coupling.hpp"

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

/// √Σ (turnRate)²/m of each patch, 1/(m √kg).
std::vector<double> rootTurnMobility(const PatchTurns& turns, std::span<const double> inverseMass) {
  std::vector<double> roots;
  for (const PatchFrame& frame : turns.frames) {
    double sum = 0.0;
    for (std::size_t k = 0; k < frame.node.size(); ++k)
      sum += turnRate(frame, k) * turnRate(frame, k) * inverseMass[frame.node[k]];
    roots.push_back(std::sqrt(sum));
  }
  return roots;
}

double squared(double x) { return x * x; }

/// How much a contact follows the nodes: by its own weights, ascending, and by turns of patches, m.
struct Following {
  std::vector<std::pair<int, double>> nodes, patches;
};

std::vector<std::pair<int, double>> gathered(std::vector<std::pair<int, double>> all) {
  std::sort(all.begin(), all.end());
  std::vector<std::pair<int, double>> sums;
  for (const auto& [number, value] : all)
    if (!sums.empty() && sums.back().first == number)
      sums.back().second += value;
    else
      sums.emplace_back(number, value);
  return sums;
}

Following following(const Carrier& carrier, std::span<const std::pair<int, double>> points) {
  Following all;
  for (const auto& [point, weight] : points) {
    const auto node = carrier.map().rowColumns(point);
    for (std::size_t k = 0; k < node.size(); ++k)
      all.nodes.emplace_back(node[k], weight * std::abs(carrier.map().rowWeights(point)[k]));
    if (carrier.turns().empty()) continue;
    const auto p = static_cast<std::size_t>(point);
    all.patches.emplace_back(carrier.turns().patch[p], weight * norm(carrier.turns().offset[p]));
  }
  return {gathered(std::move(all.nodes)), gathered(std::move(all.patches))};
}

/// What contacts ask of nodes: directly, and of patches by turning them, N/m or N s/m (of patches times m).
struct Asked {
  std::vector<double> ofNode, ofPatch;
  Asked(std::size_t nodes, std::size_t patches) : ofNode(nodes, 0.0), ofPatch(patches, 0.0) {}

  void add(const Following& contact, double slope) {
    for (const auto& [node, share] : contact.nodes) ofNode[node] += slope * share;
    for (const auto& [patch, arm] : contact.patches) ofPatch[patch] += slope * arm;
  }
  /// Hands what is asked of patches on to their nodes; then of patches what their nodes give way.
  void handOn(const PatchTurns& turns, std::span<const double> inverseMass) {
    for (std::size_t p = 0; p < ofPatch.size(); ++p)
      for (std::size_t k = 0; k < turns.frames[p].node.size(); ++k)
        ofNode[turns.frames[p].node[k]] += ofPatch[p] * turnRate(turns.frames[p], k);
    for (std::size_t i = 0; i < ofNode.size(); ++i) ofNode[i] *= inverseMass[i];
    for (std::size_t p = 0; p < ofPatch.size(); ++p) {
      ofPatch[p] = 0.0;
      for (std::size_t k = 0; k < turns.frames[p].node.size(); ++k)
        ofPatch[p] += turnRate(turns.frames[p], k) * ofNode[turns.frames[p].node[k]];
    }
  }
  double meets(const Following& contact) const {
    double sum = 0.0;
    for (const auto& [node, share] : contact.nodes) sum += share * ofNode[node];
    for (const auto& [patch, arm] : contact.patches) sum += arm * ofPatch[patch];
    return sum;
  }
};

}  // namespace

void Coupling::addDemand(dem::ContactDemand& demand, const dem::Particles& particles, const dem::ContactLaws& laws,
                         std::span<const double> inverseMass) const {
  const std::size_t first = demand.links.size();
  laws.addDemand(demand, particles, carrier_->wall(), contacts_);
  const PatchTurns& turns = carrier_->turns();
  const std::size_t patches = turns.empty() ? 0 : turns.frames.size();
  Asked stiffness(inverseMass.size(), patches), damping(inverseMass.size(), patches);
  std::vector<Following> shifted, turned;
  std::vector<std::pair<int, double>> points;
  for (std::size_t l = first; l < demand.links.size(); ++l) {
    const auto& link = demand.links[l];
    const auto contact = static_cast<std::size_t>(link.contact);
    points.clear();
    carrier_->follow(contacts_, contact, points);
    shifted.push_back(following(*carrier_, points));
    stiffness.add(shifted.back(), link.shifting);
    damping.add(shifted.back(), link.shiftingDamping);
    points.clear();
    if (link.turning > 0.0 || link.turningDamping > 0.0) carrier_->turnWith(contacts_, contact, points);
    for (auto& [point, rate] : points) rate *= particles.radius[static_cast<std::size_t>(link.particle)];
    turned.push_back(following(*carrier_, points));
    stiffness.add(turned.back(), link.turning);
    damping.add(turned.back(), link.turningDamping);
  }
  stiffness.handOn(turns, inverseMass);
  damping.handOn(turns, inverseMass);
  for (std::size_t l = first; l < demand.links.size(); ++l) {
    const Following &shift = shifted[l - first], &turn = turned[l - first];
    demand.links[l].wallStiff = std::max(stiffness.meets(shift), stiffness.meets(turn));
    demand.links[l].wallDamped = std::max(damping.meets(shift), damping.meets(turn));
  }
}

double Coupling::largestMobility(std::span<const double> inverseMass) const {
  const PatchTurns& turns = carrier_->turns();
  const std::vector<double> turning = rootTurnMobility(turns, inverseMass);
  const auto ofTurns = [&](std::size_t point) {
    return turns.empty() ? 0.0 : norm(turns.offset[point]) * turning[static_cast<std::size_t>(turns.patch[point])];
  };
  double largest = 0.0;
  if (carrier_->smooth()) {
    for (std::size_t c = 0; c < turns.offset.size(); ++c) largest = std::max(largest, ofTurns(c));
    return squared(std::sqrt(surface::largestMobility(*carrier_->smooth(), inverseMass)) + largest);
  }
  for (int row = 0; row < carrier_->map().rows(); ++row)
    largest = std::max(largest, squared(std::sqrt(rowMobility(carrier_->map(), row, inverseMass)) +
                                        ofTurns(static_cast<std::size_t>(row))));
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
          const double share = along[k % 4] * across[k / 4];
          if (share == 0.0) continue;
          for (std::size_t i = 0; i < surface.carrier.rowColumns(control[k]).size(); ++i) {
            const int node = surface.carrier.rowColumns(control[k])[i];
            touched.push_back(node);
            weight[node] += share * surface.carrier.rowWeights(control[k])[i];
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
