// What tests of cells came to: text, CSV, JSON and a page with figures.
#include <algorithm>
#include <cmath>

#include "cell_tests.hpp"
#include "dovetail/core/finite.hpp"
#include "dovetail/io/output_folder.hpp"
#include "dovetail/io/time_series.hpp"
#include "dovetail/report/page.hpp"
#include "dovetail/report/table.hpp"
#include "dovetail/report/text.hpp"

namespace dovetail::program {

namespace {

using report::format;
using report::Json;

std::string spread(const std::vector<double>& values, double scale = 1.0) {
  if (values.empty()) return "";
  const std::string mean = format("%.4g", scale * meanOf(values));
  return values.size() < 2 ? mean : mean + format(" ± %.2g", scale * deviationOf(values));
}

/// A row of the table of banks, and what it says for one cell.
struct FigureKind {
  const char* name;
  double scale;  // of the unit in the name
  double (*value)(const CellFigures&);
};
constexpr FigureKind figureKinds[] = {
    {"solid fraction", 1.0, [](const CellFigures& f) { return f.solidFraction; }},
    {"void ratio", 1.0, [](const CellFigures& f) { return f.voidRatio(); }},
    {"contacts per grain", 1.0, [](const CellFigures& f) { return f.coordination; }},
    {"pressure, kPa", 1e-3, [](const CellFigures& f) { return f.pressure; }},
    {"fabric xx", 1.0, [](const CellFigures& f) { return f.fabric(0, 0); }},
    {"fabric yy", 1.0, [](const CellFigures& f) { return f.fabric(1, 1); }},
    {"fabric zz", 1.0, [](const CellFigures& f) { return f.fabric(2, 2); }},
    {"fabric xy", 1.0, [](const CellFigures& f) { return f.fabric(0, 1); }},
    {"K of the elastic tangent, MPa", 1e-6, [](const CellFigures& f) { return f.elastic.bulk; }},
    {"G of the elastic tangent, MPa", 1e-6, [](const CellFigures& f) { return f.elastic.shear; }},
    {"K of the frictional tangent, MPa", 1e-6, [](const CellFigures& f) { return f.frictional.bulk; }},
    {"G of the frictional tangent, MPa", 1e-6, [](const CellFigures& f) { return f.frictional.shear; }},
    {"K of the Voigt tangent, MPa", 1e-6, [](const CellFigures& f) { return f.voigt.bulk; }},
    {"G of the Voigt tangent, MPa", 1e-6, [](const CellFigures& f) { return f.voigt.shear; }},
};

std::vector<double> valuesOf(const CellBank& bank, const std::function<double(const CellFigures&)>& value,
                             double scale = 1.0) {
  std::vector<double> values;
  for (const CellFigures& one : bank.figures) values.push_back(scale * value(one));
  return values;
}

report::Table tableOf(const CellBank& bank) {
  report::Table table{{"before any test", format("mean of %zu", bank.cells.size())}, {}};
  for (const FigureKind& kind : figureKinds)
    table.rows.push_back({kind.name, spread(valuesOf(bank, kind.value, kind.scale))});
  return table;
}

report::Table secantTable(const CellBank& bank) {
  report::Table table{{"strain", "K, MPa", "G, MPa"}, {}};
  const std::vector<double>& strains = bank.figures.front().secants.strain;
  for (std::size_t k = 0; k < strains.size(); ++k)
    table.rows.push_back({format("%.3g", strains[k]),
                          spread(valuesOf(bank, [k](const CellFigures& f) { return f.secants.bulk[k]; }), 1e-6),
                          spread(valuesOf(bank, [k](const CellFigures& f) { return f.secants.shear[k]; }), 1e-6)});
  return table;
}

report::Table tableOf(const TestResult& result) {
  report::Table table{{"at the end of the test", format("mean of %zu", result.whole().size())}, {}};
  for (const TestNumber& number : numbersOf(result)) {
    const bool pascal = number.unit == "Pa";
    const std::string unit = pascal ? ", kPa" : number.unit == "1" ? "" : ", " + number.unit;
    table.rows.push_back({number.name + unit, spread(number.values, pascal ? 1e-3 : 1.0)});
  }
  return table;
}

std::string textOf(const report::Table& table) {
  std::string text;
  for (const auto& row : table.rows) {
    text += format("  %-42s", row[0].c_str());
    for (std::size_t k = 1; k < row.size(); ++k) text += format(" %-20s", row[k].c_str());
    text.erase(text.find_last_not_of(' ') + 1);
    text += "\n";
  }
  return text;
}

/// Means over the whole courses, and standard deviations.
struct Spread {
  std::vector<double> mean, deviation;
};
Spread spreadOf(const TestResult& result, const CurveColumn& column) {
  std::vector<std::vector<double>> all;
  for (const CellCourse* const course : result.whole()) all.push_back(valuesOf(*course, column));
  Spread spread;
  for (std::size_t row = 0; !all.empty() && row < all.front().size(); ++row) {
    std::vector<double> values;
    for (const auto& one : all) values.push_back(one[row]);
    spread.mean.push_back(meanOf(values));
    spread.deviation.push_back(deviationOf(values));
  }
  return spread;
}

const CurveColumn& columnNamed(const std::string& name) {
  return *std::ranges::find_if(curveColumns(), [&](const CurveColumn& one) { return name == one.name; });
}

void writeCurves(const TestResult& result, const std::filesystem::path& folder) {
  std::vector<std::string> means, each{"cell"};
  for (const CurveColumn& column : curveColumns()) {
    each.emplace_back(column.name);
    means.emplace_back(column.name);
    if (std::string(column.name) != "strain") means.push_back("spread_" + means.back());
  }
  io::TimeSeries mean(means), cells(each);
  std::vector<Spread> spreads;
  for (const CurveColumn& column : curveColumns()) spreads.push_back(spreadOf(result, column));
  for (std::size_t row = 0; row < spreads.front().mean.size(); ++row) {
    std::vector<double> values;
    for (std::size_t k = 0; k < spreads.size(); ++k) {
      values.push_back(spreads[k].mean[row]);
      if (k > 0) values.push_back(spreads[k].deviation[row]);
    }
    mean.append(values);
  }
  for (std::size_t cell = 0; cell < result.courses.size(); ++cell)
    for (const rve::DrivenState& state : result.courses[cell].states) {
      std::vector<double> values{static_cast<double>(cell)};
      for (const CurveColumn& column : curveColumns()) values.push_back(column.value(state));
      cells.append(values);
    }
  io::writeCsv(folder / (result.test->name + ".csv"), mean, io::provenance());
  io::writeCsv(folder / (result.test->name + "_cells.csv"), cells, io::provenance());
}

report::Figure curveFigure(const TestResult& result, const std::string& column, const std::string& label) {
  const Spread strain = spreadOf(result, columnNamed("strain")), values = spreadOf(result, columnNamed(column));
  report::Figure figure{result.test->name + "_" + column, label, {"strain", false}, {label, false}, {}, {}};
  report::Curve mean{"mean", strain.mean, values.mean}, low{"less the spread", strain.mean, {}},
      high{"with the spread", strain.mean, {}};
  for (std::size_t k = 0; k < values.mean.size(); ++k) {
    low.y.push_back(values.mean[k] - values.deviation[k]);
    high.y.push_back(values.mean[k] + values.deviation[k]);
  }
  figure.curves.push_back(std::move(mean));
  if (result.whole().size() > 1) figure.curves.insert(figure.curves.end(), {std::move(low), std::move(high)});
  return figure;
}

report::Figure secantFigure(const CellBank& bank, const std::string& name, const std::string& label,
                            std::vector<double> rve::SecantModuli::*modulus, double rve::Moduli::*ofTangent) {
  const std::vector<double>& strains = bank.figures.front().secants.strain;
  report::Figure figure{bank.name + "_" + name, label, {"strain", true}, {label, false}, {}, {}};
  report::Curve secant{"secant", strains, {}, true, true};
  for (std::size_t k = 0; k < strains.size(); ++k)
    secant.y.push_back(1e-6 * meanOf(valuesOf(bank, [&](const CellFigures& f) { return (f.secants.*modulus)[k]; })));
  figure.curves.push_back(std::move(secant));
  const auto level = [&](const char* words, rve::Moduli CellFigures::*tangent) {
    const double value = 1e-6 * meanOf(valuesOf(bank, [&](const CellFigures& f) { return f.*tangent.*ofTangent; }));
    figure.curves.push_back({words, {strains.front(), strains.back()}, {value, value}});
  };
  level("elastic tangent", &CellFigures::elastic);
  level("frictional tangent", &CellFigures::frictional);
  level("Voigt tangent", &CellFigures::voigt);
  return figure;
}

std::string failuresOf(const TestResult& result) {
  std::string text;
  for (std::size_t k = 0; k < result.courses.size(); ++k)
    if (const std::string& failure = result.courses[k].failure; !failure.empty())
      text += format("cell %zu went no further: ", k) + failure + "\n";
  return text;
}

report::Page pageOf(const CellPlan& plan, const CellResults& results, const std::vector<std::string>& shown) {
  report::Page page{plan.title.empty() ? "Cells" : plan.title, {}};
  for (const CellBank& bank : results.banks) {
    report::Section section{"Cells " + bank.name, {tableOf(bank)}};
    if (plan.secants) {
      section.blocks.emplace_back(secantTable(bank));
      section.blocks.emplace_back(secantFigure(bank, "bulk", "K (MPa)", &rve::SecantModuli::bulk, &rve::Moduli::bulk));
      section.blocks.emplace_back(
          secantFigure(bank, "shear", "G (MPa)", &rve::SecantModuli::shear, &rve::Moduli::shear));
    }
    page.sections.push_back(std::move(section));
  }
  for (const TestResult& result : results.tests) {
    report::Section section{"Test " + result.test->name, {}};
    if (const std::string failures = failuresOf(result); !failures.empty())
      section.blocks.emplace_back(report::Paragraph{failures});
    if (!result.whole().empty()) {
      section.blocks.emplace_back(tableOf(result));
      const bool sheared = result.test->kind == TestKind::shear;
      for (const auto& [column, label] : std::vector<std::pair<std::string, std::string>>{
               {"stress_ratio", "(σ₁ − σ₃)/(σ₁ + σ₃)"},
               {"volumetric_strain", "volumetric strain, compression > 0"},
               {"pressure_Pa", "pressure (Pa)"},
               {sheared ? "sigma_xy_Pa" : "sliding_fraction", sheared ? "σ₁₂ (Pa)" : "fraction of contacts that slide"},
               {"coordination", "contacts per grain"}})
        section.blocks.emplace_back(curveFigure(result, column, label));
      for (const std::string& column : shown) section.blocks.emplace_back(curveFigure(result, column, column));
    }
    page.sections.push_back(std::move(section));
  }
  return page;
}

Json jsonOf(const std::vector<double>& values) {
  Json list = Json::array();
  for (const double value : values) list.push_back(report::numberOrNull(value));
  return list;
}

Json jsonOf(const CellPlan& plan, const CellResults& results) {
  Json json = report::objectOf(io::provenance());
  json["title"] = plan.title;
  json["seconds"] = results.seconds;
  for (const CellBank& bank : results.banks) {
    Json& one = json["cells"][bank.name];
    one["number"] = bank.cells.size();
    one["grains"] = bank.cells.front().size();
    one["file"] = bank.file.filename().string();
    one["reused"] = bank.reused;
    for (const FigureKind& kind : figureKinds) one[kind.name] = jsonOf(valuesOf(bank, kind.value, kind.scale));
    for (const CellFigures& figures : bank.figures)
      if (plan.secants)
        one["secants"].push_back({{"strain", jsonOf(figures.secants.strain)},
                                  {"bulk_Pa", jsonOf(figures.secants.bulk)},
                                  {"shear_Pa", jsonOf(figures.secants.shear)}});
  }
  for (const TestResult& result : results.tests) {
    Json& one = json["tests"][result.test->name];
    for (const TestNumber& number : numbersOf(result)) {
      if (number.values.empty()) continue;
      one[number.name] = {{"unit", number.unit},
                          {"mean", report::numberOrNull(meanOf(number.values))},
                          {"spread", report::numberOrNull(deviationOf(number.values))},
                          {"cells", jsonOf(number.values)}};
    }
    one["failures"] = Json::array();
    for (std::size_t k = 0; k < result.courses.size(); ++k)
      if (!result.courses[k].failure.empty())
        one["failures"].push_back({{"cell", k}, {"why", result.courses[k].failure}});
  }
  return json;
}

std::string textOf(const CellPlan& plan, const CellResults& results) {
  std::string text = plan.title.empty() ? "" : plan.title + "\n\n";
  for (const CellBank& bank : results.banks) {
    text +=
        format("cells \"%s\": %zu of %zu grains\n", bank.name.c_str(), bank.cells.size(), bank.cells.front().size()) +
        textOf(tableOf(bank));
    if (plan.secants) text += "  secant moduli: strain, K and G in MPa\n" + textOf(secantTable(bank));
    text += "\n";
  }
  for (const TestResult& result : results.tests) {
    text += format("test \"%s\": %zu of %zu cells to the end\n", result.test->name.c_str(), result.whole().size(),
                   result.courses.size()) +
            failuresOf(result) + (result.whole().empty() ? "" : textOf(tableOf(result))) + "\n";
  }
  return text + format("%.1f s in all\n", results.seconds);
}

}  // namespace

std::vector<std::string> cellFiles(const CellPlan& plan) {
  std::vector<std::string> files{"cells.txt", "cells.json", "report.html", "report.md"};
  for (const CellTest& test : plan.tests)
    for (const char* const ending : {".csv", "_cells.csv"}) files.push_back(test.name + ending);
  return files;
}

std::string writeCellFiles(const CellPlan& plan, const CellResults& results, const std::filesystem::path& folder,
                           const std::vector<std::string>& shown) {
  const std::string text = textOf(plan, results);
  for (const TestResult& result : results.tests)
    if (!result.whole().empty()) writeCurves(result, folder);
  io::writeFileAtomically(folder / "cells.txt", io::provenanceLines(io::provenance(), "# ") + "\n" + text);
  io::writeFileAtomically(folder / "cells.json", jsonOf(plan, results).dump(1) + "\n");
  report::writePage(folder, pageOf(plan, results, shown));
  return text;
}

}  // namespace dovetail::program
