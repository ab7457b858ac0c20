#include <gtest/gtest.h>
#include <hdf5.h>

#include <cmath>
#include <limits>
#include <random>

#include "dovetail/core/error.hpp"
#include "dovetail/io/output_folder.hpp"
#include "dovetail/io_hdf5/time_series_hdf5.hpp"
#include "scratch_folder.hpp"

namespace dovetail::io {
namespace {

using test::bits;
using test::ScratchFolder;

/// Strings of a variable-length attribute.
std::vector<std::string> readStrings(hid_t object, const char* name) {
  const hid_t attribute = H5Aopen(object, name, H5P_DEFAULT);
  if (attribute < 0) return {"(there is no attribute)"};
  const hid_t space = H5Aget_space(attribute), type = H5Aget_type(attribute);
  std::vector<char*> raw(static_cast<std::size_t>(H5Sget_simple_extent_npoints(space)));
  std::vector<std::string> values;
  if (H5Tis_variable_str(type) > 0 && H5Aread(attribute, type, raw.data()) >= 0) {
    values.assign(raw.begin(), raw.end());
    H5Dvlen_reclaim(type, space, H5P_DEFAULT, raw.data());
  }
  H5Tclose(type);
  H5Sclose(space);
  H5Aclose(attribute);
  return values;
}

std::vector<double> readColumn(hid_t file, const std::string& name, std::string& unit) {
  const hid_t dataset = H5Dopen2(file, name.c_str(), H5P_DEFAULT);
  if (dataset < 0) return {};
  const hid_t space = H5Dget_space(dataset);
  EXPECT_EQ(H5Sget_simple_extent_ndims(space), 1);
  std::vector<double> values(static_cast<std::size_t>(H5Sget_simple_extent_npoints(space)));
  EXPECT_GE(H5Dread(dataset, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()), 0);
  unit = readStrings(dataset, "unit").at(0);
  H5Sclose(space);
  H5Dclose(dataset);
  return values;
}

std::vector<std::string> attributeNamesInOrder(hid_t file) {
  std::vector<std::string> names;
  const auto collect = [](hid_t, const char* name, const H5A_info_t*, void* list) -> herr_t {
    static_cast<std::vector<std::string>*>(list)->push_back(name);
    return 0;
  };
  H5Aiterate2(file, H5_INDEX_CRT_ORDER, H5_ITER_INC, nullptr, collect, &names);
  return names;
}

TimeSeries randomSeries(int rows) {
  TimeSeries series({"time_s", "kinetic_particles_J", "contacts"});
  series.append({-0.0, std::numeric_limits<double>::denorm_min(), std::numeric_limits<double>::infinity()});
  std::mt19937_64 random(7);
  for (int i = 0; i < rows; ++i)
    series.append({std::bit_cast<double>(random()), std::bit_cast<double>(random()), std::bit_cast<double>(random())});
  return series;
}

TEST(Hdf5, RoundTripsToTheLastBit) {
  const ScratchFolder scratch;
  const TimeSeries written = randomSeries(1000);
  // Longer than an attribute of fixed length may be.
  const KeyValues source = provenance({{"dt", "1e-5"}, {"scene", std::string(100000, 'x') + "\nµ"}});
  writeHdf5(scratch / "series.h5", written, source);
  const hid_t file = H5Fopen((scratch / "series.h5").c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  ASSERT_GE(file, 0);
  EXPECT_EQ(readStrings(file, "columns"), written.names());
  const std::vector<std::string> units{"s", "J", "1"};
  for (std::size_t c = 0; c < written.names().size(); ++c) {
    std::string unit;
    const std::vector<double> values = readColumn(file, written.names()[c], unit);
    EXPECT_EQ(unit, units[c]);
    ASSERT_EQ(values.size(), written.rows());
    for (std::size_t i = 0; i < values.size(); ++i) ASSERT_EQ(bits(values[i]), bits(written.column(c)[i]));
  }
  std::vector<std::string> keys;
  for (const auto& [key, value] : source) {
    keys.push_back(key);
    EXPECT_EQ(readStrings(file, key.c_str()), std::vector<std::string>{value}) << key;
  }
  keys.push_back("columns");
  EXPECT_EQ(attributeNamesInOrder(file), keys);
  H5Fclose(file);
  EXPECT_EQ(scratch.content(), std::set<std::string>{"series.h5"});
}

TEST(Hdf5, WritesATableWithoutRows) {
  const ScratchFolder scratch;
  writeHdf5(scratch / "series.h5", TimeSeries({"time_s"}), {});
  const hid_t file = H5Fopen((scratch / "series.h5").c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  ASSERT_GE(file, 0);
  std::string unit;
  EXPECT_TRUE(readColumn(file, "time_s", unit).empty());
  EXPECT_EQ(unit, "s");
  H5Fclose(file);
}

TEST(Hdf5, ReplacesItsOwnAndNothingElse) {
  const ScratchFolder scratch;
  writeHdf5(scratch / "series.h5", randomSeries(3), provenance({{"scene", std::string(200000, 'x')}}));
  EXPECT_TRUE(isOurs(scratch / "series.h5"));
  writeHdf5(scratch / "series.h5", randomSeries(5000), {});
  EXPECT_TRUE(isOurs(scratch / "series.h5"));
  const std::string before = test::readText(scratch / "series.h5");
  EXPECT_GT(before.size(), 3u * 5000u * sizeof(double));
  test::writeText(scratch / "other.h5", "mine");
  EXPECT_THROW(writeHdf5(scratch / "other.h5", randomSeries(3), {}), InputError);
  EXPECT_EQ(test::readText(scratch / "other.h5"), "mine");
  EXPECT_EQ(scratch.content(), (std::set<std::string>{"series.h5", "other.h5"}));
}

TEST(Hdf5, KeepsTheOldFileWhenTheDiskIsFull) {
  const ScratchFolder scratch;
  writeHdf5(scratch / "series.h5", randomSeries(3), {});
  const std::string before = test::readText(scratch / "series.h5");
  {
    const test::FullDisk full(10000);
    EXPECT_THROW(writeHdf5(scratch / "series.h5", randomSeries(5000), {}), Error);
  }
  EXPECT_EQ(test::readText(scratch / "series.h5"), before);
  EXPECT_EQ(scratch.content(), std::set<std::string>{"series.h5"});
}

TEST(Hdf5, KeepsTheOldFileWhenAnAttributeFails) {
  const ScratchFolder scratch;
  writeHdf5(scratch / "series.h5", randomSeries(3), {});
  const std::string before = test::readText(scratch / "series.h5");
  EXPECT_THROW(writeHdf5(scratch / "series.h5", randomSeries(3), {{"a", "1"}, {"a", "2"}}), Error);
  EXPECT_EQ(test::readText(scratch / "series.h5"), before);
  EXPECT_EQ(scratch.content(), std::set<std::string>{"series.h5"});
}

TEST(Hdf5, RefusesPlacesWhereNothingCanBeWritten) {
  const ScratchFolder scratch;
  test::writeText(scratch / "file", "mine");
  EXPECT_THROW(writeHdf5(scratch / "file/series.h5", randomSeries(3), {}), InputError);
  EXPECT_THROW(writeHdf5(scratch / "absent/series.h5", randomSeries(3), {}), InputError);
  EXPECT_EQ(scratch.content(), std::set<std::string>{"file"});
}

TEST(Hdf5, ReadsWhatItWroteAndRefusesDamagedFiles) {
  const ScratchFolder scratch;
  const TimeSeries series = randomSeries(50);
  const KeyValues source{{"version", "dovetail " + buildInfo().version}, {"scene", std::string(100000, 'x')}};
  writeHdf5(scratch / "a.h5", series, source);
  const TimeSeries back = readHdf5(scratch / "a.h5");
  ASSERT_EQ(back.names(), series.names());
  for (std::size_t c = 0; c < series.names().size(); ++c)
    for (std::size_t k = 0; k < series.rows(); ++k) EXPECT_EQ(bits(back.column(c)[k]), bits(series.column(c)[k]));
  EXPECT_EQ(readHdf5Provenance(scratch / "a.h5"), source);
  writeHdf5(scratch / "b.h5", series, source);
  const std::string bytes = test::readText(scratch / "a.h5");
  EXPECT_EQ(bytes, test::readText(scratch / "b.h5"));
  for (const std::size_t size : {std::size_t{0}, std::size_t{100}, bytes.size() / 2, bytes.size() - 1}) {
    test::writeText(scratch / "cut.h5", bytes.substr(0, size));
    EXPECT_THROW(readHdf5(scratch / "cut.h5"), InputError) << size;
  }
  EXPECT_THROW(readHdf5(scratch / "none.h5"), InputError);
}

}  // namespace
}  // namespace dovetail::io
