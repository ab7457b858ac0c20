// What scenes say of their step: impacts to come, dashpots, soft springs.
#include <gtest/gtest.h>

#include <cmath>
#include <sstream>

#include "scene_parts.hpp"

namespace dovetail::scene::test {
namespace {

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
       {shortRun, shortRun + R"(, "output": {"series": 1e-4})", std::string(R"("stages": [{"do": "settle"}])")}) {
    EXPECT_THROW(started(grains(two, number(1.01 * limit), stages)), InputError) << stages;
    EXPECT_NO_THROW(started(grains(two, number(0.99 * limit), stages))) << stages;
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

}  // namespace
}  // namespace dovetail::scene::test
