#include "dovetail/surface/contact_fractions.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

namespace dovetail::surface {

void ContactFractions::begin() {
  std::swap(now, before);
  now.particle.clear();
  now.weight.clear();
  now.fraction.clear();
  now.energy.clear();
}

bool ContactFractions::acted(int particle) const {
  const auto place = std::ranges::lower_bound(before.particle, particle);
  return place != before.particle.end() && *place == particle &&
         before.fraction[static_cast<std::size_t>(place - before.particle.begin())] > faded;
}

void ContactFractions::add(int particle, double weight, double overlap, double fraction) {
  if (now.particle.empty() || now.particle.back() != particle) {
    now.particle.push_back(particle);
    now.weight.push_back(weight);
    now.fraction.push_back(fraction);
    now.energy.push_back(0.0);
    overlaps_ = overlap;
    return;
  }
  overlaps_ += overlap;
  now.fraction.back() += (fraction - now.fraction.back()) * overlap / overlaps_;
}

void ContactFractions::book(std::span<const int> particle, std::span<const double> energy) {
  for (std::size_t c = 0, k = 0; c < energy.size(); ++c) {
    while (now.particle[k] != particle[c]) ++k;
    now.energy[k] += energy[c];
  }
  for (std::size_t k = 0, o = 0; k < now.particle.size(); ++k) {
    while (o < before.particle.size() && before.particle[o] < now.particle[k]) ++o;
    if (o == before.particle.size()) return;
    if (before.particle[o] != now.particle[k]) continue;
    const double from = before.fraction[o], to = now.fraction[k], had = before.energy[o], has = now.energy[k];
    const double weight = to > faded ? now.weight[k] : before.weight[o];
    if (from > 0.0 && to > 0.0)
      made += 0.5 * weight * (had / (before.weight[o] * from) + has / (now.weight[k] * to)) * (to - from);
    else
      made += has - had;
  }
}

bool ContactFractions::isWhole() const {
  const std::size_t count = now.particle.size();
  return now.weight.size() == count && now.fraction.size() == count && now.energy.size() == count &&
         std::ranges::is_sorted(now.particle) && (count == 0 || now.particle.front() >= 0);
}

void ContactFractions::renumber(std::span<const int> newNumber) {
  std::vector<std::pair<int, std::size_t>> stay;
  for (std::size_t k = 0; k < now.particle.size(); ++k)
    if (const int number = newNumber[static_cast<std::size_t>(now.particle[k])]; number >= 0)
      stay.emplace_back(number, k);
  std::sort(stay.begin(), stay.end());
  Touching moved;
  for (const auto& [number, k] : stay) {
    moved.particle.push_back(number);
    moved.weight.push_back(now.weight[k]);
    moved.fraction.push_back(now.fraction[k]);
    moved.energy.push_back(now.energy[k]);
  }
  now = std::move(moved);
}

}  // namespace dovetail::surface
