// Series of points in one VTKHDF file are laid out as version 2.0 of the format says: VTK 9.1 does not read them.
#include <gtest/gtest.h>
#include <hdf5.h>

#include "dovetail/core/error.hpp"
#include "dovetail/io/output_folder.hpp"
#include "dovetail/io_hdf5/vtkhdf.hpp"
#include "scratch_folder.hpp"

namespace dovetail::io {
namespace {

using test::messageOf, test::ScratchFolder;

template <class Number>
std::vector<Number> readAll(hid_t file, const std::string& name, hid_t type) {
  const hid_t set = H5Dopen2(file, name.c_str(), H5P_DEFAULT), space = H5Dget_space(set);
  std::vector<Number> values(static_cast<std::size_t>(H5Sget_simple_extent_npoints(space)));
  H5Dread(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data());
  H5Sclose(space);
  H5Dclose(set);
  return values;
}
std::vector<std::int64_t> integers(hid_t file, const std::string& name) {
  return readAll<std::int64_t>(file, "VTKHDF/" + name, H5T_NATIVE_INT64);
}
std::vector<double> doubles(hid_t file, const std::string& name) {
  return readAll<double>(file, "VTKHDF/" + name, H5T_NATIVE_DOUBLE);
}

struct Frames : ::testing::Test {
  /// Three frames of two, no and three points.
  std::vector<Vec3> first{{1, 2, 3}, {4, 5, 6}}, none{}, third{{0.1, 0.2, 0.3}, {7, 8, 9}, {1, 1, 1}};
  std::vector<double> radius1{0.5, 0.25}, radius3{0.5, 0.25, 1.0};
  std::vector<std::int64_t> id1{4, 9}, id3{4, 9, 12};
  std::vector<HdfPoints> frames{{0.0, first, {{"radius", radius1, 1}}, {{"id", id1}}},
                                {0.5, none, {{"radius", {}, 1}}, {{"id", {}}}},
                                {0.75, third, {{"radius", radius3, 1}}, {{"id", id3}}}};
  ScratchFolder folder;
};

TEST_F(Frames, EveryStepFindsItsPointsCellsAndFields) {
  const auto path = folder / "grains.vtkhdf";
  writeVtkHdfSeries(path, frames, {});
  EXPECT_TRUE(isOurs(path));
  const hid_t file = H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  ASSERT_GE(file, 0);
  EXPECT_EQ(doubles(file, "Steps/Values"), (std::vector{0.0, 0.5, 0.75}));
  const std::vector<std::int64_t> counts = integers(file, "NumberOfPoints"), cells = integers(file, "NumberOfCells"),
                                  ids = integers(file, "PointData/id"), offsets = integers(file, "Offsets"),
                                  connectivity = integers(file, "Connectivity");
  EXPECT_EQ(integers(file, "NumberOfConnectivityIds"), counts);
  const std::vector<double> points = doubles(file, "Points"), radii = doubles(file, "PointData/radius");
  const std::vector<std::int64_t> begins = integers(file, "Steps/PointOffsets"),
                                  parts = integers(file, "Steps/PartOffsets");
  for (const char* const name :
       {"CellOffsets", "ConnectivityIdOffsets", "PointDataOffsets/radius", "PointDataOffsets/id"})
    EXPECT_EQ(integers(file, std::string("Steps/") + name), begins);
  std::size_t offset = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    ASSERT_EQ(parts[k], static_cast<std::int64_t>(k));
    ASSERT_EQ(counts[k], static_cast<std::int64_t>(frames[k].points.size()));
    EXPECT_EQ(cells[k], counts[k]);
    for (std::size_t i = 0; i < frames[k].points.size(); ++i, ++offset) {
      const auto at = static_cast<std::size_t>(begins[k]) + i;
      EXPECT_EQ((Vec3{points[3 * at], points[3 * at + 1], points[3 * at + 2]}), frames[k].points[i]);
      EXPECT_EQ(radii[at], frames[k].fields[0].values[i]);
      EXPECT_EQ(ids[at], frames[k].integers[0].values[i]);
      EXPECT_EQ(connectivity[at], static_cast<std::int64_t>(i));
      EXPECT_EQ(offsets[offset], static_cast<std::int64_t>(i));
    }
    EXPECT_EQ(offsets[offset++], counts[k]);
  }
  EXPECT_EQ(offsets.size(), offset);
  EXPECT_EQ((readAll<std::uint8_t>(file, "VTKHDF/Types", H5T_NATIVE_UINT8)), std::vector<std::uint8_t>(5, 1));
  H5Fclose(file);
}

TEST_F(Frames, ThatDoNotGoTogetherAreRefused) {
  const auto refused = [&](auto&& change) {
    std::vector<HdfPoints> changed = frames;
    change(changed);
    return messageOf<InputError>([&] { writeVtkHdfSeries(folder / "x.vtkhdf", changed, {}); });
  };
  EXPECT_NE(refused([](auto& all) { all.clear(); }).find("no frames"), std::string::npos);
  EXPECT_NE(refused([](auto& all) { all[1].time = 0.0; }).find("not later"), std::string::npos);
  EXPECT_NE(refused([](auto& all) { all[2].fields[0].name = "size"; }).find("fields are not those"), std::string::npos);
  EXPECT_NE(refused([&](auto& all) { all[2].fields[0].values = radius1; }).find("another size"), std::string::npos);
  EXPECT_NE(refused([&](auto& all) { all[0].integers[0].values = id3; }).find("another size"), std::string::npos);
  EXPECT_TRUE(folder.content().empty());
}

}  // namespace
}  // namespace dovetail::io
