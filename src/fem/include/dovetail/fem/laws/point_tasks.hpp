// Points with states of their own, as tasks for the threads of a process.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "dovetail/fem/laws/point_field.hpp"

namespace dovetail::fem {

/// Points that are evaluated one by one, on all threads: those that took longest the last time come first.
class PointTasks {
public:
  std::size_t size() const { return points_.size(); }
  /// @param point  not null
  void add(std::unique_ptr<FieldPoint> point);
  /// The others keep their order.
  void remove(std::size_t p);
  FieldPoint& operator[](std::size_t p) { return *points_.at(p); }
  const FieldPoint& operator[](std::size_t p) const { return *points_.at(p); }

  /// As PointField::evaluate, of these points in their order.
  void evaluate(const FieldRequest& request);
  void commit();
  void revert();
  /// That each took the last time, s.
  std::span<const double> seconds() const { return seconds_; }

private:
  std::vector<std::size_t> longestFirst() const;
  void evaluate(std::size_t p, const FieldRequest& request);

  std::vector<std::unique_ptr<FieldPoint>> points_;
  std::vector<double> seconds_;
};

/// Reads the number of points that states of a field begin with.
/// @param where  for the message @throws InputError unless it is `count`
void readPointCount(ByteReader& archive, std::size_t count, const std::string& where);

}  // namespace dovetail::fem
