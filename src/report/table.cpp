#include "dovetail/report/table.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <sstream>

#include "dovetail/core/finite.hpp"
#include "dovetail/report/text.hpp"

namespace dovetail::report {

Json objectOf(const io::KeyValues& rows) {
  Json json = Json::object();
  for (const auto& [key, value] : rows) json[key] = value;
  return json;
}

Json numberOrNull(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

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
  io::KeyValues head;
  for (const Json& entry : entries)
    if (io::KeyValues fields = flattened(entry); fields.size() > head.size()) head = std::move(fields);
  for (const Json& entry : entries)
    for (const auto& field : flattened(entry))
      if (std::ranges::find(head, field.first, &io::KeyValues::value_type::first) == head.end()) head.push_back(field);
  std::ostringstream csv;
  csv << io::provenanceLines(provenance, "# ");
  const auto line = [&](auto part) {
    for (std::size_t k = 0; k < head.size(); ++k) csv << (k == 0 ? "" : ",") << part(head[k].first);
    csv << '\n';
  };
  if (!entries.empty()) line([](const std::string& name) { return name; });
  for (const Json& entry : entries) {
    std::map<std::string, std::string> fields;
    for (auto& [name, value] : flattened(entry)) fields.emplace(name, std::move(value));
    line([&](const std::string& name) { return fields.contains(name) ? fields[name] : "nan"; });
  }
  return csv.str();
}

std::string textOf(const Json& value) {
  if (value.is_string()) return value.get<std::string>();
  if (value.is_boolean()) return value.get<bool>() ? "yes" : "no";
  if (value.is_number_float()) return formatNumber(value.get<double>());
  return value.is_number() ? value.dump() : "";
}

}  // namespace dovetail::report
