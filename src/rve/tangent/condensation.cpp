#include "condensation.hpp"

#include <Eigen/LU>
#include <set>
#include <utility>

namespace dovetail::rve {

namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }

auto ofNode(auto& x, int node) { return x.template middleRows<perSphere>(perSphere * node); }

/// Of one node, which has no row or column after it. Returns its neighbours. Its block may be almost singular: systems
/// with it are solved, for a product with its inverse would lose as many digits as its condition has.
std::vector<int> eliminate(int node, CondensedNetwork& network) {
  struct Link {
    int other;
    SphereBlock solved, from;  // block⁻¹ of the row's, and in the column, of the node
  };
  auto& row = network.rows[at(node)];
  const Eigen::PartialPivLU<SphereBlock> own(row.at(node));
  row.erase(node);
  std::vector<Link> links;
  for (const auto& [other, block] : row)
    links.push_back({other, own.solve(block), network.rows[at(other)].extract(node).mapped()});
  row.clear();
  const Eigen::MatrixXd b = own.solve(ofNode(network.b, node)), g = ofNode(network.g, node);
  network.solved += g.transpose() * b;
  std::vector<int> neighbours;
  for (const Link& i : links) {
    for (const Link& j : links)
      network.rows[at(i.other)].try_emplace(j.other, SphereBlock::Zero()).first->second -= i.from.lazyProduct(j.solved);
    ofNode(network.b, i.other) -= i.from.lazyProduct(b);
    ofNode(network.g, i.other) -= i.solved.transpose().lazyProduct(g);
    neighbours.push_back(i.other);
  }
  return neighbours;
}

/// Without the nodes that have no row.
CondensedNetwork compact(const CondensedNetwork& network) {
  std::vector<int> kept, place(network.rows.size(), -1);
  for (int i = 0; at(i) < network.rows.size(); ++i) {
    if (network.rows[at(i)].empty()) continue;
    place[at(i)] = static_cast<int>(kept.size());
    kept.push_back(i);
  }
  const auto size = static_cast<Eigen::Index>(perSphere * kept.size());
  CondensedNetwork left{SphereRows(kept.size()), {size, network.b.cols()}, {size, network.g.cols()}, network.solved};
  for (int k = 0; at(k) < kept.size(); ++k) {
    const int node = kept[at(k)];
    for (const auto& [j, block] : network.rows[at(node)]) left.rows[at(k)].emplace(place[at(j)], block);
    ofNode(left.b, k) = ofNode(network.b, node);
    ofNode(left.g, k) = ofNode(network.g, node);
  }
  return left;
}

}  // namespace

Eigen::MatrixXd product(const SphereRows& rows, const Eigen::MatrixXd& x) {
  Eigen::MatrixXd y = Eigen::MatrixXd::Zero(x.rows(), x.cols());
  for (int i = 0; at(i) < rows.size(); ++i)
    for (const auto& [j, block] : rows[at(i)]) ofNode(y, i) += block.lazyProduct(ofNode(x, j));
  return y;
}

Eigen::MatrixXd transposedProduct(const SphereRows& rows, const Eigen::MatrixXd& x) {
  Eigen::MatrixXd y = Eigen::MatrixXd::Zero(x.rows(), x.cols());
  for (int i = 0; at(i) < rows.size(); ++i)
    for (const auto& [j, block] : rows[at(i)]) ofNode(y, j) += block.transpose().lazyProduct(ofNode(x, i));
  return y;
}

CondensedNetwork condensed(SphereRows rows, Eigen::MatrixXd b, Eigen::MatrixXd g, std::size_t most) {
  const Eigen::MatrixXd none = Eigen::MatrixXd::Zero(g.cols(), b.cols());
  CondensedNetwork network{std::move(rows), std::move(b), std::move(g), none};
  std::set<std::pair<std::size_t, int>> byDegree;
  const auto key = [&](int node) { return std::pair(network.rows[at(node)].size() - 1, node); };
  for (int i = 0; at(i) < network.rows.size(); ++i) byDegree.insert(key(i));
  while (!byDegree.empty() && byDegree.begin()->first <= most) {
    const int node = byDegree.begin()->second;
    byDegree.erase(byDegree.begin());
    for (const auto& [other, block] : network.rows[at(node)]) byDegree.erase(key(other));
    for (const int other : eliminate(node, network)) byDegree.insert(key(other));
  }
  return compact(network);
}

}  // namespace dovetail::rve
