#include "measure.hpp"

#include "dovetail/core/parallel.hpp"
#include "dovetail/dem/pairs/pair_collide.hpp"

namespace dovetail::dem_benchmark {

double now() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

Rates ratesOf(std::vector<double> millions) {
  std::sort(millions.begin(), millions.end());
  const std::size_t n = millions.size();
  return {0.5 * (millions[(n - 1) / 2] + millions[n / 2]), millions.front(), millions.back()};
}

std::size_t bytesHeld(const dem::Particles& p, const dem::PairList& l) {
  const auto bytes = [](const auto&... arrays) { return ((arrays.capacity() * sizeof(arrays[0])) + ... + 0); };
  return bytes(p.x, p.v, p.f, p.radius, p.mass, p.omega, p.torque, p.material, p.id) + l.bytesHeld();
}

double bytesMovedPerStep(const dem::Particles& p, const dem::PairList& l, bool mass, bool oneSize) {
  const double n = static_cast<double>(p.size()), pairs = static_cast<double>(l.size()), vector = 24.0;
  const double both = 2.0;  // read and written
  const double spins = p.rotates() ? 1.0 : 0.0;
  const double sizes = 8.0 * ((mass ? 1.0 : 0.0) + 1.0) * (oneSize ? 0.0 : 1.0);
  // x, v, f (and ω, torque) read and written; masses (and radii for the inertia) read.
  const double move = both * vector * (3.0 + 2.0 * spins) + 8.0 * (1.0 + spins);
  // x, v (and ω) read, f (and torque) read and written.
  const double collide = vector * (2.0 + spins) + both * vector * (1.0 + spins) + sizes;
  const double held = 8.0 * static_cast<double>(l.memory().size() + l.motion().size());
  const double perPair = 8.0 + both * (l.size() == 0 ? 0.0 : held / pairs);
  return n * (move + collide) + pairs * perPair;
}

std::size_t touching(const dem::Particles& p, const dem::PairList& l) {
  std::size_t count = 0;
  for (std::size_t k = 0; k < l.size(); ++k) {
    const auto i = static_cast<std::size_t>(l.pairs()[k][0]), j = static_cast<std::size_t>(l.pairs()[k][1]);
    count += pairContact(p, i, j, l.shift(k)).overlap > 0.0 ? 1 : 0;
  }
  return count;
}

double triadBandwidth(int count) {
  setThreads(count);
  constexpr std::size_t n = 20'000'000;
  std::vector<double> a(n, 0.0), b(n, 1.0), c(n, 2.0);
  double best = 0.0;
  for (int repeat = 0; repeat < 5; ++repeat) {
    const double start = now();
    parallelFor(n, n / 16, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) a[i] = b[i] + 3.0 * c[i];
    });
    best = std::max(best, 24.0 * static_cast<double>(n) / (now() - start));
  }
  setThreads(1);
  return a[n / 2] > 0.0 ? 1e-9 * best : 0.0;
}

}  // namespace dovetail::dem_benchmark
