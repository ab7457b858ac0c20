#include <algorithm>
#include <limits>
#include <numeric>

#include "supernodal.hpp"

namespace dovetail::linalg::detail {

namespace {

constexpr double subtreesWanted = 24.0;
constexpr double leastWork = 32768.0;  // entries of L that are worth a task

std::vector<std::size_t> parentsOf(const SupernodalPattern& L) {
  const std::size_t count = L.supernodes();
  std::vector<std::size_t> ofColumn(L.size()), parent(count, count);
  for (std::size_t s = 0; s < count; ++s)
    std::fill_n(ofColumn.begin() + static_cast<std::ptrdiff_t>(L.column(s)), L.columns(s), s);
  for (std::size_t s = 0; s < count; ++s)
    if (const auto below = L.rowsBelow(s); !below.empty()) parent[s] = ofColumn[static_cast<std::size_t>(below[0])];
  return parent;
}

}  // namespace

SupernodalPlan planOf(const SupernodalPattern& L) {
  const std::size_t count = L.supernodes();
  SupernodalPlan plan;
  plan.parent = parentsOf(L);
  std::vector<double> work(count + 1, 0.0);  // of the subtree; the last one: of all
  std::vector<std::size_t> first(count);     // supernode of the subtree
  std::iota(first.begin(), first.end(), std::size_t{0});
  for (std::size_t s = 0; s < count; ++s) {
    work[s] += static_cast<double>(L.rows(s).size() * L.columns(s));
    work[plan.parent[s]] += work[s];
    if (plan.parent[s] < count) first[plan.parent[s]] = std::min(first[plan.parent[s]], first[s]);
  }
  const double most = std::max(leastWork, work[count] / subtreesWanted);
  work[count] = std::numeric_limits<double>::infinity();
  for (std::size_t s = 0; s < count; ++s)
    if (work[s] > most)
      plan.above.push_back(s);
    else if (work[plan.parent[s]] > most)
      plan.subtrees.push_back({first[s], s + 1, work[s]});
  std::ranges::stable_sort(plan.subtrees, std::ranges::greater{}, &SupernodalPlan::Subtree::work);
  return plan;
}

}  // namespace dovetail::linalg::detail
