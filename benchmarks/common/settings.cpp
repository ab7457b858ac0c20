#include "common/settings.hpp"

#include "dovetail/core/finite.hpp"

namespace dovetail::benchmark {

void addTimeOptions(program::Options& o, RunOptions& s, const RunWords& words) {
  program::Option& factor =
      o.number("--dt-factor F", s.dtFactor, program::positive("a positive fraction of the contact time, or --dt auto"),
               "time step over the contact time" + words.dtDefault);
  factor.reportAs([&s] {
    if (s.dtAuto) return std::string("auto");
    return s.fractionOfCritical ? formatNumber(*s.fractionOfCritical) + " of critical" : formatNumber(s.dtFactor);
  });
  o.add("--dt auto", words.automaticStep + " of the critical step",
        [&s](const std::string& text) {
          if (text != "auto") throw InputError("there is no '" + text + "'", "--dt", "write auto, or take --dt-factor");
          s.dtAuto = true;
        },
        {});
  o.number("--dt-fraction S", s.fractionOfCritical, program::positive("a positive fraction of the critical step"),
           "time step over the critical step")
      .key = "";
  o.flag("--insist", s.beyondCritical, "also allows a step above the critical one").key = "";
  o.integer("--fem-every K", s.femEvery, 1, 1000, "DEM steps per FEM step");
  o.number("--until T", s.until, program::positive("a positive time in seconds, up to 1e6", 1e6),
           "end, s; default: " + words.endDefault, words.endDefault)
      .in("s");
  o.integer("--threads N", s.threads, 1, 1024, "results do not depend on it");
}

void addOutputOptions(program::Options& o, RunOptions& s, const RunWords& words) {
  o.group("Output, studies", false);
  o.text("--out DIR", s.out, "folder for VTU, PVD, CSV and HDF5 files");
  o.number("--output-interval T", s.outputInterval, program::positive("a positive time in seconds"),
           "time between frames, s");
  o.text("--summary FILE", s.summary, "JSON file of all figures");
  o.word("--study", s.study, words.studies, "a set of runs; tables and figures go to --out");
  o.text("--only TEXT", s.only, "of a study, the run with this label, or those whose labels contain it");
  o.integer("--workers N", s.workers, 0, 1024,
            "processes of a study; 0 (default): one run after the other, for reliable timings");
  o.text("--reference DIR", s.reference, "folder with the published curves (" + words.curves + ")");
  o.flag("--profile", s.profile, "time per stage");
  o.flag("--quiet", s.quiet, "print nothing but errors");
}

void checkRun(const program::Options& o, RunOptions& s) {
  s.written = o.written();
  o.refuseBoth("--dt", "--dt-factor");
  o.refuseBoth("--dt", "--dt-fraction");
  o.refuseBoth("--dt-factor", "--dt-fraction");
  if (!s.study.empty() && !s.summary.empty())
    throw InputError("a study writes its own summary", "--summary", "take --out DIR, which gets <study>.json");
  if (!s.study.empty() && !s.reference.empty())
    throw InputError("a study is not compared with the published curves", "--reference",
                     "leave out --study or --reference");
  if (!s.study.empty())
    o.refuseIdle("--output-interval --profile", "with --study, which writes no pictures", "leave it out");
  if (s.study.empty()) o.refuseIdle("--workers --only", "without --study", "leave it out");
  if (s.out.empty()) o.refuseIdle("--output-interval", "without --out", "add --out DIR, or leave it out");
  if (s.quiet) o.refuseIdle("--reference", "with --quiet", "leave out one of them");
  if (s.quiet && s.summary.empty())
    o.refuseIdle("--profile", "with --quiet and no summary", "add --summary FILE, or leave out one of them");
}

std::vector<std::string> changesOf(const report::Json& entries) {
  std::vector<std::string> changes;
  for (const auto& [key, value] : entries.items()) changes.push_back(key + "=" + value.dump());
  return changes;
}

void require(bool good, const std::string& option, const std::string& value, const std::string& remedy) {
  if (!good) throw InputError("the value " + value + " is not possible", option, remedy);
}

}  // namespace dovetail::benchmark
