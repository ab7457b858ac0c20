#include "dovetail/surface/patch_turns.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <string>

#include "carried_points.hpp"
#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"
#include "packed.hpp"

namespace dovetail::surface {

namespace {

using Columns = std::array<Vec3, 3>;

std::size_t at(int i) { return static_cast<std::size_t>(i); }

struct Moments {
  Columns u, v;
};

[[gnu::always_inline]] inline void sumMoments(const PatchFrame& frame, std::span<const Vec3> u, std::span<const Vec3> v,
                                              Moments& sum) {
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
    sum.u[c] = unpacked(ofU[c]);
    sum.v[c] = unpacked(ofV[c]);
  }
}

/// Σ a u Dᵀ and Σ a v Dᵀ by columns; means need not be taken off, as Σ a D = 0.
Moments moments(const PatchFrame& frame, std::span<const Vec3> u, std::span<const Vec3> v) {
  Moments sum;
  withVectors([&] { sumMoments(frame, u, v, sum); });
  return sum;
}

/// f_i += a_i D_i · columns.
[[gnu::always_inline]] inline void addOnArms(const PatchFrame& frame, const Columns& columns, std::span<Vec3> force) {
  const Packed x = packed(columns[0]), y = packed(columns[1]), z = packed(columns[2]);
  for (std::size_t k = 0; k < frame.node.size(); ++k) {
    const Vec3& arm = frame.arm[k];
    Vec3& f = force[at(frame.node[k])];
    f = unpacked(packed(f) + (arm.x * x + arm.y * y + arm.z * z));
  }
}

Columns turnedBack(const Quaternion& turn, const Columns& a) {
  return {rotateBack(turn, a[0]), rotateBack(turn, a[1]), rotateBack(turn, a[2])};
}

/// Σ a D × y of s = Σ a y Dᵀ.
Vec3 axial(const Columns& s) { return {s[1].z - s[2].y, s[2].x - s[0].z, s[0].y - s[1].x}; }

/// Rows of the inverse of tr(s) 1 − ½ (s + sᵀ). @return false if it has none
bool invertInertia(const Columns& s, Columns& inverse) {
  const double trace = s[0].x + s[1].y + s[2].z;
  const double xy = -0.5 * (s[0].y + s[1].x), yz = -0.5 * (s[1].z + s[2].y), zx = -0.5 * (s[2].x + s[0].z);
  const Columns rows{Vec3{trace - s[0].x, xy, zx}, Vec3{xy, trace - s[1].y, yz}, Vec3{zx, yz, trace - s[2].z}};
  inverse = {cross(rows[1], rows[2]), cross(rows[2], rows[0]), cross(rows[0], rows[1])};
  const double determinant = dot(rows[0], inverse[0]);
  if (!(determinant > 1e-12 * trace * trace * trace) || !(trace > 0.0)) return false;
  for (Vec3& row : inverse) row = row / determinant;
  return true;
}

Vec3 times(const Columns& rows, const Vec3& b) { return {dot(rows[0], b), dot(rows[1], b), dot(rows[2], b)}; }

/// The rotation that takes one pair of directions to another, each orthogonalised.
Quaternion between(const std::array<Vec3, 2>& from, const Vec3& a, const Vec3& b) {
  const auto frameOf = [](const Vec3& first, const Vec3& second) {
    const Vec3 x = normalized(first), z = normalized(cross(first, second));
    return Columns{x, cross(z, x), z};
  };
  const Columns f = frameOf(from[0], from[1]), g = frameOf(a, b);
  const auto entry = [&](int i, int j) { return g[0][i] * f[0][j] + g[1][i] * f[1][j] + g[2][i] * f[2][j]; };
  const double xx = entry(0, 0), yy = entry(1, 1), zz = entry(2, 2);
  const std::array<Quaternion, 4> candidate{
      Quaternion{1.0 + xx + yy + zz, entry(2, 1) - entry(1, 2), entry(0, 2) - entry(2, 0), entry(1, 0) - entry(0, 1)},
      Quaternion{entry(2, 1) - entry(1, 2), 1.0 + xx - yy - zz, entry(0, 1) + entry(1, 0), entry(0, 2) + entry(2, 0)},
      Quaternion{entry(0, 2) - entry(2, 0), entry(0, 1) + entry(1, 0), 1.0 - xx + yy - zz, entry(1, 2) + entry(2, 1)},
      Quaternion{entry(1, 0) - entry(0, 1), entry(0, 2) + entry(2, 0), entry(1, 2) + entry(2, 1), 1.0 - xx - yy + zz}};
  return normalized(*std::ranges::max_element(candidate, {}, [](const Quaternion& q) { return norm(q); }));
}

/// Newton's method from a frame that the patch's long directions carry along; what is left after the step that follows
/// a small one is round-off. Depends on the positions alone.
bool findTurn(PatchFrame& frame, const Columns& a) {
  const auto along = [&](const Vec3& p) { return p.x * a[0] + p.y * a[1] + p.z * a[2]; };
  const Vec3 first = along(frame.axis[0]), second = along(frame.axis[1]);
  if (!(norm(cross(first, second)) > 0.0)) return false;
  frame.turn = between(frame.axis, first, second);
  for (int iteration = 0; iteration < 50; ++iteration) {
    const Columns s = turnedBack(frame.turn, a);
    if (!invertInertia(s, frame.inverse)) return false;
    const Vec3 step = times(frame.inverse, axial(s));
    // By 2 atan(|step|/2) about it, which is as good to a Newton step as |step|.
    frame.turn = normalized(frame.turn * Quaternion{1.0, 0.5 * step.x, 0.5 * step.y, 0.5 * step.z});
    if (norm(step) < 1e-7) return invertInertia(turnedBack(frame.turn, a), frame.inverse);
  }
  return false;
}

void placeFrame(PatchFrame& frame, int patch, std::span<const Vec3> u, std::span<const Vec3> v) {
  Moments sum = moments(frame, u, v);
  for (std::size_t c = 0; c < 3; ++c) sum.u[c] += frame.moments[c];
  if (!findTurn(frame, sum.u))
    throw NumericalError("a smooth patch of the surface has shrunk so far that it has no direction",
                         "patch " + std::to_string(patch), "look for what has crushed the solid");
  frame.spin = rotate(frame.turn, times(frame.inverse, axial(turnedBack(frame.turn, sum.v))));
  frame.placed = true;
}

}  // namespace

PatchFrame makeFrame(std::vector<int> node, std::span<const double> area, std::span<const Vec3> X) {
  PatchFrame frame;
  frame.node = std::move(node);
  double whole = 0.0;
  for (const double a : area) whole += a;
  Vec3 centre;
  for (std::size_t k = 0; k < X.size(); ++k) centre += (area[k] / whole) * (X[k] - X[0]);
  for (std::size_t k = 0; k < X.size(); ++k) {
    const Vec3 D = X[k] - X[0] - centre;
    frame.arm.push_back((area[k] / whole) * D);
    for (int c = 0; c < 3; ++c) frame.moments[at(c)] += frame.arm.back()[c] * D;
  }
  Eigen::Matrix3d matrix;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) matrix(i, j) = frame.moments[at(j)][i];
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(matrix);
  for (int k = 0; k < 2; ++k) {
    const Eigen::Vector3d p = solver.eigenvectors().col(2 - k);
    frame.axis[at(k)] = {p[0], p[1], p[2]};
  }
  frame.slender = solver.eigenvalues()[2] > 4.0 * solver.eigenvalues()[1];
  invertInertia(frame.moments, frame.inverse);
  return frame;
}

void placeFrames(PatchTurns& turns, std::span<const Vec3> u, std::span<const Vec3> v, std::span<const int> points) {
  for (PatchFrame& frame : turns.frames) frame.placed = false;
  for (int point : points) {
    const int patch = turns.patch[at(point)];
    if (PatchFrame& frame = turns.frames[at(patch)]; !frame.placed) placeFrame(frame, patch, u, v);
  }
}

void addTurningLoad(const PatchTurns& turns, const coupling::NodalLoad& onPoints, coupling::NodalLoad& load) {
  if (turns.empty()) return;
  std::vector<Vec3> couple(turns.frames.size());
  for (int point : onPoints.touched) {
    if (!bears(onPoints, point)) continue;
    const std::size_t p = at(point), patch = at(turns.patch[p]);
    couple[patch] += cross(rotate(turns.frames[patch].turn, turns.offset[p]), onPoints.force[p]);
  }
  for (std::size_t patch = 0; patch < couple.size(); ++patch) {
    if (couple[patch] == Vec3{}) continue;
    const PatchFrame& frame = turns.frames[patch];
    const Vec3 g = times(frame.inverse, rotateBack(frame.turn, couple[patch]));
    const Columns onArm{rotate(frame.turn, cross(g, {1, 0, 0})), rotate(frame.turn, cross(g, {0, 1, 0})),
                        rotate(frame.turn, cross(g, {0, 0, 1}))};
    for (const int node : frame.node) load.touch(node);
    withVectors([&] { addOnArms(frame, onArm, load.force); });
  }
}

double turnRate(const PatchFrame& frame, std::size_t k) {
  double squared = 0.0;
  for (const Vec3& direction : {Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}})
    squared += squaredNorm(times(frame.inverse, cross(frame.arm[k], direction)));
  return std::sqrt(squared);
}

double turningGain(const PatchTurns& turns) {
  std::vector<double> ofPatch;  // per metre of offset
  for (const PatchFrame& frame : turns.frames) {
    double sum = 0.0;
    for (std::size_t k = 0; k < frame.node.size(); ++k) sum += turnRate(frame, k);
    ofPatch.push_back(sum);
  }
  double gain = 0.0;
  for (std::size_t point = 0; point < turns.offset.size(); ++point)
    gain = std::max(gain, norm(turns.offset[point]) * ofPatch[at(turns.patch[point])]);
  return 2.0 * gain;  // K may fall to the half, that is, the patch may shrink so far
}

}  // namespace dovetail::surface
