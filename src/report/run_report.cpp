#include "dovetail/report/run_report.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <map>

#include "dovetail/core/finite.hpp"
#include "dovetail/io/output_folder.hpp"
#include "dovetail/report/text.hpp"

namespace dovetail::report {

namespace {

constexpr std::size_t mostCurves = 8;

double reachOf(std::span<const double> values) {
  double largest = 0.0;
  for (const double value : values)
    if (std::isfinite(value)) largest = std::max(largest, std::abs(value));
  return largest;
}

/// But for round-off.
bool isConstant(std::span<const double> values) {
  const double least = 1e-9 * reachOf(values);
  return std::all_of(values.begin(), values.end(),
                     [&](double value) { return std::abs(value - values.front()) <= least || value != value; });
}

/// Places before which more time passes than usual between rows: there a stage has relaxed, or a run has waited.
std::vector<std::size_t> gapsIn(std::span<const double> time) {
  std::vector<double> steps;
  for (std::size_t k = 1; k < time.size(); ++k) steps.push_back(time[k] - time[k - 1]);
  if (steps.size() < 3) return {};
  std::vector<double> sorted = steps;
  std::nth_element(sorted.begin(), sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2), sorted.end());
  std::vector<std::size_t> gaps;
  for (std::size_t k = 0; k < steps.size(); ++k)
    if (steps[k] > 5.0 * sorted[sorted.size() / 2]) gaps.push_back(k + 1);
  return gaps;
}

/// "plate_kinetic_J" → "plate kinetic"
std::string nameOf(const std::string& column) {
  const std::string unit = io::unitOf(column);
  std::string name = column;
  if (unit != "1") {
    std::string ending = "_" + unit;
    if (const std::size_t slash = ending.find('/'); slash != std::string::npos) ending.replace(slash, 1, "_per_");
    if (name.ends_with(ending)) name.resize(name.size() - ending.size());
  }
  std::replace(name.begin(), name.end(), '_', ' ');
  return name == "limit" ? "largest stable step" : name;
}

/// Title and axis of the columns of a unit that have no figure of their own.
std::pair<std::string, std::string> titleAndAxis(const std::string& unit, const std::vector<std::string>& columns) {
  std::string name = columns.size() == 1 ? nameOf(columns.front()) : "";
  const std::map<std::string, std::pair<std::string, std::string>> several{
      {"1", {"Numbers of grains", "number"}},
      {"m", {"Positions and displacements", "length (m)"}},
      {"m/s", {"Velocities", "velocity (m/s)"}},
      {"rad/s", {"Spins", "spin (rad/s)"}},
      {"s", {"Times", "time (s)"}},
      {"Pa", {"Stresses", "stress (Pa)"}},
      {"Nm", {"Moments", "moment (Nm)"}},
      {"kg", {"Masses", "mass (kg)"}}};
  if (name.empty()) {
    const auto found = several.find(unit);
    return found == several.end() ? std::pair{"Columns in " + unit, unit} : found->second;
  }
  const std::string axis = unit == "1" ? "number" : name + " (" + unit + ")";
  name[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(name[0])));
  return {name, axis};
}

/// The first row of figures: the one at t = 0 stands alone before a stage that relaxes and writes one row at its end.
std::size_t firstShown(const io::TimeSeries& series) {
  const std::vector<std::size_t> gaps = gapsIn(series.column("time_s"));
  return !gaps.empty() && gaps.front() == 1 ? 1 : 0;
}

bool isResidual(const std::string& column) { return column.find("residual") != std::string::npos; }

enum class Zero { asTheyAre, atTheStart };

/// The columns over time, or their changes, largest first where there are too many; nothing if all of them are 0.
void addFigure(std::vector<Block>& blocks, const io::TimeSeries& series, const std::string& name,
               const std::string& title, const std::string& axis, std::vector<std::string> columns,
               Zero zero = Zero::asTheyAre) {
  const std::size_t first = firstShown(series);
  const auto valuesOf = [&](const std::string& column) {
    const auto stored = series.column(column).subspan(first);
    std::vector<double> values(stored.begin(), stored.end());
    if (zero == Zero::atTheStart && !values.empty())
      for (double& value : values) value -= stored.front();
    return values;
  };
  const auto reach = [&](const std::string& column) { return reachOf(valuesOf(column)); };
  // What is round-off beside the others is a line at 0.
  double largest = 0.0;
  for (const std::string& column : columns) largest = std::max(largest, reach(column));
  std::erase_if(columns, [&](const std::string& column) { return reach(column) <= 1e-9 * largest; });
  const bool flat = std::all_of(columns.begin(), columns.end(), [&](const auto& c) { return isConstant(valuesOf(c)); });
  if (columns.empty() || series.rows() < 2 || flat) return;
  if (columns.size() > mostCurves) {
    std::stable_sort(columns.begin(), columns.end(), [&](const auto& a, const auto& b) { return reach(a) > reach(b); });
    columns.resize(mostCurves);
  }
  const auto time = series.column("time_s").subspan(first);
  Figure figure{name, title, {"time (s)"}, {axis}, {}, {}};
  std::vector<std::size_t> gaps = gapsIn(time);
  std::reverse(gaps.begin(), gaps.end());
  for (const std::string& column : columns) {
    Curve curve{nameOf(column), {time.begin(), time.end()}, valuesOf(column)};
    for (const std::size_t gap : gaps)
      for (std::vector<double>* const values : {&curve.x, &curve.y})
        values->insert(values->begin() + static_cast<std::ptrdiff_t>(gap), std::numeric_limits<double>::quiet_NaN());
    figure.curves.push_back(std::move(curve));
  }
  blocks.emplace_back(std::move(figure));
}

/// Figures of a series by unit: stored and booked energies, residual, momenta, forces, and what else there is.
std::vector<Block> figuresOfSeries(const io::TimeSeries& series) {
  std::vector<std::string> energies, residuals, momenta, given;
  std::map<std::string, std::vector<std::string>> others;
  for (const std::string& column : series.names()) {
    const std::string unit = io::unitOf(column);
    if (column == "time_s") continue;
    if (isResidual(column))
      residuals.push_back(column);
    else if (unit == "J")
      energies.push_back(column);
    else if (column.starts_with("momentum"))
      momenta.push_back(column);
    else if (column.starts_with("given"))
      given.push_back(column);
    else
      others[unit].push_back(column);
  }
  std::vector<Block> blocks;
  addFigure(blocks, series, "energies", "Energies, less those at the start", "energy (J)", energies, Zero::atTheStart);
  addFigure(blocks, series, "residual", "Residual of the energy balance", "energy (J)", residuals);
  addFigure(blocks, series, "momenta", "Momentum", "momentum (Ns)", momenta);
  addFigure(blocks, series, "given", "Momentum given from outside", "momentum (Ns)", given);
  addFigure(blocks, series, "forces", "Forces", "force (N)", others["N"]);
  int number = 0;
  for (auto& [unit, columns] : others) {
    std::erase_if(columns, [&](const std::string& column) { return isConstant(series.column(column)); });
    if (unit == "N") continue;
    const auto [title, axis] = titleAndAxis(unit, columns);
    addFigure(blocks, series, "series_" + std::to_string(++number), title, axis, columns);
  }
  return blocks;
}

/// "time_mean_error_m" → "time mean error (m)"; names with blanks stay
std::string labelOf(const std::string& key) {
  if (key.find(' ') != std::string::npos) return key;
  const std::string unit = io::unitOf(key);
  return nameOf(key) + (unit == "1" ? "" : " (" + unit + ")");
}

std::vector<Block> frequenciesOf(const io::TimeSeries& modes) {
  Table table;
  for (const std::string& column : modes.names()) table.head.push_back(labelOf(column));
  for (std::size_t row = 0; row < modes.rows(); ++row) {
    auto& cells = table.rows.emplace_back();
    for (const std::string& column : modes.names()) cells.push_back(format("%.5g", modes.column(column)[row]));
  }
  return {std::move(table)};
}

std::vector<Block> energyBalance(const RunRecord& record) {
  if (record.channels.empty()) return {};
  Table table{{"channel", "at opening (J)", "at the end (J)", "change (J)"}, {}};
  double stored = 0.0, residual = 0.0, atOpening = 0.0;
  const auto add = [&](const std::string& name, double before, double after) {
    table.rows.push_back({name, format("%.5g", before), format("%.5g", after), format("%.5g", after - before)});
  };
  for (const auto& c : record.channels) {
    const bool booked = c.kind == EnergyLedger::Kind::booked;
    if (c.joulesAtOpening != 0.0 || c.joules != 0.0)
      add(c.name + (booked ? " (spent)" : ""), c.joulesAtOpening, c.joules);
    residual += c.joules - c.joulesAtOpening;
    if (booked) continue;
    stored += c.joules;
    atOpening += c.joulesAtOpening;
  }
  add("stored, total", atOpening, stored);
  table.rows.push_back({"residual", "", "", format("%.3g", record.residual.value_or(residual))});
  return {std::move(table)};
}

std::vector<Block> timePerStage(const RunRecord& record) {
  if (record.stages.empty()) return {};
  double all = 0.0;
  for (const auto& stage : record.stages) all += stage.seconds;
  Table table{{"part of a step", "seconds", "fraction", "µs per call"}, {}};
  for (const auto& stage : record.stages)
    table.rows.push_back(
        {stage.name, format("%.4g", stage.seconds), format("%.1f %%", all > 0.0 ? 100.0 * stage.seconds / all : 0.0),
         format("%.4g", stage.calls > 0 ? 1e6 * stage.seconds / static_cast<double>(stage.calls) : 0.0)});
  Figure figure{"stages", "Time per part of a step", {}, {"s"}, {}, {}};
  for (const auto& stage : record.stages) figure.bars.emplace_back(stage.name, stage.seconds);
  return {std::move(figure), std::move(table)};
}

/// Five digits of a number.
std::string shortened(const std::string& value) {
  char* end = nullptr;
  const double number = std::strtod(value.c_str(), &end);
  return value.empty() || *end != '\0' || value.size() < 7 ? value : format("%.5g", number);
}

/// Figures of the summary whose name holds one of the words; they are taken out.
std::vector<Block> take(io::KeyValues& figures, std::initializer_list<const char*> words) {
  Table table{{"figure", "value"}, {}};
  std::erase_if(figures, [&](const auto& figure) {
    const bool fits = words.size() == 0 || std::any_of(words.begin(), words.end(), [&](const char* word) {
                        return figure.first.find(word) != std::string::npos;
                      });
    if (fits) table.rows.push_back({labelOf(figure.first), shortened(figure.second)});
    return fits;
  });
  if (table.rows.empty()) return {};
  return {std::move(table)};
}

std::vector<Block> linesOf(const std::vector<std::string>& lines) {
  std::vector<Block> blocks;
  for (const std::string& line : lines) blocks.emplace_back(Paragraph{line});
  return blocks;
}

}  // namespace

Page pageOf(const RunRecord& record, const Photo& photo) {
  Page page{record.title, {}};
  if (!photo.png.empty()) page.sections.push_back({"Picture", {photo}});
  std::vector<Block> state = linesOf(record.notes);
  if (!record.finished) state.emplace_back(Paragraph{"The run has not finished: there is no summary of it."});
  page.sections.push_back({"Run", std::move(state)});
  page.sections.push_back({"Warnings", linesOf(record.warnings)});
  if (record.series) {
    std::vector<Block> figuresOverTime = figuresOfSeries(*record.series);
    const std::size_t gaps = gapsIn(record.series->column("time_s")).size(), first = firstShown(*record.series);
    if (first > 0)
      figuresOverTime.emplace_back(Paragraph{"Figures begin at the end of the first stage, which relaxes."});
    if (gaps > first)
      figuresOverTime.emplace_back(
          Paragraph{"Lines end where no rows were written: stages that relax have one at their end."});
    page.sections.push_back({"Over time", std::move(figuresOverTime)});
  }
  if (record.modes) page.sections.push_back({"Natural frequencies", frequenciesOf(*record.modes)});
  page.sections.push_back({"Energy balance", energyBalance(record)});
  io::KeyValues figures = record.figures;
  page.sections.push_back({"Balances", take(figures, {"residual"})});
  page.sections.push_back({"Errors against references", take(figures, {"error"})});
  page.sections.push_back({"Time and step", take(figures, {"seconds", "step", "set by", "set_by", "dt_"})});
  page.sections.push_back({"Time per part of a step", timePerStage(record)});
  page.sections.push_back({"More figures", take(figures, {})});
  Table origin{{"entry", "value"}, {}};
  for (const auto& [key, value] : record.provenance) origin.rows.push_back({key, value});
  std::vector<Block> texts;
  if (!origin.rows.empty()) texts.emplace_back(std::move(origin));
  if (!record.summary.empty()) texts.emplace_back(Listing{"Summary", record.summary});
  if (!record.scene.empty()) texts.emplace_back(Listing{"Scene with every key", record.scene});
  page.sections.push_back({"Provenance", std::move(texts)});
  return page;
}

std::filesystem::path writeRunReport(const std::filesystem::path& folder, const Photo& photo) {
  return writePage(folder, pageOf(readRunFolder(folder), photo));
}

}  // namespace dovetail::report
