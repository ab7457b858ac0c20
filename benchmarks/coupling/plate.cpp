// What contacts with a deformable surface cost: 20 000 grains in layers on a plate of 2 000 bricks, time per stage.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <iostream>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "dovetail/core/error.hpp"
#include "dovetail/core/parallel.hpp"
#include "dovetail/coupling/run.hpp"
#include "dovetail/dem/laws/laws.hpp"
#include "dovetail/fem/elements/solid.hpp"
#include "dovetail/fem/laws/point_laws.hpp"
#include "dovetail/surface/surface_contact.hpp"
#include "program/run.hpp"

namespace {

using namespace dovetail;

constexpr double density = 2500.0, stiffness = 1e3;  // m, kg/m³, N/m
constexpr int grains = 20000;

/// Layers of a face-centred lattice that lie on z = 0, jittered by a ten-thousandth.
void addBed(dem::Particles& particles, int layers, Vec3 size) {
  const double pitch = std::sqrt(size.x * size.y * layers / grains), r = 0.5 * pitch;
  const double weight = density * 4.0 / 3.0 * std::numbers::pi * r * r * r * 9.81;
  std::mt19937 random(1);
  std::uniform_real_distribution<double> jitter(-1e-4 * r, 1e-4 * r);
  const int nx = static_cast<int>(size.x / pitch + 0.5), ny = static_cast<int>(size.y / pitch + 0.5);
  for (int l = 0; l < layers; ++l)
    for (int j = 0; j < ny; ++j)
      for (int i = 0; i < nx; ++i) {
        const double shift = l % 2 == 0 ? 0.25 : 0.75;
        const double z = r - layers * weight / stiffness + l * (pitch / std::numbers::sqrt2 - weight / stiffness);
        dem::addParticle(particles, {(i + shift) * pitch + jitter(random), (j + shift) * pitch + jitter(random), z}, {},
                         r, dem::Density{density});
      }
}

std::unique_ptr<coupling::CoupledRun> makeScene(int layers) {
  const Vec3 size{0.5, 0.4, 0.01};
  const fem::SolidMesh mesh = fem::boxOf(fem::ElementShape::hex8, {50, 40, 1}, {0, 0, -size.z}, {size.x, size.y, 0});
  auto plate = std::make_unique<fem::Model>(fem::makeModel(mesh));
  plate->add(fem::makeSolid(mesh, fem::pointMaterial(fem::Material(fem::StVenantKirchhoff{1e8, 0.3, 2500.0}))));
  for (const char* side : {"x-", "x+", "y-", "y+"}) fem::fix(plate->nodes, mesh.nodeSets.at(side));
  dem::ContactLaw<dem::LinearSpringDashpot, dem::TangentialSpring> law;
  law.normal = {stiffness, 0.5};
  law.tangential = {.stiffness = 0.8 * stiffness, .friction = 0.5};
  auto run = std::make_unique<coupling::CoupledRun>();
  run->grains.laws = dem::makeContactLaws(law);
  run->grains.gravity = {0, 0, -9.81};
  run->grains.booking = dem::Booking::off;
  addBed(run->grains.particles, layers, size);
  run->grains.pairs.setSkin(0.05 * run->grains.particles.radius[0]);
  coupling::SolidSide& side = run->addSolid(std::move(plate), {.name = "plate"});
  run->grains.terms.add(
      surface::SurfaceContact(side, surface::SurfaceCoupler(surface::makeSkin(mesh.X, mesh.faceSets.at("z+"))),
                              run->grains.laws, "plate contacts"));
  return run;
}

void measure(int layers, int steps) {
  const auto run = makeScene(layers);
  run->grains.refusesUnstableSteps = false;
  run->start(1e-6);
  const double dt = 0.1 * run->criticalStep().dt;
  run->start(dt);
  run->advance(steps / 4);
  run->profile = Profile(true);
  run->grains.profile = &run->profile;
  const auto start = std::chrono::steady_clock::now();
  run->advance(steps);
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  std::size_t touching = 0;
  for (const auto* term : run->grains.terms.all<surface::SurfaceContact>())
    touching += term->coupling().contacts().size();
  std::printf("%2d layers, %zu grains, %zu contacts with the plate, %d threads: %.3f ms per step\n", layers,
              run->grains.particles.size(), touching, threads(), 1e3 * seconds / steps);
  for (const auto& row : run->profile.rows())
    std::printf("  %-24s %7.3f ms %5.1f %%\n", row.name.c_str(), 1e3 * row.seconds / steps,
                100.0 * row.seconds / seconds);
}

}  // namespace

int main(int argc, char** argv) {
  int threads = 1, steps = 400;
  program::Options options("coupling_plate", "Times a plate under layers of grains, and the stages of its step.");
  options.integer("THREADS", threads, 1, 1024, "1 if not given");
  options.integer("STEPS", steps, 1, 1000000, "of each timing; 400 if not given");
  return program::runProgram(options, argc, argv, [&] {
    setThreads(threads);
    for (const int layers : {1, 3, 10}) measure(layers, steps);
    return true;
  });
}
