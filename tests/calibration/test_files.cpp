// Calibration files: what is read, refused, remembered and found.
#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "../io/scratch_folder.hpp"
#include "dovetail/calibration/calibrate.hpp"
#include "dovetail/core/error.hpp"

namespace dovetail::calibration {
namespace {

using io::test::readText;
using io::test::ScratchFolder;

std::string example(const char* name) { return std::string(SCENES "/calibration/") + name; }

std::string refusalOf(const std::vector<std::string>& settings, const char* file = "stiffness.json") {
  try {
    readCalibration(example(file), settings);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

void expectIn(const std::string& text, const std::string& part) {
  EXPECT_NE(text.find(part), std::string::npos) << part << " in\n" << text;
}

TEST(CalibrationFile, RefusesWithPlaceAndRemedy) {
  expectIn(refusalOf({"serch={}"}), "write \"search\"");
  expectIn(refusalOf({"parameters.0.strat=1"}), "strat");
  expectIn(refusalOf({"parameters.0.start=1 N/m"}), "between the two");
  expectIn(refusalOf({"parameters.0.most=\"1 MPa\""}), "different units");
  expectIn(refusalOf({"targets.0.of=none"}), "no experiment \"none\"");
  expectIn(refusalOf({"targets.0.quantity=youngs_modulas"}), "youngs_modulus");
  expectIn(refusalOf({"targets.0.value=3 J"}), "write it in Pa");
  expectIn(refusalOf({"targets.0.value=0", "targets.0.uncertainty=0"}), "above 0");
  expectIn(refusalOf({"targets=[]"}), "add targets");
  expectIn(refusalOf({"experiments.0.do=squeeze"}), "moduli");
  expectIn(refusalOf({"experiments.0.scene=none.json"}), "no file");
  expectIn(refusalOf({"experiments.0.pressure=-1 Pa"}), "above 0");
  EXPECT_EQ(refusalOf({}), "");
}

TEST(CalibrationFile, ExamplesAreRead) {
  for (const char* name : {"continuum.json", "stiffness.json", "modulus.json", "bounce.json", "friction.json"})
    EXPECT_NO_THROW(readCalibration(example(name))) << name;
  if (WITH_EXPRESSIONS) {
    EXPECT_NO_THROW(readCalibration(example("wave-overlap.json")));
  }
  expectIn(schemaText(), "\"experiments\"");
  expectIn(referenceText(), "| `uncertainty` |");
}

CalibrationResult run(const Calibration& file, const std::filesystem::path& folder, int rehearsals = 0) {
  std::ostringstream log;
  return calibrate(file, {.folder = folder, .rehearsals = rehearsals}, log);
}

TEST(Calibration, FindsTheStiffnessOfTheLatticeAndRemembersIt) {
  const ScratchFolder folder;
  const Calibration file = readCalibration(example("stiffness.json"));
  const CalibrationResult found = run(file, folder / "out");
  ASSERT_TRUE(found.fit && found.fit->converged);
  EXPECT_NEAR(found.value[0], 1e5, 1e2);  // 0.1 %
  EXPECT_NEAR(found.fit->uncertainty[0], 1e3, 10.0);
  EXPECT_GT(found.simulated, 3);
  const CalibrationResult again = run(file, folder / "out");
  EXPECT_EQ(again.simulated, 0);
  EXPECT_EQ(again.value, found.value);
  EXPECT_EQ(again.recalled, found.simulated + found.recalled);
  writeReports(folder / "out", file, again);
  expectIn(readText(folder / "out/calibration.json"), "\"contact.stiffness\"");
  expectIn(readText(folder / "out/calibration.txt"), "youngs_modulus");
}

TEST(Calibration, GoesOnWhereItsEvaluationsWereUsedUp) {
  const ScratchFolder folder;
  Calibration file = readCalibration(example("stiffness.json"));
  const CalibrationResult whole = run(file, folder / "whole");
  file.evaluations = 2;
  const CalibrationResult broken = run(file, folder / "out");
  EXPECT_TRUE(broken.fit && broken.fit->stopped);
  expectIn(broken.whyStopped, "used up");
  file.evaluations = 500;
  const CalibrationResult rest = run(file, folder / "out");
  EXPECT_EQ(rest.simulated, whole.simulated - broken.simulated);
  EXPECT_EQ(rest.value, whole.value);
}

TEST(Calibration, RecoversRestitutionFromBounces) {
  const ScratchFolder folder;
  const CalibrationResult found = run(readCalibration(example("bounce.json")), folder / "out", 6);
  ASSERT_TRUE(found.rehearsal);
  ASSERT_EQ(found.rehearsal->estimate.size(), 6u);
  for (const std::vector<double>& estimate : found.rehearsal->estimate) EXPECT_NEAR(estimate[0], 0.8, 0.02);
}

TEST(Calibration, RefusesDamagedRecordsAndScenesThatAreNoCells) {
  const ScratchFolder folder;
  const Calibration file = readCalibration(example("stiffness.json"));
  std::filesystem::create_directories(folder / "out");
  std::ofstream(folder / "out/evaluations.json") << "{\"version\": \"dovetail 0\", \"evaluations\": {\"a\": 1}}";
  EXPECT_THROW(run(file, folder / "out"), InputError);
  Calibration noCell = file;
  noCell.experiments[0].scene = example("drop.json");
  try {
    run(noCell, folder / "no_cell");
    FAIL();
  } catch (const InputError& error) {
    expectIn(error.what(), "walls");
  }
  Calibration unknown = file;
  unknown.parameters[0].key = "contact.stifness";
  EXPECT_THROW(run(unknown, folder / "unknown"), InputError);
}

}  // namespace
}  // namespace dovetail::calibration
