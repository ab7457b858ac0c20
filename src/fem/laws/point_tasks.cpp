#include "dovetail/fem/laws/point_tasks.hpp"

#include <algorithm>
#include <chrono>
#include <numeric>

#include "dovetail/core/error.hpp"
#include "dovetail/core/parallel.hpp"

namespace dovetail::fem {

void PointTasks::add(std::unique_ptr<FieldPoint> point) {
  points_.push_back(std::move(point));
  seconds_.push_back(0.0);
}

void PointTasks::remove(std::size_t p) {
  points_.erase(points_.begin() + static_cast<std::ptrdiff_t>(p));
  seconds_.erase(seconds_.begin() + static_cast<std::ptrdiff_t>(p));
}

void PointTasks::evaluate(const FieldRequest& request) {
  const std::vector<std::size_t> order = longestFirst();
  parallelTasks(order.size(), [&](std::size_t task) { evaluate(order[task], request); });
}

void PointTasks::commit() {
  for (const auto& point : points_) point->commit();
}

void PointTasks::revert() {
  for (const auto& point : points_) point->revert();
}

std::vector<std::size_t> PointTasks::longestFirst() const {
  std::vector<std::size_t> order(points_.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return seconds_[a] > seconds_[b]; });
  return order;
}

void PointTasks::evaluate(std::size_t p, const FieldRequest& request) {
  const auto start = std::chrono::steady_clock::now();
  const bool withTangent = !request.tangent.empty();
  const std::span<const double, 9> F(request.F.subspan(9 * p, 9));
  const PointAnswer answer{std::span<double, 9>(request.P.subspan(9 * p, 9)),
                           withTangent ? request.tangent.subspan(81 * p, 81) : std::span<double>{}, request.energy[p],
                           request.dissipated[p], request.withEnergy};
  try {
    if (request.willCommit && request.moved)
      points_[p]->advance(F, request.dt, answer);
    else
      points_[p]->evaluate(F, request.dt, request.moved, answer);
  } catch (const std::exception& error) {
    request.reason[p] = error.what();
  }
  seconds_[p] = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

void readPointCount(ByteReader& archive, std::size_t count, const std::string& where) {
  std::uint64_t read = 0;
  archive(read);
  if (read != count)
    throw InputError("the state has " + std::to_string(read) + " points, the solid " + std::to_string(count), where,
                     "load it into the model that wrote it");
}

}  // namespace dovetail::fem
