#include "contact_list.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <string>

#include "bonded.hpp"
#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"
#include "dovetail/dem/model/contact_step.hpp"

namespace dovetail::rve {

namespace {

using geometry::Image;

std::uint8_t codeOf(const Image& n) { return static_cast<std::uint8_t>((n[0] + 1) + 3 * (n[1] + 1) + 9 * (n[2] + 1)); }
Image imageOf(std::uint8_t code) { return {code % 3 - 1, code / 3 % 3 - 1, code / 9 - 1}; }

Vec3 placeOf(const Rve& cell, std::size_t i) {
  const Components& x = cell.state.x;
  return {x[0][i], x[1][i], cell.shape == Shape::disc ? 0.0 : x[2][i]};
}

/// Brings all grains into the box; returns the period each was in.
std::vector<Image> wrap(Rve& cell, const std::array<Vec3, 3>& rows) {
  std::vector<Image> was(cell.size());
  for (std::size_t i = 0; i < cell.size(); ++i) {
    was[i] = geometry::periodOf(cell.state.lattice, rows, placeOf(cell, i));
    const Vec3 back = cell.state.lattice.shift(was[i]);
    for (std::size_t k = 0; k < static_cast<std::size_t>(cell.dimension()); ++k)
      cell.state.x[k][i] -= back[static_cast<int>(k)];
  }
  return was;
}

/// Grains by the cells of a regular division of the box in reduced coordinates.
class Bins {
public:
  Bins(const Rve& cell, const std::array<Vec3, 3>& rows, double reach)
      : axes_(cell.state.lattice.axes), bin_(cell.size()) {
    const std::array<double, 3> widths = cell.state.lattice.widths();
    std::vector<Vec3> s(cell.size());
    for (std::size_t i = 0; i < s.size(); ++i) {
      const Vec3 x = placeOf(cell, i);
      s[i] = {dot(rows[0], x), dot(rows[1], x), dot(rows[2], x)};
    }
    for (std::size_t k = 0; k < 3; ++k) {
      const int a = static_cast<int>(k);
      double low = 0.0, high = 1.0;
      if (!axes_[k]) {
        low = high = s[0][a];
        for (const Vec3& p : s) low = std::min(low, p[a]), high = std::max(high, p[a]);
      }
      const double wanted = std::floor(widths[k] * (high - low) / reach);
      count_[k] = static_cast<int>(std::clamp(wanted, 1.0, 1024.0));
      for (std::size_t i = 0; i < s.size(); ++i) {
        const double fraction = high > low ? (s[i][a] - low) / (high - low) : 0.0;
        bin_[i][k] = std::clamp(static_cast<int>(fraction * count_[k]), 0, count_[k] - 1);
      }
    }
    sort();
  }

  /// Calls visit(j, image) for all grains in the bin of grain i and around it.
  template <class Visit>
  void around(std::size_t i, const Visit& visit) const {
    Image step;
    for (step[2] = -1; step[2] <= 1; ++step[2])
      for (step[1] = -1; step[1] <= 1; ++step[1])
        for (step[0] = -1; step[0] <= 1; ++step[0]) {
          Image at = bin_[i], image{};
          bool exists = true;
          for (std::size_t k = 0; k < 3; ++k) {
            at[k] += step[k];
            if (at[k] >= 0 && at[k] < count_[k]) continue;
            image[k] = step[k];
            at[k] -= step[k] * count_[k];
            exists = exists && axes_[k];
          }
          if (!exists) continue;
          const auto b = static_cast<std::size_t>(flat(at));
          for (int m = first_[b]; m < first_[b + 1]; ++m) visit(member_[static_cast<std::size_t>(m)], image);
        }
  }

private:
  int flat(const Image& at) const { return at[0] + count_[0] * (at[1] + count_[1] * at[2]); }
  void sort() {
    first_.assign(static_cast<std::size_t>(count_[0] * count_[1] * count_[2]) + 1, 0);
    for (const Image& at : bin_) ++first_[static_cast<std::size_t>(flat(at)) + 1];
    for (std::size_t b = 1; b < first_.size(); ++b) first_[b] += first_[b - 1];
    member_.resize(bin_.size());
    std::vector<int> next(first_.begin(), first_.end() - 1);
    for (std::size_t i = 0; i < bin_.size(); ++i)
      member_[static_cast<std::size_t>(next[static_cast<std::size_t>(flat(bin_[i]))]++)] = static_cast<int>(i);
  }

  std::array<bool, 3> axes_;
  std::array<int, 3> count_{1, 1, 1};
  std::vector<Image> bin_;
  std::vector<int> first_, member_;
};

/// Overlap in radii that elastic spheres which touch nobody shall be able to meet.
constexpr double loneOverlap = 1e-3;

struct Neighbour {
  int j;
  std::uint8_t image;
  bool operator==(const Neighbour&) const = default;
};

/// How images are numbered anew: by the reduction of the lattice and by the period in which each grain was.
struct Renumbering {
  geometry::IntegerMatrix map;
  std::vector<Image> was;

  Image of(std::size_t i, std::size_t j, std::uint8_t code) const {
    Image n = geometry::product(map, imageOf(code));
    for (std::size_t k = 0; k < 3; ++k) n[k] += was[j][k] - was[i][k];
    return n;
  }
};

/// Pairs that bonds hold together, however long, grain by grain; empty where there are none.
std::vector<std::vector<Neighbour>> bondedPairs(const Contacts& old, const Renumbering& renumbering) {
  std::vector<std::vector<Neighbour>> pairs(old.bond.empty() ? 0 : old.first.size() - 1);
  for (std::size_t i = 0; i < pairs.size(); ++i)
    for (int c = old.first[i]; c < old.first[i + 1]; ++c) {
      const auto at = static_cast<std::size_t>(c);
      if (!isBonded(old, at)) continue;
      const Image n = renumbering.of(i, static_cast<std::size_t>(old.other[at]), old.image[at]);
      if (std::ranges::any_of(n, [](int k) { return std::abs(k) > 1; }))
        throw NumericalError("a bond has become longer than the cell", "cell of grains",
                             "give bonds a tensile strength");
      pairs[i].push_back({old.other[at], codeOf(n)});
    }
  return pairs;
}

void list(const Rve& cell, const std::array<Vec3, 3>& rows, const std::vector<std::vector<Neighbour>>& bonded,
          Contacts& contacts) {
  const Bins bins(cell, rows, listReach(cell));
  std::vector<Neighbour> found;
  contacts.first.assign(1, 0);
  for (std::size_t i = 0; i < cell.size(); ++i) {
    found.clear();
    const Vec3 xi = placeOf(cell, i);
    bins.around(i, [&](int j, const Image& n) {
      if (j <= static_cast<int>(i)) return;
      const auto at = static_cast<std::size_t>(j);
      const double reach = cell.radius[i] + cell.radius[at] + cell.skin;
      if (squaredNorm(placeOf(cell, at) + cell.state.lattice.shift(n) - xi) < reach * reach)
        found.push_back({j, codeOf(n)});
    });
    if (!bonded.empty())
      for (const Neighbour& far : bonded[i])
        if (std::ranges::find(found, far) == found.end()) found.push_back(far);
    std::sort(found.begin(), found.end(),
              [](const Neighbour& a, const Neighbour& b) { return a.j != b.j ? a.j < b.j : a.image < b.image; });
    for (const Neighbour& f : found) {
      contacts.other.push_back(f.j);
      contacts.image.push_back(f.image);
      const double fraction = cell.frame.empty() ? 1.0 : fractionOf(cell.frame, static_cast<int>(i), f.j);
      contacts.stiffness.push_back(
          fraction * normalStiffness(cell.springs, cell.radius[i], cell.radius[static_cast<std::size_t>(f.j)]));
    }
    contacts.first.push_back(static_cast<int>(contacts.other.size()));
  }
}

/// Contacts keep their stretch: the same pair through the image that has another number now.
void inherit(Contacts& contacts, const Contacts& old, const Renumbering& renumbering) {
  for (std::size_t i = 0; i + 1 < old.first.size(); ++i)
    for (int c = old.first[i]; c < old.first[i + 1]; ++c) {
      const auto from = static_cast<std::size_t>(c);
      const auto j = static_cast<std::size_t>(old.other[from]);
      const Image n = renumbering.of(i, j, old.image[from]);
      for (int e = contacts.first[i]; e < contacts.first[i + 1]; ++e) {
        const auto to = static_cast<std::size_t>(e);
        if (contacts.other[to] != old.other[from] || imageOf(contacts.image[to]) != n) continue;
        for (std::size_t k = 0; k < 3; ++k)
          if (!old.stretch[k].empty()) contacts.stretch[k][to] = old.stretch[k][from];
        if (!old.roll.empty()) contacts.roll[to] = old.roll[from];
        if (!old.bond.empty()) contacts.bond[to] = old.bond[from];
        if (!old.tangent.empty()) contacts.tangent[to] = old.tangent[from];
      }
    }
}

/// Σ k_n over the pairs of a grain, N/m.
std::vector<double> sumsOf(const Contacts& contacts, std::size_t grains) {
  std::vector<double> sums(grains, 0.0);
  for (std::size_t i = 0; i < grains; ++i)
    for (int c = contacts.first[i]; c < contacts.first[i + 1]; ++c) {
      const double k = contacts.stiffness[static_cast<std::size_t>(c)];
      sums[i] += k;
      sums[static_cast<std::size_t>(contacts.other[static_cast<std::size_t>(c)])] += k;
    }
  return sums;
}

}  // namespace

double listReach(const Rve& cell) {
  // Asked for in every step: by vectors.
  return 2.0 * Eigen::Map<const Eigen::ArrayXd>(cell.radius.data(), static_cast<Eigen::Index>(cell.size())).maxCoeff() +
         cell.skin;
}

double fractionOf(const Frame& frame, int p, int q) {
  const auto at = [](int i) { return static_cast<std::size_t>(i); };
  const auto copies = [&](int i, const auto& visit) {
    visit(i);
    for (const std::vector<int>& group : frame.alike) {
      const bool member = std::any_of(group.begin(), group.end(), [&](int m) { return frame.grain[at(m)] == i; });
      if (!member) continue;
      for (const int m : group)
        if (frame.grain[at(m)] != i) visit(frame.grain[at(m)]);
    }
  };
  int places = 0;
  copies(p, [&](int pp) {
    copies(q, [&](int qq) {
      bool same = true;
      for (std::size_t k = 0; k < 3; ++k)
        same = same && frame.image[at(qq)][k] - frame.image[at(pp)][k] == frame.image[at(q)][k] - frame.image[at(p)][k];
      places += same ? 1 : 0;
    });
  });
  return 1.0 / places;
}

double criticalStep(const Rve& cell, std::vector<double> stiffness) {
  const Springs& springs = cell.springs;
  const double tangential = springs.slides() ? springs.tangential : 0.0;
  const double rolling = springs.rolls() ? springs.rolling * springs.tangential : 0.0;
  const double factor = dem::detail::strongest(1.0, tangential, rolling, 1.0, cell.shape == Shape::disc ? 0.5 : 0.4);
  const auto [least, most] = std::minmax_element(cell.radius.begin(), cell.radius.end());
  // A roll of k_r = β k_t r_i r_j is felt by the smaller grain as β k_t r_j / r_i of its own.
  const double widest = springs.rolls() ? *most / *least : 1.0;
  // Of grains that touch nobody two of the smallest would be fastest. Linear ones count as if each had another contact:
  // at 0.8 of their own limit they would be through a collision in two steps and part with more energy than they met
  // with, the more the more they are damped.
  const double alone = slopeAt(springs, normalStiffness(springs, *least, *least), loneOverlap * *least);
  double omega2 =
      (springs.elasticSpheres() ? 2.0 : 4.0) * alone / cell.mass[static_cast<std::size_t>(least - cell.radius.begin())];
  for (std::size_t i = 0; i < cell.size(); ++i) stiffness[i] /= cell.mass[i];
  const Contacts& contacts = cell.state.contacts;
  if (springs.elasticSpheres())  // asked for in every sweep: going through pairs would cost 3 % of it
    omega2 = std::max(omega2, 2.0 * *std::ranges::max_element(stiffness));
  else
    for (std::size_t i = 0; i < cell.size(); ++i)
      for (int c = contacts.first[i]; c < contacts.first[i + 1]; ++c)
        omega2 = std::max(
            omega2, stiffness[i] + stiffness[static_cast<std::size_t>(contacts.other[static_cast<std::size_t>(c)])]);
  return dem::detail::verletLimit(factor * widest * omega2, 0.0);
}

void updateNeighbourList(Rve& cell, bool thin) {
  CellState& s = cell.state;
  const geometry::IntegerMatrix map = geometry::reduce(s.lattice);
  const double least = 2.0 * listReach(cell);
  const std::array<double, 3> widths = s.lattice.widths();
  for (std::size_t k = 0; k < 3; ++k)
    if (s.lattice.axes[k] && widths[k] < least && !thin)
      throw NumericalError(
          "faces of the cell are " + formatNumber(widths[k]) + " m apart", "cell of grains",
          "take more grains: two of the largest diameters and skins, " + formatNumber(least) + " m, are the least");
  const std::array<Vec3, 3> rows = geometry::inverse(s.lattice);
  const Renumbering renumbering{map, wrap(cell, rows)};
  Contacts contacts;
  list(cell, rows, bondedPairs(s.contacts, renumbering), contacts);
  const std::size_t size = contacts.size();
  for (std::size_t k = 0; k < (cell.shape == Shape::disc ? 1u : 3u); ++k) contacts.stretch[k].assign(size, 0.0);
  if (cell.springs.rolls()) contacts.roll.assign(size, 0.0);
  if (!s.contacts.bond.empty()) contacts.bond.resize(size);
  if (cell.springs.elasticSpheres() && cell.springs.slides()) contacts.tangent.assign(size, 0.0);
  inherit(contacts, s.contacts, renumbering);
  if (!s.contacts.bond.empty()) boundStiffness(cell, contacts);
  s.contacts = std::move(contacts);
  s.remainingSkin = cell.skin;
  if (!cell.springs.elasticSpheres()) s.criticalStep = criticalStep(cell, sumsOf(s.contacts, cell.size()));
  leaveToBonds(s.contacts);
}

}  // namespace dovetail::rve
