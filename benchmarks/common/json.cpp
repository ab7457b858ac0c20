#include "common/json.hpp"

#include <cmath>
#include <sstream>

#include "common/text.hpp"
#include "dovetail/core/finite.hpp"

namespace dovetail::benchmark {

Json objectOf(const io::KeyValues& rows) {
  Json json = Json::object();
  for (const auto& [key, value] : rows) json[key] = value;
  return json;
}

Json numberOrNull(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

Json ledgerAsJson(const EnergyLedger& ledger) {
  Json json = Json::array();
  for (const auto& channel : ledger.channels())
    json.push_back({{"channel", channel.name},
                    {"kind", channel.kind == EnergyLedger::Kind::booked ? "booked" : "stored"},
                    {"at_opening_J", channel.joulesAtOpening},
                    {"at_end_J", channel.joules}});
  return json;
}

Json profileAsJson(const Profile& profile) {
  Json json = Json::array();
  for (const auto& row : profile.rows())
    json.push_back({{"stage", row.name}, {"seconds", row.seconds}, {"calls", row.calls}});
  return json;
}

namespace {

std::string field(const Json& value) {
  if (value.is_null()) return "nan";
  if (value.is_boolean()) return value.get<bool>() ? "1" : "0";
  if (value.is_number_float()) return formatNumber(value.get<double>());
  return value.is_string() ? quoted(value.get<std::string>()) : value.dump();
}

io::KeyValues flattened(const Json& entry) {
  io::KeyValues fields;
  for (const auto& [name, value] : entry.items()) {
    if (!value.is_object()) {
      fields.emplace_back(name, field(value));
      continue;
    }
    for (const auto& [inner, part] : value.items())
      fields.emplace_back(name == "settings" ? inner : name + "_" + inner, field(part));
  }
  return fields;
}

}  // namespace

std::string csvOf(const std::vector<Json>& entries, const io::KeyValues& provenance) {
  std::ostringstream csv;
  csv << io::provenanceLines(provenance, "# ");
  for (std::size_t row = 0; row < entries.size(); ++row) {
    const io::KeyValues fields = flattened(entries[row]);
    const auto line = [&](auto part) {
      for (std::size_t k = 0; k < fields.size(); ++k) csv << (k == 0 ? "" : ",") << part(fields[k]);
      csv << '\n';
    };
    if (row == 0) line([](const auto& f) { return f.first; });
    line([](const auto& f) { return f.second; });
  }
  return csv.str();
}

}  // namespace dovetail::benchmark
