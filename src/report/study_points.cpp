#include "study_points.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include "dovetail/report/front.hpp"
#include "dovetail/report/text.hpp"

namespace dovetail::report {

namespace {

std::string pointOf(const Json& row) { return row.value("point", row["label"].get<std::string>()); }

void add(const StudyPoint& point, bool hasRanges, Curve& curve) {
  curve.x.push_back(point.seconds);
  curve.y.push_back(point.error);
  if (hasRanges) curve.ranges.push_back({point.lowest, point.highest});
}

/// Names of its places on all axes but the last.
std::string placeOf(const StudyPoint& point) {
  return point.point.substr(0, std::min(point.point.rfind(", "), point.point.size()));
}

/// A point of no number ends a line.
StudyPoint gap() {
  StudyPoint point;
  point.seconds = point.error = point.lowest = point.highest = std::nan("");
  return point;
}

/// A line joins the points that differ on the last axis alone.
Curve curveOf(const std::vector<StudyPoint>& points, const std::string& way) {
  Curve curve{way, {}, {}, true, true};
  const StudyPoint* before = nullptr;
  for (const StudyPoint& point : points) {
    if (point.way != way) continue;
    const bool several = point.point.find(", ") != std::string::npos;
    if (before && several && placeOf(*before) != placeOf(point)) add(gap(), hasRepeats(points), curve);
    add(point, hasRepeats(points), curve);
    before = &point;
  }
  return curve;
}

Curve frontOf(std::vector<StudyPoint> points) {
  std::ranges::stable_sort(points, {}, &StudyPoint::seconds);
  Curve curve{"front", {}, {}, true, true};
  for (const StudyPoint& point : points)
    if (point.onFront) add(point, false, curve);
  return curve;
}

Curve runsOf(const std::vector<StudyPoint>& points) {
  Curve curve{"runs", {}, {}, false, true};
  for (const StudyPoint& point : points) add(point, hasRepeats(points), curve);
  return curve;
}

}  // namespace

double numberIn(const Json& row, const std::string& key) {
  return row.contains(key) && row[key].is_number() ? row[key].get<double>() : std::nan("");
}

bool finished(const Json& row) { return row["outcome"] == "finished"; }

bool hasError(const Json& row, const std::string& error) {
  return finished(row) && !row.value("prepares", false) && std::isfinite(numberIn(row, error));
}

bool isOf(const Json& row, const StudyPoint& point) {
  return row.value("way", "") == point.way && pointOf(row) == point.point;
}

bool hasWays(const std::vector<StudyPoint>& points) {
  return std::ranges::any_of(points, [](const StudyPoint& point) { return !point.way.empty(); });
}

bool hasRepeats(const std::vector<StudyPoint>& points) {
  return std::ranges::any_of(points, [](const StudyPoint& point) { return point.runs > 1; });
}

Figure frontFigure(const std::vector<StudyPoint>& points, const Study& study, const Json& whole) {
  const std::string &error = study.fronts.front().error, &cost = study.cost.name;
  Figure figure{study.name, error + " against " + cost, {cost + " (s)", true}, {"|" + error + "|", true}, {}, {}};
  std::vector<std::string> ways;
  for (const StudyPoint& point : points)
    if (std::ranges::find(ways, point.way) == ways.end()) ways.push_back(point.way);
  if (hasWays(points)) {
    for (const std::string& way : ways) figure.curves.push_back(curveOf(points, way));
  } else {
    figure.curves = {runsOf(points), frontOf(points)};
  }
  if (points.empty() || !whole.contains("scatter")) return figure;
  const auto [least, most] = std::ranges::minmax(points, {}, &StudyPoint::seconds);
  const double scatter = whole["scatter"];
  figure.curves.push_back({"scatter of the reference", {least.seconds, most.seconds}, {scatter, scatter}});
  figure.curves.back().dashed = true;
  return figure;
}

Table tableOf(const std::vector<StudyPoint>& points, const Study::Front& front) {
  Table table{{"point", "runs", "seconds", front.error, "lowest", "highest", front.mark}, {}};
  for (const StudyPoint& point : points) {
    const std::string name =
        point.way.empty() || point.way == point.point ? point.point : point.way + ": " + point.point;
    std::vector<std::string> cells{name, std::to_string(point.runs)};
    for (const double value : {point.seconds, point.error, point.lowest, point.highest})
      cells.push_back(format("%.4g", value));
    cells.emplace_back(point.onFront ? "yes" : "");
    table.rows.push_back(std::move(cells));
  }
  return table;
}

Json jsonOf(const std::vector<StudyPoint>& points, const std::string& cost) {
  Json json = Json::array();
  for (const StudyPoint& point : points)
    json.push_back({{"way", point.way},
                    {"point", point.point},
                    {"runs", point.runs},
                    {cost, point.seconds},
                    {"error", point.error},
                    {"lowest", point.lowest},
                    {"highest", point.highest},
                    {"on_front", point.onFront}});
  return json;
}

std::vector<CostCurve> costCurves(const Study& study, const std::vector<Json>& rows) {
  std::map<std::string, std::map<double, std::vector<double>>> costs;
  std::vector<std::string> order;
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const StudyCase& one = study.cases[k];
    if (!one.size || rows[k].is_null() || !finished(rows[k]) || rows[k].value("prepares", false)) continue;
    if (!(numberIn(rows[k], study.cost.figure) > 0.0)) continue;
    if (!costs.contains(one.series)) order.push_back(one.series);
    costs[one.series][*one.size].push_back(numberIn(rows[k], study.cost.figure));
  }
  std::vector<CostCurve> curves;
  for (const std::string& series : order) {
    curves.push_back({series, {}, {}});
    for (const auto& [size, seconds] : costs[series]) {
      curves.back().size.push_back(size);
      curves.back().seconds.push_back(std::accumulate(seconds.begin(), seconds.end(), 0.0) /
                                      static_cast<double>(seconds.size()));
    }
  }
  return curves;
}

std::string scalingName(const Study& study) { return study.name + "_scaling"; }

std::vector<StudyPoint> pointsOf(const std::vector<Json>& rows, const std::string& error, const std::string& cost) {
  std::vector<StudyPoint> points;
  for (const Json& row : rows) {
    if (!hasError(row, error)) continue;
    const auto known = std::ranges::find_if(points, [&](const StudyPoint& point) { return isOf(row, point); });
    StudyPoint& point =
        known != points.end() ? *known : points.emplace_back(StudyPoint{row.value("way", ""), pointOf(row)});
    const double value = std::abs(numberIn(row, error));
    point.lowest = point.runs == 0 ? value : std::min(point.lowest, value);
    point.highest = std::max(point.highest, value);
    ++point.runs;
    point.seconds += (numberIn(row, cost) - point.seconds) / point.runs;
    point.error += (value - point.error) / point.runs;
  }
  const auto on = onFront(
      points, [](const StudyPoint&) { return true; }, [](const StudyPoint& point) { return point.seconds; },
      [](const StudyPoint& point) { return point.error; });
  for (std::size_t k = 0; k < points.size(); ++k) points[k].onFront = on[k];
  return points;
}

}  // namespace dovetail::report
