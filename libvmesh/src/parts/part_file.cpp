#include <algorithm>

#include "vmesh/parts/part_files.h"

#include "parts/columns.h"
#include "parts/headers.h"

namespace vmesh {
namespace {

using nlohmann::json;

constexpr const char* kPartSchema = "vmesh.part/2";

// A list of lists as a flat one, and where each begins.
struct Lists {
  std::vector<Index> offsets = {0}, all;

  void add(const std::vector<Index>& list) {
    all.insert(all.end(), list.begin(), list.end());
    offsets.push_back(static_cast<Index>(all.size()));
  }
};

void write_lists(ArrayWriter& file, const std::string& name, const Lists& lists) {
  file.add(name + ".offsets", lists.offsets);
  file.add(name, lists.all);
}

void require_offsets(const ArrayFile& file, const std::string& name, const std::vector<Index>& offsets,
                     std::size_t count) {
  file.require(!offsets.empty() && offsets.front() == 0 && offsets.back() == count &&
                   std::is_sorted(offsets.begin(), offsets.end()),
               "is damaged: the lists of " + name + " are inconsistent");
}

std::vector<std::vector<Index>> read_lists(ArrayFile& file, const std::string& name) {
  Lists lists;
  file.read(name + ".offsets", lists.offsets);
  file.read(name, lists.all);
  require_offsets(file, name, lists.offsets, lists.all.size());
  std::vector<std::vector<Index>> result(lists.offsets.size() - 1);
  for (std::size_t i = 0; i < result.size(); ++i)
    result[i].assign(lists.all.begin() + lists.offsets[i], lists.all.begin() + lists.offsets[i + 1]);
  return result;
}

json to_json(const GenerateOptions& o) {
  return {{"beta", o.beta},
          {"blend", o.blend},
          {"around", o.around},
          {"max_center_distance", o.max_center_distance},
          {"sweeps", o.sweeps},
          {"placement", to_string(o.placement)},
          {"elongation", o.elongation},
          {"ring_spacing", o.ring_spacing},
          {"deformable", o.deformable}};
}

GenerateOptions options_of(const json& j) {
  GenerateOptions o;
  o.beta = j.at("beta").get<double>();
  o.blend = j.at("blend").get<double>();
  o.around = j.at("around").get<int>();
  o.max_center_distance = j.at("max_center_distance").get<double>();
  o.sweeps = j.at("sweeps").get<int>();
  o.placement = parse_placement(j.at("placement").get<std::string>());
  o.elongation = j.at("elongation").get<double>();
  o.ring_spacing = j.at("ring_spacing").get<double>();
  o.deformable = j.at("deformable").get<bool>();
  o.simplification = 0;
  if (!(o.elongation >= 1 && o.elongation <= kMostElongation)) throw InvalidInput("its options are out of range");
  if (!(o.ring_spacing >= kLeastRingSpacing && o.ring_spacing <= kMostRingSpacing))
    throw InvalidInput("its options are out of range");
  if (!(o.around >= 3 && o.around <= 200 && o.sweeps >= 0)) throw InvalidInput("its options are out of range");
  return o;
}

void describe_field(auto& columns, auto& field) {
  columns.rows("field.nodes", field.nodes,
               [](auto& n) { return std::tie(n.position.x(), n.position.y(), n.position.z(), n.radius); });
  columns.rows("field.segments", field.segments, kBoth);
  columns.column("field.node", field.node);
  columns.column("field.cone", field.cone);
  columns.column("field.run", field.run);
  columns.column("field.travel", field.travel);
  columns.column("field.complete", field.complete);
  columns.column("field.local.offsets", field.local_offsets);
  columns.column("field.local", field.local);
  columns.column("field.parting", field.parting);
  columns.rows("field.apart", field.apart, kBoth);
  columns.rows("field.rounding", field.rounding, kBoth);
}

void describe_seams(auto& columns, auto& seams) {
  columns.rows("seams", seams, [](auto& seam) { return std::tie(seam.place.branch, seam.place.ring, seam.number); });
}

void describe_origins(auto& columns, auto& origins) {
  columns.rows("origins.stretch", origins.stretch, kBoth);
  columns.column("origins.branch", origins.branch);
  columns.column("origins.offsets", origins.offsets);
  columns.rows("origins.pieces.segment", origins.pieces, [](auto& piece) { return std::tie(piece.segment); });
  columns.rows("origins.pieces.begin", origins.pieces, [](auto& piece) { return std::tie(piece.begin); });
  columns.rows("origins.pieces.t_first", origins.pieces, [](auto& piece) { return std::tie(piece.t_first); });
  columns.rows("origins.pieces.t_last", origins.pieces, [](auto& piece) { return std::tie(piece.t_last); });
  columns.rows("origins.within", origins.within, kBoth);
  columns.column("origins.node", origins.node);
}

// The pieces' nodes and stretches, five numbers per stretch.
struct PlanLists {
  Lists nodes, stretches;
};

PlanLists lists_of(const std::vector<PiecePlan>& pieces) {
  PlanLists lists;
  for (const PiecePlan& plan : pieces) {
    lists.nodes.add(plan.nodes);
    std::vector<Index> stretches;
    for (const Stretch& s : plan.stretches)
      stretches.insert(stretches.end(), {s.branch, s.first, s.count, Index{s.seam_at_first}, Index{s.seam_at_last}});
    lists.stretches.add(stretches);
  }
  return lists;
}

std::vector<PiecePlan> read_plans(ArrayFile& file) {
  std::vector<std::vector<Index>> nodes = read_lists(file, "pieces.nodes");
  const std::vector<std::vector<Index>> stretches = read_lists(file, "pieces.stretches");
  file.require(nodes.size() == stretches.size(), "is damaged: the pieces are inconsistent");
  std::vector<PiecePlan> pieces;
  for (std::size_t p = 0; p < nodes.size(); ++p) {
    PiecePlan plan{std::move(nodes[p]), {}};
    for (std::size_t i = 0; i + 4 < stretches[p].size(); i += 5) {
      const Index* s = stretches[p].data() + i;
      plan.stretches.push_back({s[0], s[1], s[2], s[3] != 0, s[4] != 0});
    }
    pieces.push_back(std::move(plan));
  }
  return pieces;
}

ConeOrigins read_origins(ArrayFile& file, std::size_t cones, std::size_t nodes) {
  ConeOrigins origins;
  ColumnReader columns(file);
  describe_origins(columns, origins);
  const std::size_t count = origins.pieces.size();
  file.require(file.count("origins.pieces.segment") == count && file.count("origins.pieces.begin") == count &&
                   file.count("origins.pieces.t_first") == count && origins.within.size() == count &&
                   origins.stretch.size() == cones && origins.branch.size() == cones &&
                   origins.offsets.size() == cones + 1 && origins.node.size() == nodes,
               "is damaged: what its cones stand for is inconsistent");
  require_offsets(file, "origins", origins.offsets, count);
  file.require(std::adjacent_find(origins.offsets.begin(), origins.offsets.end()) == origins.offsets.end(),
               "is damaged: a cone stands for nothing");
  return origins;
}

}  // namespace

void write_part(const std::filesystem::path& path, const StoredPart& stored) {
  const SurfacePart& part = stored.part;
  ArrayWriter file({{"schema", kPartSchema},
                    {"id", stored.id},
                    {"options", to_json(part.options)},
                    {"first_piece", part.first_piece}});
  ColumnWriter columns(file);
  describe_field(columns, part.field);
  Lists branch_nodes, branch_segments;
  for (const Branch& branch : part.branches) {
    branch_nodes.add(branch.nodes);
    branch_segments.add(branch.segments);
  }
  write_lists(file, "branches.nodes", branch_nodes);
  write_lists(file, "branches.segments", branch_segments);
  const PlanLists plans = lists_of(part.pieces);
  write_lists(file, "pieces.nodes", plans.nodes);
  write_lists(file, "pieces.stretches", plans.stretches);
  describe_seams(columns, part.seams);
  describe_origins(columns, stored.origins);
  file.write(path);
}

StoredPart read_part(const std::filesystem::path& path) {
  ArrayFile file(path, kPartSchema);
  file.verify();
  StoredPart stored;
  SurfacePart& part = stored.part;
  read_header(file, [&](const json& header) {
    stored.id = header.at("id").get<std::string>();
    part.options = options_of(header.at("options"));
    part.first_piece = header.at("first_piece").get<Index>();
  });
  ColumnReader columns(file);
  describe_field(columns, part.field);
  part.field.blend = part.options.blend;
  std::vector<std::vector<Index>> nodes = read_lists(file, "branches.nodes");
  std::vector<std::vector<Index>> segments = read_lists(file, "branches.segments");
  file.require(nodes.size() == segments.size(), "is damaged: the branches are inconsistent");
  for (std::size_t b = 0; b < nodes.size(); ++b) part.branches.push_back({std::move(nodes[b]), std::move(segments[b])});
  part.pieces = read_plans(file);
  describe_seams(columns, part.seams);
  stored.origins = read_origins(file, part.field.cone.size(), part.field.node.size());
  return stored;
}

}  // namespace vmesh
