// Points that own their state: what stands behind the elements where a law and a few numbers per point are not enough,
// as for cells of particles, nonlocal averages and devices that want all points at once.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "dovetail/core/archive.hpp"
#include "dovetail/core/vec3.hpp"

namespace dovetail::fem {

class FieldPoint;
class PointMaterial;

/// A quadrature point of a solid, before any motion.
struct PointPlace {
  int element;    ///< number in the mesh; −1 of points without elements
  int point;      ///< within the element, in the order of its quadrature
  Vec3 X;         ///< m
  double volume;  ///< that it stands for, the fraction of the solid included, m³
};

/// What is asked of all points at once, in the order in which they were opened. Tensors are row-major.
struct FieldRequest {
  std::span<const double> F;  ///< ∂x/∂X at the end of the step, [9 p + 3 i + J]
  double dt;                  ///< length of the step, s; 0 where no time passes
  /// False if F and dt are those of the last evaluation, and nothing was committed or reverted since: P, dissipated and
  /// reason still hold what was answered then, and only the tangent or the energy is missing.
  bool moved;
  std::span<double> P;            ///< out: first Piola–Kirchhoff stress, Pa, [9 p + 3 i + J]
  std::span<double> tangent;      ///< out: ∂P_iJ/∂F_kL, Pa, [81 p + 9 (3 i + J) + 3 k + L]; empty if not asked for
  std::span<double> energy;       ///< out: stored energy per reference volume, J/m³
  std::span<double> dissipated;   ///< out: energy dissipated in the step per reference volume, J/m³, ≥ 0
  std::span<std::string> reason;  ///< out: why a point has no answer and what to do; empty where it has one
  bool rateAtEnd = false;         ///< as in PointBatch
  bool willCommit = false;        ///< as in Instant: the committed states are not wanted again
  bool withEnergy = true;         ///< else `energy` may be left as it is
};

/// All points of one solid with their states. Elements gather F of all points, ask once, and make forces or matrices
/// of the answers: forces and tangent at one state are one evaluation.
class PointField {
public:
  virtual ~PointField() = default;
  /// For reports: "cells of 400 grains".
  virtual std::string name() const = 0;
  /// Reference density, kg/m³.
  virtual double density() const = 0;
  /// Whether the tangent has the symmetry (iJ)(kL).
  virtual bool isSymmetric() const { return false; }
  /// As in PointMaterial.
  virtual bool feelsRates() const { return false; }
  /// Whether energy and dissipation account for all the work done on the points; if not, it is booked as it is done.
  virtual bool hasEnergy() const { return true; }

  /// Called once, before anything else: these are the points.
  virtual void open(std::span<const PointPlace> places) = 0;
  /// Answers from the committed states; what that leaves behind is kept apart, for commit(). Called from one thread.
  virtual void evaluate(const FieldRequest& request) = 0;
  /// The states that the last evaluation found are those that the next ones start from.
  virtual void commit() = 0;
  /// Forgets the last evaluation.
  virtual void revert() = 0;
  /// Committed states, and back. @throws InputError for those of other points, and keeps its own
  virtual void save(ByteWriter& archive) const = 0;
  virtual void load(ByteReader& archive) = 0;
  /// Bytes.
  virtual std::size_t memory() const { return 0; }
  /// A point in the order of open(), where they are evaluated one by one; else null. To be looked at before the next is
  /// asked for.
  virtual const FieldPoint* point(std::size_t) const { return nullptr; }
  /// That each point took in the last evaluation, s, in the order of open(); empty where nobody has looked.
  virtual std::vector<double> seconds() const { return {}; }
};

/// The points of a law, for decorators that ask it for all points at once. A solid with the law itself gives the same
/// answers, faster.
/// @throws InputError if there is no law
std::shared_ptr<PointField> pointField(std::shared_ptr<const PointMaterial> law);

/// Answer of one point; tensors as in FieldRequest.
struct PointAnswer {
  std::span<double, 9> P;
  std::span<double> tangent;  ///< 81 numbers, or empty if not asked for
  double& energy;
  double& dissipated;
  bool withEnergy;  ///< else `energy` may be left as it is
};

/// One point with a state of its own, of any type and size.
class FieldPoint {
public:
  virtual ~FieldPoint() = default;
  /// As PointField::evaluate, for one point. Several points are asked at the same time from different threads.
  /// @throws any std::exception if it has no answer: its text becomes the reason
  virtual void evaluate(std::span<const double, 9> F, double dt, bool moved, PointAnswer answer) = 0;
  /// The same where F and dt are new and commit() follows for certain: the committed state need not be kept. Until then
  /// a point that has not kept it refuses all but commit(), load() and questions about this answer.
  virtual void advance(std::span<const double, 9> F, double dt, PointAnswer answer) { evaluate(F, dt, true, answer); }
  virtual void commit() = 0;
  virtual void revert() = 0;
  virtual void save(ByteWriter& archive) const = 0;
  virtual void load(ByteReader& archive) = 0;
};

/// What all points of a field have in common; as in PointField.
struct FieldTraits {
  std::string name;
  double density;  ///< kg/m³
  bool isSymmetric = false;
  bool hasEnergy = true;
};

/// A field of points that are evaluated one by one, on all threads: those that took longest the last time come first.
/// @param makePoint  makes the point at a place in its first state
/// @throws InputError without a name, makePoint or a density > 0
std::shared_ptr<PointField> pointField(const FieldTraits& traits,
                                       std::function<std::unique_ptr<FieldPoint>(const PointPlace&)> makePoint);

}  // namespace dovetail::fem
