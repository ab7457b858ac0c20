#include "dovetail/fem/solve/modes.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"
#include "dovetail/fem/model/model_mass.hpp"
#include "dovetail/fem/solve/linear_solver.hpp"
#include "dovetail/linalg/block_matrix.hpp"

namespace dovetail::fem {

namespace {

using Columns = Eigen::MatrixXd;

/// K and M on the free components, and (K + σ M)⁻¹ with a σ that rigid motions need and no other mode feels.
class Pencil {
public:
  Pencil(Model& model, const ModesOptions& options)
      : model_(model),
        dofs_(model.constraints, model.nodes),
        mass_(model, dofs_, options.massFraction),
        K_(zeroTangent(model)),
        solver_(dofs_, options.linear, &model.nodes),
        in_(model.nodes.X.size()),
        out_(in_.size()) {
    for (const auto& term : model.terms) {
      if (!term->isSymmetric())
        throw InputError("the tangent of \"" + term->name() + "\" is not symmetric, so that there may be no modes",
                         "modesOf", "leave it out");
    }
    if (K_.isPart()) throw InputError("elements are shared by ranks", "modesOf", "find modes by one process");
    addTangents(model, {.t = model.t}, K_);
    linalg::BlockMatrix shifted = K_;
    shift_ = shift();
    mass_.addTo(shifted, shift_);
    if (!solver_.factor(shifted, true) || solver_.negativePivots() > 0)
      throw NumericalError("the state is not stable: its tangent is not positive definite", "modesOf",
                           "take the modes of another state, such as one with lower loads");
  }
  const DofMap& dofs() const { return dofs_; }
  /// What round-off may make of an ω² of zero.
  double noise() const { return 1e-3 * shift_; }
  std::vector<Vec3> fieldOf(const Eigen::VectorXd& x) {
    std::vector<Vec3> field(in_.size());
    dofs_.addIncrement({x.data(), static_cast<std::size_t>(x.size())}, field);
    return field;
  }
  Columns stiffness(const Columns& X) {
    return eachOf(X, [&] { K_.multiply(in_, out_); });
  }
  Columns mass(const Columns& X) {
    return eachOf(X, [&] { mass_.multiply(in_, out_); });
  }
  void solve(Columns& X) {
    for (Eigen::Index c = 0; c < X.cols(); ++c) solver_.solve(spanOf(X, c), spanOf(X, c));
  }

private:
  static std::span<double> spanOf(Columns& X, Eigen::Index c) {
    return {X.col(c).data(), static_cast<std::size_t>(X.rows())};
  }
  template <class Product>
  Columns eachOf(const Columns& X, const Product& product) {
    Columns Y(X.rows(), X.cols());
    for (Eigen::Index c = 0; c < X.cols(); ++c) {
      std::fill(in_.begin(), in_.end(), Vec3{});
      dofs_.addIncrement({X.col(c).data(), static_cast<std::size_t>(X.rows())}, in_);
      product();
      dofs_.reduce(out_, spanOf(Y, c));
    }
    return Y;
  }
  double shift() {
    constexpr double negligible = 1e-10;
    double most = 0.0;
    for (std::size_t n = 0; n < in_.size(); ++n)
      for (int place = K_.offsets()[n]; place < K_.offsets()[n + 1]; ++place)
        for (std::size_t k = 0; k < 9; ++k)
          most = std::max(most, std::abs(K_.values()[9 * static_cast<std::size_t>(place) + k]) / model_.nodes.mass[n]);
    return negligible * most;
  }

  Model& model_;
  double shift_ = 0.0;  // 1/s²
  DofMap dofs_;
  ModelMass mass_;
  linalg::BlockMatrix K_;
  LinearSolver solver_;
  std::vector<Vec3> in_, out_;
};

/// Columns that have a bit of everything, the same for any build.
Columns startOf(Eigen::Index rows, Eigen::Index columns) {
  Columns X(rows, columns);
  double angle = 0.0;
  for (Eigen::Index c = 0; c < columns; ++c)
    for (Eigen::Index r = 0; r < rows; ++r)
      X(r, c) = std::cos(angle += 1.0 + std::sqrt(2.0) * static_cast<double>(c + 1));
  return X;
}

}  // namespace

Modes modesOf(Model& model, const ModesOptions& options) {
  constexpr int most = 500;
  constexpr double settled = 1e-10;
  requireMass(model.nodes);
  Pencil pencil(model, options);
  const auto size = static_cast<Eigen::Index>(pencil.dofs().size()), count = static_cast<Eigen::Index>(options.count);
  if (count < 1 || count > size)
    throw InputError(std::to_string(count) + " modes are asked for of " + std::to_string(size) + " free components",
                     "modesOf", "ask for as many as there are at most, and one at least");
  Columns X = startOf(size, std::min(size, std::max(2 * count, count + 8)));
  Eigen::VectorXd before = Eigen::VectorXd::Zero(count);
  for (int iteration = 0; iteration < most; ++iteration) {
    X = pencil.mass(X);
    pencil.solve(X);
    // Rigid motions have grown out of all proportion.
    X = Eigen::HouseholderQR<Columns>(X).householderQ() * Columns::Identity(X.rows(), X.cols());
    const Columns K = X.transpose() * pencil.stiffness(X), M = X.transpose() * pencil.mass(X);
    const Eigen::GeneralizedSelfAdjointEigenSolver<Columns> ritz(0.5 * (K + K.transpose()), 0.5 * (M + M.transpose()));
    if (ritz.info() != Eigen::Success) throw NumericalError("the subspace has collapsed", "modesOf", "ask for fewer");
    X = X * ritz.eigenvectors();
    const Eigen::VectorXd values = ritz.eigenvalues().head(count);
    const bool done = ((values - before).array().abs() <= settled * values.array().abs() + pencil.noise()).all();
    before = values;
    if (!done) continue;
    Modes modes;
    for (Eigen::Index m = 0; m < count; ++m) {
      modes.frequency.push_back(std::sqrt(values[m] > pencil.noise() ? values[m] : 0.0) / (2.0 * std::numbers::pi));
      std::vector<Vec3> shape = pencil.fieldOf(X.col(m));
      double largestMotion = 0.0;
      for (const Vec3& u : shape) largestMotion = std::max(largestMotion, norm(u));
      for (Vec3& u : shape) u = 1.0 / largestMotion * u;
      modes.shape.push_back(std::move(shape));
    }
    return modes;
  }
  throw NumericalError("the frequencies do not settle", "modesOf", "ask for more modes, or fewer");
}

}  // namespace dovetail::fem
