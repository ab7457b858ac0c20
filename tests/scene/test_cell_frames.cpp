// Points of solids of cells in frames.
#include <array>
#include <cmath>
#include <fstream>
#include <sstream>

#include "../io/scratch_folder.hpp"
#include "cell_blocks.hpp"
#include "dovetail/io_vtk/frame_reader.hpp"
#include "dovetail/scene/execute.hpp"

namespace dovetail::scene::test {
namespace {

using io::FrameArray;
using io::FrameContent;
using io::test::ScratchFolder;

std::string runFor(double time) {
  return R"("steps": {"safety": 0.8}, "stages": [{"do": "run", "time": )" + std::to_string(time) +
         R"(}], "output": {"frames": 2e-3, "checkpoints": 4e-3, "contents": ["solids", "stress", "strain", "cells", "points"]})";
}
const Scene shown = blockScene(runFor(0.01));

FrameContent lastFrame(const std::filesystem::path& pvd) {
  const auto frames = io::readPvd(pvd);
  return io::readFrame(frames.back().second);
}
const std::vector<double>& valuesOf(const FrameContent& frame, const char* name, bool perCell) {
  static const std::vector<double> none;
  const FrameArray* const array = frame.find(name, perCell);
  EXPECT_TRUE(array) << name;
  return array ? array->values : none;
}

TEST(CellFrames, PointsHaveWhatElementsHaveTheMeansOf) {
  const ScratchFolder folder;
  std::ostringstream log;
  ASSERT_TRUE(run(shown, {.folder = folder / "out", .progress = false}, log));
  const FrameContent points = lastFrame(folder / "out/points_block.pvd"),
                     solid = lastFrame(folder / "out/solid_block.pvd");
  ASSERT_EQ(points.position.size(), 4U);
  EXPECT_EQ(points.time, solid.time);
  EXPECT_EQ(valuesOf(points, "element", false), (std::vector<double>(4, 0.0)));
  for (const char* const name : {"void_ratio", "coordination", "sliding", "shear_strain", "volume_strain"}) {
    double mean = 0.0;
    for (const double value : valuesOf(points, name, false)) mean += 0.25 * value;
    EXPECT_NEAR(valuesOf(solid, name, true)[0], mean, 1e-12 * (1.0 + std::abs(mean))) << name;
  }
  // The nodes of one element move linearly along its edges: u is that of the map X + u.
  const std::vector<double>&u = valuesOf(points, "displacement", false),
        &F = valuesOf(points, "deformation_gradient", false);
  double across = 0.0;
  for (std::size_t p = 0; p < 4; ++p) across += 0.25 * F[9 * p + 4];
  EXPECT_LT(across, 1.0 - 1e-6);
  const auto [low, high] = std::ranges::minmax(std::array{u[1], u[4], u[7], u[10]});
  const double apart = 0.2 / std::sqrt(3.0);  // of the points, along y
  EXPECT_NEAR(high - low, apart * (1.0 - across), 1e-9);
}

std::string textOf(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

TEST(CellFrames, AreTheSameAfterABreak) {
  const ScratchFolder folder;
  std::ostringstream log;
  ASSERT_TRUE(run(shown, {.folder = folder / "whole", .progress = false}, log));
  ASSERT_TRUE(run(blockScene(runFor(0.004)), {.folder = folder / "broken", .progress = false}, log));
  ASSERT_TRUE(resume({.folder = folder / "broken", .progress = false, .until = 0.01, .threads = 2}, log));
  const auto whole = io::readPvd(folder / "whole/points_block.pvd"),
             broken = io::readPvd(folder / "broken/points_block.pvd");
  ASSERT_EQ(whole.size(), broken.size());
  EXPECT_TRUE(textOf(whole.back().second) == textOf(broken.back().second));
}

TEST(CellFrames, WhatCannotBeShownIsRefused) {
  const auto refusal = [](const std::string& output) {
    const ScratchFolder folder;
    std::ostringstream log;
    try {
      run(blockScene(R"("steps": {"safety": 0.8}, "stages": [{"do": "run", "time": 0.01}], "output": )" + output),
          {.folder = folder / "out", .progress = false}, log);
      return std::string();
    } catch (const InputError& error) {
      return std::string(error.what());
    }
  };
  expectParts(refusal(R"({"frames": 1e-3, "contents": ["stress"]})"), {"stress", "points"});
}

}  // namespace
}  // namespace dovetail::scene::test
