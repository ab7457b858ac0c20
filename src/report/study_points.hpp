// The points of a study, in tables and figures.
#pragma once

#include <string>
#include <vector>

#include "dovetail/report/page.hpp"
#include "dovetail/report/scaling.hpp"
#include "dovetail/report/study.hpp"

namespace dovetail::report {

/// NaN if there is none.
double numberIn(const Json& row, const std::string& key);
bool finished(const Json& row);
/// Whether it takes part in the front of this figure.
bool hasError(const Json& row, const std::string& error);
bool isOf(const Json& row, const StudyPoint& point);
bool hasWays(const std::vector<StudyPoint>& points);
bool hasRepeats(const std::vector<StudyPoint>& points);

/// Error against cost: the points of each way, or all and those on the front joined.
Figure frontFigure(const std::vector<StudyPoint>& points, const Study& study, const Json& whole);
Table tableOf(const std::vector<StudyPoint>& points, const Study::Front& front);
Json jsonOf(const std::vector<StudyPoint>& points, const std::string& cost);

/// Mean costs over the size, a curve for each series. @param rows  in the order of the cases, null if there is none
std::vector<CostCurve> costCurves(const Study& study, const std::vector<Json>& rows);
std::string scalingName(const Study& study);

}  // namespace dovetail::report
