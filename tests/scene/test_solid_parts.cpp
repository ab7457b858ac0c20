// What solids are made with: regions, sets, loads, supports, planes, damping, hardening.
#include <cmath>
#include <numbers>

#include "dovetail/fem/elements/solid.hpp"
#include "dovetail/fem/terms/contact_plane.hpp"
#include "loaded_bars.hpp"

namespace dovetail::scene::test {
namespace {

/// Springs in series: 2 m of E and 2 m of 4 E.
TEST(SceneRegions, ABarOfTwoMaterials) {
  const std::string stiff = R"("sets": [{"name": "upper", "place": "box", "box": [[0, 0, 2], [1, 1, 4]]}],
      "regions": [{"elements": "upper", "material": {"law": "St-Venant-Kirchhoff", "youngs_modulus": 4e6,
                   "poisson_ratio": 0, "density": 500}}], "loads": [{"on": "z+", "type": "traction", "traction": [0, 0, 1]}])";
  Built built = loaded(staticScene(bar(stiff), R"({"do": "statics"})"));
  EXPECT_NEAR(displacementAt(built, {0, 0, 2}).z, 2e-6, 1e-11);
  EXPECT_NEAR(displacementAt(built, {0, 0, 4}).z, 2.5e-6, 1e-11);
  double mass = 0.0;
  for (const double m : built.run->solid(0).nodes().mass) mass += m;
  EXPECT_NEAR(mass, 2.0 * 1000 + 2.0 * 500, 1e-9);
  expectParts(refusalOf(staticScene(bar(R"("regions": [{"elements": "none", "material": {"law": "neo-Hookean",
      "youngs_modulus": 1, "poisson_ratio": 0, "density": 1}}])"),
                                    R"({"do": "statics"})")),
              {"none", "regions.0"});
  const std::string twice = R"("sets": [{"name": "a", "place": "box", "box": [[0, 0, 2], [1, 1, 4]]},
      {"name": "b", "place": "box", "box": [[0, 0, 1], [1, 1, 3]]}], "regions": [{"elements": "a", "material": )";
  const std::string soft = R"({"law": "neo-Hookean", "youngs_modulus": 1, "poisson_ratio": 0, "density": 1}})";
  expectParts(refusalOf(staticScene(bar(twice + soft + R"(, {"elements": "b", "material": )" + soft + "]"),
                                    R"({"do": "statics"})")),
              {"is in two regions, \"a\" and \"b\"", "regions.1"});
}

TEST(SceneLoads, AForceIsSharedByTheNodes) {
  Built built = loaded(
      staticScene(bar(R"("loads": [{"on": "z+", "type": "force", "force": [0, 0, 1]}])"), R"({"do": "statics"})"));
  EXPECT_NEAR(displacementAt(built, {0, 0, 4}).z, 4e-6, 1e-10);
}

TEST(SceneSets, CylindersFacesAndCommonParts) {
  const std::string sets = R"("sets": [
      {"name": "axis", "place": "cylinder", "point": [0, 0, 0], "axis": [0, 0, 2], "radius": 0.1},
      {"name": "others", "place": "cylinder", "point": [0, 0, 0], "axis": [0, 0, 2], "radius": 9, "inner_radius": 0.1},
      {"name": "top", "place": "faces", "direction": [0, 0, 3], "angle": "10 deg"},
      {"name": "edge", "place": "common", "of": "top", "and": "x+"},
      {"name": "corner", "place": "common", "of": "edge", "and": "axis"}])";
  expectParts(refusalOf(staticScene(bar(sets), R"({"do": "statics"})")), {"nothing in common", "sets.4"});
  const Built built = build(staticScene(bar(sets.substr(0, sets.rfind(",\n")) + "]"), R"({"do": "statics"})"));
  const fem::SolidMesh& mesh = built.meshes[0];
  EXPECT_EQ(mesh.nodeSets.at("axis").size(), 5U);
  EXPECT_EQ(mesh.nodeSets.at("others").size(), 15U);
  EXPECT_EQ(mesh.faceSets.at("top").size(), 1U);
  EXPECT_EQ(mesh.nodeSets.at("top").size(), 4U);
  EXPECT_EQ(mesh.nodeSets.at("edge").size(), 2U);
  EXPECT_FALSE(mesh.faceSets.contains("edge"));
}

/// p = λ − ε g at the plane, and what it bears is what pushes.
TEST(ScenePlanes, CarryWhatIsPushedOntoThem) {
  const std::string plane = R"("planes": [{"on": "z-", "point": [0, 0, 0], "normal": [0, 0, 1], "stiffness": 1e8}],
      "loads": [{"on": "z+", "type": "pressure", "pressure": 1000, "follows": false}])";
  Built built =
      loaded(staticScene(bar(plane, R"({"on": "x-", "components": ["x"]}, {"on": "y-", "components": ["y"]})"),
                         R"({"do": "statics", "load_steps": 2})"));
  EXPECT_NEAR(displacementAt(built, {0, 0, 0}).z, -1e-5, 1e-9);
  EXPECT_NEAR(displacementAt(built, {0, 0, 4}).z + 1e-5, -4e-3, 1e-5);
}

std::string planeAt(double z) {
  return R"("planes": [{"on": "z-", "normal": [0, 0, 1], "point": [0, 0, )" + std::to_string(z) + "]}]";
}

TEST(ScenePlanes, SolidsBehindThemAreSeen) {
  const std::string run = R"({"do": "run", "time": 0.01})";
  expectParts(refusalOf(staticScene(bar(planeAt(5.0)), run)), {"all of \"bar\" lies behind the plane", "planes.0"});
  const auto warned = [&](double z) {
    const Scene scene = staticScene(bar(planeAt(z)), run);
    const Built built = started(scene);
    std::string all;
    for (const std::string& line : warnings(built, scene)) all += line;
    return all;
  };
  expectParts(warned(0.5), {"\"bar\" starts 0.5 m behind solids.0.planes.0"});
  EXPECT_EQ(warned(0.0).find("behind"), std::string::npos);
}

/// A block that just touches its plane, with nothing else along its normal, in the first of its load steps.
TEST(ScenePlanes, ATouchingPlaneHoldsASolidInLoadSteps) {
  const std::string keys = planeAt(0.0) + R"(, "loads": [{"on": "z+", "type": "pressure", "pressure": "1e4*t"}])";
  Built built = loaded(staticScene(bar(keys, R"({"on": "x-", "components": ["x"]}, {"on": "y-", "components": ["y"]})"),
                                   R"({"do": "statics", "load_steps": 4, "time": 1})"));
  EXPECT_NEAR(displacementAt(built, {0, 0, 4}).z - displacementAt(built, {0, 0, 0}).z, -0.04, 1e-3);
  double work = 0.0;
  for (const auto& one : built.run->ledger().channels()) work = std::max(work, std::abs(one.joules));
  EXPECT_LT(std::abs(built.run->ledger().residual()), 1e-3 * work);
}

TEST(SceneDamping, MassDampingSlowsAFreeBody) {
  Built built =
      started(staticScene(bar(R"("mass_damping": 5, "velocity": [1, 0, 0])", ""), R"({"do": "run", "time": 0.1})"));
  built.run->advance(1000);
  EXPECT_NEAR(built.run->solid(0).nodes().v[3].x, std::exp(-0.5), 1e-4);
  EXPECT_NEAR(built.run->ledger().residual(), 0.0, 1e-6);
  EXPECT_THROW(started(staticScene(bar(R"("mass_damping": 1e5)"), R"({"do": "run", "time": 0.1})")), InputError);
}

TEST(SceneDamping, ViscosityShortensExplicitSteps) {
  const auto limitWith = [](double tau) {
    std::string keys = bar("\"gravity\": true");
    keys.replace(keys.find("\"density\""), 0, "\"damping_time\": " + std::to_string(tau) + ", ");
    const Scene scene = sceneFromText("{" + keys + R"("stages": [{"do": "run", "time": 0.1}]})", "s.json", "/");
    Built built = started(scene);
    return limits(built, scene).front().dt;
  };
  const double h = limitWith(0.0), tau = 0.01;
  EXPECT_NEAR(limitWith(tau), std::sqrt(tau * tau + h * h) - tau, 1e-9 * h);
}

#if WITH_EXPRESSIONS
/// σ_y + (C/γ) (1 − exp(−γ ε_p)), in 400 implicit steps.
TEST(SceneMaterials, RecoveryLetsTheBackStressSaturate) {
  std::string keys = bar("\"formulation\": \"enhanced\"", R"--({"on": "x-", "components": ["x"]},
        {"on": "y-", "components": ["y"]}, {"on": "z-", "components": ["z"]},
        {"on": "z+", "components": ["z"], "displacement": [0, 0, "0.02*t"]})--");
  const std::string elastic = R"("law": "St-Venant-Kirchhoff", "youngs_modulus": 1e6)";
  keys.replace(
      keys.find(elastic), elastic.size(),
      R"("law": "J2", "youngs_modulus": 1e9, "yield_stress": 1e6, "kinematic_modulus": 1e9, "recovery": 1000)");
  Built built = loaded(staticScene(keys, R"({"do": "statics", "load_steps": 400, "time": 1})"));
  double force = 0.0;
  const coupling::Reactions reactions = built.run->reactions(0);
  for (const int n : built.meshes[0].nodeSets.at("z+")) force += reactions.supports[static_cast<std::size_t>(n)].z;
  double stress = 2e6;  // the fixed point of σ = σ_y + (C/γ) (1 − exp(−γ (ε − σ/E)))
  for (int k = 0; k < 100; ++k) stress = 1e6 + 1e6 * (1.0 - std::exp(-1000.0 * (std::log(1.005) - stress / 1e9)));
  EXPECT_NEAR(force / stress, 1.0, 0.01);
  EXPECT_LT(force, 0.98 * (1e6 + 1e9 * 2e-3));  // that of linear hardening
}

/// A plane that pushes a bar and slides along it: Coulomb's law, and the pressure of the springs in series.
TEST(ScenePlanes, MoveAndRub) {
  const std::string plane = R"--("planes": [{"on": "z-", "point": [0, 0, 0], "normal": [0, 0, 1], "stiffness": 1e8,
      "friction": 0.01, "displacement": ["0.05*t", 0, "1e-3*t"]}])--";
  Built built = loaded(staticScene(bar(plane, R"({"on": "z+"})"), R"({"do": "statics", "time": 1})"));
  Vec3 force;
  for (const Vec3& f : built.run->reactions(0).supports) force += f;
  EXPECT_NEAR(force.z, -1e-3 / (4.0 / 1e6 + 1.0 / 1e8), 1e-3 * 250.0);
  EXPECT_NEAR(force.x / force.z, 0.01, 1e-6);
  EXPECT_NEAR(force.y, 0.0, 1e-6);
  EXPECT_GT(channel(built, "bar: dissipated in load steps"), 0.9 * 2.5 * 0.05 / 2.0);
  EXPECT_LT(std::abs(built.run->ledger().residual()), 2e-2 * channel(built, "bar: dissipated in load steps"));
}

/// σ_y + C ε_p on the way up; on the way back it yields after twice σ_y, where isotropic hardening would not yet.
TEST(SceneMaterials, KinematicHardeningAndYieldCurves) {
  const auto stressAt = [](double time, const std::string& hardening) {
    std::string keys = bar("\"formulation\": \"enhanced\"", R"--({"on": "x-", "components": ["x"]},
        {"on": "y-", "components": ["y"]}, {"on": "z-", "components": ["z"]},
        {"on": "z+", "components": ["z"], "displacement": [0, 0, "0.02*(t < 1 ? t : 2 - t)"]})--");
    const std::string elastic = R"("law": "St-Venant-Kirchhoff", "youngs_modulus": 1e6)";
    keys.replace(keys.find(elastic), elastic.size(),
                 R"("law": "J2", "youngs_modulus": 1e9, "yield_stress": 1e6, )" + hardening);
    Built built =
        loaded(staticScene(keys, R"({"do": "statics", "load_steps": 20, "time": )" + std::to_string(time) + "}"));
    double force = 0.0;
    const coupling::Reactions reactions = built.run->reactions(0);
    for (const int n : built.meshes[0].nodeSets.at("z+")) force += reactions.supports[static_cast<std::size_t>(n)].z;
    return force;
  };
  const std::string kinematic = R"("kinematic_modulus": 1e8)", isotropic = R"("hardening": 1e8)",
                    curve = R"("hardening_curve": [{"plastic_strain": 2e-3, "yield_stress": 1.2e6},
                                                   {"plastic_strain": 1, "yield_stress": 1.2e6}])";
  EXPECT_NEAR(stressAt(1.0, kinematic) / 1.3636e6, 1.0, 0.01);
  EXPECT_NEAR(stressAt(1.0, isotropic) / 1.3636e6, 1.0, 0.01);
  EXPECT_NEAR(stressAt(2.0, kinematic) / -0.909e6, 1.0, 0.01);
  // From 1.3636 MPa by 2.7273e-3 to −1.3636 MPa, then by 2.2727e-3 along the tangent.
  EXPECT_NEAR(stressAt(2.0, isotropic) / -1.5702e6, 1.0, 0.01);
  EXPECT_NEAR(stressAt(1.0, curve) / 1.2e6, 1.0, 0.01);
  expectParts(refusalOf(staticScene(
                  [&] {
                    std::string keys = bar(pulled);
                    const std::string law = R"("law": "St-Venant-Kirchhoff")";
                    return keys.replace(keys.find(law), law.size(),
                                        R"("law": "J2", "yield_stress": 1, )" + isotropic + ", " + curve);
                  }(),
                  R"({"do": "statics"})")),
              {"both hardening and a hardening_curve"});
}

/// Hydrostatic pressure on one side: the force is half of ρ g h² per width, a third up.
TEST(SceneLoads, MayDependOnThePlace) {
  for (const char* const follows : {"true", "false"}) {
    const std::string pressure = R"--("loads": [{"on": "x-", "type": "pressure", "pressure": "1e-3*(4 - z)")--";
    Built built = loaded(
        staticScene(bar(pressure + ", \"follows\": " + follows + "}]"), R"({"do": "statics", "load_steps": 1})"));
    Vec3 force, moment;
    const coupling::Reactions reactions = built.run->reactions(0);
    for (std::size_t n = 0; n < reactions.supports.size(); ++n) {
      force += reactions.supports[n];
      moment += cross(built.meshes[0].X[n], reactions.supports[n]);
    }
    EXPECT_NEAR(force.x, -0.5e-3 * 16, 1e-9);
    EXPECT_NEAR(moment.y, -0.5e-3 * 16 * 4 / 3, 1e-7);
  }
  Built built = loaded(staticScene(bar(R"("loads": [{"on": "z+", "type": "traction", "traction": [0, 0, "2*x*y"]}])"),
                                   R"({"do": "statics"})"));
  Vec3 force;
  for (const Vec3& f : built.run->reactions(0).supports) force += f;
  EXPECT_NEAR(force.z, -0.5, 1e-7);
}

TEST(SceneSupports, MayDependOnThePlace) {
  Built built =
      loaded(staticScene(bar("\"gravity\": true", R"({"on": "z-", "displacement": ["1e-4*z*t", "1e-4*x*t", "2e-4*z*t"]},
                                  {"on": "z+", "displacement": ["1e-4*z*t", "1e-4*x*t", "2e-4*z*t"]})"),
                         R"({"do": "statics", "time": 2})"));
  const Vec3 u = displacementAt(built, {1, 0, 4});
  EXPECT_NEAR(u.x, 8e-4, 1e-15);
  EXPECT_NEAR(u.y, 2e-4, 1e-15);
  EXPECT_NEAR(u.z, 16e-4, 1e-15);
  expectParts(
      refusalOfRun(R"("let": {"y": 2},)" + bar("\"gravity\": true", R"({"on": "z-", "displacement": ["y*t", 0, 0]})")),
      {"both a coordinate and a parameter", "another name"});
  expectParts(refusalOfRun(bar("\"gravity\": true", R"({"on": "z-", "velocity": ["y*t", 0, 0]})")), {"velocity"});
}

/// As a rigid body, whatever the angle, from wherever a support stands.
TEST(SceneSupports, TurnNodesAboutAnAxis) {
  const std::string turn = R"("turn": {"axis": [0, 0, 2], "angle": "pi/3*t"}, "point": [0.5, 0.5, 0])";
  Built built =
      loaded(staticScene(bar("\"gravity\": true", R"({"on": "z-", )" + turn + R"(}, {"on": "z+", )" + turn + "}"),
                         R"({"do": "statics", "time": 1})"));
  for (const Vec3 at : {Vec3{1, 0, 0}, Vec3{1, 1, 2}}) {
    const Vec3 r = at - Vec3{0.5, 0.5, at.z}, now = at + displacementAt(built, at) - Vec3{0.5, 0.5, at.z};
    EXPECT_NEAR(now.x, 0.5 * r.x - std::sqrt(0.75) * r.y, 1e-8);
    EXPECT_NEAR(now.y, std::sqrt(0.75) * r.x + 0.5 * r.y, 1e-8);
    EXPECT_NEAR(now.z, 0.0, 1e-8);
  }
  expectParts(refusalOfRun(bar("\"gravity\": true", R"({"on": "z-", "turn": {"axis": [0, 0, 1], "angle": "t"}})")),
              {"no point on its axis"});
  expectParts(refusalOfRun(bar("\"gravity\": true", R"({"on": "z-"}, {"on": "x-", )" + turn + "}")),
              {"turned by pi/3*t", "supports item 0"});
}
#endif

}  // namespace
}  // namespace dovetail::scene::test
