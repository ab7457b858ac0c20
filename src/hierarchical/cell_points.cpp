#include "cell_points.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"
#include "dovetail/rve/operators.hpp"
#include "dovetail/rve/rve_archive.hpp"

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
  static constexpr bool startsAnew = true;  ///< answers and tangents are paths from the committed cell
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
  static constexpr bool startsAnew = false;
  DynamicCells settings;

  void go(rve::Rve& cell, const Eigen::Matrix3d& F, double dt, bool stays) const {
    if (!stays || dt > 0.0) stepTo(cell, F, settings);
  }
  rve::Tangent tangent(const rve::Rve& cell) const { return rve::voigtTangent(cell); }
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

/// With a tenth to spare, for the strain of the next step.
bool isThin(const rve::Rve& cell) { return cell.frame.empty() && rve::relativeWidth(cell) < 1.1; }

/// A cell, and the committed state where the cell has gone on from it.
template <class Update>
class CellPoint final : public fem::FieldPoint, public CellOwner {
public:
  CellPoint(const rve::Rve& cell, Update update) : cell_(cell), before_(cell.state.ledger), update_(update) {}

  void evaluate(std::span<const double, 9> F, double dt, bool moved, fem::PointAnswer answer) override {
    const Eigen::Matrix3d wanted = Eigen::Map<const RowMajor>(F.data());
    if (!answered_ || dt != dt_ || wanted != F_) {
      requirePlane(cell_, wanted);
      keep();
      go(wanted, dt);
      moved = true;
    }
    tell(moved, answer);
  }
  void advance(std::span<const double, 9> F, double dt, fem::PointAnswer answer) override {
    if constexpr (Update::startsAnew) return evaluate(F, dt, true, answer);
    const Eigen::Matrix3d wanted = Eigen::Map<const RowMajor>(F.data());
    requirePlane(cell_, wanted);
    goBack();
    committed_ = Committed::lost;
    go(wanted, dt);
    tell(true, answer);
  }

  void commit() override {
    if (!answered_) return;
    update_.commit(cell_);
    for (; isThin(cell_) && copies_ < mostCopies; copies_ *= 2) rve::repeat(cell_);
    before_ = cell_.state.ledger;
    committedF_ = F_;
    committed_ = Committed::inCell;
    answered_ = false;
  }
  void revert() override { answered_ = false; }
  int copies() const override { return copies_; }
  void visitCommitted(const std::function<void(const rve::Rve&)>& visit) const override {
    if (committed_ == Committed::inCell) return visit(cell_);
    rve::Rve cell = cell_;
    cell.state = committed();
    visit(cell);
  }

  void save(ByteWriter& archive) const override {
    archive(copies_);
    rve::writeState(cell_, committed(), archive);
    Eigen::Matrix3d F = committedF_;
    passMatrix(archive, F);
    Update update = update_;
    update.pass(archive);
  }
  void load(ByteReader& archive) override {
    int copies = 0;
    archive(copies);
    if (copies < 1 || copies > mostCopies)
      throw InputError("it is of " + std::to_string(copies) + " copies", "cell of grains", "take an older file");
    rve::Rve cell = rve::inCopies(cell_, copies_, copies);
    rve::CellState state = rve::readState(cell, archive);
    Eigen::Matrix3d F = committedF_;
    passMatrix(archive, F);
    if (!((F - state.F).norm() <= 1e-9 * state.F.norm()))
      throw InputError("the deformation differs from that of the cell", "cell of grains", "take an older file");
    Update update = update_;
    update.pass(archive);
    cell_ = std::move(cell);
    cell_.state = std::move(state);
    copies_ = copies;
    before_ = cell_.state.ledger;
    committedF_ = F;
    update_ = update;
    committed_ = Committed::inCell;
    answered_ = false;
  }

private:
  enum class Committed { inCell, kept, lost };

  [[noreturn]] static void refuse() {
    throw NumericalError("the grains have gone on in a step that was not accepted, and where it began was not kept",
                         "cell of grains", "load a saved state");
  }
  const rve::CellState& committed() const {
    if (committed_ == Committed::lost) refuse();
    return committed_ == Committed::kept ? kept_ : cell_.state;
  }
  /// The cell is in its committed state, which is nowhere else.
  void goBack() {
    if (committed_ == Committed::lost) refuse();
    if (committed_ == Committed::kept) std::swap(cell_.state, kept_);
    committed_ = Committed::inCell;
    answered_ = false;
  }
  /// The same, but it is kept too.
  void keep() {
    if (committed_ == Committed::kept)
      cell_.state = kept_;
    else
      kept_ = committed();
    committed_ = Committed::kept;
    answered_ = false;
  }
  void go(const Eigen::Matrix3d& F, double dt) {
    update_.go(cell_, F, dt, F == committedF_);
    F_ = F;
    dt_ = dt;
    answered_ = true;
  }
  void tell(bool moved, fem::PointAnswer& answer) {
    if (moved) {
      Eigen::Map<RowMajor>(answer.P.data()) = rve::nominalStress(cell_);
      const rve::RveLedger& now = cell_.state.ledger;
      answer.dissipated =
          (now.friction - before_.friction + now.damping - before_.damping + now.bonds - before_.bonds) / cell_.volume;
    }
    if (answer.withEnergy) answer.energy = (rve::storedEnergy(cell_) + rve::kineticEnergy(cell_)) / cell_.volume;
    if (answer.tangent.empty()) return;
    Eigen::Map<Eigen::Matrix<double, 9, 9, Eigen::RowMajor>> tangent(answer.tangent.data());
    if constexpr (Update::startsAnew)
      tangent = update_.tangent(cell_, committed());
    else
      tangent = update_.tangent(cell_);
  }

  rve::Rve cell_;
  int copies_ = 1;         ///< of the sample, side by side
  rve::CellState kept_;    ///< the committed state, if it is kept apart
  rve::RveLedger before_;  ///< of the committed state
  Update update_;
  Eigen::Matrix3d F_, committedF_ = Eigen::Matrix3d::Identity();
  double dt_ = 0.0;
  Committed committed_ = Committed::inCell;  ///< where that state is
  bool answered_ = false;                    ///< whether the cell is the answer for F_ and dt_
};

template <class Update>
MakeCell makerOf(std::shared_ptr<const std::vector<rve::Rve>> samples, const Update& update) {
  rve::Rve tried = samples->front();
  Update trying = update;
  trying.go(tried, tried.state.F, 1.0, false);  // says what is wrong with the settings
  return [samples = std::move(samples), update](std::size_t sample) {
    return std::make_unique<CellPoint<Update>>(samples->at(sample), update);
  };
}

}  // namespace

MakeCell cellMaker(std::shared_ptr<const std::vector<rve::Rve>> samples, const QuasiStaticCells& settings) {
  return makerOf(std::move(samples), QuasiStatic{settings});
}

MakeCell cellMaker(std::shared_ptr<const std::vector<rve::Rve>> samples, const DynamicCells& settings) {
  return makerOf(std::move(samples), Dynamic{settings});
}

}  // namespace dovetail::hierarchical
