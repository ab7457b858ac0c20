#include "output_cost.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <ostream>

#include "build/parts.hpp"
#include "build/sizes.hpp"
#include "cell_fields.hpp"
#include "dovetail/core/finite.hpp"
#include "dovetail/dem/model/loads.hpp"
#include "dovetail/dem/model/sample.hpp"
#include "dovetail/dem/model/walls.hpp"
#include "point_fields.hpp"

namespace dovetail::scene {

namespace {

/// Of all stages that run for a time, s.
double timeOf(const Scene& scene) {
  double time = 0.0;
  for (const Stage& stage : scene.stages)
    if (const auto* const run = std::get_if<RunFor>(&stage.kind)) time += run->time;
  return time;
}

/// @param every  macro steps between two; 0: none
std::int64_t timesWritten(const Plan& plan, const Scene& scene, std::int64_t every) {
  if (every == 0) return 0;
  std::int64_t count = 1;
  for (std::size_t k = 0; k < plan.stages.size(); ++k)
    if (const auto* const statics = std::get_if<Statics>(&scene.stages[k].kind))
      count += statics->time || statics->arcLength ? plan.stages[k] : 1;
    else if (!std::holds_alternative<FindModes>(scene.stages[k].kind))
      count += std::holds_alternative<Relax>(scene.stages[k].kind) ? 1 : (plan.stages[k] + every - 1) / every;
  return count;
}

// ---- bytes of a frame: numbers of eight, as they lie in files of VTK

constexpr double number = 8.0, vector = 3.0 * number, cell = 2.0 * number + 1.0, line = 2.0 * vector + 3.0 * number;

constexpr double grain = 2.0 * vector + 2.0 * number + cell, force = vector + 4.0 * number;
constexpr double touching = 2.0;  // contacts a grain of a bed

double bytesOfGrains(const dem::Model& grains, double count, const std::vector<std::string>& contents) {
  const auto has = [&](const char* word) { return std::ranges::find(contents, word) != contents.end(); };
  double each = has("grains") ? grain : 0.0;
  for (const auto& [word, bytes] : {std::pair{"spin", vector}, {"forces", vector}, {"weights", number}})
    if (has(word)) each += bytes;
  double bytes = each * count;
  if (has("contacts"))
    bytes += (line + force) * std::max(static_cast<double>(dem::sampleContacts(grains).size()), touching * count);
  if (has("bonds"))
    for (const auto* const term : grains.terms.all<dem::BondTerm>())
      bytes += (line + force + number) * static_cast<double>(term->bonds.size());
  if (has("walls"))
    for (const auto* const term : grains.terms.all<dem::MeshWallTerm>()) {
      const dem::TriangulatedWall& wall = term->mesh.wall;
      bytes += vector * static_cast<double>(wall.x.size()) +
               (2.0 * vector + 2.0 * number) * static_cast<double>(wall.facets.size());
    }
  return bytes;
}

double bytesOfCells(const Built& built, const Output& output) {
  const auto has = [&](const char* word) { return std::ranges::find(output.contents, word) != output.contents.end(); };
  double bytes = 0.0;
  for (const CellPoint& shown : shownCells(built, output))
    visit(shown, [&](const rve::Rve& rve) {
      bytes += (grain + (has("spin") ? vector : 0.0)) * static_cast<double>(rve.radius.size());
      if (has("contacts")) bytes += (line + force) * touching * static_cast<double>(rve.radius.size());
    });
  return bytes;
}

double bytesOfSolids(const Built& built, const std::vector<std::string>& contents) {
  const auto has = [&](const char* word) { return std::ranges::find(contents, word) != contents.end(); };
  const double values = (has("stress") ? 11.0 * number : 0.0) + (has("strain") ? 14.0 * number : 0.0) +
                        (has("cells") ? 12.0 * number : 0.0) + (has("history") ? 2.0 * number : 0.0);
  double bytes = 0.0;
  if (has("points"))
    for (std::size_t s = 0; s < built.meshes.size(); ++s)
      bytes += (2.0 * vector + 10.0 * number + cell + values) *
               static_cast<double>(pointsOf(*built.run->solid(s).model).size());
  if (!has("solids")) return bytes;
  // Packed by zlib, which makes little of shapes that repeat and values that are smooth.
  constexpr double packed = 0.75;
  for (const fem::SolidMesh& mesh : built.meshes) {
    const auto nodes = static_cast<double>(mesh.X.size());
    bytes += mesh.groups.empty() ? (3.0 * vector + number + cell + values) * nodes  // material points
                                 : packed * (2.0 * vector * nodes + values * static_cast<double>(mesh.elementCount()));
  }
  return bytes;
}

struct Frames {
  std::int64_t count = 0;
  double bytesEach = 0.0;
  double bytes() const { return static_cast<double>(count) * bytesEach; }
};

Frames framesOf(const Built& built, const Scene& scene, const Plan& plan) {
  const dem::Model& grains = built.run->grains;
  auto count = static_cast<double>(countOfGrains(grains.particles));
  for (const Insertion& one : scene.insertions) count += 0.5 * expectedIn(one, timeOf(scene));
  constexpr double head = 2000.0;
  // A stage in which no time passes replaces the frame before.
  const auto replaced = std::ranges::count_if(scene.stages, [](const Stage& stage) {
    const auto* const statics = std::get_if<Statics>(&stage.kind);
    return statics && !statics->time && !statics->arcLength;
  });
  return {timesWritten(plan, scene, plan.frames) - (plan.frames > 0 ? replaced : 0),
          head + bytesOfGrains(grains, count, scene.output.contents) + bytesOfCells(built, scene.output) +
              bytesOfSolids(built, scene.output.contents)};
}

std::string room(double bytes) {
  if (bytes < 1e6) return rounded(bytes / 1e3) + " kB";
  return bytes < 1e9 ? rounded(bytes / 1e6) + " MB" : rounded(bytes / 1e9) + " GB";
}

// ---- outputs that say nothing

void lookAtIntervals(const Scene& scene, double macroStep, Lines& lines) {
  struct Asked {
    const char *key, *what;
    const std::optional<double>& interval;
  };
  const Output& out = scene.output;
  const double time = timeOf(scene);
  if (!(macroStep < time)) return;
  for (const Asked& one : {Asked{"series", "row", out.series}, Asked{"frames", "frame", out.frames},
                           Asked{"checkpoints", "checkpoint", out.checkpoints}})
    if (one.interval && *one.interval < 0.9 * macroStep)
      lines.push_back("output." + std::string(one.key) + " requests a " + one.what + " every " +
                      rounded(*one.interval) + " s, which is shorter than a macro step (" + rounded(macroStep) +
                      " s), and gets one per macro step: take a larger interval, such as " +
                      rounded(std::max(time / 200.0, macroStep)) + " s.");
}

void lookAtContents(const Built& built, const Scene& scene, Lines& lines) {
  const Output& out = scene.output;
  if (out.contents == Output{}.contents) return;
  if (!out.frames)
    return lines.push_back(
        "output.contents is given and output.frames is not, so that nothing of it is written: give output.frames an "
        "interval, or leave contents out.");
  if (out.contents.empty())
    lines.push_back(
        "output.contents is empty, so that frames hold nothing: name parts, such as \"grains\", or leave "
        "contents or frames out.");
  struct Part {
    const char *word, *missing;
    bool isThere;
  };
  const dem::Model& grains = built.run->grains;
  const bool anyGrains = countOfGrains(grains.particles) > 0 || !scene.insertions.empty();
  const auto isOverlap = [](const Coupling& one) { return std::holds_alternative<Overlap>(one.kind); };
  const auto flows = [](const Solid& one) {
    return std::ranges::any_of(materialsOf(one), [](const SolidMaterial* material) { return yields(*material); });
  };
  for (const Part& part :
       {Part{"weights", "overlap", std::ranges::any_of(scene.couplings, isOverlap)},
        Part{"history", "solid that yields", std::ranges::any_of(scene.solids, flows)},
        Part{"cells", "solid of cells", !scene.cells.empty()}, Part{"grains", "grains", anyGrains},
        Part{"contacts", "grains", anyGrains || !out.cells.empty()}, Part{"bonds", "bonds", !scene.bonds.empty()},
        Part{"solids", "solids", !built.meshes.empty()}, Part{"points", "solids", !built.meshes.empty()},
        Part{"walls", "wall that is a mesh", !grains.terms.all<dem::MeshWallTerm>().empty()}})
    if (!part.isThere && std::ranges::find(out.contents, part.word) != out.contents.end())
      lines.push_back("output.contents has " + quoted(part.word) + ", and the scene has no " + part.missing +
                      ": leave it out.");
}

void lookAtTimes(const Scene& scene, double macroStep, Lines& lines) {
  constexpr std::int64_t few = 10;
  for (std::size_t k = 0; k < scene.stages.size(); ++k) {
    const std::string of = "stages." + std::to_string(k);
    if (const auto* const run = std::get_if<RunFor>(&scene.stages[k].kind); run && run->time < 0.5 * macroStep)
      lines.push_back(of + ".time is " + rounded(run->time) + " s, and a step " + rounded(macroStep) +
                      " s: it runs for one; give it a longer time, or check its unit.");
    if (const auto* const relax = std::get_if<Relax>(&scene.stages[k].kind); relax && relax->macroSteps < few)
      lines.push_back(of + ".macro_steps is " + std::to_string(relax->macroSteps) +
                      ", and nothing comes to rest in so few steps: take some ten thousand.");
  }
}

void lookAtRates(const Scene& scene, Lines& lines) {
  const double time = timeOf(scene);
  const bool relaxes =
      std::ranges::any_of(scene.stages, [](const Stage& stage) { return std::holds_alternative<Relax>(stage.kind); });
  for (std::size_t k = 0; k < scene.insertions.size() && time > 0.0; ++k) {
    const Insertion& one = scene.insertions[k];
    const std::string name = "insertions." + std::to_string(k);
    const double total = totalOf(one), count = expectedIn(one, time);
    if (one.from >= time && !relaxes)
      lines.push_back(name + " begins at " + rounded(one.from) + " s, and the run ends at " + rounded(time) +
                      " s: let it begin earlier, or run for longer.");
    else if (one.replacesLeavers)
      continue;
    else if (count < 1.0)
      lines.push_back(name + " inserts only " + rounded(count) + " grains in " + rounded(time) +
                      " s: give it a rate above " + rounded(1.0 / time) + " per second, or run for longer.");
    else if (std::isfinite(total) && count < 0.99 * total)
      lines.push_back(name + " inserts only " + rounded(count) + " of its " + rounded(total) +
                      " grains by the end: give it a higher rate, or more time.");
  }
}

}  // namespace

void reportOutput(const Built& built, const Scene& scene, const Plan& plan, std::ostream& log) {
  for (std::size_t k = 0; k < scene.insertions.size(); ++k)
    if (scene.insertions[k].replacesLeavers)
      log << "insertions." << k << ": as many grains enter as leave, where there is room\n";
    else
      log << "insertions." << k << ": about " << rounded(expectedIn(scene.insertions[k], timeOf(scene)))
          << " grains enter in " << timeOf(scene) << " s, where there is room\n";
  if (plan.series > 0) log << "series: " << timesWritten(plan, scene, plan.series) << " rows\n";
  if (plan.frames == 0) return;
  const Frames frames = framesOf(built, scene, plan);
  log << "frames: " << frames.count << " of about " << room(frames.bytesEach) << ", " << room(frames.bytes())
      << " on disk\n";
}

void lookAtOutput(const Built& built, const Scene& scene, Lines& lines) {
  constexpr std::int64_t many = 10000;
  const Plan plan = planOf(built, scene);
  const Frames frames = framesOf(built, scene, plan);
  if (frames.count > many)
    lines.push_back("output.frames requests " + std::to_string(frames.count) + " frames" +
                    (plan.frames == 1 ? ", one at every macro step" : "") + ", " + room(frames.bytes()) +
                    " on disk: take a larger interval, such as " + rounded(timeOf(scene) / 200.0) + " s.");
  else
    lookAtIntervals(scene, built.run->macroStep(), lines);
  lookAtContents(built, scene, lines);
  lookAtTimes(scene, built.run->macroStep(), lines);
  lookAtRates(scene, lines);
  std::error_code error;
  const auto free = std::filesystem::space(std::filesystem::current_path(error), error);
  if (!error && frames.bytes() > static_cast<double>(free.available))
    lines.push_back("The frames take about " + room(frames.bytes()) + ", and " +
                    room(static_cast<double>(free.available)) +
                    " are free on the disk of this folder: take a larger output.frames, or leave some of the contents "
                    "out.");
}

}  // namespace dovetail::scene
