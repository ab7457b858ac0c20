// Grains that attract each other, dent or are damped, against hand calculations.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "dovetail/dem/model/loads.hpp"
#include "dovetail/dem/model/walls.hpp"
#include "dovetail/scene/read.hpp"
#include "scene_parts.hpp"

namespace dovetail::scene::test {
namespace {

constexpr double pi = std::numbers::pi, radius = 0.01, stiffness = 1e4;  // m, N/m

std::string contact(const std::string& keys) {
  return R"("contact": {"law": "linear", "stiffness": 1e4, )" + keys + "},";
}
/// Two grains along x, with a velocity of the second one.
std::string pairAt(double distance, double velocity = 0.0) {
  return R"("particles": [{"from": "list", "density": 2500, "spheres": [{"at": [0, 0, 0], "radius": 0.01}, {"at": [)" +
         std::to_string(distance) + R"(, 0, 0], "radius": 0.01, "velocity": [)" + std::to_string(velocity) +
         ", 0, 0]}]}],";
}
/// On the first of two grains, N; > 0: they repel.
double repulsion(const std::string& law, double distance) {
  Built built = build(sceneFromText("{" + law + pairAt(distance) + end + "}", "s.json", "/"));
  dem::findForces(built.run->grains);
  return -built.run->grains.particles.f[0].x;
}
Built startedAt(const std::string& dt, const std::string& text) {
  return started(sceneFromText("{" + text + R"("steps": {"dt": )" + dt + R"(}, "stages": [{"do": "run", "time": 1}]})",
                               "s.json", "/"));
}
double joules(Built& built, const std::string& channel) {
  for (const auto& one : built.run->ledger().channels())
    if (one.name == channel) return one.joules;
  return 0.0;
}
double residual(Built& built) {
  double sum = 0.0;
  for (const auto& one : built.run->ledger().channels()) sum += one.joules - one.joulesAtOpening;
  return sum;
}

TEST(ContactLaws, AdhesionIsTheSumOfItsParts) {
  const double overlap = 1e-5, half = 0.5 * radius;  // of two equal spheres
  const std::string all =
      R"("adhesion": {"force": "20 mN", "stiffness": 100, "pressure": "10 kPa", "work": "0.5 J/m2"})";
  const double pull = 0.02 + 2.0 * pi * 0.5 * half + (100.0 + pi * 1e4 * half) * overlap;
  EXPECT_NEAR(repulsion(contact(all), 2.0 * radius - overlap), stiffness * overlap - pull, 1e-12);
  EXPECT_EQ(repulsion(contact(all), 2.0 * radius + 1e-6), 0.0);
  // At its largest where the overlap vanishes: the pull-off force of DMT.
  EXPECT_NEAR(repulsion(contact(R"("adhesion": {"work": 0.5})"), 2.0 * radius - 1e-6),
              stiffness * 1e-6 - 2.0 * pi * 0.5 * half, 1e-12);
}

TEST(ContactLaws, AdhesionActsAtWallsWithTheRadiusOfTheGrain) {
  for (const char* const rolling : {"", R"(, "rolling": {"friction": 0.1, "stiffness_ratio": 0.2})"}) {
    Built built = build(sceneFromText(
        "{" + contact(R"("friction": 0.3, "adhesion": {"work": 0.5})" + std::string(rolling)) +
            R"("particles": [{"from": "list", "density": 2500, "spheres": [{"at": [0, 0, 0.00999], "radius": 0.01}]}],
               "walls": [{"shape": "plane", "point": [0, 0, 0], "normal": [0, 0, 1]}],)" +
            end + "}",
        "s.json", "/"));
    dem::findForces(built.run->grains);
    EXPECT_NEAR(built.run->grains.particles.f[0].z, stiffness * 1e-5 - 2.0 * pi * 0.5 * radius, 1e-12);
  }
}

TEST(ContactLaws, OnePairOfMaterialsMayStick) {
  const auto of = [](const std::string& first, const std::string& second) {
    Built built = build(sceneFromText(
        R"({"contact": {"law": "linear", "stiffness": 1e4}, "contacts": [{"between": "wet", "and": "wet", "law": "linear",
            "stiffness": 1e4, "liquid_bridge": {"surface_tension": 0.072, "volume": "1 mm3"}}], "particles": [
            {"from": "list", "density": 1, "contact_material": ")" +
            first + R"(", "spheres": [{"at": [0, 0, 0], "radius": 0.01}]},
            {"from": "list", "density": 1)" +
            second + R"(, "spheres": [{"at": [0.01999, 0, 0], "radius": 0.01}]}],)" + end + "}",
        "s.json", "/"));
    dem::findForces(built.run->grains);
    return -built.run->grains.particles.f[0].x;
  };
  EXPECT_NEAR(of("wet", R"(, "contact_material": "wet")"), stiffness * 1e-5 - 2.0 * pi * radius * 0.072, 1e-12);
  EXPECT_NEAR(of("wet", ""), stiffness * 1e-5, 1e-12);
}

/// A bridge between two that fly apart, to its rupture.
TEST(ContactLaws, ALiquidBridgeTakesItsWorkOfRupture) {
  const double tension = 0.072, volume = 1e-9, angle = pi / 6.0, overlap = 1e-6, speed = 0.1;
  const std::string law =
      contact(R"("liquid_bridge": {"surface_tension": "72 mN/m", "volume": "1 mm3", "contact_angle": "30 deg"})");
  Built built = startedAt("1e-6", law + pairAt(2.0 * radius - overlap, speed));
  const dem::Particles& p = built.run->grains.particles;
  const double pull = 2.0 * pi * radius * tension * std::cos(angle), scale = std::sqrt(radius / volume);
  const auto gap = [&] { return norm(p.x[1] - p.x[0]) - 2.0 * radius; };
  const auto curve = [&](double s) { return 1.0 + 1.05 * s + 2.5 * s * s; };
  built.run->advance(3000);
  ASSERT_GT(gap(), 1e-4);
  EXPECT_NEAR(p.f[0].x, pull / curve(scale * gap()), 1e-9 * pull);
  const double rupture = (1.0 + 0.5 * angle) * std::cbrt(volume);
  while (gap() < 1.1 * rupture) built.run->advance(100);
  EXPECT_EQ(p.f[0].x, 0.0);
  double work = 0.0;  // ∫ pull/curve, by the midpoint rule
  const int parts = 100000;
  for (int k = 0; k < parts; ++k) work += rupture / parts * pull / curve(scale * rupture * (k + 0.5) / parts);
  EXPECT_NEAR(joules(built, "particles: fracture"), work, 1e-6 * work);
  EXPECT_NEAR(residual(built), 0.0, 1e-4 * work);
  const double before = 0.25 * p.mass[0] * speed * speed + 0.5 * stiffness * overlap * overlap - pull * overlap;
  const double apart = p.v[1].x - p.v[0].x;
  EXPECT_NEAR(before - 0.25 * p.mass[0] * apart * apart, work, 1e-3 * work);
}

TEST(ContactLaws, DentsTakeTheirRestitution) {
  Built built = startedAt("1e-6", R"("contact": {"law": "elastic-plastic", "stiffness": "10 kN/m",
      "unloading_stiffness": "40 kN/m", "friction": 0.3},)" +
                                      pairAt(0.021, -1.0));
  built.run->advance(5000);
  const dem::Particles& p = built.run->grains.particles;
  EXPECT_NEAR(p.v[1].x - p.v[0].x, 0.5, 1e-4);
  const double lost = 0.25 * p.mass[0] * (1.0 - 0.25);
  EXPECT_NEAR(joules(built, "particles: plastic contacts"), lost, 1e-3 * lost);
  EXPECT_NEAR(residual(built), 0.0, 1e-4 * lost);
}

TEST(ContactLaws, DampingOfTheScene) {
  const std::string grain = R"("gravity": [0, 0, -10], "particles": [{"from": "list", "density": 1, "spheres": [
      {"at": [0, 0, 0], "radius": 0.01, "velocity": [2, 0, 0], "spin": [0, 0, 3]}]}],)";
  Built viscous = startedWith(law, R"("damping": {"rate": "50 Hz"}, )" + grain);
  viscous.run->advance(1000);  // 10 ms
  const auto& p = viscous.run->grains.particles;
  const double decay = std::exp(-50.0 * 0.01);
  EXPECT_NEAR(p.v[0].x, 2.0 * decay, 1e-3);
  EXPECT_NEAR(p.omega[0].z, 3.0 * decay, 2e-3);
  EXPECT_NEAR(p.v[0].z, -10.0 / 50.0 * (1.0 - decay), 1e-4);
  EXPECT_GT(joules(viscous, "particles: damping"), 0.0);
  EXPECT_NEAR(residual(viscous), 0.0, 1e-6 * joules(viscous, "particles: damping"));
  Built local = startedWith(law, R"("damping": {"local": 0.7}, )" + grain);
  local.run->advance(1000);
  // Undamped in the first half step: there is no motion yet.
  EXPECT_NEAR(local.run->grains.particles.v[0].z, -0.3 * 10.0 * 0.01 - 0.7 * 10.0 * 0.5e-5, 1e-10);
  EXPECT_EQ(local.run->grains.particles.v[0].x, 2.0);
  EXPECT_NEAR(residual(local), 0.0, 1e-6 * joules(local, "particles: damping"));
}

TEST(ContactLaws, DampingBeyondTheStepIsRefused) {
  const std::string grain =
      R"("particles": [{"from": "list", "density": 1, "spheres": [{"at": [0, 0, 0], "radius": 0.01}]}],)";
  expectParts(refusalWith(law, R"("damping": {"rate": 6e4}, )" + grain),
              {"damping rate is 60000 1/s", "0.6 in a step", "damping", "a smaller step"});
  EXPECT_EQ(refusalWith(law, R"("damping": {"rate": 4e4}, )" + grain), "");
}

TEST(ContactLaws, GrainsMaySpinAtTheStart) {
  const Built built = build(sceneOf(R"("particles": [
      {"from": "lattice", "lattice": "simple-cubic", "box": [[0, 0, 0], [0.2, 0.2, 0.2]], "radius": 0.1, "density": 1},
      {"from": "list", "density": 1, "spin": [1, 0, 0], "spheres": [{"at": [9, 0, 0], "radius": 0.1, "spin": [0, "60 rpm", 0]}]}],)"));
  const dem::Particles& p = built.run->grains.particles;
  EXPECT_EQ(p.omega[0], Vec3{});
  EXPECT_NEAR(p.omega[1].y, 2.0 * pi, 1e-14);
  EXPECT_EQ(p.omega[1].x, 1.0);
}

TEST(ContactLaws, WhatCannotBeInOneIsRefused) {
  const auto refused = [](const std::string& laws, std::initializer_list<const char*> parts) {
    expectParts(refusalWith(laws, pairAt(0.03)), parts);
  };
  const std::string bridge = R"("liquid_bridge": {"surface_tension": 0.07, "volume": 1e-9})";
  const std::string sticky = R"("adhesion": {"force": 1})";
  refused(contact(bridge + ", " + sticky), {"contact", "adhesion and a liquid bridge"});
  refused(contact(R"("bonded": true, )" + sticky), {"bonded springs cannot have"});
  refused(contact(R"("adhesion": {})"), {"the adhesion is zero"});
  refused(contact(R"("adhesion": {"stiffness": 2e4})"), {"sink into each other"});
  refused(contact(R"("adhesion": {"work": "2 N"})"), {"work", "N/m"});
  const std::string dents = R"("contact": {"law": "elastic-plastic", "stiffness": 1e4, "unloading_stiffness": )";
  refused(dents + "4e4, " + bridge + "},", {"elastic-plastic", "liquid bridges"});
  refused(dents + R"(4e4, "restitution": 0.9},)", {"√", "0.5", "leave restitution out"});
  refused(dents + "1e3},", {"unloading stiffness", "contact"});
  const std::string block = R"("solids": [{"name": "b", "mesh": "box", "cells": [1, 1, 1],
      "box": [[0, 0, -1], [1, 1, -0.5]], "material": {"law": "neo-Hookean", "youngs_modulus": 1e9, "poisson_ratio": 0.3,
      "density": 1000}}], "couplings": [{"type": "surface", "solid": "b")";
  expectParts(refusalWith(dents + "4e4},", pairAt(0.03) + block + "}],"), {"couplings.0", "on facets"});
  EXPECT_EQ(refusalWith(dents + "4e4},", pairAt(0.03) + block + R"(, "contact": {"law": "linear", "stiffness": 1}}],)"),
            "");
  const std::string other = R"("contacts": [{"between": "a", "and": "a", "law": "linear", "stiffness": 1e4, )";
  refused(contact(sticky) + other + bridge + "}],", {"mixed in one scene"});
}

}  // namespace
}  // namespace dovetail::scene::test
