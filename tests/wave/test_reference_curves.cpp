#include <gtest/gtest.h>

#include <cmath>

#include "../io/scratch_folder.hpp"
#include "dovetail/core/error.hpp"
#include "reference_curves.hpp"

namespace dovetail::wave {
namespace {

using io::test::messageOf;
using io::test::ScratchFolder;
using io::test::writeText;

const std::string table = "t_s,py_DE_kgmps,Etot_J\n0,-33.5,2\n0.01,-33.5,2\n0.1,-33.5,1\n";

std::string refusal(const ScratchFolder& folder) {
  return messageOf<InputError>([&] { readReferenceCurves(folder.path().string()); });
}

TEST(ReferenceCurves, AreReadByParticlesAndWidth) {
  const ScratchFolder folder;
  for (const char* name : {"wave_64P_c2.5dX.csv", "wave_64P_c0.0dX.csv", "wave_1P_fullDEM.csv", "wave_1P_c1.5dX.csv"})
    writeText(folder / name, table);
  writeText(folder / "waveprofile_1P_c0.0dX.csv", "another table\n");
  writeText(folder / "cantilever_c0d.csv", "another table\n");
  const auto curves = readReferenceCurves(folder.path().string());
  ASSERT_EQ(curves.size(), 4u);
  EXPECT_EQ(curves[0].particlesPerEdge, 1);
  EXPECT_EQ(curves[0].cgWidth, 1.5);
  EXPECT_EQ(curves[1].cgWidth, std::nullopt);
  EXPECT_EQ(curves[2].particlesPerEdge, 4);
  EXPECT_EQ(curves[2].cgWidth, 0.0);
  EXPECT_EQ(curves[3].cgWidth, 2.5);
  EXPECT_EQ(curves[0].energy.size(), 3u);
}

TEST(ReferenceCurves, FitRunsOfTheSameParticlesWidthAndSignal) {
  ReferenceCurve curve;
  curve.particlesPerEdge = 4;
  curve.cgWidth = 2.5;
  Settings settings;
  settings.signal = "impulse";
  settings.particlesPerEdge = 4;
  EXPECT_FALSE(fits(curve, settings));
  settings.cgWidth = 2.5;
  EXPECT_TRUE(fits(curve, settings));
  settings.fullDem = true;
  EXPECT_FALSE(fits(curve, settings));
  curve.cgWidth.reset();
  EXPECT_TRUE(fits(curve, settings));
  settings.signal = "cosine";
  EXPECT_FALSE(fits(curve, settings));
}

TEST(ReferenceCurves, DifferencesAreTakenWhereBothHaveSamples) {
  ReferenceCurve curve;
  curve.energy = {{0.0, 2.0}, {0.5, 2.0}, {1.0, 1.5}, {2.0, 9.0}};
  const std::vector<EnergySample> ours{{-0.1, 2.0}, {0.4, 2.0}, {0.6, 1.6}, {1.1, 1.6}};
  EXPECT_NEAR(largestDifference(curve, ours), 0.1, 1e-12);  // 0.2 of 2 at t = 0.5; t = 2 is past the run
}

TEST(ReferenceCurves, TheDissipatedShareIsThatBetweenTheAuthorsTimes) {
  const std::vector<EnergySample> falling{{0.0, 2.0}, {0.0193, 2.0}, {0.0199, 1.9}, {0.0608, 1.5}, {0.0817, 1.0}};
  EXPECT_NEAR(dissipatedFraction(falling, 1), 0.25, 1e-12);
  EXPECT_NEAR(dissipatedFraction(falling, 4), 1.0 - 1.0 / 1.9, 1e-12);
  EXPECT_TRUE(std::isnan(dissipatedFraction({{0.0, 1.0}, {0.05, 1.0}}, 1)));
}

TEST(ReferenceCurves, ABadFolderNamesTheOption) {
  const ScratchFolder folder;
  for (const std::string& path : {folder.path().string(), (folder / "nowhere").string()}) {
    const std::string message = messageOf<InputError>([&] { readReferenceCurves(path); });
    EXPECT_NE(message.find("--reference"), std::string::npos) << message;
    EXPECT_NE(message.find("wave_*P_c*dX.csv"), std::string::npos) << message;
  }
}

TEST(ReferenceCurves, ABadFileNamesTheFile) {
  const ScratchFolder folder;
  const std::string file = (folder / "wave_1P_c0.0dX.csv").string();
  for (const char* text : {"t_s,py\n0,1\n", "t_s,Etot_J\n0,here\n", "t_s,Etot_J\n0,1\n0,1\n", "t_s,Etot_J\n0,nan\n",
                           "t_s,Etot_J\n0\n", "t_s,Etot_J\n", "t_s,Etot_J\n0,0\n", ""}) {
    writeText(file, text);
    EXPECT_NE(refusal(folder).find("wave_1P_c0.0dX.csv"), std::string::npos) << text << refusal(folder);
  }
  std::filesystem::remove(file);
  writeText(folder / "wave_1P_cWidedX.csv", table);
  EXPECT_NE(refusal(folder).find("'Wide'"), std::string::npos) << refusal(folder);
}

}  // namespace
}  // namespace dovetail::wave
