#include "gradient_matrix.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "mesh/cell_jacobian.hpp"

namespace dovetail::fem::detail {

namespace {

/// At a point, or the mean over an element: ψ_a by X of all nodes, N_c and N_c by X of the corners.
struct Sample {
  double volume = 0.0;
  std::array<Vec3, 8> byX{}, cornerByX{};
  std::array<double, 8> corner{};
};

/// (ΠF)_c = 1 + Σ_n u_n ⊗ weight_n at a corner; nodes ascend.
struct CornerMean {
  double volume = 0.0;
  std::vector<int> node;
  std::vector<Vec3> weight;
};

void sortAndUnite(std::vector<int>& list) {
  std::ranges::sort(list);
  list.erase(std::unique(list.begin(), list.end()), list.end());
}

std::size_t placeIn(const std::vector<int>& sorted, int node) {
  return static_cast<std::size_t>(std::ranges::lower_bound(sorted, node) - sorted.begin());
}

class Builder {
public:
  Builder(const SolidCells& cells, double modulus)
      : cells_(cells),
        modulus_(modulus),
        corners_(dimensionOf(cells.shape) == 3 ? ElementShape::hex8 : ElementShape::quad4),
        cornerCount_(static_cast<std::size_t>(nodesOf(corners_))),
        dimension_(dimensionOf(cells.shape)),
        rule_(dimensionOf(cells.shape) == 3 ? forceRule(cells.shape) : reducedRule(cells.shape)),
        geometry_(geometryAt(cells, rule_)),
        means_(cells.X.size()) {
    findMeans();
    linalg::MatrixPattern pattern(cells.X.size());
    for (std::size_t e = 0; e < cells.size(); ++e) pattern.add(patchOf(e));
    A_ = linalg::NodeMatrix(std::move(pattern));
    for (std::size_t e = 0; e < cells.size(); ++e) addElement(e);
  }
  linalg::NodeMatrix matrix() && { return std::move(A_); }

private:
  Sample sampleAt(std::size_t e, std::size_t q) const {
    const std::size_t n = cells_.nodes;
    const PointGeometry& point = geometry_[e / laneCount * rule_.point.size() + q];
    const int lane = static_cast<int>(e % laneCount);
    std::array<Vec3, 8> parent;
    Sample sample;
    sample.volume = std::max(0.0, point.weight[lane]);  // quad8 can make less than 0 of fractions
    shapeFunctions(corners_, rule_.point[q], std::span(sample.corner).first(cornerCount_),
                   std::span(parent).first(cornerCount_));
    const auto mapped = [&](const Vec3& byXi) {
      Vec3 byX;
      for (int j = 0; j < dimension_; ++j)
        for (int k = 0; k < dimension_; ++k) byX[j] += byXi[k] * point.map[static_cast<std::size_t>(3 * k + j)][lane];
      return byX;
    };
    for (std::size_t a = 0; a < n; ++a) sample.byX[a] = mapped(rule_.gradient[n * q + a]);
    for (std::size_t c = 0; c < cornerCount_; ++c) sample.cornerByX[c] = mapped(parent[c]);
    return sample;
  }
  std::vector<Sample> samplesOf(std::size_t e) const {
    std::vector<Sample> samples;
    for (std::size_t q = 0; q < rule_.point.size(); ++q) samples.push_back(sampleAt(e, q));
    return samples;
  }
  static Sample meanOf(std::span<const Sample> samples) {
    Sample mean;
    for (const Sample& one : samples) mean.volume += one.volume;
    if (mean.volume == 0.0) return mean;
    for (const Sample& one : samples)
      for (std::size_t a = 0; a < 8; ++a) {
        mean.byX[a] += one.volume / mean.volume * one.byX[a];
        mean.corner[a] += one.volume / mean.volume * one.corner[a];
      }
    return mean;
  }

  CornerMean& meanAt(std::size_t e, std::size_t c) { return means_[static_cast<std::size_t>(cells_.nodeOf(e, c))]; }

  void findMeans() {
    for (std::size_t e = 0; e < cells_.size(); ++e)
      for (std::size_t c = 0; c < cornerCount_; ++c)
        for (std::size_t a = 0; a < cells_.nodes; ++a) meanAt(e, c).node.push_back(cells_.nodeOf(e, a));
    for (CornerMean& mean : means_) {
      sortAndUnite(mean.node);
      mean.weight.resize(mean.node.size());
    }
    for (std::size_t e = 0; e < cells_.size(); ++e)
      for (const Sample& sample : samplesOf(e))
        for (std::size_t c = 0; c < cornerCount_; ++c) {
          CornerMean& mean = meanAt(e, c);
          const double volume = sample.volume * sample.corner[c];
          mean.volume += volume;
          for (std::size_t a = 0; a < cells_.nodes; ++a)
            mean.weight[placeIn(mean.node, cells_.nodeOf(e, a))] += volume * sample.byX[a];
        }
    for (CornerMean& mean : means_)
      if (mean.volume > 0.0)
        for (Vec3& weight : mean.weight) weight = (1.0 / mean.volume) * weight;
  }

  /// The nodes that the means at the corners of an element see, ascending.
  std::vector<int> patchOf(std::size_t e) {
    std::vector<int> patch;
    for (std::size_t c = 0; c < cornerCount_; ++c) {
      const std::vector<int>& seen = meanAt(e, c).node;
      patch.insert(patch.end(), seen.begin(), seen.end());
    }
    sortAndUnite(patch);
    return patch;
  }

  double lengthOf(std::size_t e) const {
    std::array<int, 8> nodes;
    for (std::size_t a = 0; a < cells_.nodes; ++a) nodes[a] = cells_.nodeOf(e, a);
    const Jacobian J = jacobianAt(cells_.X, std::span(nodes).first(cells_.nodes), centreRule(cells_.shape).gradient,
                                  depthOf(cells_.shape, cells_.thickness));
    std::array<double, 3> length = {2.0 * norm(J[0]), 2.0 * norm(J[1]), 2.0 * norm(J[2])};
    if (dimension_ == 2) return std::sqrt(length[0] * length[1]);
    std::ranges::sort(length);
    return length[1];
  }

  void addElement(std::size_t e) {
    const std::vector<int> patch = patchOf(e);
    const std::vector<Sample> points = samplesOf(e);
    const bool atPoints = cells_.shape == ElementShape::quad8;
    const std::vector<Sample> compared = atPoints ? points : std::vector{meanOf(points)};
    const double h = lengthOf(e), kappa = (atPoints ? 8.0 : 4.0) * modulus_ / (h * h);
    const auto size = static_cast<Eigen::Index>(patch.size()), corners = static_cast<Eigen::Index>(cornerCount_);
    Eigen::MatrixXd stiffness = Eigen::MatrixXd::Zero(corners, corners), matrix = Eigen::MatrixXd::Zero(size, size);
    for (const Sample& point : points)
      for (std::size_t c = 0; c < cornerCount_; ++c)
        for (std::size_t d = 0; d < cornerCount_; ++d)
          stiffness(static_cast<Eigen::Index>(c), static_cast<Eigen::Index>(d)) +=
              modulus_ * point.volume * dot(point.cornerByX[c], point.cornerByX[d]);
    for (int j = 0; j < dimension_; ++j) {
      Eigen::MatrixXd mean = Eigen::MatrixXd::Zero(corners, size);  // ∂(ΠF)_j at the corners by u
      for (std::size_t c = 0; c < cornerCount_; ++c) {
        const CornerMean& own = meanAt(e, c);
        for (std::size_t k = 0; k < own.node.size(); ++k)
          mean(static_cast<Eigen::Index>(c), static_cast<Eigen::Index>(placeIn(patch, own.node[k]))) = own.weight[k][j];
      }
      matrix += mean.transpose() * (stiffness * mean);
      for (const Sample& sample : compared) {
        Eigen::VectorXd difference =
            -mean.transpose() * Eigen::Map<const Eigen::VectorXd>(sample.corner.data(), corners);
        for (std::size_t a = 0; a < cells_.nodes; ++a)
          difference[static_cast<Eigen::Index>(placeIn(patch, cells_.nodeOf(e, a)))] += sample.byX[a][j];
        matrix += (kappa * sample.volume * difference) * difference.transpose();
      }
    }
    scatter(patch, matrix);
  }

  void scatter(const std::vector<int>& patch, const Eigen::MatrixXd& matrix) {
    for (std::size_t a = 0; a < patch.size(); ++a) {
      auto place = static_cast<std::size_t>(A_.offsets()[static_cast<std::size_t>(patch[a])]);
      for (std::size_t b = 0; b < patch.size(); ++b, ++place) {
        while (A_.columns()[place] != patch[b]) ++place;
        A_.values()[place] += matrix(static_cast<Eigen::Index>(a), static_cast<Eigen::Index>(b));
      }
    }
  }

  const SolidCells& cells_;
  double modulus_;
  ElementShape corners_;
  std::size_t cornerCount_;
  int dimension_;
  const CellRule& rule_;
  std::vector<PointGeometry> geometry_;
  std::vector<CornerMean> means_;  // per node of the mesh, empty but at corners
  linalg::NodeMatrix A_;
};

}  // namespace

linalg::NodeMatrix gradientMatrix(const SolidCells& cells, double modulus) { return Builder(cells, modulus).matrix(); }

}  // namespace dovetail::fem::detail
