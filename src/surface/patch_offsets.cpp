#include "dovetail/surface/patch_offsets.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "carried_points.hpp"
#include "packed.hpp"

namespace dovetail::surface {

namespace {

using Columns = std::array<Vec3, 3>;

std::size_t at(int i) { return static_cast<std::size_t>(i); }

/// Σ u armᵀ and Σ v armᵀ by columns; the arms sum to nothing. Differences from the first node keep the digits of bodies
/// that have gone far.
[[gnu::always_inline]] inline void sumGradients(PatchFrame& frame, std::span<const Vec3> u, std::span<const Vec3> v) {
  std::array<Packed, 3> ofU{}, ofV{};
  const Packed u0 = packed(u[at(frame.node.front())]), v0 = packed(v[at(frame.node.front())]);
  for (std::size_t k = 0; k < frame.node.size(); ++k) {
    const Vec3& arm = frame.arm[k];
    const Packed du = packed(u[at(frame.node[k])]) - u0, dv = packed(v[at(frame.node[k])]) - v0;
    ofU[0] += arm.x * du;
    ofU[1] += arm.y * du;
    ofU[2] += arm.z * du;
    ofV[0] += arm.x * dv;
    ofV[1] += arm.y * dv;
    ofV[2] += arm.z * dv;
  }
  for (std::size_t c = 0; c < 3; ++c) {
    frame.gradient[c] = unpacked(ofU[c]);
    frame.rate[c] = unpacked(ofV[c]);
  }
}

/// f_i += columns · arm_i.
[[gnu::always_inline]] inline void addOnArms(const PatchFrame& frame, const Columns& columns, std::span<Vec3> force) {
  const Packed x = packed(columns[0]), y = packed(columns[1]), z = packed(columns[2]);
  for (std::size_t k = 0; k < frame.node.size(); ++k) {
    const Vec3& arm = frame.arm[k];
    Vec3& f = force[at(frame.node[k])];
    f = unpacked(packed(f) + (arm.x * x + arm.y * y + arm.z * z));
  }
}

}  // namespace

PatchFrame makeFrame(std::vector<int> node, std::span<const double> area, std::span<const Vec3> X) {
  constexpr double flat = 1e-14;  // of the largest moment: what is left of a height by round-off, squared
  const auto toEigen = [](const Vec3& a) { return Eigen::Vector3d(a.x, a.y, a.z); };
  const auto toVec3 = [](const Eigen::Vector3d& a) { return Vec3{a[0], a[1], a[2]}; };
  PatchFrame frame;
  frame.node = std::move(node);
  double whole = 0.0;
  for (double one : area) whole += one;
  Vec3 centre;
  for (std::size_t k = 0; k < X.size(); ++k) centre += (area[k] / whole) * (X[k] - X[0]);
  Eigen::Matrix3d moments = Eigen::Matrix3d::Zero();
  for (std::size_t k = 0; k < X.size(); ++k) {
    const Eigen::Vector3d D = toEigen(X[k] - X[0] - centre);
    moments += (area[k] / whole) * D * D.transpose();
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(moments);
  const Eigen::Vector3d& size = solver.eigenvalues();
  frame.longest = toVec3(solver.eigenvectors().col(2));
  frame.slender = size[2] > 4.0 * size[1];
  Eigen::Matrix3d scale = Eigen::Matrix3d::Zero();
  for (int k = 0; k < 3; ++k) {
    const Eigen::Vector3d along = solver.eigenvectors().col(k);
    if (size[k] > flat * size[2]) scale += along * along.transpose() / std::sqrt(size[k]);
  }
  for (int k = 0; k < 3; ++k) frame.scale[at(k)] = toVec3(scale.col(k));
  Vec3 sum;
  for (std::size_t k = 0; k < X.size(); ++k) {
    frame.arm.push_back((area[k] / whole) * frame.scaled(X[k] - X[0] - centre));
    sum += frame.arm.back();
  }
  for (std::size_t k = 0; k < X.size(); ++k) frame.arm[k] -= (area[k] / whole) * sum;
  return frame;
}

void placeFrames(PatchOffsets& offsets, std::span<const Vec3> u, std::span<const Vec3> v, std::span<const int> points) {
  for (PatchFrame& frame : offsets.frames) frame.placed = false;
  for (int point : points) {
    PatchFrame& frame = offsets.frames[at(offsets.patch[at(point)])];
    if (frame.placed) continue;
    withVectors([&] { sumGradients(frame, u, v); });
    frame.placed = true;
  }
}

void addOffsetLoad(const PatchOffsets& offsets, const coupling::NodalLoad& onPoints, coupling::NodalLoad& load) {
  if (offsets.empty()) return;
  std::vector<Columns> moment(offsets.frames.size());
  for (int point : onPoints.touched) {
    if (!bears(onPoints, point)) continue;
    const std::size_t p = at(point);
    for (int c = 0; c < 3; ++c) moment[at(offsets.patch[p])][at(c)] += offsets.offset[p][c] * onPoints.force[p];
  }
  for (std::size_t patch = 0; patch < moment.size(); ++patch) {
    if (moment[patch] == Columns{}) continue;
    for (const int node : offsets.frames[patch].node) load.touch(node);
    withVectors([&] { addOnArms(offsets.frames[patch], moment[patch], load.force); });
  }
}

double armLength(const PatchFrame& frame, std::size_t k) { return norm(frame.arm[k]); }

double offsetGain(const PatchOffsets& offsets) {
  std::vector<double> ofPatch;
  for (const PatchFrame& frame : offsets.frames) {
    double sum = 0.0;
    for (std::size_t k = 0; k < frame.node.size(); ++k) sum += armLength(frame, k);
    ofPatch.push_back(sum);
  }
  double gain = 0.0;
  for (std::size_t point = 0; point < offsets.offset.size(); ++point)
    gain = std::max(gain, norm(offsets.offset[point]) * ofPatch[at(offsets.patch[point])]);
  return gain;
}

}  // namespace dovetail::surface
