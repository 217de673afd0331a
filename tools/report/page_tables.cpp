#include <algorithm>

#include "report/page_content.h"

namespace vmesh::tool {
namespace {

/// What a page shows elsewhere, or what is irrelevant on it.
constexpr const char* kLeftOut[] = {"schema", "generator", "seconds", "slow_pieces", "warnings", "problems", "options"};

bool is_left_out(const std::string& key) {
  return std::find(std::begin(kLeftOut), std::end(kLeftOut), key) != std::end(kLeftOut) || key.ends_with("_s");
}

/// "max_center_distance" -> "max center distance", "radius_mm" -> "radius, mm".
std::string words_of(const std::string& key) {
  constexpr const char* kUnits[] = {"mm2", "mm3", "mm", "J"};
  std::string words = key;
  for (const std::string unit : kUnits) {
    if (!key.ends_with("_" + unit)) continue;
    words.replace(words.size() - unit.size() - 1, unit.size() + 1, ", " + unit);
    break;
  }
  std::replace(words.begin(), words.end(), '_', ' ');
  return words;
}

std::string capitalised(std::string text) {
  if (!text.empty() && text[0] >= 'a' && text[0] <= 'z') text[0] = static_cast<char>(text[0] - 'a' + 'A');
  return text;
}

std::string value_text(const Json& value) {
  if (value.is_null()) return "none";
  if (value.is_boolean()) return value.get<bool>() ? "yes" : "no";
  if (value.is_number_float()) return format_number(value.get<double>());
  if (value.is_string()) return value.get<std::string>();
  return value.dump();
}

bool is_point(const Json& value) {
  return value.is_array() && value.size() == 3 &&
         std::all_of(value.begin(), value.end(), [](const Json& v) { return v.is_number(); });
}

void add_rows(const Json& object, const std::string& prefix, ReportTable& table) {
  for (const auto& [key, value] : object.items()) {
    if (is_left_out(key)) continue;
    const std::string name = prefix + words_of(key);
    if (value.is_object()) {
      add_rows(value, name + ": ", table);
    } else if (is_point(value)) {
      table.rows.push_back({name, value_text(value[0]) + ", " + value_text(value[1]) + ", " + value_text(value[2])});
    } else if (value.is_array()) {
      if (!value.empty()) table.rows.push_back({name, std::to_string(value.size())});
    } else {
      table.rows.push_back({name, value_text(value)});
    }
  }
}

ReportTable property_table(const std::string& key, const std::string& title) {
  return {key, title, {"property", "value"}, {}};
}

}  // namespace

std::vector<ReportTable> tables_of(const Json& summary) {
  Json plain = Json::object();
  std::vector<ReportTable> tables = {property_table("summary", "Summary")};
  for (const auto& [key, value] : summary.items()) {
    if (is_left_out(key)) continue;
    if (!value.is_object()) {
      plain[key] = value;
      continue;
    }
    ReportTable table = property_table(key, capitalised(words_of(key)));
    add_rows(value, "", table);
    if (!table.rows.empty()) tables.push_back(std::move(table));
  }
  add_rows(plain, "", tables.front());
  return tables;
}

}  // namespace vmesh::tool
