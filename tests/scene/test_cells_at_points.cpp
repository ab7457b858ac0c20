// Material points with cells of grains in scenes.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "../../src/scene/run/cell_fields.hpp"
#include "../../src/scene/run/frame_fields.hpp"
#include "../threads.hpp"
#include "dovetail/core/error.hpp"
#include "point_scenes.hpp"

namespace dovetail::scene::test::points {
namespace {

/// @param keys  further keys of the material @param frame  borders
std::string bedOfCells(const std::string& keys = R"(, "deal": "by depth")", const std::string& more = "",
                       const std::string& cell = R"("grains": "discs", "count": 40, "thickness": 0.1)",
                       const std::string& grid = plane) {
  return R"("gravity": [0, -9.81, 0], "cells": [{"name": "sand", )" + cell +
         R"(, "radius": {"smallest": 3e-3, "largest": 7e-3}, "density": 2650,
      "contact": {"law": "linear", "modulus": 6e6, "friction": 0.5}, "prepare": [{"pressure": 100, "friction": 0.1}]}],)" +
         body(R"("from": "box", "box": [[0, 0, 0], [0.15, 0.1, 0.1]])",
              grid + R"(, "transfer": "apic", "borders": [{"side": "y-", "at": 0, "kind": "held"},
                 {"side": "x-", "at": 0, "kind": "symmetry"}, {"side": "x+", "at": 0.15, "kind": "symmetry"}])",
              more + R"("material": {"law": "cells", "cells": "sand")" + keys + "}");
}
Scene cellsIn(const std::string& solids, const std::string& stages = R"("stages": [{"do": "run", "time": 0.1}])") {
  return sceneFromText("{" + solids + R"("steps": {"safety": 0.5}, )" + stages + "}", "s.json", "/");
}
double deepest(const Built& built) {
  double lowest = 0.0;
  const std::vector<Vec3> u = displacementsOf(pointsIn(built), built.run->solid(0).nodes());
  for (const Vec3& one : u) lowest = std::min(lowest, one.y);
  return lowest;
}

/// Dealt by depth, a bed stands; of one pressure it sinks under its weight.
TEST(ScenePoints, OfCellsStandUnderTheirWeight) {
  const Scene scene = cellsIn(bedOfCells());
  Built dealt = started(scene), alike = started(cellsIn(bedOfCells("")));
  for (Built* const built : {&dealt, &alike}) {
    const double stored = built->run->ledger().stored();
    built->run->advance(200);
    EXPECT_LT(std::abs(built->run->ledger().residual()), 1e-4 * stored);
    EXPECT_LT(norm(built->run->totals().residual.linear), 1e-9 * built->run->totals().turnedOver);
  }
  EXPECT_LT(deepest(alike), -1e-6);
  EXPECT_GT(deepest(dealt), 0.3 * deepest(alike));
  const auto at = cellPointsOf("snow", dealt);
  ASSERT_EQ(at.size(), pointsIn(dealt).masses().size());
  EXPECT_EQ(at[5].point, 5);
  EXPECT_EQ(at[5].element, -1);
  std::set<std::string> names;
  for (const MeshField& field : solidFields(*dealt.run->solid(0).model, 0, scene.solids[0], {"cells"}))
    names.insert(field.name);
  EXPECT_TRUE(names.contains("void_ratio"));
}

TEST(ScenePoints, OfCellsGoOnWithTheSameBytes) {
  const Scene scene = cellsIn(bedOfCells(R"(, "deal": "by depth")", R"("velocity": [0.5, -2, 0], )"));
  std::vector<char> halfway;
  const auto end = onThreads(1, [&] {
    Built built = started(scene);
    built.run->advance(15);
    halfway = built.run->save();
    built.run->advance(15);
    EXPECT_GT(pointsIn(built).renewals(), 0);
    return built.run->save();
  });
  EXPECT_EQ(end, onThreads(3, [&] {
              Built built = started(scene);
              built.run->load(halfway);
              built.run->advance(15);
              return built.run->save();
            }));
}

/// Cells of few discs are thin soon, and repeated.
TEST(ScenePoints, OfThinCellsAreToldAndGoOnWithTheSameBytes) {
  const Scene scene = cellsIn(bedOfCells(R"(, "deal": "by depth")", R"("velocity": [0.2, -1.5, 0], )",
                                         R"("grains": "discs", "count": 13, "thickness": 0.1)"));
  Built built = started(scene), again = started(scene);
  EXPECT_EQ(linesOnRepeatedCells(*built.run), std::vector<std::string>{});
  built.run->advance(60);
  const RepeatedCells now = repeatedCells(*built.run->solid(0).model);
  EXPECT_EQ(now.all, pointsIn(built).masses().size());
  EXPECT_GT(now.repeated, 0U);
  EXPECT_GE(now.mostCopies, 2);
  ASSERT_EQ(linesOnRepeatedCells(*built.run).size(), 1U);
  EXPECT_NE(linesOnRepeatedCells(*built.run)[0].find("cells have become thin"), std::string::npos);
  again.run->load(built.run->save());
  for (Built* const one : {&built, &again}) one->run->advance(10);
  EXPECT_EQ(built.run->save(), again.run->save());
}

TEST(ScenePoints, OfCellsAreToldWhatCannotBe) {
  const std::string deal = R"(, "deal": "by depth")";
  expectParts(refusalOf(cellsIn(
                  bedOfCells(deal, "", R"("grains": "discs", "count": 40, "thickness": 0.1)", R"("spacing": 0.05)"))),
              {"solids.0", "discs", "points of plane strain"});
  expectParts(refusalOf(cellsIn(bedOfCells(deal, R"("stepping": "implicit", )"))), {"too coarsely for implicit steps"});
  expectParts(refusalOf(cellsIn(bedOfCells(), R"("stages": [{"do": "statics", "load_steps": 2, "time": 1}])")),
              {"load steps of cells at material points", "a run or a relaxation"});
  std::string bare = bedOfCells();
  const std::size_t begin = bare.find(", \"borders\""), end = bare.find(']', begin);
  const Built loose = started(cellsIn(bare.erase(begin, end + 1 - begin)));
  const auto said = [](const Built& built) {
    return std::ranges::any_of(built.notes, [](const std::string& note) {
      return note.find("starts to move") != std::string::npos && note.find("solids.0") != std::string::npos;
    });
  };
  EXPECT_TRUE(said(loose));
  EXPECT_FALSE(said(started(cellsIn(bedOfCells()))));
}

}  // namespace
}  // namespace dovetail::scene::test::points
