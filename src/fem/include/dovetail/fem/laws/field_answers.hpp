// What a field of points answers at a state of the nodes, kept for all who ask one after another.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "dovetail/fem/laws/point_field.hpp"
#include "dovetail/fem/model/term.hpp"

namespace dovetail::fem {

/// What is wanted of an answer beside the stress.
struct Wanted {
  bool tangent = false;
  bool energy = true;
  bool toRead = false;  ///< not to go on from: answers of a state that was committed since will do
};

/// Asks a field once per state: forces, energies, tangent and commit() of a step are of one evaluation.
class FieldAnswers {
public:
  explicit FieldAnswers(std::shared_ptr<PointField> field) : field_(std::move(field)) {}
  const PointField& field() const { return *field_; }

  bool isOpen() const { return !places_.empty(); }
  void open(std::span<const PointPlace> places);
  std::span<const PointPlace> places() const { return places_; }

  /// Whether the answers are those of these displacements and this length of the step, and whether nothing was
  /// committed since (where `toRead` that does not matter).
  bool knows(std::span<const Vec3> u, const Instant& now, const Wanted& wanted) const;
  /// Where F of all points belongs before ask(), [9 p + 3 i + J].
  std::span<double> F() { return F_; }
  /// @throws NumericalError naming the first point without an answer, or with one that is not finite
  void ask(std::span<const Vec3> u, const Instant& now, const Wanted& wanted, const std::string& name);
  std::span<const double> F() const { return F_; }
  std::span<const double> P() const { return P_; }
  std::span<const double> tangent() const { return tangent_; }
  std::span<const double> energy() const { return energy_; }          ///< J/m³
  std::span<const double> dissipated() const { return dissipated_; }  ///< J/m³

  /// The nodes are others now, and F at displacements u of them is what it was: the answers are those of a committed
  /// state.
  void moveTo(std::span<const Vec3> u) { u_.assign(u.begin(), u.end()); }
  void commit();
  void revert();
  /// With the last answers: they need not be asked for anew.
  void save(ByteWriter& archive) const;
  /// @throws InputError for those of other points, or numbers that are not finite; all is then as it was
  void load(ByteReader& archive);
  /// Bytes.
  std::size_t memory() const;

private:
  void requireAnswers(const std::string& name) const;
  FieldRequest request(const Instant& now, bool moved, const Wanted& wanted);
  void findEnergies();

  std::shared_ptr<PointField> field_;
  std::vector<PointPlace> places_;
  std::vector<double> F_, P_, tangent_, energy_, dissipated_;
  std::vector<std::string> reason_;
  std::vector<Vec3> u_;
  double dt_ = 0.0;
  bool rateAtEnd_ = false, asked_ = false, hasTangent_ = false, hasEnergy_ = false, committed_ = false;
};

}  // namespace dovetail::fem
