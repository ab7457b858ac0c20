// ∂t(ρv) + ∇·(ρ v⊗v) = ∇·σ + ρg + t_b at a point (Weinhart et al. 2012), and what is missing without t_b.
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "dovetail/cg/fields.hpp"
#include "random_state.hpp"

namespace dovetail::cg {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

Vector3d eigen(const Vec3& a) { return {a.x, a.y, a.z}; }

constexpr double floorHeight = 0.0;
const Vec3 gravity{0.0, 0.0, -9.81};

/// Spheres on a floor, with linear springs between them and to the floor.
struct Heap {
  std::vector<Vec3> x, v, a;
  std::vector<double> mass;
  std::vector<Vec3> from, to, force;  ///< all branches
  std::vector<Vec3> floorPoint, floorForce;
  SnapshotView snapshot() const { return {{x, v, mass}, {from, to, force}, {floorPoint, floorForce}, {}}; }
};

void addContacts(Heap& heap, double radius, double stiffness) {
  const auto branch = [&](const Vec3& from, const Vec3& to, const Vec3& force) {
    heap.from.push_back(from);
    heap.to.push_back(to);
    heap.force.push_back(force);
  };
  heap.a.assign(heap.x.size(), gravity);
  for (std::size_t i = 0; i < heap.x.size(); ++i) {
    for (std::size_t j = i + 1; j < heap.x.size(); ++j) {
      const Vec3 l = heap.x[i] - heap.x[j];
      const double overlap = 2.0 * radius - norm(l);
      if (overlap <= 0.0) continue;
      const Vec3 f = stiffness * overlap * normalized(l);
      branch(heap.x[i], heap.x[j], f);
      heap.a[i] += f / heap.mass[i];
      heap.a[j] -= f / heap.mass[j];
    }
    const double overlap = radius - (heap.x[i].z - floorHeight);
    if (overlap <= 0.0) continue;
    const Vec3 f{0.0, 0.0, stiffness * overlap};
    const Vec3 contact{heap.x[i].x, heap.x[i].y, floorHeight};
    branch(heap.x[i], contact, f);
    heap.floorPoint.push_back(contact);
    heap.floorForce.push_back(f);
    heap.a[i] += f / heap.mass[i];
  }
}

/// A shaken lattice of spheres above the floor, moving.
Heap movingHeap() {
  testing::RandomState random(11);
  Heap heap;
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j)
      for (int k = 0; k < 3; ++k) {
        const Vec3 lattice{0.2 * (i - 1.5), 0.2 * (j - 1.5), 0.1 + 0.2 * k};
        heap.x.push_back(lattice + random.vector(-0.03, 0.03));
        heap.v.push_back(random.vector(-2.0, 2.0));
        heap.mass.push_back(random.number(0.5, 1.5));
      }
  addContacts(heap, 0.1, 2000.0);
  return heap;
}

/// Three spheres on top of each other, at rest under their weight.
Heap restingColumn() {
  const double radius = 0.1, stiffness = 2000.0, mass = 1.2;
  Heap heap;
  double z = floorHeight, weight = 3.0 * mass * 9.81;
  for (int i = 0; i < 3; ++i) {
    z += (i == 0 ? radius : 2.0 * radius) - weight / stiffness;
    weight -= mass * 9.81;
    heap.x.push_back({0.0, 0.0, z});
    heap.v.push_back({});
    heap.mass.push_back(mass);
  }
  addContacts(heap, radius, stiffness);
  return heap;
}

/// σ − ρ v⊗v at a point.
Matrix3d flux(const Kernel& kernel, const Heap& heap, const Vec3& point) {
  const std::vector<Vec3> points{point};
  const Fields fields = sample(kernel, points, heap.snapshot());
  return fields.stress(0) - fields.density[0] * eigen(fields.velocity[0]) * eigen(fields.velocity[0]).transpose();
}

Vector3d divergence(const Kernel& kernel, const Heap& heap, const Vec3& point, double h) {
  Vector3d sum = Vector3d::Zero();
  for (int c = 0; c < 3; ++c) {
    Vec3 forward = point, backward = point;
    forward[c] += h;
    backward[c] -= h;
    sum += (flux(kernel, heap, forward).col(c) - flux(kernel, heap, backward).col(c)) / (2.0 * h);
  }
  return sum;
}

/// ∂t(ρv) along the motion of the particles.
Vector3d momentumRate(const Kernel& kernel, const Heap& heap, const Vec3& point, double dt) {
  const auto momentum = [&](double t) {
    Heap moved = heap;
    for (std::size_t i = 0; i < heap.x.size(); ++i) {
      moved.x[i] += t * heap.v[i] + 0.5 * t * t * heap.a[i];
      moved.v[i] += t * heap.a[i];
    }
    return eigen(sample(kernel, std::vector<Vec3>{point}, moved.snapshot()).momentum[0]);
  };
  return (momentum(dt) - momentum(-dt)) / (2.0 * dt);
}

struct Balance {
  Vector3d without, boundary;  ///< residual without t_b; t_b
  double scale;                ///< size of the terms
};

Balance balanceAt(const Kernel& kernel, const Heap& heap, const Vec3& point, double h) {
  const std::vector<Vec3> points{point};
  const Vector3d rate = momentumRate(kernel, heap, point, h / 10.0), div = divergence(kernel, heap, point, h);
  const Fields fields = sample(kernel, points, heap.snapshot());
  const Vector3d weight = fields.density[0] * eigen(gravity), boundary = eigen(fields.wallForce[0]);
  return {rate - div - weight, boundary, rate.norm() + div.norm() + weight.norm()};
}

TEST(MomentumBalance, HoldsAtEveryPointOfAMovingHeap) {
  const Heap heap = movingHeap();
  ASSERT_GT(heap.force.size(), 20u);
  ASSERT_GT(heap.floorPoint.size(), 4u);
  testing::RandomState random(12);
  for (double width : {0.15, 0.4}) {
    const Kernel kernel{KernelShape::lucy, 3, width};
    double coarse = 0.0, fine = 0.0;
    for (int trial = 0; trial < 40; ++trial) {
      const Vec3 point = random.vector(-0.25, 0.25) + Vec3{0, 0, 0.25};
      const Balance far = balanceAt(kernel, heap, point, 4e-4 * width),
                    near = balanceAt(kernel, heap, point, 1e-4 * width);
      coarse = std::max(coarse, (far.without - far.boundary).norm() / far.scale);
      fine = std::max(fine, (near.without - near.boundary).norm() / near.scale);
    }
    // Only the finite differences err, at second order: 16 times less for a quarter of the step.
    EXPECT_LT(fine, 1e-6);
    EXPECT_NEAR(coarse / fine, 16.0, 1.0);
  }
}

TEST(MomentumBalance, WithoutTheBoundaryTermMomentumIsMissingAtTheWall) {
  const Heap heap = movingHeap();
  for (double width : {0.15, 0.4}) {
    const Kernel kernel{KernelShape::lucy, 3, width};
    for (const Vec3& contact : heap.floorPoint) {
      const Balance atWall = balanceAt(kernel, heap, contact + Vec3{0, 0, 0.2 * width}, 1e-3 * width);
      EXPECT_GT(atWall.boundary.norm(), 0.05 * atWall.scale);
      EXPECT_LT((atWall.without - atWall.boundary).norm(), 1e-4 * atWall.boundary.norm());
      const Balance away = balanceAt(kernel, heap, contact + Vec3{0, 0, 1.01 * width}, 1e-3 * width);
      EXPECT_EQ(away.boundary.norm(), 0.0);
      EXPECT_LT(away.without.norm(), 5e-6 * away.scale);
    }
  }
}

TEST(MomentumBalance, AColumnAtRestCarriesItsWeight) {
  const Heap heap = restingColumn();
  for (const Vec3& a : heap.a) ASSERT_LT(norm(a), 1e-11);
  for (KernelShape shape : {KernelShape::lucy, KernelShape::gauss}) {
    const Kernel kernel{shape, 3, 0.3};
    for (double z : {-0.02, 0.013, 0.08, 0.151}) {
      const Vec3 point{0.031, 0.042, z};
      const Balance balance = balanceAt(kernel, heap, point, 1e-4);
      EXPECT_LT((balance.without - balance.boundary).norm(), 1e-5 * balance.scale);
      EXPECT_GT(balance.without.norm(), 0.1 * balance.scale);
    }
  }
}

TEST(MomentumBalance, StressIntegratesToTheVirial) {
  // ∫σ_c dV = −Σ f ⊗ l (Love and Weber), whatever the width.
  const Heap heap = restingColumn();
  Matrix3d virial = Matrix3d::Zero();
  for (std::size_t i = 0; i < heap.force.size(); ++i)
    virial -= eigen(heap.force[i]) * eigen(heap.from[i] - heap.to[i]).transpose();
  EXPECT_LT(virial(2, 2), 0.0);
  const int n = 60;
  const Vec3 lower{-0.35, -0.35, -0.35}, size{0.7, 0.7, 1.2};
  const Grid grid{lower + 0.5 / n * size, size / n, {n, n, n}};
  Matrix3d total = Matrix3d::Zero();
  for (const Matrix3d& s : sample({KernelShape::lucy, 3, 0.3}, gridPoints(grid), heap.snapshot()).contactStress)
    total += size.x * size.y * size.z / (1.0 * n * n * n) * s;
  EXPECT_LT((total - virial).norm(), 1e-5 * virial.norm());
}

}  // namespace
}  // namespace dovetail::cg
