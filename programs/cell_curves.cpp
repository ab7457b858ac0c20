// Columns of the curves of tests, and the numbers that tests are done for.
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "cell_tests.hpp"

namespace dovetail::program {

namespace {

using State = rve::DrivenState;

bool ofDiscs(const State& s) { return s.stress(2, 2) == 0.0; }

/// (σ₁ − σ₃)/(σ₁ + σ₃) of the principal stresses, of discs those in their plane: the sine of the mobilised friction
/// angle.
double stressRatio(const State& s) {
  Eigen::Vector3d principal;
  if (ofDiscs(s)) {
    const double mean = 0.5 * (s.stress(0, 0) + s.stress(1, 1)),
                 radius = std::hypot(0.5 * (s.stress(0, 0) - s.stress(1, 1)), s.stress(0, 1));
    principal = {mean - radius, mean, mean + radius};
  } else {
    principal = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(s.stress, Eigen::EigenvaluesOnly).eigenvalues();
  }
  const double sum = -principal[0] - principal[2];
  return sum > 0.0 ? (principal[2] - principal[0]) / sum : std::nan("");
}

double pressureOf(const State& s) { return -s.stress.trace() / (ofDiscs(s) ? 2.0 : 3.0); }

}  // namespace

const std::vector<CurveColumn>& curveColumns() {
  static const std::vector<CurveColumn> columns = {
      {"strain", [](const State& s) { return s.strain; }},
      {"volumetric_strain", [](const State& s) { return -std::log(s.F.determinant()); }},
      {"stress_ratio", stressRatio},
      {"pressure_Pa", pressureOf},
      {"sigma_xx_Pa", [](const State& s) { return s.stress(0, 0); }},
      {"sigma_yy_Pa", [](const State& s) { return s.stress(1, 1); }},
      {"sigma_zz_Pa", [](const State& s) { return s.stress(2, 2); }},
      {"sigma_xy_Pa", [](const State& s) { return s.stress(0, 1); }},
      {"void_ratio", [](const State& s) { return s.voidRatio(); }},
      {"solid_fraction", [](const State& s) { return s.solidFraction; }},
      {"coordination", [](const State& s) { return s.coordination; }},
      {"fabric_xx", [](const State& s) { return s.fabric(0, 0); }},
      {"fabric_yy", [](const State& s) { return s.fabric(1, 1); }},
      {"fabric_zz", [](const State& s) { return s.fabric(2, 2); }},
      {"fabric_xy", [](const State& s) { return s.fabric(0, 1); }},
      {"sliding_fraction", [](const State& s) { return s.sliding; }},
      {"F_xx", [](const State& s) { return s.F(0, 0); }},
      {"F_yy", [](const State& s) { return s.F(1, 1); }},
      {"F_zz", [](const State& s) { return s.F(2, 2); }},
      {"F_xy", [](const State& s) { return s.F(0, 1); }},
      {"work_J", [](const State& s) { return s.ledger.work; }},
      {"friction_J", [](const State& s) { return s.ledger.friction; }},
      {"damping_J", [](const State& s) { return s.ledger.damping; }},
      {"stored_J", [](const State& s) { return s.stored; }},
      {"kinetic_J", [](const State& s) { return s.kinetic; }},
      {"unbalanced", [](const State& s) { return s.unbalanced; }},
  };
  return columns;
}

std::vector<double> valuesOf(const CellCourse& course, const CurveColumn& column) {
  std::vector<double> values;
  for (const State& state : course.states) values.push_back(column.value(state));
  return values;
}

double meanOf(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

double deviationOf(const std::vector<double>& values) {
  if (values.size() < 2) return 0.0;
  const double mean = meanOf(values);
  double squares = 0.0;
  for (const double value : values) squares += (value - mean) * (value - mean);
  return std::sqrt(squares / static_cast<double>(values.size() - 1));
}

namespace {

double degrees(double sine) { return std::asin(std::clamp(sine, -1.0, 1.0)) * 180.0 / std::numbers::pi; }

/// The test of one cell, without the way back.
struct Way {
  const CellTest& test;
  std::vector<State> states;

  Way(const CellTest& all, const CellCourse& course)
      : test(all), states(course.states.begin(), course.states.begin() + all.outputs + 1) {}

  const State& peak() const { return *std::ranges::max_element(states, {}, stressRatio); }
  /// Of the last quarter.
  double late(double (*value)(const State&)) const {
    std::vector<double> values;
    for (std::size_t k = states.size() - states.size() / 4; k < states.size(); ++k) values.push_back(value(states[k]));
    return meanOf(values);
  }
  double along(const State& s) const { return -s.stress(test.axis, test.axis); }
  double across(const State& s) const {
    double sum = 0.0;
    for (int k = 0; k < (ofDiscs(s) ? 2 : 3); ++k) sum += k == test.axis ? 0.0 : -s.stress(k, k);
    return sum / (ofDiscs(s) ? 1.0 : 2.0);
  }
  /// sin ψ of the steepest growth of volume over a tenth of the way.
  double dilatancy() const {
    const std::size_t window = std::max<std::size_t>(1, states.size() / 10);
    double steepest = 1e300;
    for (std::size_t k = window; k < states.size(); ++k) {
      const State &a = states[k - window], &b = states[k];
      steepest = std::min(steepest, -std::log(b.F.determinant() / a.F.determinant()) / (b.strain - a.strain));
    }
    return -steepest / (2.0 - steepest);
  }
};

double shearOverNormal(const State& s) { return -s.stress(0, 1) / s.stress(1, 1); }

using NumberOf = double (*)(const Way&);
struct NumberKind {
  const char *name, *unit;
  NumberOf value;
};

std::vector<NumberKind> kindsFor(const CellTest& test) {
  std::vector<NumberKind> kinds;
  const NumberKind bulk{"K to the end", "Pa", [](const Way& w) {
                          return (pressureOf(w.states.back()) - pressureOf(w.states.front())) / w.states.back().strain;
                        }};
  if (test.kind == TestKind::isotropic) return {bulk};
  if (test.kind == TestKind::oedometer)
    return {{"K0, side over axial stress at the end", "1",
             [](const Way& w) { return w.across(w.states.back()) / w.along(w.states.back()); }},
            {"constrained modulus to the end", "Pa", [](const Way& w) {
               return (w.along(w.states.back()) - w.along(w.states.front())) / w.states.back().strain;
             }}};
  kinds.push_back({"largest stress ratio", "1", [](const Way& w) { return stressRatio(w.peak()); }});
  kinds.push_back({"strain there", "1", [](const Way& w) { return w.peak().strain; }});
  kinds.push_back({"friction angle, largest", "deg", [](const Way& w) { return degrees(stressRatio(w.peak())); }});
  kinds.push_back({"friction angle, last quarter", "deg", [](const Way& w) { return degrees(w.late(stressRatio)); }});
  if (test.kind == TestKind::shear) {
    kinds.push_back({"shear over normal stress, largest", "1", [](const Way& w) {
                       return shearOverNormal(*std::ranges::max_element(w.states, {}, shearOverNormal));
                     }});
    kinds.push_back(
        {"shear over normal stress, last quarter", "1", [](const Way& w) { return w.late(shearOverNormal); }});
  } else if (!test.constantVolume) {
    kinds.push_back({"dilatancy angle", "deg", [](const Way& w) { return degrees(w.dilatancy()); }});
  }
  if (test.constantVolume)
    kinds.push_back({"least pressure", "Pa",
                     [](const Way& w) { return pressureOf(*std::ranges::min_element(w.states, {}, pressureOf)); }});
  return kinds;
}

}  // namespace

std::vector<TestNumber> numbersOf(const TestResult& result) {
  std::vector<TestNumber> numbers;
  for (const NumberKind& kind : kindsFor(*result.test)) {
    numbers.push_back({kind.name, kind.unit, {}});
    for (const CellCourse* const course : result.whole())
      numbers.back().values.push_back(kind.value(Way(*result.test, *course)));
  }
  return numbers;
}

}  // namespace dovetail::program
