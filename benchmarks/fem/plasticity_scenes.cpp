#include "plasticity_scenes.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "dovetail/fem/mesh/mesh_shapes.hpp"
#include "dovetail/fem/solve/statics.hpp"

namespace dovetail::fem {
namespace {

constexpr double closeness = 1e-9;  // m

std::vector<int> nodesWhere(const SolidMesh& mesh, const std::function<bool(const Vec3&)>& condition) {
  std::vector<int> nodes;
  for (std::size_t n = 0; n < mesh.X.size(); ++n)
    if (condition(mesh.X[n])) nodes.push_back(static_cast<int>(n));
  return nodes;
}
std::vector<int> nodesAt(const SolidMesh& mesh, int component, double value) {
  return nodesWhere(mesh, [=](const Vec3& X) { return std::abs(X[component] - value) < closeness; });
}

/// Pushes the bore outwards by t.
void widenBore(const SolidMesh& mesh, Model& model) {
  for (const int n : nodeSet(mesh, "inner")) {
    const Vec3& X = mesh.X[static_cast<std::size_t>(n)];
    for (int c = 0; c < 2; ++c) {
      const double fraction = X[c] / Tube::inner;
      if (std::abs(fraction) > closeness)
        model.constraints.prescribe(std::array{n}, c, [fraction](double t) { return fraction * t; });
    }
  }
}

/// A quarter of the section in an O-grid whose core reaches to half the radius, z from 0 to 1.
SolidMesh quarterBar(const NeckingBar& bar) {
  const double side = 0.5, corner = 0.42;
  const auto core = [=](double s, double t) {
    return Vec3{s * (side + t * (corner - side)), t * (side + s * (corner - side)), 0.0};
  };
  const auto rim = [=](double s, double t) {  // from the core's edge x = side to the arc below 45°
    const double angle = t * std::numbers::pi / 4.0;
    const Vec3 from = core(1.0, t), to = {std::cos(angle), std::sin(angle), 0.0};
    return from + s * (to - from);
  };
  const auto placed = [](Vec3 section, double z) { return Vec3{section.x, section.y, z}; };
  const Vec3 lower, upper = {1.0, 1.0, 1.0};
  const std::array<int, 3> inside = {bar.across, bar.across, bar.along}, outside = {bar.around, bar.across, bar.along};
  const std::array<SolidMesh, 3> parts = {
      mappedBox(ElementShape::hex8, inside, lower, upper, [&](const Vec3& X) { return placed(core(X.x, X.y), X.z); }),
      mappedBox(ElementShape::hex8, outside, lower, upper, [&](const Vec3& X) { return placed(rim(X.x, X.y), X.z); }),
      mappedBox(ElementShape::hex8, {bar.across, bar.around, bar.along}, lower, upper, [&](const Vec3& X) {
        const Vec3 mirrored = rim(X.y, X.x);
        return Vec3{mirrored.y, mirrored.x, X.z};
      })};
  return joinMeshes(parts, closeness);
}

/// Radius of the corners of a section: its polygon has the area of the circle.
double cornerRadius(const NeckingBar& bar, double z) {
  const double angle = std::numbers::pi / (4.0 * bar.across);  // of one side
  const double taper = 1.0 - NeckingBar::thinning * (1.0 - z / NeckingBar::halfLength);
  return NeckingBar::radius * taper * std::sqrt(angle / std::sin(angle));
}

/// The section scaled to the bar, cells along it finer towards the neck.
SolidMesh neckingMesh(const NeckingBar& bar) {
  SolidMesh mesh = quarterBar(bar);
  for (Vec3& X : mesh.X) {
    const double z = NeckingBar::halfLength * (0.25 * X.z + 0.75 * X.z * X.z), r = cornerRadius(bar, z);
    X = {r * X.x, r * X.y, z};
  }
  return mesh;
}

/// Sees the neck of a model in its present state.
class Neck {
public:
  Neck(const NeckingBar& bar, const SolidMesh& mesh, Solid& solid)
      : mesh_(mesh), solid_(solid), top_(nodesAt(mesh, 2, NeckingBar::halfLength)) {
    // The profile: surface nodes in the plane y = 0, from the middle outwards.
    profile_ = nodesWhere(mesh, [&](const Vec3& X) {
      return std::abs(X.y) < closeness && std::abs(X.x - cornerRadius(bar, X.z)) < closeness;
    });
    std::sort(profile_.begin(), profile_.end(), [&](int a, int b) { return at(a).z < at(b).z; });
  }

  NeckingStep look(Model& model) const {
    const auto place = [&](std::size_t k) {
      const auto n = static_cast<std::size_t>(profile_[k]);
      const double fraction = NeckingBar::radius * (1.0 - NeckingBar::thinning) / at(profile_[0]).x;
      return Vec3{fraction * (mesh_.X[n].x + model.nodes.u[n].x), 0.0, mesh_.X[n].z + model.nodes.u[n].z};
    };
    evaluateForces(model, {model.t, 0.0});
    NeckingStep step{model.t, 0.0, place(0).x, 0.0, 0.0, 0.0};
    for (const int n : top_) step.force -= 4.0 * model.nodes.f[static_cast<std::size_t>(n)].z;
    // r = a + c z²/2 + d z⁴ through three nodes, even in z
    const Vec3 p = place(1), q = place(2);
    const double rise = (p.x - step.neckRadius) / (p.z * p.z), rise2 = (q.x - step.neckRadius) / (q.z * q.z);
    step.neckCurve = 2.0 * (rise * q.z * q.z - rise2 * p.z * p.z) / (q.z * q.z - p.z * p.z);
    readMaterial(model, step);
    return step;
  }

private:
  const Vec3& at(int n) const { return mesh_.X[static_cast<std::size_t>(n)]; }

  /// Flow stress over the layer of points next to the middle section, weighted by their volume.
  void readMaterial(Model& model, NeckingStep& step) const {
    const Solid::Sample sample = solid_.sample(model.nodes, {model.t, 0.0});
    const std::size_t size = solid_.material()->historySize();
    const YieldCurve yield = NeckingBar::material().yield;
    double lowest = NeckingBar::halfLength, volume = 0.0;
    for (const Vec3& X : sample.X) lowest = std::min(lowest, X.z);
    for (std::size_t p = 0; p < sample.X.size(); ++p) {
      const double strain = plasticStrain({&sample.history[p * size], size});
      step.deepestStrain = std::max(step.deepestStrain, strain);
      if (sample.X[p].z > 1.01 * lowest) continue;
      step.flowStress += sample.volume[p] * yield.stress(strain);
      volume += sample.volume[p];
    }
    step.flowStress /= volume;
  }

  const SolidMesh& mesh_;
  Solid& solid_;
  std::vector<int> top_, profile_;
};

}  // namespace

double Tube::limitPressure() { return 2.0 / std::numbers::sqrt3 * yieldStress * std::log(outer / inner); }

TubeResult pressurise(const Tube& tube) {
  const double length = 0.1, elastic = Tube::yieldStress / Tube::young;
  const SolidMesh mesh = cylinderSector(tube.shape, {tube.radial, tube.around, 1}, Tube::inner, Tube::outer,
                                        std::numbers::pi / 2.0, length);
  Model model = makeModel(mesh);
  model.add(makeSolid(mesh,
                      pointMaterial(J2Plasticity{Tube::young, tube.poissonRatio, 1.0, linearYield(Tube::yieldStress)}),
                      {.formulation = tube.formulation}));
  model.constraints.hold(nodesAt(mesh, 1, 0.0), componentY);
  model.constraints.hold(nodesAt(mesh, 0, 0.0), componentX);
  model.constraints.hold(nodesWhere(mesh, [](const Vec3&) { return true; }), componentZ);
  widenBore(mesh, model);

  TubeResult result{};
  const double last = 12.0 * elastic * Tube::inner, step = last / tube.steps;
  const StaticReport report = solveStatics(
      model, last, {.firstStep = step, .largestStep = step, .smallestStep = 1e-3 * step},
      [&](const Model&, const StaticStep& done) {
        evaluateForces(model, {done.t, 0.0});
        double outward = 0.0;
        for (const int n : nodeSet(mesh, "inner")) {
          const Vec3 &X = mesh.X[static_cast<std::size_t>(n)], &f = model.nodes.f[static_cast<std::size_t>(n)];
          outward -= (f.x * X.x + f.y * X.y) / Tube::inner;
        }
        result.displacement.push_back(done.t);
        result.pressure.push_back(outward / (Tube::inner * std::numbers::pi / 2.0 * length));
        return true;
      });
  result.iterations = report.iterations;
  result.seconds = report.seconds;
  return result;
}

J2Plasticity NeckingBar::material() {
  return {206.9e9, 0.29, 7800.0, saturatingYield(0.45e9, 0.12924e9, 0.715e9, 16.93)};
}

double NeckingBar::considereForce() {
  const J2Plasticity metal = material();
  double greatest = 0.0;
  for (double a = 0.0; a < 0.5; a += 1e-5) {
    const double stress = metal.yield.stress(a);
    greatest = std::max(greatest, stress * std::exp(-a - stress / metal.youngsModulus));
  }
  return std::numbers::pi * radius * radius * greatest;
}

double NeckingStrip::considereForce() {
  const J2Plasticity metal = NeckingBar::material();
  double greatest = 0.0;
  for (double a = 0.0; a < 0.5; a += 1e-5) {
    const double stress = 2.0 / std::numbers::sqrt3 * metal.yield.stress(a);
    const double elastic = (1.0 - 0.5 * metal.poissonRatio) * stress / metal.youngsModulus;
    greatest = std::max(greatest, stress * std::exp(-0.5 * std::numbers::sqrt3 * a - elastic));
  }
  return 2.0 * halfWidth * greatest;
}

StripResult stretch(const NeckingStrip& strip) {
  constexpr double length = NeckingStrip::halfLength;
  const SolidMesh mesh = mappedBox(strip.shape, {strip.across, strip.along, 1}, {}, {1.0, 1.0, 1.0}, [](const Vec3& X) {
    const double y = length * (0.25 * X.y + 0.75 * X.y * X.y);
    return Vec3{NeckingStrip::halfWidth * X.x * (1.0 - NeckingBar::thinning * (1.0 - y / length)), y, X.z};
  });
  Model model = makeModel(mesh);
  model.add(makeSolid(mesh, pointMaterial(NeckingBar::material()), {.formulation = strip.formulation}));
  model.constraints.hold(nodeSet(mesh, "x-"), componentX);
  model.constraints.hold(nodeSet(mesh, "y-"), componentY);
  model.constraints.hold(nodesWhere(mesh, [](const Vec3&) { return true; }), componentZ);
  model.constraints.prescribe(nodeSet(mesh, "y+"), 1, [](double t) { return t; });
  const auto neck = static_cast<std::size_t>(nodesWhere(mesh, [](const Vec3& X) {
    return X.y < closeness && X.x > NeckingStrip::halfWidth * (1.0 - NeckingBar::thinning) - closeness;
  })[0]);
  StripResult result{};
  const StaticReport report =
      solveStatics(model, strip.elongation,
                   {.firstStep = 0.1 * strip.largestStep, .largestStep = strip.largestStep, .smallestStep = 1e-8},
                   [&](const Model&, const StaticStep&) {
                     evaluateForces(model, {model.t, 0.0});
                     StripStep step{model.t, 0.0, mesh.X[neck].x + model.nodes.u[neck].x};
                     for (const int n : nodeSet(mesh, "y+"))
                       step.force -= 2.0 * model.nodes.f[static_cast<std::size_t>(n)].y;
                     result.steps.push_back(step);
                     return true;
                   });
  result.iterations = report.iterations;
  result.cuts = report.cuts;
  result.seconds = report.seconds;
  return result;
}

double bridgmanFactor(double radius, double curvature) {
  const double ratio = 2.0 / (radius * curvature);  // 2R/a
  return (1.0 + ratio) * std::log1p(1.0 / ratio);
}

NeckingResult stretch(const NeckingBar& bar) {
  const SolidMesh mesh = neckingMesh(bar);
  Model model = makeModel(mesh);
  const std::shared_ptr<Solid> solid =
      makeSolid(mesh, pointMaterial(NeckingBar::material()), {.formulation = bar.formulation});
  model.add(solid);
  for (int c = 0; c < 3; ++c) model.constraints.hold(nodesAt(mesh, c, 0.0), 1u << c);
  model.constraints.prescribe(nodesAt(mesh, 2, NeckingBar::halfLength), 2, [](double t) { return t; });

  const Neck neck(bar, mesh, *solid);
  NeckingResult result{};
  const StaticReport report = solveStatics(
      model, bar.elongation, {.firstStep = 0.1 * bar.largestStep, .largestStep = bar.largestStep, .smallestStep = 1e-8},
      [&](const Model&, const StaticStep&) {
        result.steps.push_back(neck.look(model));
        return true;
      });
  result.cells = solid->size();
  result.iterations = report.iterations;
  result.cuts = report.cuts;
  result.seconds = report.seconds;
  result.energyResidual = report.energyResidual() / report.supportWork;
  return result;
}

}  // namespace dovetail::fem
