#include "dovetail/hierarchical/cell_field.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"
#include "dovetail/rve/operators.hpp"
#include "dovetail/rve/rve_archive.hpp"
#include "samples.hpp"

namespace dovetail::hierarchical {

namespace {

using RowMajor = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;

/// By rows, to an archive or from it.
template <class Archive, class Matrix>
void passMatrix(Archive& archive, Matrix& matrix) {
  constexpr int n = Matrix::RowsAtCompileTime;
  std::array<double, n * n> values;
  Eigen::Map<Eigen::Matrix<double, n, n, Eigen::RowMajor>> rows(values.data());
  rows = matrix;
  archive(values);
  matrix = rows;
}

class QuasiStatic {
public:
  explicit QuasiStatic(const QuasiStaticCells& settings) : settings_(settings) {}

  /// A cell that is to stay where it was committed is at rest there already.
  void go(rve::Rve& cell, const Eigen::Matrix3d& F, double, bool stays) const {
    if (!stays) relax(cell, F, settings_);
  }
  /// @param cell  the answer  @param committed  what its path started from
  rve::Tangent tangent(const rve::Rve& cell, const rve::CellState& committed) {
    switch (settings_.tangent) {
      case Operator::elasticTangent:
        return rve::elasticTangent(cell);
      case Operator::frictionalTangent:
        return rve::frictionalTangent(cell);
      case Operator::voigtTangent:
        return rve::voigtTangent(cell);
      case Operator::elasticProbe:
        return rve::elasticProbe(cell);
      case Operator::numericalTangent:
        return numericalTangent(cell, committed);
      case Operator::averagedTangent:
        break;
    }
    if (history_.frozen) return history_.at(cell.state.F);
    last_ = numericalTangent(cell, committed);
    asked_ = true;
    return last_;
  }
  void commit(const rve::Rve& cell) {
    if (settings_.tangent == Operator::averagedTangent && asked_)
      history_.next(cell.state.F, rve::nominalStress(cell), [this] { return last_; });
  }
  template <class Archive>
  void pass(Archive& archive) {
    if (settings_.tangent != Operator::averagedTangent) return;
    passMatrix(archive, history_.F);
    passMatrix(archive, history_.P);
    passMatrix(archive, history_.mean);
    passMatrix(archive, last_);
    archive(history_.count, history_.frozen, asked_);
  }

private:
  QuasiStaticCells settings_;
  rve::AveragedTangent history_;
  rve::Tangent last_ = rve::Tangent::Zero();
  bool asked_ = false;  ///< whether there is a last one

  rve::Tangent numericalTangent(const rve::Rve& cell, const rve::CellState& committed) const {
    rve::Rve start = cell;
    start.state = committed;
    rve::PathOptions path = settings_.path;
    path.rest.tolerance = settings_.unbalanced;
    return rve::numericalTangent(start, cell.state.F, {.path = path});
  }
};

struct Dynamic {
  DynamicCells settings;

  void go(rve::Rve& cell, const Eigen::Matrix3d& F, double dt, bool stays) const {
    if (!stays || dt > 0.0) stepTo(cell, F, settings);
  }
  rve::Tangent tangent(const rve::Rve& cell, const rve::CellState&) const { return rve::voigtTangent(cell); }
  void commit(const rve::Rve&) {}
  template <class Archive>
  void pass(Archive&) {}
};

/// Discs have no answer out of their plane, which F̄ of a mean dilatation leaves.
void requirePlane(const rve::Rve& cell, const Eigen::Matrix3d& F) {
  if (cell.shape == rve::Shape::sphere) return;
  if (F.col(2) == Eigen::Vector3d::UnitZ() && F.row(2) == Eigen::RowVector3d::Unit(2)) return;
  throw InputError("F33 is " + formatNumber(F(2, 2)) + ", but discs deform in their plane only", "cell of grains",
                   "use quad4 or quad8 with Formulation::standard or reduced; meanDilatation changes F33");
}

struct CellOwner {
  virtual ~CellOwner() = default;
  virtual rve::Rve committed() const = 0;
};

/// The committed cell, and what the last answer made of it.
template <class Update>
class CellPoint final : public fem::FieldPoint, public CellOwner {
public:
  CellPoint(const rve::Rve& cell, Update update) : cell_(cell), committed_(cell.state), update_(update) {}

  void evaluate(std::span<const double, 9> F, double dt, bool moved, fem::PointAnswer answer) override {
    const Eigen::Matrix3d wanted = Eigen::Map<const RowMajor>(F.data());
    if (!known_ || dt != dt_ || wanted != F_) {
      known_ = false;
      requirePlane(cell_, wanted);
      rve::restore(cell_, committed_);
      update_.go(cell_, wanted, dt, wanted == committedF_);
      F_ = wanted;
      dt_ = dt;
      known_ = true;
    }
    if (moved) tell(answer);
    if (!answer.tangent.empty())
      Eigen::Map<Eigen::Matrix<double, 9, 9, Eigen::RowMajor>>(answer.tangent.data()) =
          update_.tangent(cell_, committed_);
  }

  void commit() override {
    if (!known_) return;
    update_.commit(cell_);
    std::swap(committed_, cell_.state);
    committedF_ = F_;
    known_ = false;
  }
  void revert() override { known_ = false; }
  rve::Rve committed() const override {
    rve::Rve cell = cell_;
    cell.state = committed_;
    return cell;
  }

  void save(ByteWriter& archive) const override {
    rve::writeState(cell_, committed_, archive);
    Eigen::Matrix3d F = committedF_;
    passMatrix(archive, F);
    Update update = update_;
    update.pass(archive);
  }
  void load(ByteReader& archive) override {
    rve::CellState state = rve::readState(cell_, archive);
    Eigen::Matrix3d F = committedF_;
    passMatrix(archive, F);
    if (!((F - state.F).norm() <= 1e-9 * state.F.norm()))
      throw InputError("the deformation differs from that of the cell", "cell of grains", "take an older file");
    Update update = update_;
    update.pass(archive);
    committed_ = std::move(state);
    committedF_ = F;
    update_ = update;
    known_ = false;
  }

private:
  void tell(fem::PointAnswer& answer) const {
    Eigen::Map<RowMajor>(answer.P.data()) = rve::nominalStress(cell_);
    const rve::RveLedger &now = cell_.state.ledger, &before = committed_.ledger;
    answer.energy = (rve::storedEnergy(cell_) + rve::kineticEnergy(cell_)) / cell_.volume;
    answer.dissipated =
        (now.friction - before.friction + now.damping - before.damping + now.bonds - before.bonds) / cell_.volume;
  }

  rve::Rve cell_;
  rve::CellState committed_;
  Update update_;
  Eigen::Matrix3d F_, committedF_ = Eigen::Matrix3d::Identity();
  double dt_ = 0.0;
  bool known_ = false;  ///< whether the cell is the answer for F_ and dt_
};

template <class Update>
std::shared_ptr<fem::PointField> fieldOf(std::vector<rve::Rve> samples, double unbalanced, Update update) {
  validateSamples(samples, unbalanced);
  rve::Rve tried = samples.front();
  update.go(tried, tried.state.F, 1.0, false);  // says what is wrong with the settings
  const fem::FieldTraits traits{.name = nameOf(samples), .density = meanDensity(samples)};
  return fem::pointField(traits, [samples = std::move(samples), update](const fem::PointPlace& place) {
    const auto number = static_cast<std::size_t>(place.element + place.point) % samples.size();
    return std::make_unique<CellPoint<Update>>(samples[number], update);
  });
}

}  // namespace

std::optional<rve::Rve> committedCell(const fem::PointField& field, std::size_t point) {
  const auto* const owner = dynamic_cast<const CellOwner*>(field.point(point));
  if (!owner) return {};
  return owner->committed();
}

std::shared_ptr<fem::PointField> cellField(std::vector<rve::Rve> samples, const QuasiStaticCells& settings) {
  return fieldOf(std::move(samples), settings.unbalanced, QuasiStatic{settings});
}

std::shared_ptr<fem::PointField> cellField(std::vector<rve::Rve> samples, const DynamicCells& settings) {
  return fieldOf(std::move(samples), RestCriterion{}.tolerance, Dynamic{settings});
}

}  // namespace dovetail::hierarchical
