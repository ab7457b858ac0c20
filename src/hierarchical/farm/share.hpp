// The points of a field that one rank answers for.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "cell_points.hpp"
#include "dovetail/fem/laws/point_tasks.hpp"
#include "letters.hpp"

namespace dovetail::hierarchical {

class FarmShare {
public:
  /// @throws InputError if a setting is not valid
  explicit FarmShare(const CellRecipe& recipe);

  /// A point that begins as the sample of that number.
  std::unique_ptr<fem::FieldPoint> fresh(std::size_t sample) const { return make_(sample); }
  /// A point as such a parcel says. @throws InputError if the state is not one of its sample
  std::unique_ptr<fem::FieldPoint> unpack(const Parcel& parcel) const;
  void take(const Parcel& parcel);
  /// @throws Error if the committed state of the point is lost
  std::vector<char> stateOf(std::uint64_t number) const;
  void drop(std::uint64_t number);
  void clear();
  const fem::FieldPoint& point(std::uint64_t number) const { return points_[placeOf(number)]; }

  /// Of its cells, in their order.
  std::vector<int> copies() const;
  Answers evaluate(const Question& question);
  void commit() { points_.commit(); }
  void revert() { points_.revert(); }

private:
  std::size_t placeOf(std::uint64_t number) const;

  MakeCell make_;
  std::vector<std::uint64_t> numbers_;
  fem::PointTasks points_;
};

}  // namespace dovetail::hierarchical
