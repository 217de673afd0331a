#include <ostream>

#include <nlohmann/json.hpp>

#include "comments.h"
#include "formats.h"
#include "graph_files.h"
#include "slicer_markups.h"
#include "text.h"

namespace vmesh::io {
namespace {

using Json = nlohmann::json;

constexpr const char* kSchema = "vmesh.centerline/1";

class JsonReader {
 public:
  JsonReader(const Json& document, const std::string& source) : document_(document) { raw_.source = source; }

  RawCenterline run() {
    if (!document_.is_object())
      fail("the top level must be an object {\"schema\": \"" + std::string(kSchema) + "\", ...}");
    if (text_of("schema") != kSchema) {
      throw Unsupported(raw_.source + ": the schema is " + cite(text_of("schema")) + "; this version reads \"" +
                        kSchema + "\"");
    }
    read_unit_and_space();
    read_nodes(array_of("nodes"));
    read_segments(array_of("segments"));
    if (document_.contains("end_sections")) read_end_sections(array_of("end_sections"));
    return std::move(raw_);
  }

 private:
  [[noreturn]] void fail(const std::string& what) const { throw InvalidInput(raw_.source + ": " + what); }

  std::string text_of(const char* key) const {
    const auto found = document_.find(key);
    return found != document_.end() && found->is_string() ? found->get<std::string>() : std::string();
  }

  /// Does not print nested lists, which would need stack in proportion to their depth.
  static std::string shown(const Json& value) {
    return value.is_structured() ? std::string("a value in brackets") : cite(value.dump());
  }

  const Json& array_of(const char* key) const {
    const auto found = document_.find(key);
    if (found == document_.end() || !found->is_array())
      fail(std::string("\"") + key + "\" must be an array; it is missing or no array");
    return *found;
  }

  void read_unit_and_space() {
    if (document_.contains("unit")) {
      const auto unit = parse_length_unit(text_of("unit"));
      if (!unit) fail("the unit " + cite(text_of("unit")) + " is not known; use nm, um, mm, cm or m");
      raw_.unit = *unit;
    }
    if (document_.contains("space")) {
      const auto space = parse_space(text_of("space"));
      if (!space) fail("the space " + cite(text_of("space")) + " is not known; use LPS or RAS");
      raw_.space = *space;
    }
  }

  void read_nodes(const Json& nodes) {
    for (const Json& row : nodes) {
      const std::string name = "node " + std::to_string(raw_.nodes.size());
      if (!row.is_array() || row.size() != 4) fail(name + ": it must be [x, y, z, radius]");
      for (const Json& value : row) {
        if (!value.is_number()) fail(name + ": every value of [x, y, z, radius] must be a number");
      }
      raw_.nodes.push_back({{row[0].get<double>(), row[1].get<double>(), row[2].get<double>()}, row[3].get<double>()});
    }
  }

  /// `place`: of the value, for messages.
  Index node_at(const Json& value, const std::string& place) const {
    const bool known = value.is_number_unsigned() && value.get<std::uint64_t>() < raw_.nodes.size();
    if (!known) {
      fail(place + ": " + shown(value) + " is not a node; the nodes are 0 to " +
           std::to_string(static_cast<std::ptrdiff_t>(raw_.nodes.size()) - 1));
    }
    return static_cast<Index>(value.get<std::uint64_t>());
  }

  void read_segments(const Json& segments) {
    for (const Json& row : segments) {
      const std::string name = "segment " + std::to_string(raw_.segments.size());
      if (!row.is_array() || row.size() != 2) fail(name + ": it must be [a, b], two node indices");
      const Index a = node_at(row[0], name);
      raw_.segments.push_back({a, node_at(row[1], name)});
    }
  }

  void read_end_sections(const Json& sections) {
    std::vector<std::size_t> degree(raw_.nodes.size(), 0);
    for (const auto& [a, b] : raw_.segments) {
      ++degree[a];
      ++degree[b];
    }
    for (const Json& entry : sections) {
      const std::string name = "end section " + std::to_string(raw_.end_sections.size());
      if (!entry.is_object()) fail(name + ": it must be an object {\"node\": ..., \"center\": [x, y, z], ...}");
      EndSection section = end_section(entry, name);
      if (degree[section.node] != 1)
        fail(name + ": node " + std::to_string(section.node) + " is no end: it is in " +
             std::to_string(degree[section.node]) + " segments");
      if (const std::string problem = problem_of(section); !problem.empty()) fail(name + ": " + problem);
      raw_.end_sections.push_back(std::move(section));
    }
  }

  EndSection end_section(const Json& entry, const std::string& name) const {
    EndSection section;
    section.node = node_at(member(entry, "node", name), name + ": \"node\"");
    section.center = point(member(entry, "center", name), name + ": \"center\"");
    section.normal = point(member(entry, "normal", name), name + ": \"normal\"");
    const Json& area = member(entry, "area", name);
    if (!area.is_number()) fail(name + ": \"area\": " + shown(area) + " is not a number");
    section.area = area.get<double>();
    const Json& open = member(entry, "open", name);
    if (!open.is_boolean()) fail(name + ": \"open\": " + shown(open) + " is neither true nor false");
    section.open = open.get<bool>();
    if (!entry.contains("ring")) return section;
    const Json& ring = entry["ring"];
    if (!ring.is_array()) fail(name + ": \"ring\": it must be an array of points [x, y, z]");
    for (const Json& p : ring)
      section.ring.push_back(point(p, name + ": \"ring\" point " + std::to_string(section.ring.size())));
    if (ring.empty()) fail(name + ": \"ring\": it needs at least three points; leave it out if it is not known");
    return section;
  }

  const Json& member(const Json& entry, const char* key, const std::string& name) const {
    const auto found = entry.find(key);
    if (found == entry.end()) fail(name + ": \"" + key + "\" is missing");
    return *found;
  }

  Vec3 point(const Json& value, const std::string& place) const {
    if (!value.is_array() || value.size() != 3) fail(place + ": it must be [x, y, z]");
    for (const Json& x : value) {
      if (!x.is_number()) fail(place + ": every value of [x, y, z] must be a number");
    }
    return {value[0].get<double>(), value[1].get<double>(), value[2].get<double>()};
  }

  const Json& document_;
  RawCenterline raw_;
};

std::string string_member(const char* key, const std::string& value) {
  if (value.empty()) return {};
  return "  " + Json(key).dump() + ": " + Json(one_line(value)).dump(-1, ' ', false, Json::error_handler_t::replace) +
         ",\n";
}

std::string text_of(const Vec3& p) {
  std::string text = "[";
  append(text, p.x());
  append(text += ", ", p.y());
  append(text += ", ", p.z());
  return text + "]";
}

std::string text_of(const EndSection& section) {
  std::string text = "{\"node\": " + std::to_string(section.node) + ", \"center\": " + text_of(section.center) +
                     ", \"normal\": " + text_of(section.normal) + ", \"area\": ";
  append(text, section.area);
  text += std::string(", \"open\": ") + (section.open ? "true" : "false");
  for (std::size_t i = 0; i < section.ring.size(); ++i)
    text += (i == 0 ? ",\n     \"ring\": [" : ", ") + text_of(section.ring[i]);
  return text + (section.ring.empty() ? "}" : "]}");
}

void write_sections(std::ostream& out, const std::vector<EndSection>& sections) {
  if (sections.empty()) return;
  out << ",\n  \"end_sections\": [";
  for (std::size_t i = 0; i < sections.size(); ++i) out << (i == 0 ? "\n    " : ",\n    ") << text_of(sections[i]);
  out << "\n  ]";
}

}  // namespace

RawCenterline parse_centerline_json(std::string_view content, const std::string& source,
                                    const CenterlineReadOptions& options) {
  Json document;
  try {
    document = Json::parse(content);
  } catch (const Json::exception& error) {
    constexpr std::size_t kMostShown = 300;  // the message cites what was read last, which may be the whole file
    throw InvalidInput(source +
                       ": this is not valid JSON: " + one_line(std::string_view(error.what()).substr(0, kMostShown)));
  }
  if (document.is_object() && document.contains("markups")) return read_markups(document, source, options);
  if (is_node_link(document)) return read_node_link(document, source, options);
  if (!options.radius_array.empty())
    throw InvalidInput(source + ": radii are the fourth numbers of \"nodes\"; --radius-array does not apply");
  return JsonReader(document, source).run();
}

void write_centerline_json(std::ostream& out, const Centerline& centerline, const CenterlineMetadata& metadata,
                           const std::vector<EndSection>& sections) {
  out << "{\n  \"schema\": \"" << kSchema << "\",\n  \"space\": \"" << to_string(metadata.space)
      << "\",\n  \"unit\": \"" << to_string(metadata.unit) << "\",\n"
      << string_member("generator", metadata.generator) << string_member("options", metadata.options)
      << string_member("input", metadata.input_name) << string_member("input_sha256", metadata.input_sha256)
      << "  \"nodes\": [";
  std::string row;
  for (Index n = 0; n < centerline.nodes().size(); ++n) {
    const auto& [p, r] = centerline.node(n);
    row = n == 0 ? "\n    [" : ",\n    [";
    append(row, p.x());
    for (const double x : {p.y(), p.z(), r}) append(row += ", ", x);
    out << row << "]";
  }
  out << "\n  ],\n  \"segments\": [";
  for (Index s = 0; s < centerline.segments().size(); ++s) {
    const auto& [a, b] = centerline.segment(s);
    out << (s == 0 ? "\n    [" : ",\n    [") << std::to_string(a) << ", " << std::to_string(b) << "]";
  }
  out << "\n  ]";
  if (!metadata.segment_labels.empty()) {
    row = ",\n  \"segment_labels\": [";
    for (std::size_t s = 0; s < metadata.segment_labels.size(); ++s)
      append(row += s == 0 ? "" : ", ", metadata.segment_labels[s]);
    out << row << "]";
  }
  write_sections(out, sections);
  out << "\n}\n";
}

}  // namespace vmesh::io
