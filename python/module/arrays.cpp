#include "arrays.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>

#include "dovetail/core/error.hpp"

namespace dovetail::python {

Numbers arrayOf(const Vec3& a) {
  Numbers all(3);
  for (int c = 0; c < 3; ++c) all.mutable_at(c) = a[c];
  return all;
}

Numbers arrayOf(std::span<const Vec3> a) {
  Numbers all({static_cast<py::ssize_t>(a.size()), py::ssize_t{3}});
  double* to = all.mutable_data();
  for (const Vec3& one : a)
    for (int c = 0; c < 3; ++c) *to++ = one[c];
  return all;
}

Numbers arrayOf(std::span<const double> a) {
  Numbers all(static_cast<py::ssize_t>(a.size()));
  std::ranges::copy(a, all.mutable_data());
  return all;
}

Numbers rowsOf(const std::vector<Vec3>& a, const std::vector<int>& which) {
  Numbers all({static_cast<py::ssize_t>(which.size()), py::ssize_t{3}});
  double* to = all.mutable_data();
  if (a.empty()) std::fill(to, to + 3 * which.size(), 0.0);
  if (!a.empty())
    for (const int i : which) {
      const Vec3& one = a[static_cast<std::size_t>(i)];
      *to++ = one.x;
      *to++ = one.y;
      *to++ = one.z;
    }
  return all;
}

namespace {
std::string shapeOf(const Numbers& a) {
  std::string text = "(";
  for (py::ssize_t k = 0; k < a.ndim(); ++k) text += (k > 0 ? ", " : "") + std::to_string(a.shape(k));
  return text + ")";
}

bool allFinite(std::span<const double> a) {
  constexpr std::uint64_t exponent = 0x7ff0000000000000;  // all of its bits are set in infinities and NaN alone
  std::uint64_t found = 0;
  for (const double v : a) found |= (std::bit_cast<std::uint64_t>(v) & exponent) == exponent;
  return found == 0;
}
}  // namespace

Rows::Rows(const Numbers& a, std::size_t n, const std::string& what)
    : from_(a.data()), step_(a.ndim() == 1 ? 0 : 3), size_(n) {
  const bool one = a.ndim() == 1 && a.shape(0) == 3;
  if (!one && !(a.ndim() == 2 && static_cast<std::size_t>(a.shape(0)) == n && a.shape(1) == 3))
    throw InputError("the shape is " + shapeOf(a), what, "give (" + std::to_string(n) + ", 3), or 3 numbers for all");
  if (allFinite({from_, static_cast<std::size_t>(a.size())})) return;
  const py::ssize_t k = std::find_if(from_, from_ + a.size(), [](double v) { return !std::isfinite(v); }) - from_;
  throw InputError(
      "number " + std::to_string(k % 3) + (one ? "" : " of row " + std::to_string(k / 3)) + " is not finite", what,
      "give finite numbers");
}

std::vector<Vec3> vectorsOf(const Numbers& a, std::size_t n, const std::string& what) {
  const Rows rows(a, n, what);
  std::vector<Vec3> all(n);
  for (std::size_t i = 0; i < n; ++i) all[i] = rows[i];
  return all;
}

}  // namespace dovetail::python
