// What scenes say of their step: impacts to come, states that pass the limit, dashpots, soft springs.
#include <gtest/gtest.h>

#include <cmath>
#include <sstream>

#include "../io/scratch_folder.hpp"
#include "dovetail/scene/execute.hpp"
#include "scene_parts.hpp"

namespace dovetail::scene::test {
namespace {

using io::test::ScratchFolder;

const double mass = 1000.0 * 4.0 / 3.0 * M_PI * 1e-6;  // kg, of a grain of 1 cm

/// Grains of 1 cm, 1000 kg/m³, k = 1e4 N/m.
Scene grains(const std::string& spheres, const std::string& dt, const std::string& more,
             const std::string& contact = R"("restitution": 1)") {
  return sceneFromText(R"({"contact": {"law": "linear", "stiffness": 1e4, )" + contact +
                           R"(}, "particles": [{"from": "list", "density": 1000, "spheres": [)" + spheres +
                           R"(]}], "steps": {"dt": )" + dt + R"(, "threads": 1}, )" + more + "}",
                       "s.json", "/");
}
std::string at(double x, double y, double z, double vx = 0.0, double vy = 0.0, double vz = 0.0) {
  std::ostringstream text;
  text << R"({"at": [)" << x << ", " << y << ", " << z << R"(], "radius": 0.01, "velocity": [)" << vx << ", " << vy
       << ", " << vz << "]}";
  return text.str();
}
std::string number(double value) {
  std::ostringstream text;
  text.precision(15);
  text << value;
  return text.str();
}

const std::string shortRun = R"("stages": [{"do": "run", "time": 1e-3}])";

TEST(SceneSteps, BeyondTheImpactsToComeAreRefusedWhateverIsWritten) {
  const double limit = 2.0 * std::sqrt(0.5 * mass / 1e4);
  const std::string two = at(0, 0, 0, 0.1) + "," + at(0.05, 0, 0);
  for (const std::string& stages :
       {shortRun, shortRun + R"(, "output": {"series": 1e-4})", std::string(R"("stages": [{"do": "relax"}])")}) {
    EXPECT_THROW(started(grains(two, number(1.01 * limit), stages)), InputError) << stages;
    EXPECT_NO_THROW(started(grains(two, number(0.99 * limit), stages))) << stages;
  }
}

/// A light grain between a plane and a heavy one has two contacts, each impact one.
TEST(SceneSteps, ThatTheStateHasPassedIsToldOnceWhateverIsWritten) {
  const double dt = 1.003 * 2.0 * std::sqrt(mass / 2e4);
  const std::string given = R"("gravity": [0, 0, -9.81], "walls": [{"shape": "plane", "point": [0, 0, 0],
      "normal": [0, 0, 1]}], "stages": [{"do": )";
  for (const std::string& stage :
       {std::string(R"("relax", "macro_steps": 40}])"), R"("run", "time": )" + number(40.0 * dt) + "}]",
        R"("run", "time": )" + number(40.0 * dt) + R"(}], "output": {"series": )" + number(dt) + "}"}) {
    const ScratchFolder folder;
    std::ostringstream log;
    const std::string spheres = at(0, 0, 0.010001) + R"(, {"at": [0, 0, 0.120002], "radius": 0.1})";
    ASSERT_TRUE(run(grains(spheres, number(dt), given + stage), {.folder = folder.path(), .progress = false}, log));
    const std::string text = log.str(), told = "WARNING: at t";
    const std::size_t first = text.find(told);
    ASSERT_NE(first, std::string::npos) << text;
    EXPECT_EQ(text.substr(0, text.find("stage 1:")).rfind(told), first) << text;
  }
}

TEST(SceneSteps, AutomaticOnesKnowDashpotsAcrossContacts) {
  const std::string above = at(0, 0, 0.02, 1.0) + "," + at(0, 0.05, 0.02, 0.5);
  const std::string walls = R"("walls": [{"shape": "plane", "point": [0, 0, 0], "normal": [0, 0, 1]}], )";
  const auto stepWith = [&](double ratio) {
    return started(grains(above, "\"auto\"", walls + shortRun,
                          R"("restitution": 0.3, "friction": 1, "tangential_damping_ratio": )" + number(ratio)))
        .run->dt();
  };
  Built touching = started(grains(at(0, 0, 0.00999999), "1e-6", walls + shortRun,
                                  R"("restitution": 0.3, "friction": 1, "tangential_damping_ratio": 20)"));
  EXPECT_LE(stepWith(20), 0.2 * touching.run->criticalStep().dt * (1.0 + 1e-6));
  EXPECT_LT(stepWith(20), 0.2 * stepWith(0));
}

TEST(SceneSteps, AutomaticOnesKeepLowRestitutions) {
  for (const double e : {0.1, 0.3})
    for (const bool wall : {true, false}) {
      const std::string walls = R"("walls": [{"shape": "plane", "point": [0, 0, 0], "normal": [0, 0, 1]}], )";
      const std::string law = R"("restitution": )" + number(e);
      const std::string stage = R"("stages": [{"do": "run", "time": 0.02}])";
      Built built = started(wall ? grains(at(0, 0, 0.0101, 0, 0, -0.1), "\"auto\"", walls + stage, law)
                                 : grains(at(0, 0, 0.0201, 0, 0, -0.1) + "," + at(0, 0, 0), "\"auto\"", stage, law));
      built.run->advance(static_cast<std::int64_t>(0.05 / built.run->dt()));
      const auto& v = built.run->grains.particles.v;
      EXPECT_NEAR((v[0].z - (wall ? 0.0 : v[1].z)) / 0.1, e, 0.035) << e << wall;
    }
}

TEST(SceneSteps, SpringsTooSoftForSpeedsOrWeightsAreToldAtCheck) {
  const std::string walls = R"("walls": [{"shape": "plane", "point": [0, 0, 0], "normal": [0, 0, 1]}], )";
  const auto said = [&](const std::string& spheres, const std::string& more) {
    const Scene scene = grains(spheres, "\"auto\"", more + walls + shortRun);
    std::string all;
    for (const std::string& line : warnings(started(scene), scene)) all += line + "\n";
    return all;
  };
  EXPECT_EQ(said(at(0, 0, 0.05, 0, 0, -1), "").find("too soft"), std::string::npos);
  EXPECT_NE(said(at(0, 0, 0.05, 0, 0, -20), "").find("too soft for the speeds"), std::string::npos);
  std::string column = at(0, 0, 0.01);
  for (int k = 1; k < 6; ++k) column += "," + at(0, 0, 0.01 + 0.02 * k);
  EXPECT_EQ(said(column, R"("gravity": [0, 0, -9.81], )").find("too soft"), std::string::npos);
  EXPECT_NE(said(column, R"("gravity": [0, 0, -9810], )").find("too soft for the weight"), std::string::npos);
}

TEST(SceneSteps, GrainsDeepInContactsAreCountedAndNamed) {
  const auto told = [&](double speed) {
    const ScratchFolder folder;
    std::ostringstream log;
    const std::string walls = R"("walls": [{"shape": "plane", "point": [0, 0, 0], "normal": [0, 0, 1]}], )";
    const std::string stage = R"("stages": [{"do": "run", "time": 0.003}])";
    const Scene scene = grains(at(0.1, 0, 0.05) + "," + at(0, 0, 0.0101, 0, 0, -speed), "1e-5", walls + stage);
    EXPECT_TRUE(run(scene, {.folder = folder.path(), .progress = false}, log));
    return log.str();
  };
  EXPECT_EQ(told(5.0).find("deeper than half a radius"), std::string::npos);  // 0.32 radii
  EXPECT_NE(told(10.0).find("1 grain was seen in contacts deeper than half a radius"), std::string::npos);
  EXPECT_NE(told(10.0).find("(grain 1 at"), std::string::npos);
}

}  // namespace
}  // namespace dovetail::scene::test
