#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "dovetail/core/error.hpp"
#include "dovetail/io/csv_table.hpp"
#include "dovetail/io/output_folder.hpp"
#include "dovetail/io/time_series.hpp"
#include "scratch_folder.hpp"

namespace dovetail::io {
namespace {

using test::bits;
using test::messageOf;
using test::ScratchFolder;
using test::writeText;

/// Doubles of every magnitude, and the awkward ones.
TimeSeries awkwardSeries(int rows) {
  using Limits = std::numeric_limits<double>;
  TimeSeries series({"time_s", "kinetic_particles_J", "contacts"});
  series.append({0.0, -0.0, Limits::denorm_min()});
  series.append({Limits::max(), -Limits::min(), Limits::infinity()});
  series.append({-Limits::infinity(), 0.1, 1.0 / 3.0});
  std::mt19937_64 random(20240611);
  const auto anyFinite = [&] {
    double value = Limits::infinity();
    while (!std::isfinite(value)) value = std::bit_cast<double>(random());
    return value;
  };
  for (int i = 0; i < rows; ++i) series.append({anyFinite(), anyFinite(), anyFinite()});
  return series;
}

TEST(TimeSeries, StoresColumns) {
  TimeSeries series({"time_s", "contacts"});
  EXPECT_EQ(series.rows(), 0u);
  series.append({0.5, 3.0});
  series.append(std::vector<double>{1.0, 4.0});
  EXPECT_EQ(series.rows(), 2u);
  EXPECT_EQ(series.column("contacts")[1], 4.0);
  EXPECT_EQ(series.column(0)[0], 0.5);
}

TEST(TimeSeries, RefusesBadNamesAndRows) {
  EXPECT_THROW(TimeSeries(std::vector<std::string>{}), InputError);
  EXPECT_THROW(TimeSeries({"a", "b", "a"}), InputError);
  for (const char* name : {"", "a,b", "a b", "#a", "1a", "a/b", "a\n"}) EXPECT_THROW(TimeSeries({name}), InputError);
  TimeSeries series({"a", "b"});
  EXPECT_THROW(series.append({1.0}), InputError);
  EXPECT_THROW(series.append({1.0, 2.0, 3.0}), InputError);
  EXPECT_EQ(series.rows(), 0u);
  EXPECT_NE(messageOf<InputError>([&] { series.column("c"); }).find("a, b"), std::string::npos);
}

TEST(TimeSeries, UnitIsTheEndOfTheName) {
  EXPECT_EQ(unitOf("kinetic_particles_J"), "J");
  EXPECT_EQ(unitOf("time_s"), "s");
  EXPECT_EQ(unitOf("speed_m_per_s"), "m/s");
  EXPECT_EQ(unitOf("acceleration_m_per_s2"), "m/s2");
  EXPECT_EQ(unitOf("area_m2"), "m2");
  EXPECT_EQ(unitOf("line_load_N_per_m"), "N/m");
  EXPECT_EQ(unitOf("count_per_m3"), "1/m3");
  EXPECT_EQ(unitOf("momentum_particles_x_Ns"), "Ns");
  EXPECT_EQ(unitOf("torque_kNm"), "kNm");
  EXPECT_EQ(unitOf("angular_momentum_z_Nms"), "Nms");
  EXPECT_EQ(unitOf("inertia_kgm2"), "kgm2");
  EXPECT_EQ(unitOf("wave_Nothing"), "1");
  EXPECT_EQ(unitOf("contacts"), "1");
  EXPECT_EQ(unitOf("wall_contacts"), "1");
  EXPECT_EQ(unitOf("contacts_per_particle"), "1");
  EXPECT_EQ(unitOf("m"), "1");
  EXPECT_EQ(unitOf(""), "1");
}

TEST(Csv, RoundTripsToTheLastBit) {
  const ScratchFolder scratch;
  const TimeSeries written = awkwardSeries(2000);
  writeCsv(scratch / "series.csv", written, provenance({{"dt", "1e-5"}, {"text", "two\nlines, with commas"}}));
  const TimeSeries read = readCsv(scratch / "series.csv");
  ASSERT_EQ(read.names(), written.names());
  ASSERT_EQ(read.rows(), written.rows());
  for (std::size_t c = 0; c < read.names().size(); ++c)
    for (std::size_t row = 0; row < read.rows(); ++row)
      ASSERT_EQ(bits(read.column(c)[row]), bits(written.column(c)[row])) << read.names()[c] << ", row " << row;
}

TEST(Csv, KeepsNotANumber) {
  const ScratchFolder scratch;
  TimeSeries series({"a"});
  series.append({std::numeric_limits<double>::quiet_NaN()});
  writeCsv(scratch / "series.csv", series, {});
  EXPECT_TRUE(std::isnan(readCsv(scratch / "series.csv").column(0)[0]));
}

TEST(Csv, IsPlainText) {
  const ScratchFolder scratch;
  TimeSeries series({"time_s", "contacts"});
  series.append({0.1, 2.0});
  const KeyValues source = withMark({{"setting.dt", "0.1"}});
  writeCsv(scratch / "series.csv", series, source);
  EXPECT_EQ(test::readText(scratch / "series.csv"), provenanceLines(source, "# ") + "time_s,contacts\n0.1,2\n");
}

TEST(Csv, ReplacesItsOwnAndNothingElse) {
  const ScratchFolder scratch;
  TimeSeries series({"a"});
  series.append({1.0});
  writeCsv(scratch / "series.csv", series, {});
  series.append({2.0});
  writeCsv(scratch / "series.csv", series, {});
  EXPECT_EQ(readCsv(scratch / "series.csv").rows(), 2u);
  writeText(scratch / "other.csv", "x\n1\n");
  EXPECT_THROW(writeCsv(scratch / "other.csv", series, {}), InputError);
  EXPECT_EQ(test::readText(scratch / "other.csv"), "x\n1\n");
}

TEST(Csv, GrowsToTheBytesOfTheWholeTable) {
  const ScratchFolder scratch;
  writeCsv(scratch / "growing.csv", awkwardSeries(7), {});  // of an earlier run
  const TimeSeries whole = awkwardSeries(100);
  TimeSeries series(whole.names());
  GrowingCsv file(scratch / "growing.csv", {{"dt", "1"}});
  std::vector<double> row(whole.names().size());
  for (std::size_t r = 0; r < whole.rows(); ++r) {
    for (std::size_t c = 0; c < row.size(); ++c) row[c] = whole.column(c)[r];
    series.append(row);
    if (r % 7 != 3) continue;
    file.write(series);
    EXPECT_EQ(readCsv(scratch / "growing.csv").rows(), r + 1);
  }
  file.write(series);
  file.write(series);
  writeCsv(scratch / "whole.csv", whole, {{"dt", "1"}});
  EXPECT_EQ(test::readText(scratch / "growing.csv"), test::readText(scratch / "whole.csv"));
}

TEST(Csv, ThatGrowsKeepsItsRowsWhenTheDiskIsFull) {
  const ScratchFolder scratch;
  TimeSeries series({"a"});
  series.append({1.0});
  GrowingCsv file(scratch / "series.csv", {});
  file.write(series);
  for (int k = 0; k < 500; ++k) series.append({1.0 / 3.0});
  {
    const test::FullDisk full(1000);
    EXPECT_THROW(file.write(series), Error);
  }
  EXPECT_EQ(readCsv(scratch / "series.csv").rows(), 1u);
  file.write(series);
  EXPECT_EQ(readCsv(scratch / "series.csv").rows(), 501u);
}

TEST(Csv, NamesTheLineThatCannotBeRead) {
  const ScratchFolder scratch;
  const auto path = scratch / "series.csv";
  for (const char* bad : {"# c\na,b\n1,2\n3\n", "# c\na,b\n1,2\n3,4,5\n", "# c\na,b\n1,2\n3,x\n",
                          "# c\na,b\n1,2\n3,4 \n", "# c\na,b\n1,2\n3,\n"}) {
    writeText(path, bad);
    EXPECT_NE(messageOf<InputError>([&] { readCsv(path); }).find(path.string() + ", line 4"), std::string::npos) << bad;
  }
  writeText(path, "# only a comment\n");
  EXPECT_THROW(readCsv(path), InputError);
  EXPECT_THROW(readCsv(scratch / "absent.csv"), InputError);
  EXPECT_THROW(readCsv(scratch.path()), InputError);
}

TEST(Csv, NamesTheLineOfNamesThatCannotBe) {
  const ScratchFolder scratch;
  const auto path = scratch / "table.csv";
  const std::pair<std::string, std::string> bad[] = {{"# c\na,a\n", "'a' occurs twice"},
                                                     {"\na,b c\n", "'b c' cannot be used"},
                                                     {"\na,\n", "a name is empty"},
                                                     {"\na,x [mm]\n", "the name 'x [mm]' cannot be used"},
                                                     {"\na,x [mm]\n", "write x_mm"},
                                                     {"\na,v (m/s^2)\n", "write v_m_per_s2"},
                                                     {"a\n\x1B[31m7\n", "'?[31m7' is not a number"},
                                                     {"\na;b\n1;2\n", "not separated by commas"},
                                                     {"\na\tb\n1\t2\n", "not separated by commas"},
                                                     {"\n0.1 0.2\n", "not separated by commas"},
                                                     {"\n1,2\n", "begins with numbers"},
                                                     {"# three names\n1,2\n", "begins with numbers"},
                                                     {"a\n+-1\n", "'+-1' is not a number"}};
  for (const auto& [content, wanted] : bad) {
    writeText(path, content);
    const std::string message = messageOf<InputError>([&] { readCsv(path); });
    EXPECT_NE(message.find(wanted), std::string::npos) << message;
    EXPECT_NE(message.find(path.string() + ", line 2"), std::string::npos) << message;
  }
  writeText(path, std::string("a\n7\0\n", 5));
  const std::string message = messageOf<InputError>([&] { readCsv(path); });
  EXPECT_NE(message.find("bytes that are zero [" + path.string() + ", line 2]: "), std::string::npos) << message;
  writeText(path, std::string("\xFF\xFEx\0", 4));
  EXPECT_NE(messageOf<InputError>([&] { readCsv(path); }).find("UTF-16"), std::string::npos);
}

TEST(Csv, ReadsMarksAndNamesOfOtherPrograms) {
  const ScratchFolder scratch;
  for (const char* content : {"\xEF\xBB\xBF"
                              "a,b\n+1.0e-01,2\n",
                              "# a,b\n1e-1,+2\n", "# by numpy\n# a, b\n0.1,2\n", "a,b\r0.1,2\r",
                              "\xEF\xBB\xBF# a,b\r\n0.1,2\r\n", "a,b\r\n0.1,2\r\n\x1A"}) {
    writeText(scratch / "table.csv", content);
    const TimeSeries table = readCsv(scratch / "table.csv");
    EXPECT_EQ(table.names(), (std::vector<std::string>{"a", "b"})) << content;
    ASSERT_EQ(table.rows(), 1u) << content;
    EXPECT_EQ(table.column("a")[0], 0.1) << content;
    EXPECT_EQ(table.column("b")[0], 2.0) << content;
  }
}

TEST(Csv, TellsTheLinesOfItsRows) {
  const ScratchFolder scratch;
  writeText(scratch / "table.csv", "# a comment\n\na\n1\n# another\n\n2\r\n3");
  const CsvTable table = readCsvTable(scratch / "table.csv");
  EXPECT_EQ(table.line, (std::vector<std::size_t>{4, 7, 8}));
  EXPECT_EQ(table.series.rows(), 3u);
}

TEST(Csv, ReadsLinesOfOtherSystems) {
  const ScratchFolder scratch;
  writeText(scratch / "series.csv", "a,b\r\n\r\n1,2\r\n3,4");
  const TimeSeries series = readCsv(scratch / "series.csv");
  EXPECT_EQ(series.names(), (std::vector<std::string>{"a", "b"}));
  ASSERT_EQ(series.rows(), 2u);
  EXPECT_EQ(series.column("b")[1], 4.0);
}

}  // namespace
}  // namespace dovetail::io
