// Terms on faces, carried by material points.
#include "dovetail/core/error.hpp"
#include "dovetail/linalg/block_matrix.hpp"
#include "dovetail/mpm/markers.hpp"
#include "dovetail/mpm/point_solid.hpp"

namespace dovetail::mpm {

namespace {

class OnMarkers final : public MarkerTerm {
public:
  OnMarkers(std::shared_ptr<const PointSolid> points, std::size_t set, std::shared_ptr<fem::Term> term)
      : points_(std::move(points)), set_(set), term_(std::move(term)) {
    nodes_.X = markers().X;
  }

  const fem::Term& term() const override { return *term_; }
  fem::Nodes seen(const fem::Nodes& nodes) const override {
    fem::Nodes all;
    all.X = nodes_.X;
    all.u = valuesAt(markers(), nodes.u);
    all.v = valuesAt(markers(), nodes.v);
    for (std::size_t m = 0; m < all.X.size(); ++m) all.u[m] += markers().X[m] - all.X[m];
    all.f.assign(all.X.size(), {});
    return all;
  }

  std::string name() const override { return term_->name(); }
  bool usesVelocity() const override { return term_->usesVelocity(); }
  bool feelsRates() const override { return term_->feelsRates(); }
  bool isSymmetric() const override { return term_->isSymmetric(); }
  bool hasEnergy() const override { return term_->hasEnergy(); }

  void addForces(const fem::Nodes& nodes, const fem::Instant& now, std::span<Vec3> f) override {
    place(nodes);
    term_->addForces(nodes_, now, nodes_.f);
    addTransposed(markers(), nodes_.f, f);
  }
  double energy(const fem::Nodes& nodes, const fem::Instant& now) override {
    place(nodes);
    return term_->energy(nodes_, now);
  }

  void addPattern(linalg::MatrixPattern& pattern) const override {
    for (const std::vector<int>& group : groupsOf(pairs())) pattern.add(group);
  }
  void addTangent(const fem::Nodes& nodes, const fem::Instant& now, linalg::BlockMatrix& K) override {
    addCarried(nodes, K, [&](linalg::BlockMatrix& own) { term_->addTangent(nodes_, now, own); });
  }
  void addDamping(const fem::Nodes& nodes, const fem::Instant& now, linalg::BlockMatrix& C) override {
    addCarried(nodes, C, [&](linalg::BlockMatrix& own) { term_->addDamping(nodes_, now, own); });
  }

  double commit(const fem::Nodes& nodes, const fem::Instant& now) override {
    place(nodes);
    return term_->commit(nodes_, now);
  }
  double workOfMotion() const override { return term_->workOfMotion(); }
  bool augment(const fem::Nodes& nodes, const fem::Instant& now) override {
    place(nodes);
    return term_->augment(nodes_, now);
  }
  void revert() override { term_->revert(); }
  void save(ByteWriter& archive) const override { term_->save(archive); }
  void load(ByteReader& archive) override { term_->load(archive); }

private:
  const Markers& markers() const { return points_->markers(set_); }

  void place(const fem::Nodes& nodes) { nodes_ = seen(nodes); }

  linalg::NodePairs pairs() const {
    linalg::MatrixPattern pattern(nodes_.X.size());
    term_->addPattern(pattern);
    return linalg::NodePairs(std::move(pattern));
  }

  /// Nodes that a marker and those coupled with it go with.
  std::vector<std::vector<int>> groupsOf(const linalg::NodePairs& pairs) const {
    std::vector<std::vector<int>> groups;
    for (std::size_t m = 0; m < pairs.nodes(); ++m) {
      std::vector<int>& group = groups.emplace_back();
      eachOf(pairs, m, [&](std::size_t, int other) {
        for (const int column : markers().map.rowColumns(other)) group.push_back(nodeOf(column).node);
      });
    }
    return groups;
  }

  template <class Visit>
  static void eachOf(const linalg::NodePairs& pairs, std::size_t m, Visit&& visit) {
    for (int k = pairs.offsets()[m]; k < pairs.offsets()[m + 1]; ++k)
      visit(static_cast<std::size_t>(k), pairs.columns()[static_cast<std::size_t>(k)]);
  }

  NodeImage nodeOf(int column) const {
    const auto nodes = static_cast<int>(markers().nodes());
    return column < nodes ? NodeImage{column, 0} : markers().images[static_cast<std::size_t>(column - nodes)];
  }

  /// K += Sᵀ K_own S.
  template <class Add>
  void addCarried(const fem::Nodes& nodes, linalg::BlockMatrix& K, Add&& add) {
    place(nodes);
    linalg::BlockMatrix own(pairs());
    add(own);
    for (std::size_t m = 0; m < own.nodes(); ++m)
      eachOf(own, m, [&](std::size_t k, int other) {
        addBlock(static_cast<int>(m), other, own.values().subspan(9 * k).first<9>(), K);
      });
  }

  void addBlock(int row, int column, std::span<const double, 9> block, linalg::BlockMatrix& K) const {
    const cg::Projection& map = markers().map;
    const auto sign = [](std::uint8_t flip, int c) { return flip >> c & 1 ? -1.0 : 1.0; };
    for (std::size_t a = 0; a < map.rowColumns(row).size(); ++a)
      for (std::size_t b = 0; b < map.rowColumns(column).size(); ++b) {
        const NodeImage to = nodeOf(map.rowColumns(row)[a]), from = nodeOf(map.rowColumns(column)[b]);
        const double weight = map.rowWeights(row)[a] * map.rowWeights(column)[b];
        std::array<double, 9> part{};
        for (int i = 0; i < 3; ++i)
          for (int j = 0; j < 3; ++j) {
            const auto k = static_cast<std::size_t>(3 * i + j);
            part[k] = weight * sign(to.flip, i) * sign(from.flip, j) * block[k];
          }
        K.addBlock(to.node, from.node, part);
      }
  }

  std::shared_ptr<const PointSolid> points_;
  std::size_t set_;
  std::shared_ptr<fem::Term> term_;
  fem::Nodes nodes_;  // the markers
};

}  // namespace

std::shared_ptr<MarkerTerm> onMarkers(std::shared_ptr<const PointSolid> points, std::size_t set,
                                      std::shared_ptr<fem::Term> term) {
  if (points == nullptr || term == nullptr)
    throw InputError("there are no points, or no term", "mpm::onMarkers", "give those of makePoints, and a load");
  return std::make_shared<OnMarkers>(std::move(points), set, std::move(term));
}

}  // namespace dovetail::mpm
