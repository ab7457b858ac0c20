#include <gtest/gtest.h>
#include <vtkCell.h>
#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkFieldData.h>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkSmartPointer.h>
#include <vtkStringArray.h>
#include <vtkUnstructuredGrid.h>
#include <vtkVariant.h>
#include <vtkXMLDataElement.h>
#include <vtkXMLImageDataReader.h>
#include <vtkXMLPolyDataReader.h>
#include <vtkXMLUnstructuredGridReader.h>
#include <vtkXMLUtilities.h>

#include <cmath>
#include <limits>
#include <random>

#include "dovetail/core/error.hpp"
#include "dovetail/io/output_folder.hpp"
#include "dovetail/io_vtk/vtu_series.hpp"
#include "scratch_folder.hpp"

namespace dovetail::io {
namespace {

using test::bits;
using test::readText;
using test::ScratchFolder;
using test::writeText;

struct RandomData {
  std::mt19937_64 random{11};
  double number() {
    double value = std::numeric_limits<double>::infinity();
    while (!std::isfinite(value)) value = std::bit_cast<double>(random());
    return value;
  }
  std::vector<double> numbers(std::size_t count) {
    std::vector<double> values(count);
    for (double& value : values) value = number();
    return values;
  }
  std::vector<Vec3> vectors(std::size_t count) {
    std::vector<Vec3> values(count);
    for (Vec3& value : values) value = {number(), number(), number()};
    return values;
  }
};

vtkSmartPointer<vtkUnstructuredGrid> readGrid(const std::filesystem::path& path) {
  vtkNew<vtkXMLUnstructuredGridReader> reader;
  EXPECT_NE(reader->CanReadFile(path.c_str()), 0);
  reader->SetFileName(path.c_str());
  reader->Update();
  EXPECT_EQ(reader->GetErrorCode(), 0u);
  return reader->GetOutput();
}

void expectSame(vtkFieldData* data, const char* name, const std::vector<Vec3>& values) {
  vtkDataArray* array = data->GetArray(name);
  ASSERT_NE(array, nullptr) << name;
  ASSERT_EQ(array->GetDataType(), VTK_DOUBLE);
  ASSERT_EQ(array->GetNumberOfComponents(), 3);
  ASSERT_EQ(array->GetNumberOfTuples(), static_cast<vtkIdType>(values.size()));
  for (std::size_t i = 0; i < values.size(); ++i)
    for (int c = 0; c < 3; ++c)
      ASSERT_EQ(bits(array->GetComponent(static_cast<vtkIdType>(i), c)), bits(values[i][c])) << name << " " << i;
}

void expectSame(vtkFieldData* data, const char* name, const std::vector<double>& values) {
  vtkDataArray* array = data->GetArray(name);
  ASSERT_NE(array, nullptr) << name;
  ASSERT_EQ(array->GetDataType(), VTK_DOUBLE);
  ASSERT_EQ(array->GetNumberOfComponents(), 1);
  ASSERT_EQ(array->GetNumberOfTuples(), static_cast<vtkIdType>(values.size()));
  for (std::size_t i = 0; i < values.size(); ++i)
    ASSERT_EQ(bits(array->GetTuple1(static_cast<vtkIdType>(i))), bits(values[i])) << name << " " << i;
}

void expectSamePoints(vtkUnstructuredGrid* grid, const std::vector<Vec3>& points) {
  ASSERT_EQ(grid->GetNumberOfPoints(), static_cast<vtkIdType>(points.size()));
  ASSERT_EQ(grid->GetPoints()->GetDataType(), VTK_DOUBLE);
  for (std::size_t i = 0; i < points.size(); ++i)
    for (int c = 0; c < 3; ++c) ASSERT_EQ(bits(grid->GetPoint(static_cast<vtkIdType>(i))[c]), bits(points[i][c])) << i;
}

void expectTimeAndProvenance(vtkUnstructuredGrid* grid, double time, const KeyValues& source) {
  expectSame(grid->GetFieldData(), "TimeValue", std::vector<double>{time});
  auto* lines = vtkStringArray::SafeDownCast(grid->GetFieldData()->GetAbstractArray("provenance"));
  ASSERT_NE(lines, nullptr);
  ASSERT_EQ(lines->GetNumberOfValues(), static_cast<vtkIdType>(source.size()));
  for (std::size_t i = 0; i < source.size(); ++i)
    EXPECT_EQ(lines->GetValue(static_cast<vtkIdType>(i)), source[i].first + ": " + source[i].second);
}

/// Times and file names of a PVD, by VTK's own XML parser.
std::vector<std::pair<double, std::string>> readPvd(const std::filesystem::path& path) {
  std::vector<std::pair<double, std::string>> frames;
  const auto root = vtkSmartPointer<vtkXMLDataElement>::Take(vtkXMLUtilities::ReadElementFromFile(path.c_str()));
  EXPECT_NE(root.Get(), nullptr);
  if (!root) return frames;
  EXPECT_STREQ(root->GetName(), "VTKFile");
  EXPECT_STREQ(root->GetAttribute("type"), "Collection");
  vtkXMLDataElement* collection = root->FindNestedElementWithName("Collection");
  EXPECT_NE(collection, nullptr);
  for (int i = 0; collection && i < collection->GetNumberOfNestedElements(); ++i) {
    vtkXMLDataElement* entry = collection->GetNestedElement(i);
    frames.emplace_back(std::stod(entry->GetAttribute("timestep")), entry->GetAttribute("file"));
  }
  return frames;
}

TEST(VtuSeries, MeshRoundTripsToTheLastBit) {
  const ScratchFolder scratch;
  RandomData data;
  const std::vector<Vec3> points = data.vectors(12), displacement = data.vectors(12);
  const std::vector<double> temperature = data.numbers(12), energy = data.numbers(2);
  const std::vector<std::array<int, 8>> cells{{0, 1, 4, 3, 6, 7, 10, 9}, {1, 2, 5, 4, 7, 8, 11, 10}};
  const KeyValues source = provenance({{"note", "two\nlines <&> -- µ"}});
  VtuSeries series(scratch.path(), "solid", source);
  series.write(
      0.1,
      HexFrame{points, cells, {{"displacement", displacement}}, {{"temperature", temperature}}, {{"energy", energy}}});
  const auto grid = readGrid(series.framePath(0));
  expectSamePoints(grid, points);
  ASSERT_EQ(grid->GetNumberOfCells(), 2);
  for (int cell = 0; cell < 2; ++cell) {
    EXPECT_EQ(grid->GetCellType(cell), VTK_HEXAHEDRON);
    vtkNew<vtkIdList> nodes;
    grid->GetCellPoints(cell, nodes);
    ASSERT_EQ(nodes->GetNumberOfIds(), 8);
    for (int i = 0; i < 8; ++i)
      EXPECT_EQ(nodes->GetId(i), cells[static_cast<std::size_t>(cell)][static_cast<std::size_t>(i)]);
  }
  EXPECT_EQ(grid->GetPointData()->GetNumberOfArrays(), 2);
  EXPECT_EQ(grid->GetCellData()->GetNumberOfArrays(), 1);
  expectSame(grid->GetPointData(), "displacement", displacement);
  expectSame(grid->GetPointData(), "temperature", temperature);
  expectSame(grid->GetCellData(), "energy", energy);
  expectTimeAndProvenance(grid, 0.1, source);
}

TEST(VtuSeries, ParticlesRoundTripToTheLastBit) {
  const ScratchFolder scratch;
  RandomData data;
  const std::vector<Vec3> x = data.vectors(500), v = data.vectors(500), f = data.vectors(500), spin = data.vectors(500);
  const std::vector<double> radius = data.numbers(500), mass = data.numbers(500);
  std::vector<std::int64_t> id(500);
  for (std::size_t i = 0; i < id.size(); ++i) id[i] = static_cast<std::int64_t>(data.random());
  const KeyValues source = provenance();
  VtuSeries series(scratch.path(), "grains", source);
  series.write(0.0, ParticleFrame{x, radius, v, f, id, {{"omega", spin}}, {{"mass", mass}}});
  series.write(1.0 / 3.0, ParticleFrame{x, radius, {}, {}, {}, {}, {}});
  const auto full = readGrid(series.framePath(0));
  expectSamePoints(full, x);
  ASSERT_EQ(full->GetNumberOfCells(), 500);
  vtkNew<vtkIdList> nodes;
  for (int i = 0; i < 500; ++i) {
    ASSERT_EQ(full->GetCellType(i), VTK_VERTEX);
    full->GetCellPoints(i, nodes);
    ASSERT_EQ(nodes->GetNumberOfIds(), 1);
    ASSERT_EQ(nodes->GetId(0), i);
    ASSERT_EQ(full->GetPointData()->GetArray("id")->GetVariantValue(i).ToTypeInt64(), id[static_cast<std::size_t>(i)]);
  }
  expectSame(full->GetPointData(), "radius", radius);
  expectSame(full->GetPointData(), "velocity", v);
  expectSame(full->GetPointData(), "force", f);
  expectSame(full->GetPointData(), "omega", spin);
  expectSame(full->GetPointData(), "mass", mass);
  expectTimeAndProvenance(full, 0.0, source);
  const auto bare = readGrid(series.framePath(1));
  EXPECT_EQ(bare->GetPointData()->GetNumberOfArrays(), 2);
  EXPECT_EQ(bare->GetPointData()->GetArray("id")->GetTuple1(499), 499.0);
  expectTimeAndProvenance(bare, 1.0 / 3.0, source);
}

TEST(VtuSeries, FrameWithoutParticlesOpens) {
  const ScratchFolder scratch;
  VtuSeries series(scratch.path(), "grains", {});
  series.write(0.0, ParticleFrame{});
  const auto grid = readGrid(series.framePath(0));
  EXPECT_EQ(grid->GetNumberOfPoints(), 0);
  EXPECT_EQ(grid->GetNumberOfCells(), 0);
}

TEST(VtuSeries, MeshesAreCompressedAppendedAndOurs) {
  const ScratchFolder scratch;
  const std::vector<Vec3> x(100000);
  VtuSeries series(scratch.path(), "solid", {});
  series.write(0.0, HexFrame{x, {}, {}, {}, {}});
  const std::string text = readText(series.framePath(0));
  EXPECT_NE(text.find("vtkZLibDataCompressor"), std::string::npos);
  EXPECT_NE(text.find("<AppendedData encoding=\"raw\">"), std::string::npos);
  EXPECT_EQ(text.find("format=\"binary\""), std::string::npos);
  EXPECT_EQ(text.find("format=\"ascii\""), std::string::npos);
  EXPECT_LT(text.size(), x.size() * sizeof(Vec3) / 2);
  EXPECT_TRUE(isOurs(series.framePath(0)));
  EXPECT_TRUE(isOurs(series.pvdPath()));
}

vtkSmartPointer<vtkPolyData> readPoly(const std::filesystem::path& path) {
  vtkNew<vtkXMLPolyDataReader> reader;
  EXPECT_NE(reader->CanReadFile(path.c_str()), 0);
  reader->SetFileName(path.c_str());
  reader->Update();
  EXPECT_EQ(reader->GetErrorCode(), 0u);
  return reader->GetOutput();
}

TEST(VtuSeries, LinesAndTrianglesRoundTripToTheLastBit) {
  RandomData data;
  const ScratchFolder scratch;
  const std::vector<Vec3> x = data.vectors(4), force = data.vectors(2);
  const std::vector<double> normal = data.numbers(2);
  const std::vector<std::int64_t> id{-1, std::int64_t{1} << 60};
  const std::vector<std::array<int, 2>> lines{{0, 1}, {2, 3}};
  const std::vector<std::array<int, 3>> triangles{{0, 1, 2}, {3, 2, 1}};
  VtuSeries series(scratch.path(), "lines", {}, {}, FrameFile::vtp),
      wall(scratch.path(), "wall", {}, {}, FrameFile::vtp);
  series.write(0.25, PolyFrame{x, lines, {}, {{"force", force}}, {{"normal", normal}}, {{"id", id}}});
  wall.write(0.25, PolyFrame{x, {}, triangles, {{"force", force}}, {}, {}});
  EXPECT_EQ(series.framePath(0).extension(), ".vtp");
  EXPECT_TRUE(isOurs(series.framePath(0)));
  const auto poly = readPoly(series.framePath(0));
  ASSERT_EQ(poly->GetNumberOfLines(), 2);
  expectSame(poly->GetCellData(), "force", force);
  for (vtkIdType i = 0; i < 2; ++i) {
    EXPECT_EQ(bits(poly->GetCellData()->GetArray("normal")->GetComponent(i, 0)),
              bits(normal[static_cast<std::size_t>(i)]));
    EXPECT_EQ(poly->GetCellData()->GetArray("id")->GetVariantValue(i).ToTypeInt64(), id[static_cast<std::size_t>(i)]);
    for (int k = 0; k < 2; ++k)
      EXPECT_EQ(poly->GetCell(i)->GetPointId(k), lines[static_cast<std::size_t>(i)][static_cast<std::size_t>(k)]);
  }
  EXPECT_EQ(poly->GetFieldData()->GetArray("TimeValue")->GetComponent(0, 0), 0.25);
  const auto facets = readPoly(wall.framePath(0));
  ASSERT_EQ(facets->GetNumberOfPolys(), 2);
  EXPECT_EQ(facets->GetCell(1)->GetPointId(2), 1);
  expectSame(facets->GetCellData(), "force", force);
  EXPECT_THROW(series.write(0.5, PolyFrame{x, lines, triangles, {}, {}, {}}), InputError);
  EXPECT_THROW(series.write(0.5, PolyFrame{{x.data(), 3}, lines, {}, {}, {}, {}}), InputError);
  EXPECT_THROW(series.write(0.5, PolyFrame{x, lines, {}, {}, {{"normal", {normal.data(), 1}}}, {}}), InputError);
}

TEST(VtuSeries, GridsRoundTripToTheLastBit) {
  RandomData data;
  const ScratchFolder scratch;
  const std::vector<double> density = data.numbers(24), stress = data.numbers(9 * 24);
  const GridFrame grid{{1, 2, 3}, {0.5, 0.25, 2}, {4, 3, 2}, {{"density", density}, {"stress", stress, 9}}};
  writeText(scratch / "fields.vti", vtiText(1.5, grid, {}));
  EXPECT_TRUE(isOurs(scratch / "fields.vti"));
  vtkNew<vtkXMLImageDataReader> reader;
  reader->SetFileName((scratch / "fields.vti").c_str());
  reader->Update();
  vtkImageData* const image = reader->GetOutput();
  ASSERT_EQ(image->GetNumberOfPoints(), 24);
  EXPECT_EQ(image->GetPoint(4 + 1)[0], 1.5);
  EXPECT_EQ(image->GetPoint(4 + 1)[1], 2.25);
  for (vtkIdType p = 0; p < 24; ++p) {
    const auto n = static_cast<std::size_t>(p);
    EXPECT_EQ(bits(image->GetPointData()->GetArray("density")->GetComponent(p, 0)), bits(density[n]));
    for (int c = 0; c < 9; ++c)
      EXPECT_EQ(bits(image->GetPointData()->GetArray("stress")->GetComponent(p, c)),
                bits(stress[9 * n + static_cast<std::size_t>(c)]));
  }
  GridFrame wrong = grid;
  wrong.fields[0].values = {density.data(), 23};
  EXPECT_THROW(vtiText(1.5, wrong, {}), InputError);
}

TEST(VtuSeries, PvdListsEveryFrameAfterEachWrite) {
  const ScratchFolder scratch;
  VtuSeries series(scratch / "new/out", "grains", {});
  EXPECT_FALSE(std::filesystem::exists(series.pvdPath()));
  const std::vector<double> times{0.0, 0.1, 0.1 + 0.2, 1e300};
  for (std::size_t n = 0; n < times.size(); ++n) {
    series.write(times[n], ParticleFrame{});
    const auto listed = readPvd(series.pvdPath());
    ASSERT_EQ(listed.size(), n + 1);
    EXPECT_EQ(series.frames(), n + 1);
    for (std::size_t i = 0; i <= n; ++i) {
      EXPECT_EQ(bits(listed[i].first), bits(times[i]));
      EXPECT_EQ(listed[i].second, "grains/grains_00000" + std::to_string(i) + ".vtu");
      EXPECT_EQ(series.pvdPath().parent_path() / listed[i].second, series.framePath(i));
      expectSame(readGrid(series.framePath(i))->GetFieldData(), "TimeValue", std::vector<double>{times[i]});
    }
  }
  EXPECT_EQ(scratch.content().size(), 2 + 2 + times.size());  // no temporary is left
}

TEST(VtuSeries, RefusesWhatDoesNotFitAndWritesNothing) {
  const ScratchFolder scratch;
  const std::vector<Vec3> points(8);
  const std::vector<double> seven(7), eight(8), one(1);
  const std::vector<std::array<int, 8>> cells{{0, 1, 2, 3, 4, 5, 6, 7}}, outside{{0, 1, 2, 3, 4, 5, 6, 8}},
      negative{{-1, 1, 2, 3, 4, 5, 6, 7}};
  VtuSeries series(scratch.path(), "solid", {});
  const auto refused = [&](double time, const HexFrame& frame) { EXPECT_THROW(series.write(time, frame), InputError); };
  refused(0.0, {points, outside, {}, {}, {}});
  refused(0.0, {points, negative, {}, {}, {}});
  refused(0.0, {points, cells, {}, {{"a", seven}}, {}});
  refused(0.0, {points, cells, {}, {}, {{"a", eight}}});
  refused(0.0, {points, cells, {{"a", points}}, {{"a", eight}}, {}});
  refused(0.0, {points, cells, {}, {{"", eight}}, {}});
  refused(std::nan(""), {points, cells, {}, {}, {}});
  EXPECT_THROW(series.write(0.0, ParticleFrame{points, seven, {}, {}, {}, {}, {}}), InputError);
  EXPECT_THROW(series.write(0.0, ParticleFrame{points, eight, {}, {}, {}, {}, {{"radius", eight}}}), InputError);
  EXPECT_EQ(scratch.content(), std::set<std::string>{"solid"});
  series.write(1.0, HexFrame{points, cells, {}, {}, {{"a", one}}});
  refused(1.0, {points, cells, {}, {}, {}});
  refused(0.5, {points, cells, {}, {}, {}});
  EXPECT_EQ(readPvd(series.pvdPath()).size(), 1u);
}

TEST(VtuSeries, RefusesPlacesAndNamesTakenByOthers) {
  const ScratchFolder scratch;
  writeText(scratch / "file", "mine");
  writeText(scratch / "taken.pvd", "mine");
  std::filesystem::create_directories(scratch / "grains");
  writeText(scratch / "grains/grains_000007.vtu", "mine");
  const auto before = scratch.content();
  EXPECT_THROW(VtuSeries(scratch / "file", "solid", {}), InputError);
  EXPECT_THROW(VtuSeries(scratch.path(), "file", {}), InputError);
  EXPECT_THROW(VtuSeries(scratch.path(), "taken", {}), InputError);
  EXPECT_THROW(VtuSeries(scratch.path(), "grains", {}), InputError);
  for (const char* name : {"", "..", "a/b", "a\"b", "a b"})
    EXPECT_THROW(VtuSeries(scratch.path(), name, {}), InputError);
  EXPECT_EQ(scratch.content(), before);
  for (const char* name : {"file", "taken.pvd", "grains/grains_000007.vtu"})
    EXPECT_EQ(readText(scratch / name), "mine");
}

TEST(VtuSeries, SecondRunReplacesFramesAndKeepsOtherFiles) {
  const ScratchFolder scratch;
  const std::vector<Vec3> two(2);
  const std::vector<double> radius(2);
  VtuSeries first(scratch.path(), "grains", {});
  for (int i = 0; i < 3; ++i) first.write(i, ParticleFrame{});
  writeText(scratch / "grains/notes.txt", "mine");
  VtuSeries second(scratch.path(), "grains", {});
  EXPECT_EQ(readPvd(second.pvdPath()).size(), 3u);  // nothing is lost before there is something new
  second.write(5.0, ParticleFrame{two, radius, {}, {}, {}, {}, {}});
  ASSERT_EQ(readPvd(second.pvdPath()).size(), 1u);
  EXPECT_EQ(readPvd(second.pvdPath())[0].first, 5.0);
  EXPECT_EQ(readGrid(second.framePath(0))->GetNumberOfPoints(), 2);
  EXPECT_EQ(readText(scratch / "grains/notes.txt"), "mine");
}

TEST(VtuSeries, FullDiskLeavesTheFramesBefore) {
  const ScratchFolder scratch;
  RandomData data;
  const std::vector<Vec3> x = data.vectors(5000);
  const std::vector<double> radius(5000, 1.0);
  VtuSeries series(scratch.path(), "grains", {});
  series.write(0.0, ParticleFrame{});
  const auto before = scratch.content();
  {
    const test::FullDisk full(20000);
    EXPECT_THROW(series.write(1.0, ParticleFrame{x, radius, {}, {}, {}, {}, {}}), Error);
  }
  EXPECT_EQ(scratch.content(), before);
  EXPECT_EQ(readPvd(series.pvdPath()).size(), 1u);
  series.write(1.0, ParticleFrame{x, radius, {}, {}, {}, {}, {}});
  EXPECT_EQ(readPvd(series.pvdPath()).size(), 2u);
}

}  // namespace
}  // namespace dovetail::io
