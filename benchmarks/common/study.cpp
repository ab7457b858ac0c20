#include "common/study.hpp"

#include <algorithm>

#include "dovetail/core/error.hpp"

namespace dovetail::benchmark {

namespace {

using report::Json;

/// What options say: those of a run itself, of its points, and what no run of a study takes.
class Words {
public:
  void set(const std::string& option, const Json& value) {
    std::erase_if(all_, [&](const auto& one) { return one.first == option; });
    if (!value.is_null()) all_.emplace_back(option, value.is_string() ? value.get<std::string>() : value.dump());
  }
  void set(const Json& options) {
    for (const auto& [option, value] : options.items()) set("--" + option, value);
  }
  std::vector<std::string> commandLine() const {
    std::vector<std::string> words;
    for (const auto& [option, value] : all_) {
      words.push_back(option);
      if (value != "true") words.push_back(value);
    }
    return words;
  }

private:
  io::KeyValues all_;
};

void addProduct(const Json& axes, std::size_t axis, const std::string& label, const Words& words,
                std::vector<PlannedRun>& runs) {
  if (axis == axes.size()) return void(runs.push_back({label, words.commandLine()}));
  for (const auto& [name, options] : axes[axis].items()) {
    Words more = words;
    more.set(options);
    addProduct(axes, axis + 1, label + (label.empty() || name.empty() ? "" : ", ") + name, more, runs);
  }
}

}  // namespace

std::vector<PlannedRun> plannedRuns(const std::string& file, const RunOptions& asked) {
  const Json study = Json::parse(file).at(asked.study);
  Words words;
  words.set(study.value("defaults", Json::object()));
  for (const auto& [option, value] : asked.written) words.set(option, Json(value));
  for (const char* const option : {"--out", "--only", "--workers"}) words.set(option, nullptr);
  std::vector<PlannedRun> all, runs;
  for (const Json& axes : study.at("runs")) addProduct(axes, 0, "", words, all);
  const bool isLabel = std::ranges::any_of(all, [&](const auto& one) { return one.label == asked.only; });
  for (PlannedRun& one : all)
    if (isLabel ? one.label == asked.only : one.label.find(asked.only) != std::string::npos)
      runs.push_back(std::move(one));
  if (runs.empty())
    throw InputError("no run of the study has this label: " + asked.only, "--only",
                     "take a label as the study prints it, such as '" + all.front().label + "'");
  return runs;
}

report::Study studyFrom(const std::string& file, const std::string& program, const RunOptions& asked) {
  const Json json = Json::parse(file);
  report::Study study;
  study.program = program;
  study.name = asked.study;
  study.folder = asked.out.empty() ? "." : asked.out;
  study.workers = asked.workers;
  study.quiet = asked.quiet;
  for (const auto& [figure, mark] : json.at("fronts").items()) study.fronts.push_back({figure, mark});
  study.shown = json.at("shown").get<std::vector<std::string>>();
  study.about = json.value("about", Json::object());
  return study;
}

}  // namespace dovetail::benchmark
