#include "summary.hpp"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <sstream>

#include "dovetail/core/finite.hpp"
#include "dovetail/io/output_folder.hpp"
#include "dovetail/scene/read.hpp"
#include "series.hpp"

namespace dovetail::scene {

namespace {

using Json = nlohmann::ordered_json;

Json listOf(const Vec3& v) { return Json::array({v.x, v.y, v.z}); }
Json momentaOf(const Momenta& m) { return {{"linear_Ns", listOf(m.linear)}, {"angular_Nms", listOf(m.angular)}}; }

Json solidsOf(const Built& built) {
  Json list = Json::array();
  for (std::size_t s = 0; s < built.meshes.size(); ++s)
    list.push_back({{"name", built.run->solid(s).name},
                    {"nodes", built.meshes[s].X.size()},
                    {"elements", built.meshes[s].elementCount()}});
  return list;
}

Json stepOf(coupling::CoupledRun& run) {
  const coupling::StepLimit limit = run.criticalStep();
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

Json energyOf(const EnergyLedger& ledger) {
  Json channels = Json::object();
  for (const EnergyLedger::Channel& channel : ledger.channels())
    channels[channel.name] = {{"kind", channel.kind == EnergyLedger::Kind::stored ? "stored" : "booked"},
                              {"now_J", channel.joules},
                              {"at_start_J", channel.joulesAtOpening}};
  return {{"channels", channels},
          {"stored_J", ledger.stored()},
          {"booked_J", ledger.booked()},
          {"residual_J", ledger.residual()},
          {"largest_residual_J", ledger.largestResidual()}};
}

Json momentumOf(const coupling::Totals& totals) {
  Json given = Json::object();
  for (const ImpulseBook::Channel& channel : totals.given.channels()) given[channel.name] = momentaOf(channel.given);
  return {{"now", momentaOf({totals.momentum, totals.angularMomentum})},
          {"given_by", given},
          {"residual", momentaOf(totals.residual)},
          {"turned_over_Ns", totals.turnedOver},
          {"turned_over_Nms", totals.turnedOverAngular},
          {"mass_kg", totals.mass},
          {"mass_residual_kg", totals.massResidual}};
}

Json figuresOf(const io::TimeSeries& table) {
  Json figures = Json::object();
  if (table.rows() == 0) return figures;
  for (std::size_t c = 0; c < table.names().size(); ++c) {
    const auto column = table.column(c);
    const auto [least, largest] = std::minmax_element(column.begin(), column.end());
    figures[table.names()[c]] = {
        {"first", column.front()}, {"last", column.back()}, {"least", *least}, {"largest", *largest}};
  }
  return figures;
}

Json timesOf(const RunNotes& notes, const Profile& profile) {
  Json stages = Json::array(), parts = Json::array();
  for (const RunNotes::Stage& stage : notes.stages)
    stages.push_back({{"stage", stage.number}, {"do", stage.what}, {"seconds", stage.seconds}});
  for (const Profile::Row& row : profile.rows())
    parts.push_back({{"part", row.name}, {"seconds", row.seconds}, {"calls", row.calls}});
  return {{"stages", stages}, {"parts", parts}};
}

}  // namespace

std::string writeSummary(const std::filesystem::path& folder, const io::KeyValues& provenance, const Scene& scene,
                         Built& built, const RunNotes& notes, const io::TimeSeries* table) {
  coupling::CoupledRun& run = *built.run;
  std::ostringstream text;
  for (const std::string& line : notes.lines) text << line << '\n';
  coupling::report(run, text);
  const std::string title = scene.title.empty() ? "" : scene.title + '\n';
  std::string told;  // the log has these from the start
  for (const std::string& note : built.notes) told += "NOTE: " + note + '\n';
  io::writeFileAtomically(folder / "summary.txt", io::provenanceLines(provenance, "# ") + title + told + text.str());
  Json json;
  for (const auto& [key, value] : provenance) json["provenance"][key] = value;
  json["title"] = scene.title;
  json["time_s"] = run.time();
  json["particles"] = run.grains.particles.size();
  json["solids"] = solidsOf(built);
  json["insertions"] = insertionsListed(built);
  json["step"] = stepOf(run);
  json["energy"] = energyOf(run.ledger());
  json["momentum"] = momentumOf(run.totals());
  json["figures"] = table ? figuresOf(*table) : Json::object();
  json["times"] = timesOf(notes, run.profile);
  json["notes"] = built.notes;
  json["warnings"] = notes.warnings;
  json["scene"] = Json::parse(sceneText(scene));
  io::writeFileAtomically(folder / "summary.json", json.dump(2) + "\n");
  return title + text.str();
}

}  // namespace dovetail::scene
