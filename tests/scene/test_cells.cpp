// Solids whose points have cells of grains.
#include <cmath>
#include <fstream>
#include <map>
#include <sstream>

#include "../io/scratch_folder.hpp"
#include "cell_blocks.hpp"
#include "dovetail/core/archive.hpp"
#include "dovetail/core/parallel.hpp"
#include "dovetail/fem/elements/solid.hpp"
#include "dovetail/hierarchical/cell_field.hpp"
#include "dovetail/rve/packing.hpp"
#include "dovetail/rve/rve_archive.hpp"
#include "dovetail/solid_io/solid_files.hpp"
#include "run/cell_fields.hpp"
#include "run/frame_fields.hpp"

namespace dovetail::scene::test {
namespace {

std::string refusalOfStart(const Scene& scene) {
  try {
    started(scene);
    return "";
  } catch (const InputError& error) {
    return error.what();
  }
}
const fem::Solid& elementsOf(const Built& built) {
  for (const auto& term : built.run->solid(0).model->terms)
    if (const auto* const solid = dynamic_cast<const fem::Solid*>(term.get())) return *solid;
  throw InputError("no elements", "", "");
}

TEST(SceneCells, AreThoseOfTheLibrary) {
  const Built built = build(blockScene(loads, discs(R"("number": 2, "seed": 4, )")));
  ASSERT_EQ(built.cells.at("sand").size(), 2U);
  const rve::Rve& second = built.cells.at("sand")[1];
  rve::Rve own = rve::randomCell({.count = 60, .sizes = dem::UniformSizes{3e-3, 7e-3}, .density = 2650, .seed = 5},
                                 {.modulus = 6e8, .tangential = 0.8, .friction = 0.5});
  rve::compress(own, {.pressure = {1e5, 1e5, 1e5}, .friction = 0.2, .rest = {.tolerance = 1e-6}});
  EXPECT_EQ(second.state.x, own.state.x);
  EXPECT_EQ(second.state.lattice.period, own.state.lattice.period);
  double mean = 0.0;
  for (const rve::Rve& cell : built.cells.at("sand")) mean += 0.5 * cell.density * rve::solidFraction(cell);
  EXPECT_NEAR(elementsOf(built).density(), mean, 1e-9 * mean);
}

/// The stress at every point is that of its cell, and in the mean balances the pressure on the side.
TEST(SceneCells, LoadStepsGiveTheAnswersOfTheCells) {
  Built built = loaded(blockScene(loads));
  auto& elements = const_cast<fem::Solid&>(elementsOf(built));
  const fem::Solid::Sample sample = elements.sample(built.run->solid(0).nodes(), {.t = 1.0});
  double side = 0.0, F22 = 0.0;
  for (std::size_t p = 0; p < 4; ++p) {
    Eigen::Matrix3d P;
    ASSERT_TRUE(
        hierarchical::visitCell(*elements.field(), p, [&](const rve::Rve& now) { P = rve::nominalStress(now); }));
    for (std::size_t k = 0; k < 9; ++k)
      EXPECT_NEAR(sample.P[9 * p + k], P(static_cast<int>(k / 3), static_cast<int>(k % 3)), 1e-9 * P.norm());
    side += 0.25 * sample.P[9 * p], F22 += 0.25 * sample.F[9 * p + 4];
    EXPECT_LT(P(1, 1), -1.1e5);
  }
  EXPECT_NEAR(F22, 1.0 - 1e-3, 1e-12);
  EXPECT_NEAR(side, -1e5 * F22, 1e-3 * 1e5);
  double exchanged = 0.0;
  for (const auto& one : built.run->ledger().channels()) exchanged += std::abs(one.joules);
  EXPECT_LT(std::abs(built.run->ledger().residual()), 1e-2 * exchanged);
}

TEST(SceneCells, MotionIsBookedAndTheSameOnAnyNumberOfThreads) {
  const Scene scene = blockScene(runs, discs(), frame + ", " + sides);
  std::vector<std::string> states;
  for (const int count : {1, 2}) {
    setThreads(count);
    Built built = started(scene);
    built.run->advance(200);
    const EnergyLedger& ledger = built.run->ledger();
    double exchanged = 0.0;
    for (const auto& one : ledger.channels()) exchanged += std::abs(one.joules);
    EXPECT_LT(std::abs(ledger.residual()), 1e-3 * exchanged);
    std::ostringstream text;
    for (const Vec3& u : built.run->solid(0).nodes().u) text << std::hexfloat << u.x << u.y;
    states.push_back(text.str());
  }
  EXPECT_EQ(states[0], states[1]);
}

TEST(SceneCells, WhatCannotBeIsRefused) {
  const auto all = frame + ", " + sides;
  expectParts(refusalOfStart(blockScene(runs, discs(), R"("supports": [{"on": "y-"}])")),
              {"start under a pressure of 1e+05 Pa", "nothing holds at node", "\"pressure\": \"100 kPa\""});
  const auto with = [&](const std::string& material, const std::string& keys, const std::string& mesh) {
    return refusalOfStart(sceneFromText("{" + discs() + block(keys, mesh, material) + runs + "}", "s.json", "/"));
  };
  const std::string plane = R"("cell": "quad4", "cells": [1, 1, 1])", sand = R"({"law": "cells", "cells": "sand"})";
  expectParts(with(R"({"law": "cells", "cells": "snd"})", all, plane), {"no cells \"snd\"", "sand", "solids.0"});
  expectParts(with(sand, all, R"("cells": [1, 1, 1])"), {"discs", "in their plane", "quad4 or quad8"});
  expectParts(with(sand, all + R"(, "formulation": "mean-dilatation")", plane), {"discs", "formulation"});
  expectParts(with(sand, all + R"(, "stepping": "implicit")", plane), {"too coarsely for implicit steps"});
  EXPECT_THROW(with(R"({"law": "cells", "cells": "sand", "density": 1000})", all, plane), InputError);
}

/// Elements of a law without initial stress do not hold that of cells beside them.
TEST(SceneCells, HoldNoOtherLaws) {
  const auto refusalBeside = [](const std::string& other) {
    return refusalOfStart(
        sceneFromText("{" + discs() +
                          block(frame + ", " + sides +
                                    R"(, "sets": [{"name": "low", "place": "box", "box": [[-1, -1, -1], [1, 0.11, 1]]}],
        "regions": [{"elements": "low", "material": )" +
                                    other + "}]",
                                R"("cell": "quad4", "cells": [1, 2, 1])") +
                          runs + "}",
                      "s.json", "/"));
  };
  EXPECT_EQ(refusalBeside(R"({"law": "cells", "cells": "sand"})"), "");
  expectParts(refusalBeside(R"({"law": "neo-Hookean", "youngs_modulus": 1e8, "poisson_ratio": 0.2, "density": 2000})"),
              {"nothing holds at node", "regions have cells of one pressure", "without stress"});
}

/// What ties pass on holds the stress too: two layers that meet in the middle.
TEST(SceneCells, AreHeldByTies) {
  const std::filesystem::path folder = std::filesystem::temp_directory_path() / "dovetail_tied_cells";
  std::filesystem::create_directories(folder);
  fem::SolidMesh both = fem::boxOf(fem::ElementShape::quad4, {1, 1, 1}, {}, {0.1, 0.1, 0.1});
  const fem::SolidMesh upper = fem::boxOf(fem::ElementShape::quad4, {2, 1, 1}, {0, 0.1, 0}, {0.1, 0.2, 0.1});
  const int offset = static_cast<int>(both.X.size());
  std::vector<int> foot = upper.nodeSets.at("y-");
  for (int& n : foot) n += offset;
  both.X.insert(both.X.end(), upper.X.begin(), upper.X.end());
  for (const int n : upper.groups[0].node) both.groups[0].node.push_back(n + offset);
  both.nodeSets = {{"foot", foot}};
  both.faceSets = {{"head", both.faceSets.at("y+")}};
  solid_io::writeSolid(both, folder / "two.inp");
  const auto refusal = [&](const std::string& ties) {
    return refusalOfStart(
        sceneFromText("{" + discs() +
                          R"("solids": [{"name": "block", "mesh": "file", "file": "two.inp", "gravity": false,
        "material": {"law": "cells", "cells": "sand"},
        "sets": [{"name": "low", "place": "side", "side": "y-"}, {"name": "top", "place": "side", "side": "y+"},
                 {"name": "left", "place": "side", "side": "x-"}, {"name": "right", "place": "side", "side": "x+"}],
        "supports": [{"on": "low", "components": ["y"]}, {"on": "top", "components": ["y"]},
                     {"on": "left", "components": ["x"]}, {"on": "right", "components": ["x"]}])" +
                          ties + "}]," + runs + "}",
                      "s.json", folder));
  };
  EXPECT_EQ(refusal(R"(, "ties": [{"nodes": "foot", "faces": "head", "tolerance": 1e-6}])"), "");
  expectParts(refusal(""), {"nothing holds at node"});
  std::filesystem::remove_all(folder);
}

/// A bed of four layers under 100 kPa and its own weight of another 80. @param deal  key of the material
Scene bed(const std::string& deal, const std::string& gravity = "[0, -200, 0]") {
  return sceneFromText(R"({"gravity": )" + gravity + ", " + discs() +
                           R"("solids": [{"name": "bed", "mesh": "box", "cell": "quad4", "cells": [1, 4, 1],
      "box": [[0, 0, 0], [0.1, 0.2, 0.1]], "material": {"law": "cells", "cells": "sand")" +
                           deal +
                           R"(}, "supports": [{"on": "x-", "components": ["x"]}, {"on": "x+", "components": ["x"]},
        {"on": "y-", "components": ["y"]}], "loads": [{"on": "y+", "type": "pressure", "pressure": 1e5}]}],)" +
                           runs + "}",
                       "s.json", "/");
}
/// Largest vertical force on a row of nodes that are free to move over the weight of a layer. (Shear stresses of the
/// cells themselves, which nothing holds, push one node of a row up and the other down.)
double pushed(const Built& built) {
  const coupling::SolidSide& side = std::as_const(*built.run).solid(0);
  std::vector<Vec3> all(side.nodes().X.size());
  for (const auto& term : side.model->terms) term->addForces(side.nodes(), {}, all);
  double most = 0.0, mass = 0.0;
  std::map<long, double> rows;
  for (std::size_t n = 0; n < all.size(); ++n) {
    mass += side.nodes().mass[n];
    rows[std::lround(1e3 * side.nodes().X[n].y)] += all[n].y;
  }
  for (const auto& [y, force] : rows)
    if (y > 0) most = std::max(most, std::abs(force));
  return most / (200.0 * mass / 4.0);
}

/// p + ρ g d is linear, and so balanced by the elements to what cells are pressed to.
TEST(SceneCells, DealtByDepthRestUnderGravity) {
  const Built inTurn = started(bed("")), byDepth = started(bed(R"(, "deal": "by depth")"));
  EXPECT_GT(pushed(inTurn), 0.4);
  EXPECT_LT(pushed(byDepth), 5e-3);
  // Pressures of the lowest and the highest points, 2 × 2 in each element.
  const std::vector<CellPoint> cells = cellPoints(*byDepth.run->solid(0).model);
  const double weight = elementsOf(byDepth).density() * 200.0, depth = 0.025 - 0.025 / std::sqrt(3.0);
  int dimension = 0;
  EXPECT_NEAR(meanOf({nearestCell(cells, {0, 0.2, 0})}, dimension).pressure(2), 1e5 + weight * depth, 2e2);
  EXPECT_NEAR(meanOf({nearestCell(cells, {0, 0, 0})}, dimension).pressure(2), 1e5 + weight * (0.2 - depth), 2e2);
  expectParts(refusalOfStart(bed(R"(, "deal": "by depth")", "[0, 0, 0]")),
              {"dealt by depth", "no gravity", "solids.0"});
}

TEST(SceneCells, ThatNoSolidHasAreNotMade) {
  const Built built = build(sceneFromText("{" + discs() +
                                              R"("solids": [{"name": "bar", "mesh": "box", "cells": [1, 1, 1],
      "box": [[0, 0, 0], [1, 1, 1]], "material": {"law": "neo-Hookean", "youngs_modulus": 1e6, "poisson_ratio": 0.3,
      "density": 1000}}], )" + runs + "}",
                                          "s.json", "/"));
  EXPECT_TRUE(built.cells.at("sand").empty());
  ASSERT_FALSE(built.notes.empty());
  expectParts(built.notes.front(), {"WARNING", "No solid has the cells \"sand\"", "not made"});
}

TEST(SceneCells, DescriptionsAreChecked) {
  const auto refusal = [](const std::string& contact, const std::string& rest) {
    try {
      return refusalOf(sceneFromText(R"({"cells": [{"name": "sand", "grains": "discs", "count": 60, "density": 2650,
          "radius": {"smallest": 3e-3, "largest": 7e-3}, "thickness": 0.1, "contact": )" +
                                         contact + rest + "]," + block(frame) + runs + "}",
                                     "s.json", "/"));
    } catch (const InputError& error) {
      return std::string(error.what());
    }
  };
  const std::string pressed = R"(, "prepare": [{"pressure": 1e5}]})";
  expectParts(refusal(R"({"law": "linear", "friction": 0.5})", pressed), {"cells.0.contact", "neither a modulus"});
  expectParts(refusal(R"({"law": "linear", "friction": 0.5, "modulus": 1e8, "stiffness": 1})", pressed),
              {"cells.0.contact", "both a modulus"});
  expectParts(refusal(R"({"law": "Hertz", "friction": 0.5, "youngs_modulus": 1e9, "poisson_ratio": 0.2})", pressed),
              {"cells.0", "sphere"});
  expectParts(refusal(R"({"law": "linear", "friction": 0.5, "modulus": 1e8})", "}"), {"cells.0", "prepare"});
}

/// Spheres in bricks, and a file of cells in place of grains.
TEST(SceneCells, ComeFromFilesToo) {
  const std::filesystem::path folder = std::filesystem::temp_directory_path() / "dovetail_scene_cells";
  std::filesystem::create_directories(folder);
  const Built built = build(blockScene(loads));
  rve::writeSamples(folder / "sand.cells", built.cells.at("sand"));
  const std::string cells = R"("cells": [{"name": "sand", "grains": "file", "file": "sand.cells"}],)";
  Built again = build(sceneFromText("{" + cells + block(frame + ", " + sides) + loads + "}", "s.json", folder));
  EXPECT_EQ(again.cells.at("sand").front().state.x, built.cells.at("sand").front().state.x);
  std::filesystem::remove_all(folder);
}

/// One layer of bricks that cannot move along z.
/// A packing that repeats, as a table with two periods along z; cells cut out of it are the cell that it was.
TEST(SceneCells, AreCutOutOfPackings) {
  const rve::Springs springs{.modulus = 6e8, .tangential = 0.8, .friction = 0.5};
  rve::Rve packing = rve::randomCell({.shape = rve::Shape::sphere,
                                      .count = 120,
                                      .sizes = dem::UniformSizes{4e-3, 6e-3},
                                      .solidFraction = 0.55,
                                      .density = 2650},
                                     springs);
  rve::compress(packing,
                {.pressure = {1e5, 1e5, 1e5}, .friction = 0.0, .tolerance = 1e-5, .rest = {.tolerance = 1e-6}});
  const double x = packing.state.lattice.period[0].x, y = packing.state.lattice.period[1].y,
               z = packing.state.lattice.period[2].z;
  const io::test::ScratchFolder folder;
  std::ostringstream table;
  table.precision(17);
  table << "x_m,y_m,z_m,radius_m\n";
  const auto wrapped = [](double place, double period) { return place - period * std::floor(place / period); };
  for (const int again : {0, 1})
    for (std::size_t i = 0; i < packing.size(); ++i)
      table << wrapped(packing.state.x[0][i], x) << ',' << wrapped(packing.state.x[1][i], y) << ','
            << wrapped(packing.state.x[2][i], z) + again * z << ',' << packing.radius[i] << '\n';
  io::test::writeText(folder / "packing.csv", table.str());
  const auto cellsOf = [&](const std::string& box, const std::string& more) {
    return sceneFromText(R"({"cells": [{"name": "sand", "grains": "cut", "file": "packing.csv", "box": )" + box +
                             R"(, "contact": {"law": "linear", "modulus": 6e8, "friction": 0.5},
           "prepare": [{"pressure": 1e5, "friction": 0}], "tolerance": 1e-5)" +
                             more + "}]," + runs + "}",
                         (folder / "s.json").string(), folder.path());
  };
  const auto number = [](double value) {
    std::ostringstream text;
    text.precision(17);
    text << value;
    return text.str();
  };
  const std::string whole = "[[0, 0, 0], [" + number(x) + ", " + number(y) + ", " + number(z) + "]]";
  const std::vector<rve::Rve> cut =
      makeCells(cellsOf(whole, R"(, "density": 2650, "number": 2, "step": [0, 0, )" + number(z) + "]").cells.front());
  ASSERT_EQ(cut.size(), 2u);
  for (const rve::Rve& cell : cut) {
    ASSERT_EQ(cell.size(), packing.size());
    EXPECT_NEAR(volume(cell), volume(packing), 1e-4 * volume(packing));
    EXPECT_EQ(cell.density, 2650.0);
    EXPECT_NEAR(-rve::nominalStress(cell).trace() / 3.0, 1e5, 1.0);
    double farthest = 0.0;
    for (std::size_t i = 0; i < cell.size(); ++i)
      for (std::size_t k = 0; k < 3; ++k) {
        const double period = k == 0 ? x : k == 1 ? y : z, d = cell.state.x[k][i] - packing.state.x[k][i];
        farthest = std::max(farthest, std::abs(d - period * std::round(d / period)));
      }
    EXPECT_LT(farthest, 2e-4);  // radii are 20 times as large
  }
  const auto refusal = [&](const std::string& box, const std::string& more) -> std::string {
    try {
      makeCells(cellsOf(box, more).cells.front());
      return "";
    } catch (const InputError& error) {
      return error.what();
    }
  };
  EXPECT_NE(refusal(whole, "").find("no densities"), std::string::npos);
  EXPECT_NE(refusal("[[1, 1, 1], [2, 2, 2]]", R"(, "density": 2650)").find("holds 0 of the 240 grains"),
            std::string::npos);
}

TEST(PlaneStrain, IsALayerOfBricksInScenes) {
  const auto tip = [](const std::string& shape, const std::string& sides) {
    const Built built = loaded(
        staticScene(R"("solids": [{"name": "beam", "mesh": "box", "cell": ")" + shape +
                        R"(", "cells": [4, 1, 1], "box": [[0, 0, 0], [4, 1, 0.5]], "material": {"law": "neo-Hookean",
        "youngs_modulus": 1e6, "poisson_ratio": 0.3, "density": 1000}, "supports": [{"on": "x-"})" +
                        sides + R"(], "loads": [{"on": "y+", "type": "pressure", "pressure": 100}]}],)",
                    R"({"do": "statics", "load_steps": 2})"));
    EXPECT_EQ(displacementAt(built, {4, 1, 0}).z, 0.0);
    return displacementAt(built, {4, 1, 0}).y;
  };
  const double layer = tip("hex8", R"(, {"on": "z-", "components": ["z"]}, {"on": "z+", "components": ["z"]})");
  EXPECT_LT(layer, -1e-3);
  EXPECT_NEAR(tip("quad4", ""), layer, 1e-9 * std::abs(layer));
}

TEST(CellFields, StrainsOfASimpleShear) {
  const Scene scene = sceneFromText(R"({"solids": [{"name": "bar", "mesh": "box", "cells": [2, 1, 1],
      "box": [[0, 0, 0], [2, 1, 1]], "material": {"law": "neo-Hookean", "youngs_modulus": 1e6, "poisson_ratio": 0.3,
      "density": 1000}}], )" + runs + "}",
                                    "s.json", "/");
  Built built = started(scene);
  fem::Nodes& nodes = built.run->solid(0).nodes();
  for (std::size_t n = 0; n < nodes.X.size(); ++n) nodes.u[n] = {1e-3 * nodes.X[n].y, 0.0, 0.0};
  const auto strains = [&] {
    std::map<std::string, std::vector<double>> found;
    for (const MeshField& field : solidFields(*built.run->solid(0).model, 2, scene.solids[0], {"strain"}))
      found[field.name] = field.values;
    return found;
  };
  EXPECT_NEAR(strains().at("strain")[1], 5e-4, 1e-9);
  EXPECT_NEAR(strains().at("volume_strain")[0], 0.0, 1e-12);
  EXPECT_NEAR(strains().at("shear_strain")[1], 1e-3, 1e-9);
  EXPECT_NEAR(strains().at("turn")[2], -5e-4, 1e-9);
  // A turn is no strain.
  const double c = std::cos(0.5), s = std::sin(0.5);
  for (std::size_t n = 0; n < nodes.X.size(); ++n) {
    const Vec3& X = nodes.X[n];
    nodes.u[n] = {c * X.x - s * X.y - X.x, s * X.x + c * X.y - X.y, 0.0};
  }
  EXPECT_NEAR(strains().at("shear_strain")[0], 0.0, 1e-12);
  EXPECT_NEAR(strains().at("turn")[2], 0.5, 1e-12);
}

TEST(CellFields, MeansOfCells) {
  const Built built = started(blockScene(runs, discs(R"("number": 2, )")));
  const fem::Model& model = *built.run->solid(0).model;
  int dimension = 0;
  const std::vector<CellPoint> points = cellPoints(model);
  ASSERT_EQ(points.size(), 4U);
  EXPECT_EQ(points[3].point, 3);
  const CellMeasures mean = meanOf(points, dimension);
  EXPECT_EQ(dimension, 2);
  EXPECT_NEAR(mean.pressure(2), 1e5, 2e2);
  const std::vector<rve::Rve>& cells = built.cells.at("sand");
  double e = 0.0;
  Eigen::Matrix3d cauchy = Eigen::Matrix3d::Zero();
  for (const rve::Rve& cell : cells) {
    e += 0.5 * (1.0 / rve::solidFraction(cell) - 1.0);
    cauchy += 0.5 * rve::stress(cell).cauchy;
  }
  const double shear = std::hypot(0.5 * (cauchy(0, 0) - cauchy(1, 1)), cauchy(0, 1));
  EXPECT_NEAR(mean.stressRatio(2), -2.0 * shear / (cauchy(0, 0) + cauchy(1, 1)), 1e-9);
  EXPECT_NEAR(mean.voidRatio, e, 1e-12);
  std::map<std::string, std::vector<double>> fields;
  for (const MeshField& field : solidFields(model, 1, Solid{}, {"cells"})) fields[field.name] = field.values;
  EXPECT_NEAR(fields.at("void_ratio")[0], e, 1e-12);
  EXPECT_NEAR(fields.at("fabric")[0] + fields.at("fabric")[4], 1.0, 1e-12);  // trace 1
  EXPECT_NEAR(meanOf({nearestCell(points, {})}, dimension).voidRatio, 1.0 / rve::solidFraction(cells[0]) - 1.0, 1e-12);
}

}  // namespace
}  // namespace dovetail::scene::test
