// Who answers for the quadrature points of a solid: a law with a history of numbers, or a field of points that own
// their states.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "dovetail/fem/laws/field_answers.hpp"
#include "dovetail/fem/laws/material_probe.hpp"
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

/// Answers of a field, handed out to batches.
class FieldPoints final : public SolidPoints {
public:
  explicit FieldPoints(std::shared_ptr<PointField> field) : answers(std::move(field)) {}

  double density() const override { return answers.field().density(); }
  bool isSymmetric() const override { return answers.field().isSymmetric(); }
  bool isElastic() const override { return false; }
  bool feelsRates() const override { return answers.field().feelsRates(); }
  bool hasEnergy() const override { return answers.field().hasEnergy(); }
  double dampingTime() const override;
  bool remembers() const override { return true; }
  FieldPoints* field() override { return this; }

  bool isOpen() const override { return answers.isOpen(); }
  void open(std::size_t pointsPerElement, std::span<const PointPlace> places) override;
  ModuliAtRest moduliAtRest() override;
  void evaluate(const PointCall& call) override;
  void commit() override { answers.commit(); }
  void revert() override { answers.revert(); }
  void save(ByteWriter& archive) const override { answers.save(archive); }
  void load(ByteReader& archive, const std::string&) override { answers.load(archive); }
  std::string whyInvalid(const double* F, Scrutiny scrutiny) const override;
  std::size_t memory() const override { return answers.memory(); }

  /// Where F of all points belongs before answers.ask(): lanes of a batch, [9 q + 3 i + J].
  void gather(std::size_t batch, const Lane* F);

  FieldAnswers answers;

private:
  std::size_t place(std::size_t batch, std::size_t point, std::size_t lane) const;
  std::size_t perElement_ = 0;
};

}  // namespace dovetail::fem::detail
