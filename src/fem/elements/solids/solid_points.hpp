// Who answers for the quadrature points of a solid: a law with a history of numbers, or a field of points that own
// their states.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "dovetail/fem/laws/material_probe.hpp"
#include "dovetail/fem/laws/point_field.hpp"
#include "dovetail/fem/laws/point_material.hpp"
#include "dovetail/fem/model/term.hpp"
#include "elements/lanes/lane.hpp"

namespace dovetail::fem::detail {

/// A batch at its points, [9 q + 3 i + J] and so on; any of tangent, energy, dissipated may be null.
struct PointCall {
  std::size_t batch;
  double dt;
  bool rateAtEnd;
  const Lane* F;
  Lane *P, *tangent, *energy, *dissipated;
};

/// What is wanted of an answer beside the stress.
struct Wanted {
  bool tangent = false;
  bool energy = true;
  bool toRead = false;  ///< not to go on from: answers of a state that was committed since will do
};

class SolidPoints {
public:
  SolidPoints() = default;
  virtual ~SolidPoints() = default;
  SolidPoints(const SolidPoints&) = delete;
  SolidPoints& operator=(const SolidPoints&) = delete;

  virtual double density() const = 0;
  virtual bool isSymmetric() const = 0;
  virtual bool isElastic() const = 0;
  virtual bool feelsRates() const = 0;
  virtual bool hasEnergy() const = 0;
  /// Largest ratio of viscosity to modulus, s.
  virtual double dampingTime() const = 0;
  /// Whether there is a state that changes in commit().
  virtual bool remembers() const = 0;
  /// Null for a field.
  virtual const PointMaterial* law() const { return nullptr; }
  /// Null for a law: what is asked of points must then be asked of all of them ahead.
  virtual class FieldPoints* field() { return nullptr; }

  virtual bool isOpen() const = 0;
  /// @param places  of all points of all elements, those of one element one after another
  virtual void open(std::size_t pointsPerElement, std::span<const PointPlace> places) = 0;
  virtual ModuliAtRest moduliAtRest() = 0;
  virtual void evaluate(const PointCall& call) = 0;
  virtual void commit() = 0;
  virtual void revert() = 0;
  virtual void save(ByteWriter& archive) const = 0;
  virtual void load(ByteReader& archive, const std::string& where) = 0;
  /// Why F (nine numbers) cannot be trusted; empty if it can.
  virtual std::string whyInvalid(const double* F, Scrutiny scrutiny) const = 0;
  /// Committed numbers of a point, if there are any.
  virtual std::span<const double> history(std::size_t /*element*/, std::size_t /*point*/) const { return {}; }
  virtual std::size_t memory() const = 0;
};

/// @throws InputError for null
std::unique_ptr<SolidPoints> pointsOf(std::shared_ptr<const PointMaterial> law);
std::unique_ptr<SolidPoints> pointsOf(std::shared_ptr<PointField> field);

/// @throws InputError unless there are so many, all finite
std::vector<double> readNumbers(ByteReader& archive, std::size_t count, const std::string& where);

/// Answers of a field, kept for the batches that ask for them one after another.
class FieldPoints final : public SolidPoints {
public:
  explicit FieldPoints(std::shared_ptr<PointField> field) : field_(std::move(field)) {}

  double density() const override { return field_->density(); }
  bool isSymmetric() const override { return field_->isSymmetric(); }
  bool isElastic() const override { return false; }
  bool feelsRates() const override { return field_->feelsRates(); }
  bool hasEnergy() const override { return field_->hasEnergy(); }
  double dampingTime() const override;
  bool remembers() const override { return true; }
  FieldPoints* field() override { return this; }
  const PointField& asked() const { return *field_; }

  bool isOpen() const override { return !places_.empty(); }
  void open(std::size_t pointsPerElement, std::span<const PointPlace> places) override;
  ModuliAtRest moduliAtRest() override;
  void evaluate(const PointCall& call) override;
  void commit() override;
  void revert() override;
  void save(ByteWriter& archive) const override { field_->save(archive); }
  void load(ByteReader& archive, const std::string& where) override;
  std::string whyInvalid(const double* F, Scrutiny scrutiny) const override;
  std::size_t memory() const override;

  /// Whether the answers are those of these displacements and this length of the step, and whether nothing was
  /// committed since (where `toRead` that does not matter).
  bool knows(std::span<const Vec3> u, const Instant& now, const Wanted& wanted) const;
  /// Where F of all points belongs before ask(): lanes of a batch, [9 q + 3 i + J].
  void gather(std::size_t batch, const Lane* F);
  /// @throws NumericalError naming the first element and point without an answer, or with one that is not finite
  void ask(std::span<const Vec3> u, const Instant& now, const Wanted& wanted, const std::string& name);

private:
  void requireAnswers(const std::string& name) const;
  FieldRequest request(const Instant& now, bool moved, const Wanted& wanted);
  void findEnergies();
  std::size_t place(std::size_t batch, std::size_t point, std::size_t lane) const;

  std::shared_ptr<PointField> field_;
  std::vector<PointPlace> places_;
  std::size_t perElement_ = 0;
  std::vector<double> F_, P_, tangent_, energy_, dissipated_;
  std::vector<std::string> reason_;
  std::vector<Vec3> u_;
  double dt_ = 0.0;
  bool rateAtEnd_ = false, asked_ = false, hasTangent_ = false, hasEnergy_ = false, committed_ = false;
};

}  // namespace dovetail::fem::detail
