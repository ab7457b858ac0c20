// A copper bar flies into a rigid wall and stays short and thick: the test of Taylor (1948), as computed by many codes.
#include <cmath>
#include <cstdio>
#include <iostream>

#include "common/options.hpp"
#include "dovetail/fem/elements/solid.hpp"
#include "dovetail/fem/laws/plasticity.hpp"
#include "dovetail/fem/mesh/mesh_shapes.hpp"
#include "dovetail/fem/motion/dynamics.hpp"
#include "dovetail/fem/motion/stable_step.hpp"
#include "dovetail/fem/terms/contact_plane.hpp"

namespace {

using namespace dovetail;
using namespace dovetail::fem;

constexpr double radius = 3.2e-3, length = 32.4e-3, speed = 227.0, duration = 80e-6;  // m, m/s, s

/// Copper: von Mises with linear hardening.
J2Plasticity copper() { return {117e9, 0.35, 8930.0, linearYield(400e6, 100e6)}; }

struct Bar {
  SolidMesh mesh;
  Model model;
  std::shared_ptr<Solid> solid;
  std::shared_ptr<ContactPlane> wall;
};

/// The bar a hair above the wall z = 0, flying down.
Bar makeBar(std::array<int, 3> cells) {
  Bar bar{roundBar(ElementShape::hex8, cells, radius, length), {}, nullptr, nullptr};
  bar.model = makeModel(bar.mesh);
  // Plastic flow keeps the volume: plain bricks would lock.
  bar.solid = makeSolid(bar.mesh, pointMaterial(copper()), {.formulation = Formulation::meanDilatation, .name = "bar"});
  bar.model.add(bar.solid);
  addMass(bar.model);
  for (Vec3& v : bar.model.nodes.v) v = {0, 0, -speed};
  // The wall is half as stiff as a layer of elements, so it takes no smaller step than they do.
  const double size = length / cells[2];
  ContactOptions contact;
  contact.penalty = 0.5 * copper().youngsModulus / size;
  contact.name = "wall";
  bar.wall = makeContactPlane(bar.mesh, faceSet(bar.mesh, "z-"), {{0, 0, -1e-9}, {0, 0, 1}, {}}, contact);
  bar.model.add(bar.wall);
  return bar;
}

struct Shape {
  double length, radius;  // m
};
Shape shapeOf(const Bar& bar) {
  double low = 1e9, high = -1e9, widest = 0.0;
  for (std::size_t n = 0; n < bar.mesh.X.size(); ++n) {
    const Vec3 x = bar.mesh.X[n] + bar.model.nodes.u[n];
    low = std::min(low, x.z);
    high = std::max(high, x.z);
    widest = std::max(widest, std::hypot(x.x, x.y));
  }
  return {high - low, widest};
}

/// Largest accumulated plastic strain at a quadrature point.
double largestStrain(Bar& bar) {
  const Solid::Sample sample = bar.solid->sample(bar.model.nodes, {bar.model.t, 0.0});
  const std::size_t size = bar.solid->material()->historySize();
  double most = 0.0;
  for (std::size_t q = 0; q < sample.volume.size(); ++q) most = std::max(most, sample.history[size * q + 9]);
  return most;
}

/// Published ranges of final length and radius at the wall: Kamoulakos (1990), Zhu & Cescotto (1995).
struct Range {
  const char* what;
  double from, to, found;  // mm
  double tolerance;        // mm, beside the range
  bool holds() const { return found >= from - tolerance && found <= to + tolerance; }
};

bool flyIntoTheWall(const example::Options& options) {
  const std::array<int, 3> cells = options.quick ? std::array{2, 2, 12} : std::array{2, 2, 18};
  Bar bar = makeBar(cells);
  // Elements at the wall are pressed flat, and the step follows them. The bound does not know the wall: half of it will
  // do.
  ExplicitIntegrator integrator(bar.model, stableStep(bar.model).dt,
                                {.energyEvery = 50, .safety = 0.5, .measureEvery = 10});
  std::printf("%zu bricks\n", bar.solid->size());
  std::printf("   t, us   length, mm   radius, mm   force, kN   plastic strain\n");
  for (int frame = 1; frame <= 8; ++frame) {
    integrator.runUntil(duration * frame / 8);
    const Shape shape = shapeOf(bar);
    std::printf("%8.0f %12.3f %12.3f %11.2f %16.2f\n", 1e6 * bar.model.t, 1e3 * shape.length, 1e3 * shape.radius,
                1e-3 * bar.wall->report(bar.model.nodes, {bar.model.t, 0.0}).force.z, largestStrain(bar));
  }
  std::cout << '\n' << integrator.report();
  const Shape shape = shapeOf(bar);
  const double tolerance = options.quick ? 0.4 : 0.2;
  const Range ranges[] = {{"length", 21.3, 21.7, 1e3 * shape.length, tolerance},
                          {"radius", 6.9, 7.3, 1e3 * shape.radius, tolerance}};
  bool good = true;
  for (const Range& r : ranges) {
    std::printf("%s: %.3f mm, published %.1f to %.1f mm, tolerance %.1f mm: %s\n", r.what, r.found, r.from, r.to,
                r.tolerance, r.holds() ? "ok" : "OFF");
    good = good && r.holds();
  }
  const EnergyLedger& ledger = integrator.ledger();
  const double missing = std::abs(ledger.residual()) / ledger.storedAtOpening();
  std::printf("energy that the ledger misses: %.2f %% of the first\n", 100.0 * missing);
  return good && missing < 0.02;
}

}  // namespace

int main(int argc, char** argv) {
  return example::runExample(argc, argv, "solid", "a copper bar flies into a rigid wall (Taylor's test)",
                             flyIntoTheWall, example::Files::none);
}
