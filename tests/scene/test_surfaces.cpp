// Surface couplings of a scene: one surface per solid.
#include <gtest/gtest.h>

#include <cmath>

#include "dovetail/coupling/run.hpp"
#include "dovetail/surface/surface_contact.hpp"
#include "scene_parts.hpp"

namespace dovetail::scene::test {
namespace {

/// Grains on the top of a block, on the seam of its halves and on its edge.
std::string blockWith(const std::string& couplings, const std::string& more = "") {
  return more + R"("particles": [{"from": "list", "density": 2500, "spheres": [
      {"at": [0.5, 0.31, 0.0995], "radius": 0.1}, {"at": [0.52, 0.61, 0.0995], "radius": 0.1},
      {"at": [0.95, 0.2, 0.0995], "radius": 0.1}, {"at": [1.07, 0.8, 0.07], "radius": 0.1}]}],
    "solids": [{"name": "b", "mesh": "box", "cells": [4, 4, 2], "box": [[0, 0, -0.5], [1, 1, 0]],
      "material": {"law": "neo-Hookean", "youngs_modulus": 1e6, "poisson_ratio": 0.2, "density": 500},
      "sets": [{"name": "left", "place": "box", "box": [[-1, -1, -0.01], [0.501, 2, 1]]},
               {"name": "right", "place": "box", "box": [[0.499, -1, -0.01], [2, 2, 1]]}],
      "supports": [{"on": "z-"}]}],
    "couplings": [)" +
         couplings + "],";
}

std::string on(const std::string& set, const std::string& more = "") {
  return R"({"type": "surface", "solid": "b", "on": ")" + set + "\"" + more + "}";
}

std::vector<Vec3> placesAfter(const std::string& couplings, int steps) {
  Built built = started(sceneOf(blockWith(couplings)));
  built.run->advance(steps);
  return built.run->grains.particles.x;
}

TEST(SurfacesOfScenes, FaceSetsThatMeetAreOneSurface) {
  for (const char* const kernel : {R"(, "kernel": "none")", "", R"(, "kernel": 0.3)"}) {
    const auto forces = [&](const std::string& couplings) {
      return started(sceneOf(blockWith(couplings))).run->grains.particles.f;
    };
    const std::vector<Vec3> once = forces(on("z+", kernel));
    const std::vector<Vec3> twice = forces(on("left", kernel) + "," + on("right", kernel));
    for (std::size_t i = 0; i < 3; ++i) {
      EXPECT_NEAR(once[i].z, 1e4 * 5e-4, 1e-9);
      EXPECT_LT(norm(twice[i] - once[i]), 1e-11) << kernel << i;
    }
    const std::string halves = on("left", kernel) + "," + on("right", kernel);
    const std::vector<Vec3> a = placesAfter(on("z+", kernel), 200), b = placesAfter(halves, 200);
    for (std::size_t i = 0; i < a.size(); ++i) EXPECT_LT(norm(a[i] - b[i]), 1e-12) << kernel << i;
    const std::vector<Vec3> edge = forces(halves + "," + on("x+", kernel));
    const double overlap = 0.1 - std::hypot(0.07, 0.07);
    EXPECT_NEAR(norm(edge[3]), 1e4 * overlap, 1e-9) << kernel;
    EXPECT_LT(norm(edge[2] - once[2]), 1e-11) << kernel;
  }
}

TEST(SurfacesOfScenes, RefuseAFaceInTwoCouplings) {
  expectParts(refusalOfRun(blockWith(on("z+") + "," + on("right"))), {"z+", "right", "faces in common", "couplings.0"});
  expectParts(refusalOfRun(blockWith(on("skin", R"(, "kernel": "none")") + "," + on("x+"))), {"faces in common"});
}

TEST(SurfacesOfScenes, HaveAKernelUnlessTold) {
  const auto kernelOf = [](const std::string& couplings, const std::string& more) {
    const Built built = started(sceneOf(blockWith(couplings, more)));
    const auto contacts = std::as_const(built.run->grains).terms.all<surface::SurfaceContact>();
    return surface::hasKernel(contacts.at(0)->coupling().skin());
  };
  EXPECT_TRUE(kernelOf(on("z+"), ""));
  EXPECT_FALSE(kernelOf(on("z+", R"(, "kernel": "none")"), ""));
}

TEST(SurfacesOfScenes, HaveNoKernelThatEndsAtAPeriodicSide) {
  const std::string periodic = R"("periodic": {"axes": ["y"], "box": [[-1, 0, -1], [2, 1, 1]]},)";
  const Built built = started(sceneOf(blockWith(on("z+"), periodic)));
  ASSERT_FALSE(built.notes.empty());
  expectParts(built.notes.back(), {"no kernel", "periodic"});
  expectParts(refusalOfRun(blockWith(on("z+", R"(, "kernel": 0.3)"), periodic)),
              {"continues across a periodic boundary"});
}

}  // namespace
}  // namespace dovetail::scene::test
