#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "../io/scratch_folder.hpp"
#include "dovetail/solid_io_vtk/solid_vtu.hpp"
#include "mesh_files.hpp"

namespace dovetail::solid_io {
namespace {

class Vtu : public testing::Test {
protected:
  std::filesystem::path write(const std::string& text) const {
    const auto path = folder_ / "test.vtu";
    std::ofstream(path, std::ios::binary) << text;
    return path;
  }
  io::test::ScratchFolder scratch_;  // tests run side by side
  std::filesystem::path folder_ = scratch_.path();
};

/// A grid in ASCII with one tetrahedron of four points.
std::string asciiTet(const std::string& connectivity, const std::string& offsets, const std::string& types,
                     const std::string& arrays = "") {
  return "<VTKFile type=\"UnstructuredGrid\" version=\"0.1\" byte_order=\"LittleEndian\"><UnstructuredGrid>"
         "<Piece NumberOfPoints=\"5\" NumberOfCells=\"2\"><Points><DataArray type=\"Float64\" "
         "NumberOfComponents=\"3\" format=\"ascii\">0 0 0 1 0 0 0 1 0 0 0 1 7 7 7</DataArray></Points><Cells>"
         "<DataArray type=\"Int64\" Name=\"connectivity\" format=\"ascii\">" +
         connectivity + "</DataArray><DataArray type=\"Int64\" Name=\"offsets\" format=\"ascii\">" + offsets +
         "</DataArray><DataArray type=\"UInt8\" Name=\"types\" format=\"ascii\">" + types +
         "</DataArray></Cells><CellData>" + arrays + "</CellData></Piece></UnstructuredGrid></VTKFile>\n";
}

TEST_F(Vtu, SolidsOfAllShapesGoThereAndBack) {
  for (const fem::ElementShape shape : fem::allCellShapes) {
    const fem::SolidMesh mesh = testMesh(shape);
    const std::vector<Vec3> u(mesh.X.size(), Vec3{1.0, 2.0, 3.0});
    const std::vector<double> stress(9 * mesh.elementCount(), 5.0), heat(mesh.X.size(), 1.0);
    const auto path = folder_ / (std::string(fem::name(shape)) + ".vtu");
    writeVtu(path, mesh, {.perPoint = {{"heat", heat}}, .perCell = {{"stress", stress, 9}}, .displacement = u});
    writeVtu(path, mesh);  // our own files are replaced
    const SolidFile back = readVtu(path);
    EXPECT_EQ(back.mesh.X, mesh.X);
    ASSERT_EQ(back.mesh.groups.size(), 1u);
    EXPECT_EQ(back.mesh.groups[0].shape, shape);
    EXPECT_EQ(back.mesh.groups[0].node, mesh.groups[0].node);
    EXPECT_EQ(back.mesh.nodeSets, mesh.nodeSets);
    EXPECT_EQ(back.mesh.elementSets, mesh.elementSets);
    EXPECT_EQ(back.notes.size(), fem::dimensionOf(shape) == 2 ? 1u : 0u);
  }
}

TEST_F(Vtu, WholeNumbersAndSurfaceCellsAreSets) {
  const auto path = write(asciiTet("0 1 2 3 0 1 2", "4 7", "10 5",
                                   "<DataArray type=\"Int32\" Name=\"material\" format=\"ascii\">3 8</DataArray>"
                                   "<DataArray type=\"Float64\" Name=\"p\" format=\"ascii\">1 1</DataArray>"));
  const SolidFile file = readVtu(path);
  EXPECT_EQ(fem::elementSet(file.mesh, "material 3"), std::vector<int>{0});
  EXPECT_EQ(fem::faceSet(file.mesh, "material 8").at(0).node, (std::array<int, 9>{0, 2, 1, -1, -1, -1, -1, -1, -1}));
  EXPECT_EQ(file.mesh.X.size(), 4u);
  EXPECT_EQ(file.mesh.elementSets.size() + file.mesh.faceSets.size(), 2u);
}

/// Flags named "a 3", values 3 and 8 of "a", and flags "a" of points and of a surface cell.
TEST_F(Vtu, ArraysThatGiveSetsOfOneNameStayApart) {
  std::string text = asciiTet("0 1 2 3 0 1 2", "4 7", "10 5",
                              "<DataArray type=\"Int32\" Name=\"a\" format=\"ascii\">8 3</DataArray>"
                              "<DataArray type=\"UInt8\" Name=\"a 8\" format=\"ascii\">0 1</DataArray>"
                              "<DataArray type=\"UInt8\" Name=\"b\" format=\"ascii\">0 1</DataArray>");
  text.insert(text.find("<CellData>"),
              "<PointData><DataArray type=\"UInt8\" Name=\"b\" format=\"ascii\">0 0 0 1 0</DataArray></PointData>");
  const SolidFile file = readVtu(write(text));
  EXPECT_EQ(fem::elementSet(file.mesh, "a 8"), std::vector<int>{0});
  EXPECT_EQ(fem::faceSet(file.mesh, "a 3").size(), 1u);
  EXPECT_EQ(fem::faceSet(file.mesh, "a 8").size(), 1u);
  EXPECT_EQ(fem::nodeSet(file.mesh, "b"), std::vector<int>{3});
  EXPECT_EQ(fem::nodeSet(file.mesh, "b (cells)"), (std::vector<int>{0, 1, 2}));
}

TEST_F(Vtu, NumbersMayHaveAPlusSign) {
  std::string text = asciiTet("0 1 2 3 0 1 2", "4 7", "10 5");
  text.replace(text.find("0 0 0 1 0 0 0 1"), 15, "0 0 0 +1.0e+00 0 0 0 1");
  EXPECT_EQ(readVtu(write(text)).mesh.X[1], (Vec3{1.0, 0.0, 0.0}));
  text.replace(text.find("+1.0"), 2, "+-1");
  EXPECT_THROW(readVtu(write(text)), InputError);
  EXPECT_EQ(readVtu(write("\xEF\xBB\xBF" + asciiTet("0 1 2 3 0 1 2", "4 7", "10 5"))).mesh.X.size(), 4u);
}

TEST_F(Vtu, MeshesOfSeveralShapesHaveASetOfEach) {
  fem::SolidMesh mesh = fem::boxOf(fem::ElementShape::hex8, {1, 1, 1}, {}, {1.0, 1.0, 1.0});
  mesh.X.insert(mesh.X.end(), {{3, 0, 0}, {4, 0, 0}, {3, 1, 0}, {3, 0, 1}});
  mesh.groups.push_back({fem::ElementShape::tet4, {8, 9, 10, 11}});
  mesh.elementSets["both"] = {0, 1};
  writeVtu(folder_ / "mixed.vtu", mesh);
  const SolidFile file = readVtu(folder_ / "mixed.vtu");
  EXPECT_EQ(fem::elementSet(file.mesh, "hex8"), std::vector<int>{0});
  EXPECT_EQ(fem::elementSet(file.mesh, "tet4"), std::vector<int>{1});
  EXPECT_EQ(fem::elementSet(file.mesh, "both tet4"), std::vector<int>{1});
}

TEST_F(Vtu, WithoutVolumesQuadrilateralsAreElementsAndLinesTheirFaces) {
  const auto path = write(asciiTet("0 1 3 2 3 1", "4 6", "9 3",
                                   "<DataArray type=\"Int32\" Name=\"part\" format=\"ascii\">3 8</DataArray>"));
  EXPECT_NE(messageOf([&] { readVtu(path); }).find("node 3 of its quadrilaterals is not in one plane"),
            std::string::npos)
      << messageOf([&] { readVtu(path); });
  std::string text =
      asciiTet("0 1 3 2 3 1", "4 6", "9 3", "<DataArray type=\"Int32\" Name=\"part\" format=\"ascii\">3 8</DataArray>");
  text.replace(text.find("0 0 1 7 7 7"), 11, "1 1 0 7 7 7");
  const SolidFile file = readVtu(write(text));
  EXPECT_EQ(file.mesh.groups.at(0).shape, fem::ElementShape::quad4);
  EXPECT_EQ(fem::elementSet(file.mesh, "part 3"), std::vector<int>{0});
  EXPECT_EQ(fem::faceSet(file.mesh, "part 8").at(0).shape, fem::FaceShape::line2);
  EXPECT_EQ(fem::nodeSet(file.mesh, "part 8"), (std::vector<int>{1, 3}));
}

TEST_F(Vtu, BadFilesAreRefused) {
  const std::pair<std::string, std::string> broken[] = {
      {"nonsense", "no complete VTU file"},
      {asciiTet("0 1 2 3 0 1 2", "4 7", "10 13"), "type 13"},
      {asciiTet("0 1 2 9 0 1 2", "4 7", "10 5"), "point that does not exist"},
      {asciiTet("0 1 2 3 0 1 2", "3 7", "10 5"), "cell 0"},
      {asciiTet("0 2 1 3 0 1 2", "4 7", "10 5"), "inside out or too distorted: element 0 ["},
      {asciiTet("0 1 2 3 0 1 2", "4 7", "10 5",
                "<DataArray type=\"Int32\" Name=\"part\" format=\"ascii\">1e30 8</DataArray>"),
       "1e30 is no Int32"},
      {asciiTet("0 1 2 3 0 1 2", "4 7", "10 5",
                "<DataArray type=\"Int32\" Name=\"p\" NumberOfComponents=\"9223372036854775807\">3 8</DataArray>"),
       "NumberOfComponents"},
      {asciiTet("0 1 2 0 1 2", "3 6", "5 5"), "no volume elements, and element 0 is a triangle"}};
  for (const auto& [text, wanted] : broken) {
    const auto path = write(text);
    EXPECT_NE(messageOf([&] { readVtu(path); }).find(wanted), std::string::npos)
        << wanted << " not in: " << messageOf([&] { readVtu(path); });
  }
  EXPECT_THROW(readVtu(folder_ / "none.vtu"), InputError);
}

TEST_F(Vtu, TruncatedFilesAreRefused) {
  const std::string text = vtuText(testMesh(fem::ElementShape::tet10));
  for (std::size_t end = 0; end + 20 < text.size(); end += 1 + text.size() / 60) {
    const auto path = write(text.substr(0, end));
    EXPECT_THROW(readVtu(path), InputError) << end;
  }
}

/// What VTK's reader does to the program here, if it is asked for its message: it names an array that is not there.
TEST_F(Vtu, DamagedBlocksAreRefused) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  GTEST_SKIP() << "the allocators of sanitizers end the program where VTK's reader gets std::bad_alloc";
#endif
  const std::string good = vtuText(testMesh(fem::ElementShape::hex8));
  const std::size_t from = good.find('_', good.find("<AppendedData")), to = good.find("</AppendedData");
  std::mt19937 random(1);
  for (int round = 0; round < 100; ++round) {
    std::string bad = good;
    const std::size_t at = from + random() % (to - from);
    if (round % 2 == 0)
      bad[at] = static_cast<char>(random() % 256);
    else
      bad.erase(at, 1 + random() % 20);
    try {
      fem::validate(readVtu(write(bad)).mesh);
    } catch (const InputError& error) {
      EXPECT_GT(std::string(error.what()).size(), 20u);
    }
  }
}

TEST_F(Vtu, FieldsThatDoNotFitAreRefused) {
  const fem::SolidMesh mesh = testMesh(fem::ElementShape::hex8);
  const std::vector<double> values(mesh.X.size());
  EXPECT_THROW(vtuText(mesh, {.perCell = {{"a", values}}}), InputError);
  EXPECT_THROW(vtuText(mesh, {.perPoint = {{"a", values}, {"a", values}}}), InputError);
  EXPECT_THROW(vtuText(mesh, {.perPoint = {{"", values}}}), InputError);
  const std::vector<Vec3> few(3);
  EXPECT_THROW(vtuText(mesh, {.displacement = few}), InputError);
}

const std::string tetAndFace = asciiTet("0 1 2 3 0 1 2", "4 7", "10 5");

std::string with(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return at == std::string::npos ? text : text.replace(at, from.size(), to);
}

/// The second of two tetrahedra is a copy, refined, hidden, or on the border, which is no reason to leave it out.
TEST_F(Vtu, CopiedAndHiddenCellsAreLeftOutAndNoted) {
  for (const auto& [flag, stays] : {std::pair{"1", false}, {"8", false}, {"32", false}, {"16", true}, {"0", true}}) {
    const std::string arrays =
        "<DataArray type=\"Int32\" Name=\"part\" format=\"ascii\">3 4</DataArray>"
        "<DataArray type=\"UInt8\" Name=\"vtkGhostType\" format=\"ascii\">0 " +
        std::string(flag) + "</DataArray>";
    const SolidFile file = readVtu(write(asciiTet("0 1 2 3 1 2 3 4", "4 8", "10 10", arrays)));
    EXPECT_EQ(file.mesh.elementCount(), stays ? 2u : 1u) << flag;
    EXPECT_EQ(file.mesh.elementSets.contains("part 4"), stays) << flag;
    EXPECT_EQ(file.mesh.X.size(), stays ? 5u : 4u) << flag;
    ASSERT_EQ(file.notes.empty(), stays) << flag;
    if (stays) continue;
    EXPECT_NE(file.notes[0].find("1 cell that vtkGhostType marks as a copy"), std::string::npos);
  }
  const SolidFile file = readVtu(write(with(tetAndFace, "<CellData>",
                                            "<PointData><DataArray type=\"UInt8\" Name=\"vtkGhostType\" "
                                            "format=\"ascii\">0 2 0 0 0</DataArray></PointData><CellData>")));
  EXPECT_NE(file.notes.at(0).find("1 point that vtkGhostType marks as hidden"), std::string::npos);
}

TEST_F(Vtu, ArraysThatLookLikeSetsAndGiveNoneAreNoted) {
  const std::string arrays =
      "<DataArray type=\"Float64\" Name=\"flags\" format=\"ascii\">0 1</DataArray>"
      "<DataArray type=\"Float64\" Name=\"heat\" format=\"ascii\">0.5 1</DataArray>"
      "<DataArray type=\"Float64\" Name=\"none\" format=\"ascii\">0 0</DataArray>"
      "<DataArray type=\"Int32\" Name=\"pair\" NumberOfComponents=\"2\" format=\"ascii\">0 1 1 1</DataArray>"
      "<DataArray type=\"Int64\" Name=\"vtkOriginalCellIds\" format=\"ascii\">7 8</DataArray>";
  const SolidFile file = readVtu(write(asciiTet("0 1 2 3 0 1 2", "4 7", "10 5", arrays)));
  EXPECT_TRUE(file.mesh.elementSets.empty());
  ASSERT_EQ(file.notes.size(), 4u);
  EXPECT_NE(file.notes[0].find("\"flags\" holds whole numbers as real ones"), std::string::npos) << file.notes[0];
  EXPECT_NE(file.notes[1].find("\"pair\" has 2 components"), std::string::npos) << file.notes[1];
  EXPECT_NE(file.notes[2].find("\"vtkOriginalCellIds\" is VTK's own"), std::string::npos) << file.notes[2];
}

TEST_F(Vtu, ArraysMayNotHoldMoreThanTheirPieceSays) {
  const auto refusal = [&](const std::string& text) {
    const auto path = write(text);
    return messageOf([&] { readVtu(path); });
  };
  EXPECT_EQ(refusal(tetAndFace), "");
  EXPECT_NE(
      refusal(with(tetAndFace, "7 7 7", "7 7 7 8")).find("\"Points\" holds 16 numbers, of which its piece has 15"),
      std::string::npos);
  EXPECT_NE(refusal(with(tetAndFace, "NumberOfCells=\"2\"", "NumberOfCells=\"1\"")).find("\"offsets\" holds 2 numbers"),
            std::string::npos);
  const std::string part = "<DataArray type=\"Int32\" Name=\"part\" format=\"ascii\">3 4 5</DataArray>";
  EXPECT_NE(refusal(asciiTet("0 1 2 3 0 1 2", "4 7", "10 5", part)).find("\"part\" holds 3 numbers"),
            std::string::npos);
}

/// Raw and compressed, behind the tags.
TEST_F(Vtu, BinaryArraysMayNotHoldMoreThanTheirPieceSays) {
  const std::string text = vtuText(testMesh(fem::ElementShape::hex8));
  ASSERT_EQ(messageOf([&] { readVtu(write(text)); }), "");
  const auto path = write(with(text, "NumberOfCells=\"6\"", "NumberOfCells=\"5\""));
  const std::string message = messageOf([&] { readVtu(path); });
  EXPECT_NE(message.find("holds 6 numbers, of which its piece has 5"), std::string::npos) << message;
}

TEST_F(Vtu, QuotesOfBothKindsAndBlanksAroundEqualSignsAreRead) {
  std::string text = tetAndFace;
  std::replace(text.begin(), text.end(), '"', '\'');
  EXPECT_EQ(readVtu(write(text)).mesh.X.size(), 4u);
  EXPECT_EQ(readVtu(write(with(text, "version='0.1'", "version = \"0.1\""))).mesh.X.size(), 4u);
  EXPECT_EQ(readVtu(write(with(text, "<Points>", "<!-- <DataArray type='x> '> --><Points>"))).mesh.X.size(), 4u);
}

std::string toBase64(const std::string& bytes) {
  const std::string signs = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  unsigned bits = 0, held = 0;
  for (const char c : bytes) {
    bits = bits << 8 | static_cast<unsigned char>(c);
    for (held += 8; held >= 6; held -= 6) text += signs[bits >> (held - 6) & 63u];
  }
  if (held > 0) text += signs[bits << (6 - held) & 63u];
  return text.append((4 - text.size() % 4) % 4, '=');
}

/// In Base64, with the information that VTK keeps of such an array and cannot read.
TEST_F(Vtu, PointsThatAreNotFiniteAreNamed) {
  std::string bytes(4 + 15 * 8, '\0');
  const double points[15] = {0, 0, 0, 1, 0, 0, 0, HUGE_VAL, 0, 0, 0, 1, 7, 7, 7};
  bytes[0] = 120;
  std::memcpy(bytes.data() + 4, points, sizeof(points));
  std::string text = with(tetAndFace, "format=\"ascii\">0 0 0 1 0 0 0 1 0 0 0 1 7 7 7",
                          "format=\"binary\">" + toBase64(bytes) +
                              "<InformationKey name=\"L2_NORM_RANGE\" location=\"vtkDataArray\" length=\"2\"><Value "
                              "index=\"0\">0</Value><Value index=\"1\">inf</Value></InformationKey>");
  const auto path = write(text);
  const std::string message = messageOf([&] { readVtu(path); });
  EXPECT_NE(message.find("a coordinate is NaN or infinite [" + path.string() + ", point 2]"), std::string::npos)
      << message;
}

TEST_F(Vtu, ErrorsOfElementsNameNoLine) {
  const auto path = write(asciiTet("0 2 1 3 0 1 2", "4 7", "10 5"));
  EXPECT_NE(messageOf([&] { readVtu(path); }).find("element 0 [" + path.string() + "]: "), std::string::npos);
}

TEST_F(Vtu, ASetWithTheNameOfAFieldHasAnother) {
  const fem::SolidMesh mesh = testMesh(fem::ElementShape::hex8);
  const std::vector<double> values(mesh.X.size(), 0.5);
  const auto path = folder_ / "set.vtu";
  writeVtu(path, mesh, {.perPoint = {{"x-", values}}});
  const SolidFile back = readVtu(path);
  EXPECT_EQ(fem::nodeSet(back.mesh, "x- (set)"), fem::nodeSet(mesh, "x-"));
  EXPECT_FALSE(back.mesh.nodeSets.contains("x-"));
}

}  // namespace
}  // namespace dovetail::solid_io
