#include <algorithm>
#include <cmath>
#include <map>
#include <memory>

#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"
#include "dovetail/fem/model/ties.hpp"

namespace dovetail::fem {

namespace {

/// Finds nodes by their place: cells of twice the tolerance, neighbours looked at too.
class NodeFinder {
public:
  NodeFinder(std::span<const Vec3> X, std::span<const int> nodes, double tolerance) : X_(X), tolerance_(tolerance) {
    for (const int n : nodes) cells_.emplace(cellOf(X[static_cast<std::size_t>(n)]), n);
  }
  /// −1 if there is none.
  int at(const Vec3& place) const {
    const Cell centre = cellOf(place);
    for (int k = 0; k < 27; ++k) {
      const Cell cell = {centre[0] + k % 3 - 1, centre[1] + k / 3 % 3 - 1, centre[2] + k / 9 - 1};
      const auto [first, last] = cells_.equal_range(cell);
      for (auto it = first; it != last; ++it)
        if (norm(X_[static_cast<std::size_t>(it->second)] - place) <= tolerance_) return it->second;
    }
    return -1;
  }

private:
  using Cell = std::array<long long, 3>;
  Cell cellOf(const Vec3& x) const {
    const double edge = 2.0 * tolerance_;
    return {std::llround(x.x / edge), std::llround(x.y / edge), std::llround(x.z / edge)};
  }
  std::span<const Vec3> X_;
  double tolerance_;
  std::multimap<Cell, int> cells_;
};

struct Box {
  Vec3 lower, upper;
};

Box boundsOf(const SolidMesh& mesh) {
  if (mesh.X.empty()) throw InputError("the mesh has no nodes", "periodicTies", "give a mesh of a box");
  Box box{mesh.X[0], mesh.X[0]};
  for (const Vec3& X : mesh.X)
    for (int c = 0; c < 3; ++c) {
      box.lower[c] = std::min(box.lower[c], X[c]);
      box.upper[c] = std::max(box.upper[c], X[c]);
    }
  return box;
}

/// Ties the first components of a node: u = u_master + (F(t) − 1) period.
void addTies(std::vector<Tie>& ties, int components, int node, int master, const Vec3& period,
             const std::shared_ptr<const GradientFunction>& F) {
  for (int c = 0; c < components; ++c) {
    const auto motion = [F, c, period](double t) {
      const std::array<double, 9> gradient = (*F)(t);
      double sum = -period[c];
      for (int j = 0; j < 3; ++j) sum += gradient[static_cast<std::size_t>(3 * c + j)] * period[j];
      return sum;
    };
    ties.push_back({node, c, {{master, c, 1.0}}, 0.0, motion});
  }
}

}  // namespace

PeriodicTies periodicTies(const SolidMesh& mesh, const GradientFunction& F, std::array<bool, 3> axes,
                          double tolerance) {
  requirePositive(tolerance, "tolerance of periodic ties");
  if (!F) throw InputError("there is no macroscopic gradient", "periodicTies", "give a function of time");
  const auto [lower, upper] = boundsOf(mesh);
  const Vec3 sides = upper - lower;
  tolerance = requirePositive(tolerance * std::max({sides.x, sides.y, sides.z}), "longest side of the cell");
  const int dimension = dimensionOf(mesh);
  std::vector<int> masters;  // on a lower face and on no upper one
  std::vector<std::pair<int, Vec3>> slaves;
  for (std::size_t n = 0; n < mesh.X.size(); ++n) {
    Vec3 period;
    bool onLower = false;
    for (int c = 0; c < dimension; ++c) {
      if (!axes[static_cast<std::size_t>(c)]) continue;
      if (upper[c] - mesh.X[n][c] <= tolerance) period[c] = upper[c] - lower[c];
      if (mesh.X[n][c] - lower[c] <= tolerance) onLower = true;
    }
    if (!(period == Vec3{}))
      slaves.emplace_back(static_cast<int>(n), period);
    else if (onLower)
      masters.push_back(static_cast<int>(n));
  }
  const NodeFinder finder(mesh.X, masters, tolerance);
  const auto shared = std::make_shared<const GradientFunction>(F);
  PeriodicTies result;
  std::vector<char> used(mesh.X.size(), 0);
  for (const auto& [node, period] : slaves) {
    const int master = finder.at(mesh.X[static_cast<std::size_t>(node)] - period);
    if (master < 0)
      throw InputError("node " + std::to_string(node) + " has no image on the opposite face", "periodicTies",
                       "use a mesh whose opposite faces match, or a larger tolerance");
    used[static_cast<std::size_t>(master)] = 1;
    addTies(result.ties, dimension, node, master, period, shared);
  }
  for (const int master : masters)
    if (!used[static_cast<std::size_t>(master)])
      throw InputError("node " + std::to_string(master) + " has no image on the opposite face", "periodicTies",
                       "use a mesh whose opposite faces match, or a larger tolerance");
  Vec3 corner = lower;
  result.corner = finder.at(corner);
  result.volume = sides.x * sides.y * (dimension == 2 ? mesh.thickness : sides.z);
  return result;
}

std::array<double, 9> averageFirstStress(const Nodes& nodes, std::span<const Vec3> f, double volume) {
  requirePositive(volume, "volume");
  std::array<double, 9> P{};
  for (std::size_t n = 0; n < f.size(); ++n)
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) P[static_cast<std::size_t>(3 * i + j)] -= f[n][i] * nodes.X[n][j] / volume;
  return P;
}

}  // namespace dovetail::fem
