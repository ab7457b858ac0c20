// What frames show is what is there.
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>
#include <map>
#include <random>

#include "../../src/scene/run/frame_fields.hpp"
#include "../io/scratch_folder.hpp"
#include "dovetail/core/error.hpp"
#include "dovetail/dem/model/loads.hpp"
#include "dovetail/dem/model/walls.hpp"
#include "dovetail/fem/elements/solid.hpp"
#include "dovetail/mesh_io/surface_files.hpp"
#include "scene_parts.hpp"

namespace dovetail::scene::test {
namespace {

const std::string stretchedBlock =
    R"("solids": [{"name": "s", "mesh": "box", "cells": [2, 2, 2], "box": [[0, 0, 0], [1, 2, 3]],
  "material": {"law": "St-Venant-Kirchhoff", "youngs_modulus": 1e6, "poisson_ratio": 0.3, "density": 1000}}],)";

/// Every node goes to F X.
void deform(fem::Nodes& nodes, const std::array<double, 9>& F) {
  for (std::size_t n = 0; n < nodes.X.size(); ++n)
    for (int i = 0; i < 3; ++i) {
      const auto row = static_cast<std::size_t>(3 * i);
      nodes.u[n][i] = F[row] * nodes.X[n].x + F[row + 1] * nodes.X[n].y + F[row + 2] * nodes.X[n].z - nodes.X[n][i];
    }
}

TEST(FrameFields, StressIsThatOfTheLaw) {
  Built built = build(sceneOf(stretchedBlock));
  std::mt19937 random(5);
  std::uniform_real_distribution<double> small(-0.2, 0.2);
  std::array<double, 9> F{1, 0, 0, 0, 1, 0, 0, 0, 1};
  for (double& value : F) value += small(random);
  fem::Model& model = *built.run->solid(0).model;
  deform(model.nodes, F);
  std::map<std::string, std::vector<double>> found;
  for (const MeshField& field : solidFields(model, 8, Solid{}, {"stress"})) found[field.name] = field.values;
  // S = λ tr E 1 + 2 μ E, σ = F S Fᵀ/J
  using Matrix = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;
  const Matrix f = Eigen::Map<const Matrix>(F.data()), E = 0.5 * (f.transpose() * f - Matrix::Identity());
  const double lambda = 1e6 * 0.3 / (1.3 * 0.4), mu = 1e6 / 2.6;
  const Matrix sigma = f * (lambda * E.trace() * Matrix::Identity() + 2.0 * mu * E) * f.transpose() / f.determinant();
  const Matrix deviator = sigma - sigma.trace() / 3.0 * Matrix::Identity();
  for (std::size_t e = 0; e < 8; ++e) {
    EXPECT_LT((Eigen::Map<const Matrix>(&found["stress"][9 * e]) - sigma).norm(), 1e-12 * sigma.norm()) << e;
    EXPECT_NEAR(found["pressure"][e], -sigma.trace() / 3.0, 1e-12 * sigma.norm());
    EXPECT_NEAR(found["von_mises"][e], std::sqrt(1.5) * deviator.norm(), 1e-12 * sigma.norm());
  }
}

/// A turn of a stretched body: its axis and angle, and F itself at every point.
TEST(FrameFields, PointsHaveDeformationAndTurn) {
  const Built built = build(sceneOf(stretchedBlock));
  fem::Model& model = *built.run->solid(0).model;
  const Eigen::Vector3d turn = Eigen::Vector3d(0.3, -0.5, 0.2);
  using Matrix = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;
  Matrix stretch;
  stretch << 1.1, 0.05, 0.0, 0.05, 0.9, 0.02, 0.0, 0.02, 1.2;
  const Matrix F = Eigen::AngleAxisd(turn.norm(), turn.normalized()).toRotationMatrix() * stretch;
  std::array<double, 9> rows{};
  Eigen::Map<Matrix>(rows.data()) = F;
  deform(model.nodes, rows);
  std::map<std::string, std::vector<double>> found;
  for (const MeshField& field : pointFields(pointsOf(model), Solid{}, {"stress", "strain"}))
    found[field.name] = field.values;
  ASSERT_EQ(found.at("deformation_gradient").size(), 9U * 64U);
  for (std::size_t p = 0; p < 64; ++p) {
    EXPECT_LT((Eigen::Map<const Matrix>(&found["deformation_gradient"][9 * p]) - F).norm(), 1e-12);
    EXPECT_LT((Eigen::Map<const Eigen::Vector3d>(&found["turn"][3 * p]) - turn).norm(), 1e-12);
    EXPECT_NEAR(found["volume_strain"][p], std::log(F.determinant()), 1e-12);
  }
  EXPECT_EQ(found.at("von_mises").size(), 64U);
}

TEST(FrameFields, PlasticStrainIsWhatWasDissipated) {
  const std::string soft = R"("solids": [{"name": "s", "mesh": "box", "cells": [2, 2, 2], "box": [[0, 0, 0], [1, 1, 1]],
    "material": {"law": "J2", "youngs_modulus": 1e6, "poisson_ratio": 0.3, "density": 1000, "yield_stress": 1e3}}],)";
  const Scene scene = sceneOf(soft);
  Built built = build(scene);
  fem::Model& model = *built.run->solid(0).model;
  double dissipated = 0.0;
  for (int step = 1; step <= 10; ++step) {
    deform(model.nodes, {1, 1e-3 * step, 0, 0, 1, 0, 0, 0, 1});
    for (const auto& term : model.terms) dissipated += term->commit(model.nodes, {.dt = 1.0});
  }
  const Points points = pointsOf(model);
  std::vector<MeshField> history;
  for (const MeshField& field : historyAt(points, scene.solids[0]))
    history.push_back(meansOf(points, field, 8, Volumes::reference));
  ASSERT_EQ(history.size(), 2U);
  EXPECT_EQ(history[0].name, "plastic_strain");
  double sum = 0.0;
  for (std::size_t e = 0; e < 8; ++e) {
    sum += 1e3 * history[0].values[e] / 8.0;  // yield stress · strain · volume
    EXPECT_NEAR(history[1].values[e], 1.0, 1e-12);
  }
  EXPECT_GT(sum, 1.0);
  EXPECT_NEAR(sum, dissipated, 1e-3 * dissipated);  // of second order in the strain
  const Built elastic = build(sceneOf(stretchedBlock));
  EXPECT_TRUE(historyAt(pointsOf(*elastic.run->solid(0).model), sceneOf(stretchedBlock).solids[0]).empty());
}

const std::string grains = R"("walls": [{"shape": "plane", "point": [0, 0, 0], "normal": [0, 0, 1]}],
  "particles": [{"from": "packing", "box": [[0, 0, 0], [0.4, 0.4, 0.4]], "radius": {"smallest": 0.04, "largest": 0.06},
                 "solid_fraction": 0.48, "overlap": 1e-2, "density": 2500}],)";

TEST(FrameFields, LinesAddUpToTheForcesOnGrains) {
  Built built = started(sceneOf(grains));
  built.run->advance(40);
  dem::findForces(built.run->grains);  // of velocities as they are after the step
  const dem::Model& model = built.run->grains;
  const ForceLines lines = contactLines(model);
  ASSERT_GT(lines.line.size(), 50U);
  std::vector<Vec3> sum(model.particles.size());
  int walls = 0;
  for (std::size_t c = 0; c < lines.line.size(); ++c) {
    const Vec3 along = lines.ends[2 * c] - lines.ends[2 * c + 1];
    EXPECT_NEAR(std::hypot(lines.normal[c], lines.tangential[c]), norm(lines.force[c]), 1e-12 * norm(lines.force[c]));
    EXPECT_NEAR(dot(along, lines.force[c]) / norm(along), lines.normal[c], 1e-9 * norm(lines.force[c]));
    const int first = dem::find(model.particles, lines.first[c]);
    EXPECT_EQ(lines.ends[2 * c], model.particles.x[static_cast<std::size_t>(first)]);
    sum[static_cast<std::size_t>(first)] += lines.force[c];
    if (lines.second[c] < 0)
      ++walls;
    else
      sum[static_cast<std::size_t>(dem::find(model.particles, lines.second[c]))] -= lines.force[c];
  }
  EXPECT_GT(walls, 0);
  for (std::size_t i = 0; i < sum.size(); ++i) EXPECT_LT(norm(sum[i] - model.particles.f[i]), 1e-9) << i;
}

TEST(FrameFields, BondsPullAlongTheirLines) {
  Built built = build(sceneOf(R"("particles": [{"from": "list", "density": 1000, "spheres": [
      {"at": [1e3, 0, 0], "radius": 0.1}, {"at": [1000.2, 0, 0], "radius": 0.1, "velocity": [10, 0, 0]}]}],)"));
  dem::Model& model = built.run->grains;
  dem::addBond(dem::bonds(model), model.particles, {}, 0, 1,
               {.youngsModulus = 1e7, .poissonRatio = 0.2, .tensileStrength = 1e9, .shearStrength = 1e9});
  built.run->start(1e-5);
  built.run->advance(20);
  const ForceLines lines = bondLines(model);
  ASSERT_EQ(lines.line.size(), 1U);
  EXPECT_LT(lines.normal[0], 0.0);
  EXPECT_NEAR(-lines.normal[0], norm(model.particles.f[0]), 1e-9 * norm(model.particles.f[0]));
  EXPECT_LT(lines.tangential[0], 1e-9 * norm(model.particles.f[0]));
  EXPECT_GT(lines.utilised[0], 0.0);
  EXPECT_EQ(lines.first[0], 0);
  EXPECT_EQ(lines.second[0], 1);
}

TEST(FrameFields, FacetsOfAWallCarryWhatPushesIt) {
  const io::test::ScratchFolder folder;
  const std::vector<Vec3> corners{{-1, -1, 0}, {2, -1, 0}, {2, 2, 0}, {-1, 2, 0}};
  mesh_io::writeStl(folder / "floor.stl", corners, std::vector<geometry::Facet>{{0, 1, 2}, {0, 2, 3}});
  Built built = started(sceneOf(R"("walls": [{"shape": "mesh", "file": "floor.stl"}], "particles": [{"from": "list",
      "density": 2500, "spheres": [{"at": [0.4, 0.1, 0.0495], "radius": 0.05, "velocity": [1, 0, 0]},
                                   {"at": [0.1, 0.9, 0.0490], "radius": 0.05}]}],)",
                                folder.path()));
  built.run->advance(3);
  const dem::MeshWall& mesh = dem::meshWall(built.run->grains, 0);
  const WallFacets facets = wallFacets(mesh);
  ASSERT_EQ(facets.traction.size(), 2U);
  const Vec3 sum = 4.5 * (facets.traction[0] + facets.traction[1]);  // areas of 4.5 m²
  EXPECT_LT(norm(sum - dem::totalForce(mesh.wall)), 1e-12 * norm(sum));
  EXPECT_GT(std::abs(sum.x), 0.0);
  for (const double pressure : facets.pressure) EXPECT_GT(std::abs(pressure), 0.0);
}

}  // namespace
}  // namespace dovetail::scene::test
