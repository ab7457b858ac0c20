// Shear waves of 10 kHz in a column whose elements are cells of Hertz's and Mindlin's spheres.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>
#include <vector>

#include "dovetail/fem/elements/solid.hpp"
#include "dovetail/fem/laws/point_laws.hpp"
#include "dovetail/fem/motion/dynamics.hpp"
#include "dovetail/hierarchical/cell_field.hpp"
#include "dovetail/rve/moduli.hpp"
#include "elastic_spheres.hpp"
#include "figure.hpp"

namespace dovetail::benchmark {

namespace {

// Liu, Sun, Yuan & Fish 2015, sec. 3.3.
constexpr double length = 0.1, width = 0.01, frequency = 10e3, dt = 1e-6;  // m, Hz, s

/// Nodes of a section move alike: elements are strained evenly, and no cell is asked twice.
void tieSections(fem::Model& model, const fem::SolidMesh& mesh) {
  const std::vector<int>&left = fem::nodeSet(mesh, "x-"), &right = fem::nodeSet(mesh, "x+");
  const auto isIn = [](const std::vector<int>& set, int node) { return std::ranges::find(set, node) != set.end(); };
  std::vector<int> first;  // of the sections met so far
  for (int node = 0; node < static_cast<int>(mesh.X.size()); ++node) {
    if (isIn(left, node) || isIn(right, node)) continue;
    const double x = mesh.X[static_cast<std::size_t>(node)].x;
    const auto same = std::ranges::find_if(
        first, [&](int n) { return std::abs(mesh.X[static_cast<std::size_t>(n)].x - x) < 1e-9 * length; });
    if (same == first.end())
      first.push_back(node);
    else
      for (int k = 0; k < 3; ++k) model.constraints.ties.push_back({node, k, {{*same, k, 1.0}}, 0.0, {}});
  }
}

struct Answer {
  double arrival = 0.0;                              ///< at the fixed end, s
  double lost = 0.0;                                 ///< of the work of the driven end, by friction and damping
  double residual = 0.0;                             ///< of the ledger over that work
  double strain = 0.0, stress = 0.0, damping = 0.0;  ///< of element 9 in the last cycle: half ranges, and what the loop
                                                     ///< loses over 2π stress · strain
};

/// A loop of shear strain and shear stress.
void describeLoop(std::span<const double> strain, std::span<const double> stress, Answer& answer) {
  const auto [leastStrain, mostStrain] = std::ranges::minmax(strain);
  const auto [leastStress, mostStress] = std::ranges::minmax(stress);
  answer.strain = 0.5 * (mostStrain - leastStrain);
  answer.stress = 0.5 * (mostStress - leastStress);
  double area = 0.0;
  for (std::size_t k = 0; k < strain.size(); ++k) {
    const std::size_t next = (k + 1) % strain.size();
    area += 0.5 * (stress[k] + stress[next]) * (strain[next] - strain[k]);
  }
  answer.damping = std::abs(area) / (2.0 * std::numbers::pi * answer.stress * answer.strain);
}

/// Until `end`, s. The front arrives at the fixed end with half of the largest shear stress that the element there has
/// within 0.3 ms.
Answer shaken(const fem::SolidMesh& mesh, const std::shared_ptr<fem::Solid>& solid, double amplitude, double end) {
  fem::Model model = fem::makeModel(mesh);
  model.add(solid);
  fem::addMass(model);
  tieSections(model, mesh);
  const std::vector<int>&left = fem::nodeSet(mesh, "x-"), &right = fem::nodeSet(mesh, "x+");
  model.constraints.hold(left, fem::componentX | fem::componentY | fem::componentZ);
  model.constraints.hold(right, fem::componentX | fem::componentZ);
  model.constraints.prescribe(
      right, 1, [amplitude](double t) { return amplitude * std::sin(2.0 * std::numbers::pi * frequency * t); });
  // Element 0 is at the fixed end.
  const auto shearStress = [&] { return solid->sample(model.nodes, {model.t, 0.0}).P[3]; };
  fem::ExplicitIntegrator run(model, dt, {.energyEvery = 10});
  const double before = shearStress();
  std::vector<double> stress, ninthStrain, ninthStress;
  while (model.t < end - 0.5 * dt) {
    run.step();
    const fem::Solid::Sample now = solid->sample(model.nodes, {model.t, 0.0});
    stress.push_back(std::abs(now.P[3] - before));
    if (now.F.size() < 90) continue;
    ninthStrain.push_back(now.F[75]);
    ninthStress.push_back(now.P[75]);
  }
  Answer answer;
  const auto cycle = static_cast<std::size_t>(std::lround(1.0 / (frequency * dt)));
  if (ninthStrain.size() >= cycle)
    describeLoop(std::span(ninthStrain).last(cycle), std::span(ninthStress).last(cycle), answer);
  const double half = 0.5 * *std::max_element(stress.begin(), stress.begin() + std::lround(0.3e-3 / dt));
  const auto front = std::ranges::find_if(stress, [half](double tau) { return tau > half; });
  answer.arrival = dt * static_cast<double>(front - stress.begin() + 1);
  const double work = std::abs(run.ledger().joules("supports"));
  answer.residual = run.ledger().largestResidual() / work;
  answer.lost = run.ledger().joules("dissipated by cells") / work;
  return answer;
}

fem::NeoHookean elasticOf(const rve::Moduli& m, double density) {
  return fem::neoHookean(9.0 * m.bulk * m.shear / (3.0 * m.bulk + m.shear),
                         (3.0 * m.bulk - 2.0 * m.shear) / (6.0 * m.bulk + 2.0 * m.shear), density);
}

}  // namespace

FigureRows column(bool quick) {
  FigureRows rows;
  const rve::Rve cell = elasticSpheres(quick ? 500 : 1000, 1);
  const double density = cell.density * rve::solidFraction(cell);
  const rve::Moduli moduli = rve::moduliOf(cell, rve::elasticTangent(cell));
  for (const int elements : {10, 20, 40}) {
    if (quick && elements == 40) continue;
    const fem::SolidMesh mesh = fem::boxOf(fem::ElementShape::hex8, {elements, 1, 1}, {}, {length, width, width});
    const auto cells = [&](double strainPerStep) {
      return fem::makeSolid(mesh,
                            hierarchical::cellField({cell}, hierarchical::DynamicCells{.strainPerStep = strainPerStep}),
                            {.formulation = fem::Formulation::reduced, .name = "cells"});
    };
    const auto elastic = fem::makeSolid(mesh, fem::pointMaterial(elasticOf(moduli, density)),
                                        {.formulation = fem::Formulation::reduced});
    const Answer printed = shaken(mesh, cells(3e-5), 1e-4, elements == 10 ? 1e-3 : 0.3e-3);
    const Answer gentle = shaken(mesh, cells(3e-8), 1e-7, 0.3e-3), beside = shaken(mesh, elastic, 1e-7, 0.3e-3);
    const std::string name = ", " + std::to_string(elements) + " elements";
    rows.push_back({"arrival at the fixed end, ms" + name, 1e3 * printed.arrival, 0.0, std::nan(""), 0.0,
                    "none is printed; 0.26 by the printed G"});
    rows.push_back({"transit by this cell's G, ms" + name, 1e3 * length / std::sqrt(moduli.shear / density), 0.0,
                    std::nan(""), 0.0, "dilation goes ahead and raises the pressure"});
    rows.push_back({"a thousandth of the amplitude: arrival over that in an elastic column" + name,
                    gentle.arrival / beside.arrival, 0.0, 1.0, 0.03});
    if (elements > 10) continue;
    rows.push_back({"fraction of the work that is lost, ten cycles", printed.lost, 0.0, std::nan("")});
    rows.push_back({"residual of the ledger over work", printed.residual, 0.0, std::nan("")});
    rows.push_back({"element 9, last cycle: half the range of shear, %", 100.0 * printed.strain, 0.0, std::nan("")});
    rows.push_back({"half the range of its shear stress, kPa", 1e-3 * printed.stress, 0.0, std::nan("")});
    rows.push_back({"damping ratio of its loop", printed.damping, 0.0, std::nan("")});
  }
  return rows;
}

}  // namespace dovetail::benchmark
