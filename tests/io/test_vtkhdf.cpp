// VTKHDF files open in VTK's own reader with the right numbers.
#include <gtest/gtest.h>
#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkFieldData.h>
#include <vtkHDFReader.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkUnstructuredGrid.h>

#include <random>

#include "dovetail/core/error.hpp"
#include "dovetail/io/output_folder.hpp"
#include "dovetail/io_hdf5/vtkhdf.hpp"
#include "scratch_folder.hpp"

namespace dovetail::io {
namespace {

using test::bits;
using test::ScratchFolder;

TEST(VtkHdf, OpensInVtkWithTheSameBits) {
  std::mt19937_64 random(3);
  std::normal_distribution<double> normal;
  const auto numbers = [&](std::size_t count) {
    std::vector<double> values(count);
    for (double& value : values) value = normal(random);
    return values;
  };
  std::vector<Vec3> x;
  for (int n = 0; n < 9; ++n) x.push_back({normal(random), normal(random), normal(random)});
  const std::vector<double> velocity = numbers(27), stress = numbers(18);
  const HdfGrid grid{x,
                     {0, 1, 2, 3, 4, 5, 6, 7, 4, 5, 6, 8},
                     {0, 8, 12},
                     {VTK_HEXAHEDRON, VTK_TETRA},
                     {{"velocity", velocity, 3, false}, {"stress", stress, 9, true}}};
  const ScratchFolder scratch;
  const std::filesystem::path path = scratch / "solid.vtkhdf";
  writeVtkHdf(path, 0.25, grid, {});
  EXPECT_TRUE(isOurs(path));
  vtkNew<vtkHDFReader> reader;
  ASSERT_NE(reader->CanReadFile(path.c_str()), 0);
  reader->SetFileName(path.c_str());
  reader->Update();
  auto* const read = vtkUnstructuredGrid::SafeDownCast(reader->GetOutputAsDataSet());
  ASSERT_NE(read, nullptr);
  ASSERT_EQ(read->GetNumberOfPoints(), 9);
  ASSERT_EQ(read->GetNumberOfCells(), 2);
  EXPECT_EQ(read->GetCellType(1), VTK_TETRA);
  EXPECT_EQ(read->GetCell(1)->GetPointId(3), 8);
  for (vtkIdType n = 0; n < 9; ++n)
    for (int c = 0; c < 3; ++c) {
      EXPECT_EQ(bits(read->GetPoint(n)[c]), bits(x[static_cast<std::size_t>(n)][c]));
      EXPECT_EQ(bits(read->GetPointData()->GetArray("velocity")->GetComponent(n, c)),
                bits(velocity[static_cast<std::size_t>(3 * n + c)]));
    }
  for (vtkIdType e = 0; e < 2; ++e)
    for (int c = 0; c < 9; ++c)
      EXPECT_EQ(bits(read->GetCellData()->GetArray("stress")->GetComponent(e, c)),
                bits(stress[static_cast<std::size_t>(9 * e + c)]));
  EXPECT_EQ(read->GetFieldData()->GetArray("TimeValue")->GetComponent(0, 0), 0.25);
  HdfGrid wrong = grid;
  wrong.fields[0].values = {velocity.data(), 26};
  EXPECT_THROW(writeVtkHdf(path, 0.25, wrong, {}), InputError);
  wrong = grid;
  wrong.offsets.pop_back();
  EXPECT_THROW(writeVtkHdf(path, 0.25, wrong, {}), InputError);
}

}  // namespace
}  // namespace dovetail::io
