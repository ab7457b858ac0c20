// A smooth strip footing on weightless sand under a surcharge: Prandtl's bearing capacity.
#include <cmath>
#include <cstdio>
#include <functional>
#include <numbers>
#include <string>
#include <vector>

#include "cases.hpp"
#include "dovetail/fem/elements/solid.hpp"
#include "dovetail/fem/laws/plasticity.hpp"
#include "dovetail/fem/mesh/mesh_shapes.hpp"
#include "dovetail/fem/solve/statics.hpp"
#include "dovetail/fem/terms/contact_plane.hpp"
#include "dovetail/fem/terms/loads.hpp"
#include "dovetail/mpm/fill.hpp"
#include "scenes.hpp"

namespace dovetail::benchmark {

namespace {

constexpr double half = 1.0, width = 6.0, depth = 2.0;           // m; half of the footing, and of the ground
constexpr double surcharge = 1e3, youngs = 1e8, poisson = 0.35;  // Pa; so stiff that shapes hardly change
constexpr double angle = 28.0 * std::numbers::pi / 180.0;        // of friction and of dilatancy
constexpr double unit = surcharge * half / youngs;               // m, of settlements
const std::vector<double> looks{10.0, 20.0, 40.0, 80.0};
const double modulus = youngs * (1.0 - poisson) / ((1.0 + poisson) * (1.0 - 2.0 * poisson));

double exactFactor() {
  return std::pow(std::tan(0.25 * std::numbers::pi + 0.5 * angle), 2) * std::exp(std::numbers::pi * std::tan(angle));
}

fem::DruckerPrager sand() { return {youngs, poisson, density, 0.0, angle, angle, fem::ConeMatch::planeStrain}; }

/// Surcharge until t = 1 s, then a settlement of the footing by t − 1 s times 1 m/s.
double pressureAt(double t) { return surcharge * std::min(t, 1.0); }
double settlementAt(double t) { return std::max(t - 1.0, 0.0); }

struct Answer {
  std::vector<double> factor;  ///< (surcharge + pressure of the footing)/surcharge, at the settlements of `looks`
  std::int64_t iterations = 0;
};

/// @param force  force(model) of the footing, N
template <class Force>
Answer press(fem::Model& model, Force&& force) {
  const fem::NewtonOptions newton{.relativeTolerance = 1e-6, .maxIterations = 40};
  fem::solveStatics(model, 1.0, {.newton = newton, .firstStep = 1.0});
  Answer answer;
  for (const double look : looks) {
    const fem::StaticReport report = fem::solveStatics(model, 1.0 + look * unit,
                                                       {.newton = newton,
                                                        .firstStep = unit,
                                                        .largestStep = 10.0 * unit,
                                                        .smallestStep = 1e-4 * unit,
                                                        .iterationTarget = 20});
    answer.factor.push_back(1.0 + force(model) / (surcharge * half));
    answer.iterations += report.iterations;
  }
  return answer;
}

/// The smooth footing touches the settled ground when t = 1 s.
/// @param stiffness  Pa/m
std::shared_ptr<fem::ContactPlane> footingOn(const fem::SolidMesh& mesh, double stiffness) {
  std::vector<fem::Face> below;
  for (const fem::Face& face : fem::faceSet(mesh, "y+"))
    if (0.5 * (mesh.X[static_cast<std::size_t>(face.node[0])].x + mesh.X[static_cast<std::size_t>(face.node[1])].x) <
        half)
      below.push_back(face);
  const double settled = depth * surcharge / modulus;
  return fem::makeContactPlane(mesh, below,
                               {.point = {0.0, depth - settled, 0.0},
                                .normal = {0.0, -1.0, 0.0},
                                .motion =
                                    [](double t) {
                                      return Vec3{0.0, -settlementAt(t), 0.0};
                                    }},
                               {.penalty = stiffness});
}

Answer points(int cells, mpm::Shape shape, double perCell) {
  const double spacing = half / cells, distance = spacing / perCell;
  const mpm::GridOptions grid{
      .spacing = spacing,
      .shape = shape,
      .borders = {{.axis = 0}, {.axis = 0, .above = true, .place = width}, {.axis = 1, .kind = mpm::BorderKind::held}}};
  const auto solid =
      mpm::makePoints(box({}, width, depth, distance), fem::pointField(fem::pointMaterial(sand())), {.grid = grid});
  const fem::SolidMesh faces = mpm::facesOfBox(grid, {{}, {width, depth, 1.0}}, static_cast<int>(perCell));
  const std::size_t set = solid->addMarkers(faces.X);
  fem::Model model = mpm::makeModel(solid);
  fem::addMass(model);
  model.add(mpm::onMarkers(solid, set, fem::deadPressure(faces, fem::faceSet(faces, "y+"), pressureAt)));
  const auto plane = footingOn(faces, 10.0 * modulus / spacing);
  const mpm::MarkerTerm& footing = model.add(mpm::onMarkers(solid, set, plane));
  return press(model,
               [&](const fem::Model& now) { return -plane->report(footing.seen(now.nodes), {.t = now.t}).force.y; });
}

Answer elements(int cells, fem::ElementShape shape, fem::Formulation formulation) {
  const fem::SolidMesh mesh =
      fem::boxOf(shape, {static_cast<int>(width) * cells, static_cast<int>(depth) * cells, 1}, {}, {width, depth, 1.0});
  fem::Model model = fem::makeModel(mesh);
  model.add(fem::makeSolid(mesh, fem::pointMaterial(sand()), {.formulation = formulation}));
  model.constraints.hold(fem::nodeSet(mesh, "y-"));
  model.constraints.hold(fem::nodeSet(mesh, "x-"), fem::componentX);
  model.constraints.hold(fem::nodeSet(mesh, "x+"), fem::componentX);
  fem::addMass(model);
  model.add(fem::deadPressure(mesh, fem::faceSet(mesh, "y+"), pressureAt));
  const fem::ContactPlane& footing = model.add(footingOn(mesh, 10.0 * modulus * cells / half));
  return press(model, [&](const fem::Model& now) { return -footing.report(now.nodes, {.t = now.t}).force.y; });
}

struct Row {
  const char* name;
  std::function<Answer(int)> answer;
  int finest;  ///< cells of half the footing
  bool judged = false;
};

const std::vector<Row> rows{
    {"quad4", [](int n) { return elements(n, fem::ElementShape::quad4, fem::Formulation::standard); }, 8},
    {"quad4, mean dilatation",
     [](int n) { return elements(n, fem::ElementShape::quad4, fem::Formulation::meanDilatation); }, 8},
    {"quad8, 2² points", [](int n) { return elements(n, fem::ElementShape::quad8, fem::Formulation::reduced); }, 8},
    {"quadratic, 2² points", [](int n) { return points(n, mpm::Shape::quadratic, 2.0); }, 12, true},
    {"cubic, 2² points", [](int n) { return points(n, mpm::Shape::cubic, 2.0); }, 4},
    {"quadratic, 3² points", [](int n) { return points(n, mpm::Shape::quadratic, 3.0); }, 4},
    {"uGIMP, 2² points", [](int n) { return points(n, mpm::Shape::gimp, 2.0); }, 4},
};

}  // namespace

bool footing(bool quick) {
  bool holds = true;
  const double exact = exactFactor();
  std::printf("N_q = %.2f; factors at settlements of", exact);
  for (const double look : looks) std::printf(" %g", look);
  std::printf(
      " q b/E, b half of the footing\n\n| | cells of b | | | | | off at the end, %% | iterations | s "
      "|\n|---|---|---|---|---|---|---|---|---|\n");
  for (const Row& row : rows)
    for (const int cells : {2, 4, 8, 12}) {
      if (cells > (quick ? 4 : row.finest)) continue;
      const double start = seconds();
      const Answer answer = row.answer(cells);
      std::printf("| %s | %d |", row.name, cells);
      for (const double factor : answer.factor) std::printf(" %.2f |", factor);
      const double off = answer.factor.back() / exact - 1.0;
      std::printf(" %+.1f | %ld | %.1f |\n", 100.0 * off, static_cast<long>(answer.iterations), seconds() - start);
      std::fflush(stdout);
      if (row.judged && cells == row.finest) holds = holds && std::abs(off) < 0.05;
    }
  return holds;
}

}  // namespace dovetail::benchmark
