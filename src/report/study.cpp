#include "dovetail/report/study.hpp"

#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iostream>
#include <map>

#include "dovetail/core/error.hpp"
#include "dovetail/core/lost_error.hpp"
#include "dovetail/core/progress.hpp"
#include "dovetail/io/interruption.hpp"
#include "dovetail/io/output_folder.hpp"
#include "dovetail/report/figure.hpp"
#include "dovetail/report/page.hpp"
#include "dovetail/report/scaling.hpp"
#include "dovetail/report/text.hpp"
#include "study_points.hpp"

namespace dovetail::report {

namespace {

Json rowOf(const StudyCase& one, const std::string& outcome, const std::string& message, const Json& figures) {
  Json row{{"label", one.label}};
  if (!one.way.empty()) row["way"] = one.way;
  if (!one.point.empty()) row["point"] = one.point;
  row.update({{"outcome", outcome}, {"message", message}});
  row.update(figures);
  row["settings"] = objectOf(one.settings);
  return row;
}

Json attempt(const StudyCase& one) {
  try {
    const Json figures = one.run();
    const bool finished = figures.value("finished", true), stable = figures.value("stable", true);
    return rowOf(one,
                 !finished ? "broke down"
                 : stable  ? "finished"
                           : "not stable",
                 figures.value("failure", ""), figures);
  } catch (const InputError& error) {
    return rowOf(one, "refused", error.what(), Json::object());
  } catch (const LostError&) {
    throw;
  } catch (const std::exception& error) {
    return rowOf(one, "broke down", error.what(), Json::object());
  }
}

/// The runs of a study as they come in.
class Conduct {
public:
  Conduct(const Study& study, std::ostream& log)
      : study_(study),
        log_(log),
        rows_(study.cases.size()),
        progress_("study " + study.name, static_cast<double>(study.cases.size()), !study.quiet) {}

  bool run() {
    const bool all = study_.workers == 0 ? oneByOne() : inProcesses();
    progress_.finish();
    return all;
  }
  std::size_t done() const { return done_; }

private:
  bool oneByOne() {
    for (std::size_t k = 0; k < rows_.size(); ++k) {
      progress_.update(static_cast<double>(k), study_.cases[k].label);
      if (isRefused(k)) continue;
      Json row = attempt(study_.cases[k]);
      if (io::interruption() != 0) return false;
      take(k, std::move(row));
    }
    return true;
  }

  bool inProcesses() {
    bool told = false;
    while (done_ < rows_.size()) {
      const int signal = io::interruption();
      if (signal != 0 && !std::exchange(told, true))
        for (const auto& [process, work] : working_) ::kill(process, signal);
      if (signal != 0 && working_.empty()) return false;
      for (std::size_t k = 0; k < rows_.size() && signal == 0; ++k)
        if (working_.size() < static_cast<std::size_t>(study_.workers) && mayBegin(k) && !isRefused(k)) begin(k);
      if (!collect()) study_.wait ? study_.wait() : void(::usleep(5000));
    }
    return io::interruption() == 0;
  }

  /// Whether a case has not begun, and all is there that it begins with.
  bool mayBegin(std::size_t number) const {
    const auto isDone = [&](std::size_t k) { return !rows_[k].is_null(); };
    return !isDone(number) && std::ranges::all_of(study_.cases[number].after, isDone) &&
           std::ranges::none_of(working_, [&](const auto& one) { return one.second.number == number; });
  }
  /// Takes a row for a case that cannot begin.
  bool isRefused(std::size_t number) {
    for (const std::size_t k : study_.cases[number].after)
      if (!finished(rows_[k])) {
        const std::string why = "it begins with \"" + study_.cases[k].label + "\", which did not finish";
        return take(number, rowOf(study_.cases[number], "refused", why, Json::object())), true;
      }
    return false;
  }

  struct Work {
    std::size_t number;
    std::FILE* answer;  // without a name
  };

  void begin(std::size_t number) {
    std::FILE* const answer = std::tmpfile();
    if (!answer) throw Error("no temporary file can be made", "", "check for free disk space");
    log_.flush();
    std::fflush(nullptr);
    const pid_t process = ::fork();
    if (process < 0) throw Error("no process can be started", "", "take fewer workers");
    if (process == 0) {
      const std::string text = attempt(study_.cases[number]).dump();
      const bool whole = std::fwrite(text.data(), 1, text.size(), answer) == text.size() && std::fflush(answer) == 0;
      ::_exit(whole ? 0 : 1);
    }
    working_.emplace(process, Work{number, answer});
  }

  /// Takes the answers of processes that have ended; false if none has.
  bool collect() {
    bool any = false;
    for (auto at = working_.begin(); at != working_.end();) {
      int status = 0;
      if (::waitpid(at->first, &status, WNOHANG) == 0) {
        ++at;
        continue;
      }
      const StudyCase& one = study_.cases[at->second.number];
      Json row = answerIn(at->second.answer);
      if (row.is_discarded())
        row = rowOf(one, "broke down",
                    WIFSIGNALED(status) ? format("signal %d ended its process", WTERMSIG(status)) : "its process ended",
                    Json::object());
      if (io::interruption() == 0) take(at->second.number, std::move(row));
      at = working_.erase(at);
      any = true;
    }
    return any;
  }

  static Json answerIn(std::FILE* file) {
    std::string text;
    std::rewind(file);
    char part[4096];
    for (std::size_t count; (count = std::fread(part, 1, sizeof part, file)) > 0;) text.append(part, count);
    std::fclose(file);
    return Json::parse(text, nullptr, false);
  }

  void take(std::size_t number, Json row) {
    rows_[number] = std::move(row);
    progress_.update(static_cast<double>(++done_), study_.cases[number].label);
    if (study_.relate) whole_ = study_.relate(rows_);
    std::vector<Json> rows;
    for (const Json& one : rows_)
      if (!one.is_null()) rows.push_back(one);
    for (const Study::Front& front : study_.fronts) mark(rows, front);
    if (!study_.quiet) print(rows_[number]);
    write(rows);
  }

  void mark(std::vector<Json>& rows, const Study::Front& front) const {
    const std::vector<StudyPoint> points = pointsOf(rows, front.error, study_.cost.figure);
    for (Json& row : rows) {
      const Json settings = row["settings"];
      row.erase("settings");  // stay last
      row[front.mark] = hasError(row, front.error) && isOnFront(points, row);
      row["settings"] = settings;
    }
  }
  static bool isOnFront(const std::vector<StudyPoint>& points, const Json& row) {
    return std::ranges::any_of(points, [&](const StudyPoint& point) { return point.onFront && isOf(row, point); });
  }

  void print(const Json& row) const {
    log_ << format("%-56s %-10s", row["label"].get<std::string>().c_str(), row["outcome"].get<std::string>().c_str());
    if (row["outcome"] != "refused") log_ << format(" %8.3f s", numberIn(row, study_.cost.figure));
    for (const std::string& key : study_.shown)
      if (std::isfinite(numberIn(row, key))) log_ << "  " << key << format(" %.3g", numberIn(row, key));
    log_ << "  " << row["message"].get<std::string>() << std::endl;
  }

  Table table(const std::vector<Json>& rows) const {
    Table table{{"run", "outcome", "seconds"}, {}};
    for (const auto& keys : {study_.shown, marks()}) table.head.insert(table.head.end(), keys.begin(), keys.end());
    for (const Json& row : rows) {
      const std::string why = textOf(row["message"]);
      std::vector<std::string> cells{textOf(row["label"]), textOf(row["outcome"]) + (why.empty() ? "" : ": " + why)};
      const auto add = [&](double value) { cells.push_back(std::isfinite(value) ? format("%.4g", value) : ""); };
      add(numberIn(row, study_.cost.figure));
      for (const std::string& key : study_.shown) add(numberIn(row, key));
      for (const std::string& key : marks()) cells.push_back(row.value(key, false) ? "yes" : "");
      table.rows.push_back(std::move(cells));
    }
    return table;
  }
  std::vector<std::string> marks() const {
    std::vector<std::string> marks;
    for (const Study::Front& front : study_.fronts) marks.push_back(front.mark);
    return marks;
  }

  void write(const std::vector<Json>& rows) const {
    const auto file = [&](const char* ending) { return study_.folder / (study_.name + ending); };
    const io::KeyValues provenance = io::provenance();
    io::writeFileAtomically(file(".csv"), csvOf(rows, provenance));
    Json json{{"provenance", objectOf(provenance)}, {"study", study_.name}};  // first: it marks the file as ours
    json.update(study_.about);
    if (whole_.is_object()) json.update(whole_);
    Page page{study_.name == "study" ? "Study" : "Study " + study_.name, {{"Runs", {table(rows)}}}};
    if (!study_.fronts.empty()) {
      const Study::Front& front = study_.fronts.front();
      const std::vector<StudyPoint> points = pointsOf(rows, front.error, study_.cost.figure);
      if (hasWays(points) || hasRepeats(points)) {
        json["points"] = jsonOf(points, study_.cost.figure);
        page.sections.push_back({"Points", {tableOf(points, front)}});
      }
      page.sections.push_back({"Error against " + study_.cost.name, {frontFigure(points, study_, whole_)}});
      io::writeFileAtomically(file(".svg"),
                              "<!-- " + provenance.front().second + " -->\n" + svgFileOf(*figuresOf(page).front()));
    }
    if (!study_.size.empty()) addScaling(page);
    json["runs"] = rows;
    io::writeFileAtomically(file(".json"), json.dump(2) + "\n");
    io::writeFileAtomically(file(".md"), "<!-- " + provenance.front().second + " -->\n\n" + markdownOf(page, ""));
  }

  void addScaling(Page& page) const {
    const std::vector<CostCurve> curves = costCurves(study_, rows_);
    const std::string name = scalingName(study_);
    const Figure figure = scalingFigure(curves, name, study_.size, study_.cost.name);
    page.sections.push_back({"Cost over the size", {figure, breakEvens(curves, study_.size)}});
    io::writeFileAtomically(study_.folder / (name + ".svg"),
                            "<!-- " + io::provenance().front().second + " -->\n" + svgFileOf(figure));
  }

  const Study& study_;
  std::ostream& log_;
  std::vector<Json> rows_;
  Progress progress_;
  std::map<pid_t, Work> working_;
  Json whole_;
  std::size_t done_ = 0;
};

}  // namespace

std::vector<std::string> filesOf(const Study& study) {
  std::vector<std::string> files{study.name + ".csv", study.name + ".json", study.name + ".md"};
  if (!study.fronts.empty()) files.push_back(study.name + ".svg");
  if (!study.size.empty()) files.push_back(scalingName(study) + ".svg");
  return files;
}

bool runStudy(const Study& study, std::ostream& log, std::ostream& error) {
  io::prepareOutputFolder(study.folder, filesOf(study));
  Conduct conduct(study, log);
  if (conduct.run()) return true;
  error << study.program << ": " << io::nameOfInterruption() << "; " << conduct.done() << " of " << study.cases.size()
        << " runs are written" << std::endl;
  return false;
}

}  // namespace dovetail::report
