// numpy arrays from what a run holds, and back: copies, since a run sorts and replaces its arrays.
#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <span>
#include <string>
#include <vector>

#include "dovetail/core/vec3.hpp"

namespace dovetail::python {

namespace py = pybind11;

using Numbers = py::array_t<double, py::array::c_style | py::array::forcecast>;

/// (3)
Numbers arrayOf(const Vec3& a);
/// (N, 3)
Numbers arrayOf(std::span<const Vec3> a);
/// (N)
Numbers arrayOf(std::span<const double> a);
/// Rows of these numbers; 0 where `a` is empty. (N, 3)
Numbers rowsOf(const std::vector<Vec3>& a, const std::vector<int>& which);

/// Rows of three numbers, read where they are.
class Rows {
public:
  /// @param a  outlives this @param n  rows @param what  for messages
  /// @throws InputError unless the shape is (n, 3), or (3) for the same in all rows, and all numbers are finite
  Rows(const Numbers& a, std::size_t n, const std::string& what);
  std::size_t size() const { return size_; }
  Vec3 operator[](std::size_t i) const { return {from_[step_ * i], from_[step_ * i + 1], from_[step_ * i + 2]}; }

private:
  const double* from_;
  std::size_t step_, size_;
};
/// A copy of them. @throws InputError as Rows
std::vector<Vec3> vectorsOf(const Numbers& a, std::size_t n, const std::string& what);

}  // namespace dovetail::python
