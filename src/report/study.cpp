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
#include "dovetail/report/front.hpp"
#include "dovetail/report/page.hpp"
#include "dovetail/report/text.hpp"

namespace dovetail::report {

namespace {

Json rowOf(const StudyCase& one, const std::string& outcome, const std::string& message, const Json& figures) {
  Json row{{"label", one.label}, {"outcome", outcome}, {"message", message}};
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

double numberIn(const Json& row, const std::string& key) {
  return row.contains(key) && row[key].is_number() ? row[key].get<double>() : std::nan("");
}

bool finished(const Json& row) { return row["outcome"] == "finished"; }

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
      Json row = attempt(study_.cases[k]);
      if (io::interruption() != 0) return false;
      take(k, std::move(row));
    }
    return true;
  }

  bool inProcesses() {
    bool told = false;
    for (std::size_t next = 0; next < rows_.size() || !working_.empty();) {
      const int signal = io::interruption();
      if (signal != 0 && !std::exchange(told, true))
        for (const auto& [process, work] : working_) ::kill(process, signal);
      if (signal != 0 && working_.empty()) return false;
      while (signal == 0 && next < rows_.size() && working_.size() < static_cast<std::size_t>(study_.workers))
        begin(next++);
      if (!collect()) study_.wait ? study_.wait() : void(::usleep(5000));
    }
    return io::interruption() == 0;
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
    std::vector<Json> rows;
    for (const Json& one : rows_)
      if (!one.is_null()) rows.push_back(one);
    for (const Study::Front& front : study_.fronts) mark(rows, front);
    if (!study_.quiet) print(rows_[number]);
    write(rows);
  }

  static void mark(std::vector<Json>& rows, const Study::Front& front) {
    const auto on = onFront(
        rows, finished, [](const Json& r) { return numberIn(r, "wall_seconds"); },
        [&](const Json& r) { return std::abs(numberIn(r, front.error)); });
    for (std::size_t k = 0; k < rows.size(); ++k) {
      const Json settings = rows[k]["settings"];
      rows[k].erase("settings");  // stay last
      rows[k][front.mark] = static_cast<bool>(on[k]);
      rows[k]["settings"] = settings;
    }
  }

  void print(const Json& row) const {
    log_ << format("%-56s %-10s", row["label"].get<std::string>().c_str(), row["outcome"].get<std::string>().c_str());
    if (row["outcome"] != "refused") log_ << format(" %8.3f s", numberIn(row, "wall_seconds"));
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
      add(numberIn(row, "wall_seconds"));
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
    json["runs"] = rows;
    io::writeFileAtomically(file(".json"), json.dump(2) + "\n");
    Page page{study_.name == "study" ? "Study" : "Study " + study_.name, {{"Runs", {table(rows)}}}};
    if (!study_.fronts.empty()) {
      page.sections.push_back({"Error against run time", {frontFigure(rows, study_.fronts.front(), study_.name)}});
      io::writeFileAtomically(file(".svg"),
                              "<!-- " + provenance.front().second + " -->\n" + svgFileOf(*figuresOf(page).front()));
    }
    io::writeFileAtomically(file(".md"), "<!-- " + provenance.front().second + " -->\n\n" + markdownOf(page, ""));
  }

  const Study& study_;
  std::ostream& log_;
  std::vector<Json> rows_;
  Progress progress_;
  std::map<pid_t, Work> working_;
  std::size_t done_ = 0;
};

}  // namespace

Figure frontFigure(const std::vector<Json>& rows, const Study::Front& front, const std::string& name) {
  Figure figure{name, front.error + " against run time", {"run time (s)", true}, {"|" + front.error + "|", true}, {},
                {}};
  Curve all{"runs", {}, {}, false, true}, best{"front", {}, {}, true, true};
  std::vector<std::pair<double, double>> on;
  for (const Json& row : rows) {
    if (!finished(row)) continue;
    const double seconds = numberIn(row, "wall_seconds"), error = std::abs(numberIn(row, front.error));
    all.x.push_back(seconds);
    all.y.push_back(error);
    if (row.value(front.mark, false)) on.emplace_back(seconds, error);
  }
  std::sort(on.begin(), on.end());
  for (const auto& [seconds, error] : on) {
    best.x.push_back(seconds);
    best.y.push_back(error);
  }
  figure.curves = {std::move(all), std::move(best)};
  return figure;
}

std::vector<std::string> filesOf(const Study& study) {
  std::vector<std::string> files{study.name + ".csv", study.name + ".json", study.name + ".md"};
  if (!study.fronts.empty()) files.push_back(study.name + ".svg");
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
