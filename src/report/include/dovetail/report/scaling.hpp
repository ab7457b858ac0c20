// What runs cost over the size of a problem, and from which size on one way costs less than another.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "dovetail/report/figure.hpp"
#include "dovetail/report/page.hpp"

namespace dovetail::report {

/// Points in ascending order of the size, all values > 0.
struct CostCurve {
  std::string name;
  std::vector<double> size, seconds;
};

/// Beyond the largest size the cost grows as a power of it: as from the point before, at least and at most as between
/// any two neighbours.
struct Growth {
  double exponent, least, most;
};
/// @throws InputError for less than two points, sizes that do not grow, or values that are not > 0
Growth growthOf(const CostCurve& curve);

struct BreakEven {
  double size;                                 ///< where the second begins to cost less than the first
  std::optional<std::array<double, 2>> range;  ///< beyond what was run: where it lies with the least and most growth of
                                               ///< both; infinite if one of these never gets there; none within
};
/// Of costs that are powers of the size between two points, and beyond the largest size of either.
/// @return nothing if the second costs less from the start, or never will
std::optional<BreakEven> breakEven(const CostCurve& dear, const CostCurve& cheap);

/// Costs over the size, beyond it broken lines with the least and most growth as bars, and as a table where each way
/// begins to cost less than another.
Figure scalingFigure(const std::vector<CostCurve>& curves, const std::string& name, const std::string& size,
                     const std::string& cost);
Table breakEvens(const std::vector<CostCurve>& curves, const std::string& size);

}  // namespace dovetail::report
