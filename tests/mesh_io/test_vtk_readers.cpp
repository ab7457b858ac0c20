// VTK's own readers as an oracle for ours, and our VTP reader on what VTK writes.
#include <gtest/gtest.h>
#include <vtkCellArray.h>
#include <vtkFloatArray.h>
#include <vtkNew.h>
#include <vtkOBJReader.h>
#include <vtkPLYReader.h>
#include <vtkPLYWriter.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkSTLReader.h>
#include <vtkSTLWriter.h>
#include <vtkSmartPointer.h>
#include <vtkXMLPolyDataWriter.h>

#include "cube_files.hpp"
#include "dovetail/core/error.hpp"
#include "dovetail/mesh_io/surface_files.hpp"
#include "dovetail/mesh_io_vtk/vtp.hpp"

namespace dovetail::mesh_io {
namespace {

using namespace test;
using geometry::Facet;

/// A closed, bumpy torus with 32-bit coordinates.
TriangleMesh torus(int n, int m) {
  TriangleMesh mesh;
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> bump(0.9, 1.1);
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < m; ++j) {
      const double u = 6.283185307 * i / n, v = 6.283185307 * j / m, r = 0.3 * bump(random);
      const Vec3 x{(1.0 + r * std::cos(v)) * std::cos(u), (1.0 + r * std::cos(v)) * std::sin(u), r * std::sin(v)};
      mesh.x.push_back({static_cast<float>(x.x), static_cast<float>(x.y), static_cast<float>(x.z)});
    }
  const auto number = [&](int i, int j) { return i % n * m + j % m; };
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < m; ++j) {
      mesh.facets.push_back({number(i, j), number(i + 1, j), number(i + 1, j + 1)});
      mesh.facets.push_back({number(i, j), number(i + 1, j + 1), number(i, j + 1)});
    }
  return mesh;
}

vtkSmartPointer<vtkPolyData> polyData(const TriangleMesh& mesh, bool doubles = false) {
  vtkNew<vtkPoints> points;
  if (doubles) points->SetDataTypeToDouble();
  for (const Vec3& x : mesh.x) points->InsertNextPoint(x.x, x.y, x.z);
  vtkNew<vtkCellArray> cells;
  for (const Facet& f : mesh.facets) cells->InsertNextCell({f[0], f[1], f[2]});
  auto data = vtkSmartPointer<vtkPolyData>::New();
  data->SetPoints(points);
  data->SetPolys(cells);
  return data;
}

/// Corners in the order of the cells; polygons as fans.
std::vector<Vec3> corners(vtkPolyData* data) {
  std::vector<Vec3> found;
  for (vtkIdType c = 0; c < data->GetNumberOfCells(); ++c) {
    vtkIdType count = 0;
    const vtkIdType* ids = nullptr;
    data->GetCellPoints(c, count, ids);
    for (vtkIdType k = 2; k < count; ++k)
      for (const vtkIdType v : {ids[0], ids[k - 1], ids[k]}) {
        double p[3];
        data->GetPoint(v, p);
        found.push_back({p[0], p[1], p[2]});
      }
  }
  return found;
}
std::vector<Vec3> corners(const TriangleMesh& mesh) {
  std::vector<Vec3> found;
  for (const Facet& f : mesh.facets)
    for (const int v : f) found.push_back(mesh.x[v]);
  return found;
}

template <class Reader>
vtkSmartPointer<vtkPolyData> readWith(const std::filesystem::path& path) {
  vtkNew<Reader> reader;
  reader->SetFileName(path.c_str());
  reader->Update();
  return reader->GetOutput();
}

template <class Writer>
void writeWith(const std::filesystem::path& path, vtkPolyData* data, bool binary) {
  vtkNew<Writer> writer;
  writer->SetFileName(path.c_str());
  binary ? writer->SetFileTypeToBinary() : writer->SetFileTypeToASCII();
  writer->SetInputData(data);
  ASSERT_EQ(writer->Write(), 1);
}

TEST(VtkReaders, ReadWhatWeWriteAndTheSameAsWeFromEveryFormat) {
  const ScratchFolder folder;
  const TriangleMesh mesh = torus(24, 11);
  writeStl(folder / "torus.stl", mesh.x, mesh.facets);
  EXPECT_EQ(corners(readWith<vtkSTLReader>(folder / "torus.stl")), corners(mesh));
  std::ostringstream obj;
  for (const Vec3& x : mesh.x) obj << "v " << x.x << " " << x.y << " " << x.z << "\n";
  for (const Facet& f : mesh.facets) obj << "f " << f[0] + 1 << " " << f[1] + 1 << " " << f[2] + 1 << "\n";
  writeText(folder / "torus.obj", obj.str());
  const TriangleMesh read = readObj(folder / "torus.obj");
  EXPECT_EQ(read.facets, mesh.facets);
  const std::vector<Vec3> theirs = corners(readWith<vtkOBJReader>(folder / "torus.obj"));  // in 32 bits
  ASSERT_EQ(theirs.size(), 3 * mesh.facets.size());
  for (std::size_t c = 0; c < theirs.size(); ++c) EXPECT_LE(norm(theirs[c] - corners(read)[c]), 2e-7);
  writeText(folder / "cube.stl", asciiStl(cube()));
  EXPECT_EQ(corners(readWith<vtkSTLReader>(folder / "cube.stl")), corners(readStl(folder / "cube.stl")));
}

TEST(VtkReaders, OursReadWhatVtkWrites) {
  const ScratchFolder folder;
  const TriangleMesh mesh = torus(13, 17);
  const auto data = polyData(mesh);
  for (const bool binary : {false, true}) {
    writeWith<vtkSTLWriter>(folder / "a.stl", data, binary);
    writeWith<vtkPLYWriter>(folder / "a.ply", data, binary);
    const TriangleMesh stl = readStl(folder / "a.stl"), ply = readPly(folder / "a.ply");
    EXPECT_EQ(stl.x.size(), mesh.x.size());
    if (binary) {
      EXPECT_EQ(corners(stl), corners(mesh));
      EXPECT_EQ(ply.x, mesh.x);
    }
    EXPECT_EQ(corners(stl), corners(readWith<vtkSTLReader>(folder / "a.stl")));
    EXPECT_EQ(corners(ply), corners(readWith<vtkPLYReader>(folder / "a.ply")));
    EXPECT_EQ(ply.facets, mesh.facets);
  }
}

TEST(Vtp, KeepsPolygonsAndStripsAndPassesOverTheRest) {
  const ScratchFolder folder;
  TriangleMesh mesh = torus(9, 7);
  for (Vec3& x : mesh.x) x = x / 3.0;
  const auto data = polyData(mesh, true);
  vtkNew<vtkCellArray> strips, points;
  strips->InsertNextCell({0, 1, 2, 3, 4});
  points->InsertNextCell({5});
  data->SetStrips(strips);
  data->SetVerts(points);
  vtkNew<vtkFloatArray> extra;
  extra->SetName("extra");
  for (std::size_t i = 0; i < mesh.x.size(); ++i) extra->InsertNextValue(1.0f);
  data->GetPointData()->AddArray(extra);
  vtkNew<vtkXMLPolyDataWriter> writer;
  writer->SetFileName((folder / "a.vtp").c_str());
  writer->SetInputData(data);
  for (const int mode : {vtkXMLWriter::Ascii, vtkXMLWriter::Binary, vtkXMLWriter::Appended}) {
    writer->SetDataMode(mode);
    ASSERT_EQ(writer->Write(), 1);
    const TriangleMesh read = readVtp(folder / "a.vtp");
    if (mode != vtkXMLWriter::Ascii) {
      EXPECT_EQ(read.x, mesh.x);
    }
    std::vector<Facet> wanted = mesh.facets;
    for (const Facet& f : {Facet{0, 1, 2}, Facet{2, 1, 3}, Facet{2, 3, 4}}) wanted.push_back(f);
    EXPECT_EQ(read.facets, wanted);
  }
}

TEST(Vtp, BadFilesAreRefusedByName) {
  const ScratchFolder folder;
  const TriangleMesh mesh = cube();
  vtkNew<vtkXMLPolyDataWriter> writer;
  writer->SetFileName((folder / "good.vtp").c_str());
  writer->SetDataModeToAscii();
  const auto refusal = [&](const std::string& content) {
    writeText(folder / "bad.vtp", content);
    return messageOf<InputError>([&] { readVtp(folder / "bad.vtp"); });
  };
  writer->SetInputData(polyData(mesh));
  writer->Write();
  const std::string good = readText(folder / "good.vtp");
  for (std::size_t length = 0; length + 20 < good.size(); length += good.size() / 12)
    EXPECT_NE(refusal(good.substr(0, length)).find("bad.vtp"), std::string::npos) << length;
  EXPECT_NE(refusal("<VTKFile type=\"UnstructuredGrid\"></VTKFile>"), "");
  EXPECT_NE(refusal("solid"), "");
  TriangleMesh wrong = mesh;
  wrong.facets[3][1] = 8;
  writer->SetInputData(polyData(wrong));
  writer->Write();
  EXPECT_NE(refusal(readText(folder / "good.vtp")).find("polygon 3"), std::string::npos);
  wrong = mesh;
  wrong.facets.clear();
  writer->SetInputData(polyData(wrong));
  writer->Write();
  EXPECT_NE(refusal(readText(folder / "good.vtp")).find("no facets"), std::string::npos);
  EXPECT_NE(messageOf<InputError>([&] { readVtp(folder / "not_there.vtp"); }).find("not_there"), std::string::npos);
}

TEST(Vtp, WithFlippedBitsItGivesAnErrorOrAWholeMesh) {
  const ScratchFolder folder;
  vtkNew<vtkXMLPolyDataWriter> writer;
  writer->SetFileName((folder / "good.vtp").c_str());
  writer->SetDataModeToAscii();
  writer->SetInputData(polyData(cube()));
  writer->Write();
  const std::string good = readText(folder / "good.vtp");
  std::mt19937_64 random(3);
  int refused = 0;
  for (int round = 0; round < 300; ++round) {
    std::string bad = good;
    bad[random() % bad.size()] ^= static_cast<char>(1 << random() % 8);
    writeText(folder / "bad.vtp", bad);
    try {
      const TriangleMesh mesh = readVtp(folder / "bad.vtp");
      ASSERT_FALSE(mesh.facets.empty());
      for (const Facet& f : mesh.facets)
        for (const int v : f) ASSERT_TRUE(v >= 0 && v < static_cast<int>(mesh.x.size()));
      for (const Vec3& x : mesh.x) ASSERT_TRUE(isFinite(x));
    } catch (const InputError&) {
      ++refused;
    }
  }
  EXPECT_GT(refused, 30);
}

}  // namespace
}  // namespace dovetail::mesh_io
