#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "../io/scratch_folder.hpp"
#include "dovetail/core/error.hpp"
#include "reference_curves.hpp"
#include "settings.hpp"

namespace dovetail::cantilever {
namespace {

using io::test::messageOf;
using io::test::ScratchFolder;
using io::test::writeText;

const std::string header = "t_s,x1_m,y1_m,z1_m,x2_m,y2_m,z2_m,Eel_DE_J,Etot_J\n";
const std::string rows =
    "0,0.2,-5.8,0.5,-0.2,-5.8,0.5,0.1,0.87\n"
    "10,0.2,4,0.4,-0.2,4,0.4,0,0.9\n"
    "20,0.2,8,0.3,-0.2,8,0.3,0.1,5\n";

std::string refusal(const ScratchFolder& folder) {
  return messageOf<InputError>([&] { readReferenceCurves(folder.path().string()); });
}

void expectMentions(const std::string& message, const std::vector<std::string>& parts) {
  for (const std::string& part : parts) EXPECT_NE(message.find(part), std::string::npos) << part << " in: " << message;
}

TEST(ReferenceCurves, AreReadNarrowOnesFirstAndCountedFromTheClamp) {
  const ScratchFolder folder;
  writeText(folder / "cantilever_c10d.csv", header + rows);
  writeText(folder / "cantilever_c0d.csv", header + rows);
  writeText(folder / "cantilever_c2.5d.csv",
            "Etot_J,Eel_DE_J,z2_m,y2_m,x2_m,z1_m,y1_m,x1_m,t_s,more\r\n1,2,3,4,5,6,7,8,9,0\r\n");
  writeText(folder / "readme.txt", "not a curve");
  const auto curves = readReferenceCurves(folder.path().string());
  ASSERT_EQ(curves.size(), 3u);
  EXPECT_EQ(curves[0].cgWidth, 0.0);
  EXPECT_EQ(curves[1].cgWidth, 2.5);
  EXPECT_EQ(curves[2].cgWidth, 10.0);
  EXPECT_EQ(curves[0].t, (std::vector<double>{0.0, 10.0, 20.0}));
  EXPECT_NEAR(curves[0].y1[0], 0.2, 1e-15);
  EXPECT_EQ(curves[0].energy[2], 5.0);
  EXPECT_EQ(curves[1].t[0], 9.0);  // columns go by name
  EXPECT_EQ(curves[1].y2[0], 10.0);
  EXPECT_EQ(curves[1].contactEnergy[0], 2.0);
}

TEST(ReferenceCurves, FiguresEndWhenParticleOneLeaves) {
  const ScratchFolder folder;
  writeText(folder / "cantilever_c0d.csv", header + rows);
  const CurveFigures f = figuresOf(readReferenceCurves(folder.path().string()).front());
  EXPECT_NEAR(f.leaveTime, 15.0, 1e-12);  // y = 10 m at 10 s, 14 m at 20 s
  EXPECT_EQ(f.largestEnergy, 0.9);
  EXPECT_EQ(f.finalEnergy, 5.0);
  EXPECT_EQ(f.noContactFraction, 0.5);
  const double sag = 2.0 * particleMass() * 9.81 / (3.0 * 1e8 * std::pow(0.8, 4) / 12.0);  // per arm³
  const double start = std::sqrt(2.0) * sag * 0.008, later = std::sqrt(2.0) * std::abs(sag * 1000.0 - 0.1);
  EXPECT_NEAR(f.errorTrueArm, 0.5 * (start + later), 1e-12);
}

TEST(ReferenceCurves, AFileThatNeverReachesTheEndLeavesAtItsLastRow) {
  const ScratchFolder folder;
  writeText(folder / "cantilever_c0d.csv", header + rows.substr(0, rows.find('\n') + 1));
  EXPECT_EQ(figuresOf(readReferenceCurves(folder.path().string()).front()).leaveTime, 0.0);
}

TEST(ReferenceCurves, ABadFolderNamesTheOption) {
  const ScratchFolder folder;
  expectMentions(refusal(folder), {"--reference", folder.path().string(), "cantilever_c*d.csv"});
  EXPECT_THROW(readReferenceCurves((folder / "nowhere").string()), InputError);
}

TEST(ReferenceCurves, ABadFileNamesTheFileAndWhatIsWrong) {
  const ScratchFolder folder;
  const std::string file = (folder / "cantilever_c4d.csv").string();
  const auto check = [&](const std::string& text, const std::vector<std::string>& parts) {
    writeText(file, text);
    const std::string message = refusal(folder);
    expectMentions(message, {file});
    expectMentions(message, parts);
  };
  check("t_s,x1_m\n0,1\n", {"y1_m", "missing"});
  check(header + "0,0.2,-5.8,0.5,-0.2,-5.8,here,0.1,0.87\n", {"line 2", "'here'"});
  check(header + rows + "30,0.2,-5.8,nan,-0.2,-5.8,0.5,0.1,0.87\n", {"z1_m", "row 4", "finite"});
  check(header + "0,0.2,-5.8,0.5\n", {"line 2", "4 values", "9"});
  check(header, {"no rows"});
  check("", {"no line of names"});
}

TEST(ReferenceCurves, AWidthThatIsNoNumberIsRefused) {
  const ScratchFolder folder;
  writeText(folder / "cantilever_cWided.csv", header + rows);
  expectMentions(refusal(folder), {"'Wide'", "cantilever_cWided.csv"});
}

}  // namespace
}  // namespace dovetail::cantilever
