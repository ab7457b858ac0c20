// Values at the quadrature points of solids, and their means over elements.
#pragma once

#include <utility>
#include <vector>

#include "dovetail/fem/elements/solid.hpp"
#include "dovetail/fem/model/model.hpp"

namespace dovetail::scene {

/// Calls act(solid, sample) for all elements of a model.
template <class Act>
void forEachSolid(const fem::Model& model, Act&& act) {
  for (const auto& term : model.terms)
    if (auto* const solid = dynamic_cast<fem::Solid*>(term.get()))
      act(*solid, solid->sample(model.nodes, {.t = model.t}));
}

/// Sums of values times weights, by element, and the means.
class Means {
public:
  Means(std::size_t elements, std::size_t components)
      : components_(components), sum_(elements * components), weight_(elements) {}
  void add(int element, double weight, const double* values) {
    const auto e = static_cast<std::size_t>(element);
    weight_[e] += weight;
    for (std::size_t c = 0; c < components_; ++c) sum_[e * components_ + c] += weight * values[c];
  }
  std::vector<double> take() {
    for (std::size_t k = 0; k < sum_.size(); ++k)
      if (const double weight = weight_[k / components_]; weight > 0.0) sum_[k] /= weight;
    return std::move(sum_);
  }

private:
  std::size_t components_;
  std::vector<double> sum_, weight_;
};

}  // namespace dovetail::scene
