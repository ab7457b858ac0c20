// A smooth strip footing on weightless sand under a surcharge: Prandtl's bearing capacity.
#include <cmath>
#include <cstdio>
#include <functional>
#include <numbers>
#include <string>
#include <vector>

#include "cases.hpp"
#include "dovetail/core/error.hpp"
#include "dovetail/fem/elements/solid.hpp"
#include "dovetail/fem/laws/plasticity.hpp"
#include "dovetail/fem/mesh/mesh_shapes.hpp"
#include "dovetail/fem/solve/statics.hpp"
#include "dovetail/fem/terms/contact_plane.hpp"
#include "dovetail/fem/terms/loads.hpp"
#include "dovetail/linalg/block_matrix.hpp"
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

/// On the upper face above each point of the upper row, with the nodes of that point.
struct Marker {
  std::vector<int> node;
  std::vector<double> weight;
  double length = 0.0;
  bool below = false;    ///< the footing
  double settled = 0.0;  ///< under the surcharge, m
};

std::vector<Marker> markersOn(const mpm::PointSolid& solid, const std::vector<Vec3>& x, double distance,
                              const mpm::GridOptions& grid) {
  const mpm::GridRows& rows = solid.rows();
  std::vector<Marker> markers;
  for (std::size_t p = 0; p < x.size(); ++p) {
    if (x[p].y < depth - distance) continue;
    Marker marker;
    marker.length = distance;
    marker.below = x[p].x < half;
    const mpm::LineWeights along = mpm::weightsAt(grid.shape, x[p].x / grid.spacing),
                           up = mpm::weightsAt(grid.shape, depth / grid.spacing);
    double sum = 0.0;
    for (std::size_t a = 0; a < rows.perPoint; ++a) {
      const std::size_t entry = rows.perPoint * static_cast<std::size_t>(rows.cell[p]) + a;
      const auto i = std::lround(rows.reached[entry].x / grid.spacing) - along.first,
                 j = std::lround(rows.reached[entry].y / grid.spacing) - up.first;
      if (i < 0 || j < 0 || i >= mpm::mostInReach || j >= mpm::mostInReach) continue;
      const double w = along.value[static_cast<std::size_t>(i)] * up.value[static_cast<std::size_t>(j)];
      if (w == 0.0) continue;
      marker.node.push_back(rows.node[entry]);
      marker.weight.push_back(w);  // of the vertical, which symmetry does not turn round
      sum += w;
    }
    if (std::abs(sum - 1.0) > 1e-9)
      throw InputError("points do not reach the face", "footing", "lay the face on nodes");
    markers.push_back(std::move(marker));
  }
  return markers;
}

/// The surcharge, and a smooth footing on springs.
class Footing final : public fem::Term {
public:
  Footing(std::vector<Marker> markers, double stiffness) : markers_(std::move(markers)), stiffness_(stiffness) {}
  std::string name() const override { return "footing"; }
  bool usesVelocity() const override { return false; }
  void addForces(const fem::Nodes& nodes, const fem::Instant& now, std::span<Vec3> f) override {
    for (const Marker& marker : markers_) {
      const double force = marker.length * (pressureAt(now.t) + pressureOf(marker, nodes, now.t));
      for (std::size_t a = 0; a < marker.node.size(); ++a)
        f[static_cast<std::size_t>(marker.node[a])].y -= marker.weight[a] * force;
    }
  }
  void addPattern(linalg::MatrixPattern& pattern) const override {
    for (const Marker& marker : markers_) pattern.add(marker.node);
  }
  void addTangent(const fem::Nodes& nodes, const fem::Instant& now, linalg::BlockMatrix& K) override {
    for (const Marker& marker : markers_) {
      if (pressureOf(marker, nodes, now.t) == 0.0) continue;
      const std::size_t n = marker.node.size(), size = 3 * n;
      std::vector<double> own(size * size);
      for (std::size_t a = 0; a < n; ++a)
        for (std::size_t b = 0; b < n; ++b)
          own[size * (3 * a + 1) + 3 * b + 1] = stiffness_ * marker.length * marker.weight[a] * marker.weight[b];
      K.add(marker.node, own);
    }
  }
  double commit(const fem::Nodes& nodes, const fem::Instant& now) override {
    if (now.t <= 1.0)
      for (Marker& marker : markers_) marker.settled = -heightOf(marker, nodes);
    return 0.0;
  }
  double force(const fem::Nodes& nodes, double t) const {
    double sum = 0.0;
    for (const Marker& marker : markers_) sum += marker.length * pressureOf(marker, nodes, t);
    return sum;
  }

private:
  double heightOf(const Marker& marker, const fem::Nodes& nodes) const {
    double u = 0.0;
    for (std::size_t a = 0; a < marker.node.size(); ++a)
      u += marker.weight[a] * nodes.u[static_cast<std::size_t>(marker.node[a])].y;
    return u;
  }
  double pressureOf(const Marker& marker, const fem::Nodes& nodes, double t) const {
    if (!marker.below || t <= 1.0) return 0.0;
    return std::max(0.0, stiffness_ * (settlementAt(t) + heightOf(marker, nodes) + marker.settled));
  }

  std::vector<Marker> markers_;
  double stiffness_;  ///< Pa/m
};

/// @param force  force(model) of the footing, N
template <class Force>
Answer press(fem::Model& model, Force&& force) {
  const fem::NewtonOptions newton{.relativeTolerance = 1e-6};
  fem::solveStatics(model, 1.0, {.newton = newton, .firstStep = 1.0});
  Answer answer;
  for (const double look : looks) {
    const fem::StaticReport report = fem::solveStatics(model, 1.0 + look * unit,
                                                       {.newton = newton,
                                                        .firstStep = unit,
                                                        .largestStep = 5.0 * unit,
                                                        .smallestStep = 1e-4 * unit,
                                                        .iterationTarget = 12});
    answer.factor.push_back(1.0 + force(model) / (surcharge * half));
    answer.iterations += report.iterations;
  }
  return answer;
}

Answer points(int cells, mpm::Shape shape, double perCell) {
  const double spacing = half / cells, distance = spacing / perCell;
  const mpm::MaterialPoints block = box({}, width, depth, distance);
  const mpm::GridOptions grid{
      .spacing = spacing,
      .shape = shape,
      .borders = {{.axis = 0}, {.axis = 0, .above = true, .place = width}, {.axis = 1, .kind = mpm::BorderKind::held}}};
  const auto solid = mpm::makePoints(block, fem::pointField(fem::pointMaterial(sand())), {.grid = grid});
  fem::Model model = mpm::makeModel(solid);
  fem::addMass(model);
  auto& footing =
      model.add(std::make_shared<Footing>(markersOn(*solid, block.x, distance, grid), 10.0 * modulus / spacing));
  return press(model, [&](const fem::Model& now) { return footing.force(now.nodes, now.t); });
}

Answer elements(int cells, fem::ElementShape shape, fem::Formulation formulation) {
  const fem::SolidMesh mesh =
      fem::boxOf(shape, {static_cast<int>(width) * cells, static_cast<int>(depth) * cells, 1}, {}, {width, depth, 1.0});
  fem::Model model = fem::makeModel(mesh);
  model.add(fem::makeSolid(mesh, fem::pointMaterial(sand()), {.formulation = formulation}));
  model.constraints.hold(fem::nodeSet(mesh, "y-"));
  model.constraints.hold(fem::nodeSet(mesh, "x-"), fem::componentX);
  model.constraints.hold(fem::nodeSet(mesh, "x+"), fem::componentX);
  const std::vector<fem::Face>& top = fem::faceSet(mesh, "y+");
  model.add(fem::deadPressure(mesh, top, pressureAt));
  std::vector<fem::Face> below;
  for (const fem::Face& face : top)
    if (0.5 * (mesh.X[static_cast<std::size_t>(face.node[0])].x + mesh.X[static_cast<std::size_t>(face.node[1])].x) <
        half)
      below.push_back(face);
  fem::addMass(model);
  const double settled = depth * surcharge / modulus;
  auto plane = fem::makeContactPlane(mesh, below,
                                     {.point = {0.0, depth - settled, 0.0},
                                      .normal = {0.0, -1.0, 0.0},
                                      .motion =
                                          [](double t) {
                                            return Vec3{0.0, -settlementAt(t), 0.0};
                                          }},
                                     {.penalty = 10.0 * modulus * cells / half});
  fem::ContactPlane& footing = model.add(plane);
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
    {"quadratic, 2² points", [](int n) { return points(n, mpm::Shape::quadratic, 2.0); }, 8, true},
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
    for (const int cells : {2, 4, 8}) {
      if (cells > (quick ? 4 : row.finest)) continue;
      const double start = seconds();
      const Answer answer = row.answer(cells);
      std::printf("| %s | %d |", row.name, cells);
      for (const double factor : answer.factor) std::printf(" %.2f |", factor);
      const double off = answer.factor.back() / exact - 1.0;
      std::printf(" %+.1f | %ld | %.1f |\n", 100.0 * off, static_cast<long>(answer.iterations), seconds() - start);
      std::fflush(stdout);
      if (row.judged && cells == 8) holds = holds && std::abs(off) < 0.05;
    }
  return holds;
}

}  // namespace dovetail::benchmark
