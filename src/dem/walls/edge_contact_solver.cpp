#include "dovetail/dem/walls/edge_contact_solver.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace dovetail::dem {

namespace {
constexpr double infinite = std::numeric_limits<double>::infinity();
constexpr double dependent = 1e-14;  // squared sine below which a normal counts as a combination of the active ones
}  // namespace

double EdgeContactSolver::violation(std::size_t i) const {
  double w = fractions_[i].overlap - fractions_[i].carried;
  for (std::size_t k = 0; k < count_; ++k) {
    const std::size_t j = active_[k];
    if (j != i) w -= coupling(dot(fractions_[i].normal, fractions_[j].normal)) * fractions_[j].carried;
  }
  return w;
}

int EdgeContactSolver::mostViolated(double tolerance) const {
  int worst = -1;
  for (std::size_t i = 0; i < fractions_.size(); ++i) {
    if (fractions_[i].carried > 0.0 || !(fractions_[i].overlap > tolerance)) continue;
    if (std::find(refused_.begin(), refused_.begin() + refusedCount_, i) != refused_.begin() + refusedCount_) continue;
    const double w = violation(i);
    if (w > tolerance) {
      tolerance = w;
      worst = static_cast<int>(i);
    }
  }
  return worst;
}

void EdgeContactSolver::factor() {
  for (std::size_t i = 0; i < count_; ++i)
    for (std::size_t j = 0; j <= i; ++j) {
      const Fraction &a = fractions_[active_[i]], &b = fractions_[active_[j]];
      double sum = i == j ? 1.0 : coupling(dot(a.normal, b.normal));
      for (std::size_t k = 0; k < j; ++k) sum -= lower_[i][k] * lower_[j][k];
      lower_[i][j] = i == j ? std::sqrt(std::max(sum, dependent)) : sum / lower_[j][j];
    }
}

void EdgeContactSolver::solveActive(Row& x) const {
  for (std::size_t i = 0; i < count_; ++i) {
    for (std::size_t k = 0; k < i; ++k) x[i] -= lower_[i][k] * x[k];
    x[i] /= lower_[i][i];
  }
  for (std::size_t i = count_; i-- > 0;) {
    for (std::size_t k = i + 1; k < count_; ++k) x[i] -= lower_[k][i] * x[k];
    x[i] /= lower_[i][i];
  }
}

void EdgeContactSolver::drop(std::size_t place) {
  fractions_[active_[place]].carried = 0.0;
  std::copy(active_.begin() + place + 1, active_.begin() + count_, active_.begin() + place);
  --count_;
}

bool EdgeContactSolver::bringIn(std::size_t entering) {
  if (count_ == capacity) return false;
  Fraction& in = fractions_[entering];
  while (true) {
    factor();
    Row relief{};  // what the active ones give up per unit that the entering one takes
    Row column{};
    for (std::size_t k = 0; k < count_; ++k) column[k] = coupling(dot(in.normal, fractions_[active_[k]].normal));
    relief = column;
    solveActive(relief);
    double pivot = 1.0;
    for (std::size_t k = 0; k < count_; ++k) pivot -= column[k] * relief[k];

    double step = pivot > dependent ? std::max(0.0, violation(entering)) / pivot : infinite;
    std::size_t leaving = count_;
    for (std::size_t k = 0; k < count_; ++k)
      if (relief[k] > 0.0 && fractions_[active_[k]].carried < step * relief[k]) {
        step = fractions_[active_[k]].carried / relief[k];
        leaving = k;
      }
    if (step == infinite) {
      in.carried = 0.0;
      return false;
    }
    for (std::size_t k = 0; k < count_; ++k) fractions_[active_[k]].carried -= step * relief[k];
    in.carried += step;
    if (leaving == count_) break;
    drop(leaving);
  }
  active_[count_++] = entering;
  return true;
}

void EdgeContactSolver::solve(std::span<Fraction> fractions, double tolerance) {
  fractions_ = fractions;
  count_ = refusedCount_ = 0;
  for (Fraction& fraction : fractions) fraction.carried = 0.0;
  for (int round = 0; round < 100; ++round) {
    const int worst = mostViolated(tolerance);
    if (worst < 0) return;
    if (bringIn(static_cast<std::size_t>(worst))) continue;
    if (refusedCount_ == capacity) return;
    refused_[refusedCount_++] = static_cast<std::size_t>(worst);
  }
}

}  // namespace dovetail::dem
