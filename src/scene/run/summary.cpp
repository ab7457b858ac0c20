#include "summary.hpp"

#include <sstream>

#include "build/parts.hpp"
#include "cell_fields.hpp"
#include "dovetail/io/output_folder.hpp"
#include "dovetail/mpm/point_solid.hpp"
#include "dovetail/report/summary.hpp"
#include "dovetail/scene/read.hpp"
#include "series.hpp"

namespace dovetail::scene {

namespace {

using report::Json;

Json listOf(const Vec3& v) { return Json::array({v.x, v.y, v.z}); }
Json momentaOf(const Momenta& m) { return {{"linear_Ns", listOf(m.linear)}, {"angular_Nms", listOf(m.angular)}}; }

Json solidsOf(const Built& built) {
  Json list = Json::array();
  for (std::size_t s = 0; s < built.meshes.size(); ++s)
    if (const auto* const body = materialPoints(*built.run->solid(s).model))
      list.push_back({{"name", built.run->solid(s).name},
                      {"points", body->rows().points()},
                      {"nodes", body->rows().nodes()},
                      {"renewals", body->renewals()}});
    else
      list.push_back({{"name", built.run->solid(s).name},
                      {"nodes", built.meshes[s].X.size()},
                      {"elements", built.meshes[s].elementCount()}});
  for (std::size_t s = 0; s < list.size(); ++s)
    if (const RepeatedCells cells = repeatedCells(*built.run->solid(s).model); cells.all > 0) {
      list[s]["cells"] = cells.all;
      list[s]["cells_repeated"] = cells.repeated;
      list[s]["most_copies"] = cells.mostCopies;
    }
  for (std::size_t s = 0; s < list.size(); ++s)
    for (const auto& term : built.run->solid(s).model->terms)
      if (const auto* const solid = dynamic_cast<const fem::Solid*>(term.get()); solid && solid->isShared())
        list[s]["ranks"].push_back({{"elements", solid->sizesOnRanks()}});
  for (std::size_t s = 0; s < list.size(); ++s)
    for (const hierarchical::FarmReport* const farm : farmsOf(*built.run->solid(s).model))
      list[s]["ranks"].push_back({{"cells", farm->points},
                                  {"busy_s", farm->busy},
                                  {"evaluations", farm->evaluations},
                                  {"moves", farm->moves},
                                  {"waited_s", farm->waited}});
  return list;
}

Json stepOf(coupling::CoupledRun& run) {
  const StepLimit limit = run.criticalStep();
  return {{"dt_s", run.dt()}, {"window_s", run.macroStep()}, {"limit_s", limit.dt}, {"limited_by", limit.owner}};
}

Json insertionsListed(const Built& built) {
  Json list = Json::array();
  for (const dem::Insertion* const one : insertionsOf(built))
    list.push_back({{"entered", one->inserted},
                    {"entered_kg", one->insertedMass},
                    {"no_room", one->refused},
                    {"no_room_kg", one->refusedMass}});
  return list;
}

Json momentumOf(const coupling::Totals& totals) {
  Json given = Json::object();
  for (const ImpulseLedger::Channel& channel : totals.given.channels()) given[channel.name] = momentaOf(channel.given);
  return {{"now", momentaOf({totals.momentum, totals.angularMomentum})},
          {"given_by", given},
          {"residual", momentaOf(totals.residual)},
          {"turned_over_Ns", totals.turnedOver},
          {"turned_over_Nms", totals.turnedOverAngular},
          {"mass_kg", totals.mass},
          {"mass_residual_kg", totals.massResidual}};
}

Json timesOf(const RunNotes& notes, const Profile& profile) {
  Json times{{"stages", Json::array()}};
  for (const RunNotes::Stage& stage : notes.stages)
    times["stages"].push_back({{"stage", stage.number},
                               {"do", stage.what},
                               {"begins_s", stage.begins},
                               {"seconds", stage.taken.wall},
                               {"processor_seconds", stage.taken.processor}});
  times.update(report::timesOf(profile));
  return times;
}

}  // namespace

std::string writeSummary(const std::filesystem::path& folder, const io::KeyValues& provenance, const Scene& scene,
                         Built& built, const RunNotes& notes, const io::TimeSeries* table) {
  coupling::CoupledRun& run = *built.run;
  std::ostringstream text;
  for (const std::string& line : notes.lines) text << line << '\n';
  coupling::report(run, text);
  for (const std::string& line : linesOnRepeatedCells(run)) text << line << '\n';
  for (const std::string& line : linesOnFarms(run)) text << line << '\n';
  const std::string title = scene.title.empty() ? "" : scene.title + '\n';
  std::string told;  // the log has these from the start
  for (const std::string& note : built.notes) told += "NOTE: " + note + '\n';
  io::writeFileAtomically(folder / "summary.txt", io::provenanceLines(provenance, "# ") + title + told + text.str());
  report::writeSummary(folder / "summary.json", provenance,
                       {{"title", scene.title},
                        {"time_s", run.time()},
                        {"particles", countOfGrains(run.grains.particles)},
                        {"solids", solidsOf(built)},
                        {"insertions", insertionsListed(built)},
                        {"step", stepOf(run)},
                        {"energy", report::energyOf(run.ledger())},
                        {"momentum", momentumOf(run.totals())},
                        {"figures", table ? report::figuresOf(*table) : Json::object()},
                        {"times", timesOf(notes, run.profile)},
                        {"notes", built.notes},
                        {"warnings", notes.warnings},
                        {"scene", Json::parse(sceneText(scene))}});
  return title + text.str();
}

}  // namespace dovetail::scene
