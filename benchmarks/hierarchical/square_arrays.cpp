// Stress of square arrays of n × n discs in a frame, with contacts along the frame at full and at half weight.
#include "dovetail/rve/rve.hpp"
#include "figure.hpp"

namespace dovetail::benchmark {

namespace {

constexpr double stiffness = 1e4;  // N/m

/// n × n discs of radius 1.02 mm, 2 mm apart, 1 m thick (Liu, thesis TU Eindhoven 2018, Table 2.4).
rve::Rve arrayOf(int n) {
  rve::Grains grains;
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) grains.centre.push_back({2e-3 * i, 2e-3 * j, 0.0});
  grains.radius.assign(grains.centre.size(), 1.02e-3);
  const double side = 2e-3 * n;
  return rve::makeRve(grains, {{Vec3{side, 0, 0}, Vec3{0, side, 0}, Vec3{0, 0, 1}}, {true, true, false}},
                      {.stiffness = stiffness, .tangential = 0.2, .friction = 0.4});
}

double stressOf(const rve::Rve& cell) { return -rve::stressOfReactions(cell)(0, 0) / stiffness; }

}  // namespace

FigureRows squareArrays(bool) {
  const rve::Conditions held{rve::Condition::displacement, rve::Condition::displacement, rve::Condition::displacement,
                             rve::Condition::displacement};
  FigureRows rows;
  const double printed[] = {0.0250, 0.0222, 0.0214};
  int k = 0;
  for (const int n : {5, 10, 15}) {
    const std::string name = "−σ₁₁/k_n, n = " + std::to_string(n);
    rve::Rve cell = rve::framed(arrayOf(n - 1), held);
    const double half = stressOf(cell);
    cell.state.contacts.stiffness.assign(cell.state.contacts.size(), stiffness);
    rve::displace(cell, cell.state.v, cell.state.spin);  // forces anew
    rows.push_back({name + ", full weight", stressOf(cell), 0.0, printed[k++], 1e-4});
    rows.push_back({name + ", half weight", half, 0.0, 0.02, 1e-4, "derived here"});
  }
  return rows;
}

}  // namespace dovetail::benchmark
