#include <algorithm>

#include "dovetail/core/parallel.hpp"
#include "supernodal.hpp"

namespace dovetail::linalg::detail {

namespace {

constexpr std::size_t worthwhile = 16384;  // entries of L that are worth a thread's while
constexpr std::size_t blockColumns = 64, blockRows = 256;

/// Rows of a worthwhile chunk, in whole blocks.
std::size_t rowChunk(std::size_t columns) {
  return std::max<std::size_t>(1, worthwhile / (columns * blockRows)) * blockRows;
}
/// Columns of one, in fours.
std::size_t columnGrain(std::size_t rows) { return std::max<std::size_t>(2, worthwhile / 4 / (rows + 1)) * 4; }

/// body(begin, end) over [0, n) in blocks of rows, shared by threads.
template <class Body>
void forRows(std::size_t n, std::size_t columns, const Body& body) {
  if (n == 0) return;
  parallelFor(n, rowChunk(columns), [&](std::size_t begin, std::size_t end) {
    withVectors([&] {
      for (std::size_t r = begin; r < end; r += blockRows) body(r, std::min(r + blockRows, end));
    });
  });
}

/// x ← L⁻¹ x in the columns of a supernode, then add(k, Σ) for each of the rows below, a block at a time.
template <int count, class Subtract>
void goUp(const SupernodalPattern& L, const double* values, std::size_t s, Vectors<count> x, const Subtract& subtract) {
  const Panel all = L.panel(s, values);
  const std::size_t width = all.columns;
  const Vectors<count> own = x.from(L.column(s));
  for (std::size_t j = 0; j < width; j += blockColumns) {
    const std::size_t n = std::min(blockColumns, width - j), rest = j + n;
    withVectors([&] { panel::solveLower(all.part(j, j, n, n), own.from(j)); });
    forRows(width - rest, n, [&](std::size_t begin, std::size_t end) {
      panel::subtractProduct(all.part(rest + begin, j, end - begin, n), own.from(j), own.from(rest + begin));
    });
  }
  forRows(all.rows - width, width, [&](std::size_t begin, std::size_t end) {
    std::array<double, blockRows* static_cast<std::size_t>(count)> change{};
    const Vectors<count> below{change.data(), blockRows};
    panel::subtractProduct(all.part(width + begin, 0, end - begin, width), own, below);
    subtract(begin, end, below);
  });
}

/// x ← L⁻ᵀ x in the columns of a supernode, those of later ones being known. @param known  room for the rows below
template <int count>
void goDown(const SupernodalPattern& L, const double* values, std::size_t s, Vectors<count> x,
            std::vector<double>& known) {
  const Panel all = L.panel(s, values);
  const std::size_t width = all.columns, lower = all.rows - width;
  const std::span<const std::int64_t> below = L.rowsBelow(s);
  const Vectors<count> own = x.from(L.column(s));
  if (known.size() < lower * static_cast<std::size_t>(count)) known.resize(lower * static_cast<std::size_t>(count));
  const Vectors<count> others{known.data(), lower};
  for (int c = 0; c < count; ++c)
    for (std::size_t k = 0; k < lower; ++k) others[c][k] = x[c][below[k]];
  for (std::size_t end = width; end > 0;) {
    const std::size_t j = (end - 1) / blockColumns * blockColumns, n = end - j;
    parallelFor(n, columnGrain(all.rows - end), [&](std::size_t first, std::size_t last) {
      withVectors([&] {
        const std::size_t k = j + first, some = last - first;
        panel::subtractTransposed(all.part(end, k, width - end, some), own.from(end), own.from(k));
        panel::subtractTransposed(all.part(width, k, lower, some), others, own.from(k));
      });
    });
    withVectors([&] { panel::solveTransposed(all.part(j, j, n, n), own.from(j)); });
    end = j;
  }
}

}  // namespace

void SupernodalSolver::prepare(const SupernodalPattern& L, const SupernodalPlan& plan) {
  outsideFrom_.assign(1, 0);
  outsideRow_.clear();
  place_.assign(L.row.size(), -1);
  for (const SupernodalPlan::Subtree& tree : plan.subtrees) {
    const std::span<const std::int64_t> outside = L.rowsBelow(tree.end - 1);
    outsideRow_.insert(outsideRow_.end(), outside.begin(), outside.end());
    outsideFrom_.push_back(outsideRow_.size());
    for (std::size_t s = tree.begin; s < tree.end; ++s) {
      const std::span<const std::int64_t> below = L.rowsBelow(s);
      std::size_t at = 0;
      for (std::size_t k = 0; k < below.size(); ++k) {
        if (below[k] < L.firstColumn[tree.end]) continue;
        while (outside[at] != below[k]) ++at;
        place_[static_cast<std::size_t>(&below[k] - L.row.data())] = static_cast<int>(at);
      }
    }
  }
}

template <int count>
void SupernodalSolver::solveTogether(const SupernodalPattern& L, const SupernodalPlan& plan, const double* values,
                                     Vectors<count> x) {
  outside_.assign(outsideRow_.size() * static_cast<std::size_t>(count), 0.0);
  const auto outsideOf = [&](std::size_t tree) {
    return Vectors<count>{outside_.data() + outsideFrom_[tree] * static_cast<std::size_t>(count),
                          outsideFrom_[tree + 1] - outsideFrom_[tree]};
  };
  parallelTasks(plan.subtrees.size(), [&](std::size_t tree) {
    const Vectors<count> outside = outsideOf(tree);
    for (std::size_t s = plan.subtrees[tree].begin; s < plan.subtrees[tree].end; ++s) {
      const std::span<const std::int64_t> below = L.rowsBelow(s);
      const int* const place = place_.data() + (below.data() - L.row.data());
      goUp(L, values, s, x, [&](std::size_t begin, std::size_t end, Vectors<count> change) {
        for (std::size_t k = begin; k < end; ++k)
          for (int c = 0; c < count; ++c)
            (place[k] < 0 ? x[c][below[k]] : outside[c][place[k]]) += change[c][k - begin];
      });
    }
  });
  for (std::size_t tree = 0; tree < plan.subtrees.size(); ++tree) {
    const Vectors<count> outside = outsideOf(tree);
    for (int c = 0; c < count; ++c)
      for (std::size_t k = 0; k < outside.stride; ++k) x[c][outsideRow_[outsideFrom_[tree] + k]] += outside[c][k];
  }
  for (const std::size_t s : plan.above) {
    const std::span<const std::int64_t> below = L.rowsBelow(s);
    goUp(L, values, s, x, [&](std::size_t begin, std::size_t end, Vectors<count> change) {
      for (int c = 0; c < count; ++c)
        for (std::size_t k = begin; k < end; ++k) x[c][below[k]] += change[c][k - begin];
    });
  }
  std::vector<double> known;
  for (std::size_t k = plan.above.size(); k-- > 0;) goDown(L, values, plan.above[k], x, known);
  parallelTasks(plan.subtrees.size(), [&](std::size_t tree) {
    std::vector<double> ofTask;
    for (std::size_t s = plan.subtrees[tree].end; s-- > plan.subtrees[tree].begin;) goDown(L, values, s, x, ofTask);
  });
}

void SupernodalSolver::solve(const SupernodalPattern& L, const SupernodalPlan& plan, const double* values,
                             std::span<double> x, int columns) {
  const std::size_t size = L.size();
  int done = 0;
  const auto rest = [&] { return x.data() + static_cast<std::size_t>(done) * size; };
  for (; done + 3 <= columns; done += 3) solveTogether<3>(L, plan, values, {rest(), size});
  if (done + 2 <= columns) {
    solveTogether<2>(L, plan, values, {rest(), size});
    done += 2;
  }
  if (done < columns) solveTogether<1>(L, plan, values, {rest(), size});
}

}  // namespace dovetail::linalg::detail
