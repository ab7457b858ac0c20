// What scenes take from meshes and tables in files, and what they tell of them.
#include <gtest/gtest.h>

#include <array>
#include <fstream>
#include <sstream>

#include "../io/scratch_folder.hpp"
#include "dovetail/scene/build.hpp"
#include "dovetail/scene/execute.hpp"
#include "dovetail/solid_io/solid_files.hpp"
#include "refusal.hpp"

namespace dovetail::scene::test {
namespace {

using io::test::ScratchFolder;
using io::test::writeText;

std::string contentOf(const std::filesystem::path& file) {
  std::ostringstream text;
  text << std::ifstream(file).rdbuf();
  return text.str();
}

const std::string cube =
    "*NODE\n1, 0,0,0\n2, 1,0,0\n3, 1,1,0\n4, 0,1,0\n5, 0,0,1\n6, 1,0,1\n7, 1,1,1\n8, 0,1,1\n"
    "*ELEMENT, TYPE=C3D8, ELSET=all\n1, 1,2,3,4,5,6,7,8\n";

std::string sceneWith(const std::string& file, const std::string& more = "") {
  return R"({"solids": [{"name": "block", "mesh": "file", "file": ")" + file + R"(",
    "material": {"law": "neo-Hookean", "youngs_modulus": 1e6, "poisson_ratio": 0.3, "density": 1000})" +
         more + R"(}], "steps": {"dt": 1e-5}, "stages": [{"do": "run", "time": 2e-5}]})";
}

/// Sets, trusses, a shell, a tie and a node that nobody uses.
TEST(SceneFiles, NotesOfMeshReadersReachCheckRunAndSummary) {
  const ScratchFolder folder;
  writeText(folder / "block.inp", cube +
                                      "*NODE\n9, 5, 5, 5\n*ELEMENT, TYPE=T3D2\n2, 1, 7\n*ELEMENT, TYPE=S4\n3, 5,6,7,8\n"
                                      "*EQUATION\n2\n1,1,1.,2,1,-1.\n");
  const std::string text = sceneWith("block.inp");
  const Scene scene = sceneFromText(text, (folder / "s.json").string(), folder.path());
  std::ostringstream checked, log;
  check(scene, checked);
  ASSERT_TRUE(run(scene, {.folder = folder / "out", .progress = false}, log));
  for (const std::string& told : {checked.str(), log.str(), contentOf(folder / "out" / "summary.txt"),
                                  contentOf(folder / "out" / "summary.json")})
    for (const char* wanted :
         {"block.inp: 1 element of type T3D2 is no part of the solid", "block.inp: 1 element of type S4 is no part",
          "block.inp: Supports, constraints and contacts of the file were ignored: *equation.",
          "block.inp: 1 node that no volume element uses was dropped."})
      EXPECT_NE(told.find(wanted), std::string::npos) << wanted << " not in:\n" << told;
}

TEST(SceneFiles, NotesOfGmshFilesAreToldToo) {
  const ScratchFolder folder;
  std::ostringstream mesh;
  fem::SolidMesh box = fem::boxOf(fem::ElementShape::hex8, {1, 1, 1}, {}, {1, 1, 1});
  box.elementSets = {{"a", {0}}, {"b", {0}}};  // written twice
  solid_io::writeGmsh(box, mesh);
  writeText(folder / "box.msh", mesh.str());
  const Built built = build(sceneFromText(sceneWith("box.msh"), "s.json", folder.path()));
  ASSERT_FALSE(built.notes.empty());
  EXPECT_EQ(built.notes.back().find("box.msh: 1 element with the nodes of an earlier one"), 0U) << built.notes.back();
}

TEST(SceneFiles, PlaneMeshesAreCheckedAsTheyRun) {
  const ScratchFolder folder;
  writeText(folder / "plate.msh",
            "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n6\n1 0 0 0\n2 1 0 0\n3 1 1 0\n4 0 1 0\n5 2 0 0\n6 2 1 0\n"
            "$EndNodes\n$Elements\n2\n1 3 2 1 1 1 2 3 4\n2 3 2 1 1 2 5 6 3\n$EndElements\n");
  const Scene scene = sceneFromText(sceneWith("plate.msh"), "s.json", folder.path());
  std::ostringstream checked, log;
  EXPECT_NO_THROW(check(scene, checked));
  EXPECT_TRUE(run(scene, {.folder = folder / "out", .progress = false}, log));
}

/// A set of the file has the name of a shape, and holds one of its two bricks.
TEST(SceneFiles, MixedMeshesOfAnyFormatAreWhole) {
  const ScratchFolder folder;
  writeText(folder / "mixed.inp",
            cube +
                "*NODE\n11, 3,0,0\n12, 4,0,0\n13, 3,1,0\n14, 3,0,1\n21, 0,0,2\n22, 1,0,2\n23, 1,1,2\n24, 0,1,2\n"
                "*ELEMENT, TYPE=C3D4\n2, 11,12,13,14\n*ELEMENT, TYPE=C3D8, ELSET=hex8\n3, 5,6,7,8,21,22,23,24\n");
  const Built built = build(sceneFromText(sceneWith("mixed.inp"), "s.json", folder.path()));
  double mass = 0.0;
  for (const double m : built.run->solid(0).model->nodes.mass) mass += m;
  EXPECT_NEAR(mass, 1000.0 * (2.0 + 1.0 / 6.0), 1e-9);
}

std::string refusalOfTable(const std::string& table) {
  const ScratchFolder folder;
  writeText(folder / "grains.csv", table);
  try {
    build(sceneFromText(R"({"contact": {"law": "linear", "stiffness": 1e4},
      "particles": [{"from": "csv", "file": "grains.csv", "density": 2500}],
      "steps": {"dt": 1e-5}, "stages": [{"do": "run", "time": 1e-4}]})",
                        "s.json", folder.path()));
    return "";
  } catch (const InputError& error) {
    return error.what();
  }
}

TEST(SceneFiles, TablesOfGrainsKeepNothingToThemselves) {
  const std::string row = "\n0.1,0.2,0.3,0.01";
  EXPECT_EQ(refusalOfTable("x_m,y_m,z_m,radius_m" + row + "\n"), "");
  EXPECT_EQ(refusalOfTable("\xEF\xBB\xBF# x_m,y_m,z_m,radius_m,vx_m_per_s,vy_m_per_s,vz_m_per_s" + row + ",+1,2,3\n"),
            "");
  const std::pair<std::string, std::string> bad[] = {
      {"x_m,y_m,z_m,radius_m\n", "the table has no rows"},
      {"x_m,y_m,z_m" + row.substr(0, 12), "no column \"radius_m\""},
      {"x_m,y_m,z_m,radius_m,vz_m_per_s" + row + ",3", "\"vz_m_per_s\", but no \"vx_m_per_s\""},
      {"x_m,y_m,z_m,radius_m,vx_m_per_s" + row + ",3", "\"vx_m_per_s\", but no \"vy_m_per_s\""},
      {"x_m,y_m,z_m,radius_m,vx,vy,vz" + row + ",1,2,3", "a column \"vx\", which is unknown"},
      {"x_m,y_m,z_m,radius_m,density_kg_per_m3" + row + ",7800", "\"density_kg_per_m3\", which is unknown"},
      {"x_m,y_m,z_m,radius_m,wx_rad_per_s" + row + ",7", "no \"wy_rad_per_s\""},
      {"x_m,y_m,z_m,radius_m,material" + row + ",1", "\"material\", which is unknown"},
      {"x_mm,y_m,z_m,radius_m" + row, "write \"x_m\""},
      {"x_m,y_m,z_m,radius_m,radius_m" + row + ",1", "occurs twice"},
      {row.substr(1), "begins with numbers"},
      {"x_m,y_m,z_m,radius_m" + row + "\n0.1,inf,0.3,0.01", "grains.csv, line 3"},
      {"x_m,y_m,z_m,radius_m\n# small\n\n0.1,0.2,0.3,-0.01", "grains.csv, line 4"},
      {"x_m,y_m,z_m,radius_m\n1e200,0.2,0.3,0.01", "farther than 1e15 m"},
      {"x [m],y_m,z_m,radius_m" + row, "write x_m"},
      {"x_m,y_m,z_m,radius_m,vx_m_per_s,vy_m_per_s,vz_m_per_s" + row + ",0,nan,0", "grains.csv, line 2"}};
  for (const auto& [table, wanted] : bad) {
    const std::string message = refusalOfTable(table + "\n");
    EXPECT_NE(message.find(wanted), std::string::npos) << wanted << " not in: " << message;
    EXPECT_NE(message.find("grains.csv"), std::string::npos) << message;
    EXPECT_NE(message.find("s.json:2"), std::string::npos) << message;
  }
}

TEST(SceneFiles, ScenesWithByteOrderMarksAreRead) {
  const ScratchFolder folder;
  writeText(folder / "base.json", "\xEF\xBB\xBF{\"gravity\": [0, 0, -1]}");
  writeText(folder / "s.json",
            "\xEF\xBB\xBF" + replaced(smallScene, "\"gravity\": [0, 0, -9.81]", R"("include": ["base.json"])"));
  EXPECT_EQ(readScene(folder / "s.json").gravity.z, -1.0);
  writeText(folder / "s.json", std::string("\xFF\xFE{\0}\0", 6));
  try {
    readScene(folder / "s.json");
    ADD_FAILURE() << "UTF-16 was read";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("UTF-16"), std::string::npos) << error.what();
  }
}

TEST(SceneFiles, TheAssemblysSetIsTheOneThatASceneNames) {
  const ScratchFolder folder;
  writeText(folder / "cae.inp", "*Part, name=P\n" + cube +
                                    "*Nset, nset=Set-1, generate\n1, 8\n*End Part\n*Assembly, name=A\n*Instance, "
                                    "name=P-1, part=P\n*End Instance\n*Nset, nset=Set-1, instance=P-1\n1, 2\n*End "
                                    "Assembly\n");
  const auto held = [&](const std::string& set) {
    const Built built = build(
        sceneFromText(sceneWith("cae.inp", R"(, "supports": [{"on": ")" + set + R"("}])"), "s.json", folder.path()));
    const auto& fixed = built.run->solid(0).model->nodes.fixed;
    return std::count_if(fixed.begin(), fixed.end(), [](auto components) { return components != 0; });
  };
  EXPECT_EQ(held("Set-1"), 2);
  EXPECT_EQ(held("P-1.Set-1"), 8);
}

/// A wall of a file that is read with these notes.
std::vector<std::string> notesOfWall(const std::string& stl, bool closed) {
  const ScratchFolder folder;
  writeText(folder / "wall.stl", stl);
  const std::string scene = R"({"contact": {"law": "linear", "stiffness": 1e4}, "walls": [{"shape": "mesh",
    "file": "wall.stl", "closed": )" +
                            std::string(closed ? "true" : "false") +
                            R"(}], "steps": {"dt": 1e-5}, "stages": [{"do": "run", "time": 1e-4}]})";
  return build(sceneFromText(scene, "s.json", folder.path())).notes;
}

std::string facetOf(const std::string& normal, const std::array<const char*, 3>& corners) {
  std::string text = "facet normal " + normal + " outer loop\n";
  for (const char* corner : corners) text += std::string("vertex ") + corner + "\n";
  return text + "endloop endfacet\n";
}

TEST(SceneFiles, WhatIsDroppedOrTurnedOfAWallIsNoted) {
  const std::array<const char*, 4> corners = {"0 0 0", "1 0 0", "0 1 0", "0 0 1"};
  const auto at = [&](std::size_t a, std::size_t b, std::size_t c, const std::string& normal = "0 0 0") {
    return facetOf(normal, {corners[a], corners[b], corners[c]});
  };
  const auto solid = [](const std::string& facets) { return "solid a\n" + facets + "endsolid a\n"; };
  const std::string rest = at(0, 1, 3) + at(1, 2, 3) + at(2, 0, 3);
  using Notes = std::vector<std::string>;
  EXPECT_EQ(notesOfWall(solid(at(0, 2, 1, "0 0 -1") + rest), true), Notes());
  EXPECT_EQ(notesOfWall(solid(at(0, 2, 1) + rest + at(1, 2, 0)), true),
            (Notes{"wall.stl: 1 duplicate facet was removed."}));
  EXPECT_EQ(notesOfWall(solid(at(0, 2, 1) + rest + at(1, 1, 0)), true),
            (Notes{"wall.stl: 1 facet without area was removed."}));
  EXPECT_EQ(notesOfWall(solid(at(0, 1, 2) + rest), true),
            (Notes{"wall.stl: 1 facet was reversed: neighbours must be oriented alike."}));
  const std::string inside = at(0, 1, 2) + at(0, 3, 1) + at(1, 3, 2) + at(2, 3, 0);
  EXPECT_EQ(notesOfWall(solid(inside), true), Notes());
  EXPECT_EQ(notesOfWall(solid(inside), false),
            (Notes{"wall.stl: 4 facets were reversed: neighbours must be oriented alike, and closed parts outwards."}));
  EXPECT_EQ(notesOfWall(solid(at(0, 2, 1, "0 0 7") + rest), true),
            (Notes{"wall.stl: Normals of the file were ignored: 1 of its 4 facets have one that points against the "
                   "order of their vertices, which counts."}));
}

}  // namespace
}  // namespace dovetail::scene::test
