#include "dovetail/report/summary.hpp"

#include <algorithm>

#include "dovetail/core/error.hpp"
#include "dovetail/io/output_folder.hpp"
#include "dovetail/io/plain_text.hpp"

namespace dovetail::report {

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

Json timesOf(const Profile& profile) {
  Json parts = Json::array();
  for (const Profile::Row& row : profile.rows())
    parts.push_back({{"part", row.name}, {"seconds", row.seconds}, {"calls", row.calls}});
  return {{"parts", parts}};
}

Json figuresOf(const io::TimeSeries& series) {
  Json figures = Json::object();
  for (std::size_t c = 0; c < series.names().size() && series.rows() > 0; ++c) {
    const auto column = series.column(c);
    const auto [least, largest] = std::minmax_element(column.begin(), column.end());
    figures[series.names()[c]] = {
        {"first", column.front()}, {"last", column.back()}, {"least", *least}, {"largest", *largest}};
  }
  return figures;
}

void writeSummary(const std::filesystem::path& file, const io::KeyValues& provenance, const Json& parts) {
  Json json{{"provenance", objectOf(provenance)}, {"version", summaryVersion}};  // provenance first: marks it as ours
  json.update(parts);
  io::writeFileAtomically(file, json.dump(2) + "\n");
}

Json readSummary(const std::filesystem::path& file) {
  const Json json = Json::parse(io::readWhole(file, "a summary"), nullptr, false);
  if (!json.is_object() || !json.contains("provenance"))
    throw InputError("this is no summary of a run, or it is damaged", file.string(), "run again");
  if (json.value("version", Json()) != summaryVersion)
    throw InputError("the summary is of another version of Dovetail", file.string(), "run again");
  return json;
}

}  // namespace dovetail::report
