#include "band_layer.hpp"

#include <algorithm>
#include <cmath>

#include "dovetail/fem/elements/solid.hpp"
#include "dovetail/fem/laws/point_law.hpp"
#include "dovetail/fem/solve/statics.hpp"
#include "dovetail/fem/terms/gradient_energy.hpp"

namespace dovetail::benchmark {

namespace {

/// P₁₂ = G F₁₂, beyond 1 falling by H; all else is linear by G.
struct SofteningShear {
  double shear, softening;
  static constexpr bool branches = true;
  template <class T>
  T energy(const fem::Tensor<T>& F) const {
    T sum = 0.5 * shear * (F[0] - 1.0) * (F[0] - 1.0);
    for (const std::size_t k : {2, 3, 5, 6, 7}) sum = sum + 0.5 * shear * F[k] * F[k];
    for (const std::size_t k : {4, 8}) sum = sum + 0.5 * shear * (F[k] - 1.0) * (F[k] - 1.0);
    const double peak = 1.0 / shear;
    const T beyond = F[1] - peak;
    return beyond > 0.0 ? sum + 0.5 * peak + beyond - 0.5 * softening * beyond * beyond
                        : sum + 0.5 * shear * F[1] * F[1];
  }
};

/// Strain above that of the peak at y from the middle of the exact band.
double strainBeyond(const SoftLayer& l, double drop, double y) {
  const double q = std::sqrt(l.softening / l.modulus), p = std::sqrt(l.shear / l.modulus);
  const double half = 0.5 * exactBand(l).width;
  if (std::abs(y) < half) return drop / l.softening * (1.0 - std::cos(q * y) / std::cos(q * half));
  return drop / l.shear * (std::exp(-p * (std::abs(y) - half)) - 1.0);
}

class Layer {
public:
  Layer(const SoftLayer& l, fem::ElementShape shape, double elementsPerBand)
      : layer_(l), height_(l.bandsAcross * exactBand(l).width) {
    const int count = static_cast<int>(std::lround(l.bandsAcross * elementsPerBand));
    mesh_ = fem::boxOf(shape, {1, count, 1}, {0.0, -0.5 * height_, 0.0}, {height_ / count, 0.5 * height_, 1.0});
    model_ = fem::makeModel(mesh_);
    const auto formulation = shape == fem::ElementShape::quad8 ? fem::Formulation::reduced : fem::Formulation::standard;
    solid_ = fem::makeSolid(mesh_, fem::elasticMaterial("softening shear", 1.0, SofteningShear{l.shear, l.softening}),
                            {.formulation = formulation});
    model_.add(solid_);
    model_.add(fem::gradientEnergy(mesh_, {.modulus = l.modulus}));
    for (std::size_t n = 0; n < mesh_.X.size(); ++n)
      model_.constraints.hold(std::array{static_cast<int>(n)}, fem::componentY);
    model_.constraints.hold(fem::nodeSet(mesh_, "y-"), fem::componentX);
    model_.constraints.prescribe(fem::nodeSet(mesh_, "y+"), 0, [this](double) { return motion_; });
  }

  /// To equilibrium at the motion that the exact layer has for this drop of the stress.
  void solve(double drop) {
    constexpr int pieces = 20000;
    const double piece = height_ / pieces;
    std::vector<double> sum(pieces + 1, 0.0);
    for (int k = 0; k < pieces; ++k)
      sum[static_cast<std::size_t>(k) + 1] =
          sum[static_cast<std::size_t>(k)] +
          piece * (1.0 / layer_.shear + strainBeyond(layer_, drop, (k + 0.5) * piece - 0.5 * height_));
    motion_ = sum.back();
    for (std::size_t n = 0; n < mesh_.X.size(); ++n) {
      const double place = std::clamp((mesh_.X[n].y + 0.5 * height_) / piece, 0.0, pieces - 1.0);
      const auto k = static_cast<std::size_t>(place);
      model_.nodes.u[n].x = sum[k] + (place - static_cast<double>(k)) * (sum[k + 1] - sum[k]);
    }
    fem::solveStatics(model_, model_.t);
  }
  double motion() const { return motion_; }
  double drop() {
    fem::evaluateForces(model_, {});
    double force = 0.0;
    for (const int n : fem::nodeSet(mesh_, "y+")) force -= model_.nodes.f[static_cast<std::size_t>(n)].x;
    return 1.0 - force / (mesh_.X[static_cast<std::size_t>(fem::nodeSet(mesh_, "x+").front())].x);
  }
  /// Between the zeros of the strain beyond the peak, straight from point to point.
  double width() {
    const fem::Solid::Sample sample = solid_->sample(model_.nodes, {});
    std::vector<std::pair<double, double>> strain;  // over y
    for (std::size_t p = 0; p < sample.X.size(); ++p)
      strain.emplace_back(sample.X[p].y, sample.F[9 * p + 1] - 1.0 / layer_.shear);
    std::ranges::sort(strain);
    double first = 0.0, last = 0.0;
    for (std::size_t k = 0; k + 1 < strain.size(); ++k) {
      const auto [y0, g0] = strain[k];
      const auto [y1, g1] = strain[k + 1];
      if ((g0 > 0.0) == (g1 > 0.0)) continue;
      (g1 > 0.0 ? first : last) = y0 + (y1 - y0) * g0 / (g0 - g1);
    }
    return last - first;
  }

private:
  SoftLayer layer_;
  double height_, motion_ = 0.0;
  fem::SolidMesh mesh_;
  fem::Model model_;
  std::shared_ptr<fem::Solid> solid_;
};

}  // namespace

Band exactBand(const SoftLayer& l) {
  const double width = fem::bandWidth(l.modulus, l.softening, l.shear);
  return {width, (1.0 / l.softening + 1.0 / l.shear) * (width + 2.0 * std::sqrt(l.modulus / l.shear))};
}

Band bandOfElements(const SoftLayer& l, fem::ElementShape shape, double elementsPerBand) {
  Layer layer(l, shape, elementsPerBand);
  layer.solve(0.25);
  const double motion = layer.motion(), drop = layer.drop();
  layer.solve(0.5);
  const double height = l.bandsAcross * exactBand(l).width;
  return {layer.width(), (layer.motion() - motion) / (layer.drop() - drop) + height / l.shear};
}

}  // namespace dovetail::benchmark
