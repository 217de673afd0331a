#include <algorithm>

#include "vmesh/parts/part_files.h"

#include "parts/headers.h"

namespace vmesh {
namespace {

using nlohmann::json;

constexpr const char* kSchema = "vmesh.part/2";

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
  o.deformable = j.at("deformable").get<bool>();
  o.simplification = 0;
  if (!(o.elongation >= 1 && o.elongation <= kMostElongation)) throw InvalidInput("its options are out of range");
  if (!(o.around >= 3 && o.around <= 200 && o.sweeps >= 0)) throw InvalidInput("its options are out of range");
  return o;
}

// The members of an excerpt that are not columns yet.
struct FieldColumns {
  explicit FieldColumns(const FieldExcerpt& f) : field(f) {
    for (const CenterlineNode& n : f.nodes)
      nodes.insert(nodes.end(), {n.position.x(), n.position.y(), n.position.z(), n.radius});
    for (const auto& [a, b] : f.segments) segments.insert(segments.end(), {a, b});
    for (const auto& [i, j] : f.apart) apart.insert(apart.end(), {i, j});
    for (const auto& shares : f.rounding) rounding.insert(rounding.end(), shares.begin(), shares.end());
  }

  void add_to(ArrayWriter& file) const {
    file.add("field.nodes", nodes);
    file.add("field.segments", segments);
    file.add("field.node", field.node);
    file.add("field.cone", field.cone);
    file.add("field.run", field.run);
    file.add("field.travel", field.travel);
    file.add("field.complete", std::span<const char>(field.complete));
    file.add("field.local.offsets", field.local_offsets);
    file.add("field.local", field.local);
    file.add("field.parting", std::span<const char>(field.parting));
    file.add("field.apart", apart);
    file.add("field.rounding", rounding);
  }

  const FieldExcerpt& field;
  std::vector<double> nodes, rounding;
  std::vector<Index> segments, apart;
};

FieldExcerpt read_field(ArrayFile& file) {
  FieldExcerpt field;
  std::vector<double> doubles;
  std::vector<Index> pairs;
  file.read("field.nodes", doubles);
  for (std::size_t i = 0; i + 3 < doubles.size(); i += 4)
    field.nodes.push_back({{doubles[i], doubles[i + 1], doubles[i + 2]}, doubles[i + 3]});
  file.read("field.segments", pairs);
  for (std::size_t i = 0; i + 1 < pairs.size(); i += 2) field.segments.push_back({pairs[i], pairs[i + 1]});
  file.read("field.apart", pairs);
  for (std::size_t i = 0; i + 1 < pairs.size(); i += 2) field.apart.emplace_back(pairs[i], pairs[i + 1]);
  file.read("field.rounding", doubles);
  for (std::size_t i = 0; i + 1 < doubles.size(); i += 2) field.rounding.push_back({doubles[i], doubles[i + 1]});
  file.read("field.node", field.node);
  file.read("field.cone", field.cone);
  file.read("field.run", field.run);
  file.read("field.travel", field.travel);
  file.read("field.complete", field.complete);
  file.read("field.local.offsets", field.local_offsets);
  file.read("field.local", field.local);
  file.read("field.parting", field.parting);
  return field;
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

std::vector<double> numbers_of(const std::vector<ConeOrigins::Stretch>& stretches) {
  std::vector<double> numbers;
  for (const auto& [first, last] : stretches) numbers.insert(numbers.end(), {first, last});
  return numbers;
}

std::vector<ConeOrigins::Stretch> read_stretches(ArrayFile& file, const std::string& name) {
  std::vector<double> numbers;
  file.read(name, numbers);
  std::vector<ConeOrigins::Stretch> stretches;
  for (std::size_t i = 0; i + 1 < numbers.size(); i += 2) stretches.push_back({numbers[i], numbers[i + 1]});
  return stretches;
}

// The same for the cones' origins.
struct OriginColumns {
  explicit OriginColumns(const ConeOrigins& o)
      : origins(o), stretch(numbers_of(o.stretch)), within(numbers_of(o.within)) {
    for (const SimplifiedCenterline::Piece& piece : o.pieces) {
      segment.push_back(piece.segment);
      begin.push_back(piece.begin);
      t_first.push_back(piece.t_first);
      t_last.push_back(piece.t_last);
    }
  }

  void add_to(ArrayWriter& file) const {
    file.add("origins.stretch", stretch);
    file.add("origins.branch", origins.branch);
    file.add("origins.offsets", origins.offsets);
    file.add("origins.pieces.segment", segment);
    file.add("origins.pieces.begin", begin);
    file.add("origins.pieces.t_first", t_first);
    file.add("origins.pieces.t_last", t_last);
    file.add("origins.within", within);
    file.add("origins.node", origins.node);
  }

  const ConeOrigins& origins;
  std::vector<double> stretch, within, begin, t_first, t_last;
  std::vector<Index> segment;
};

ConeOrigins read_origins(ArrayFile& file, std::size_t cones, std::size_t nodes) {
  ConeOrigins origins;
  origins.stretch = read_stretches(file, "origins.stretch");
  origins.within = read_stretches(file, "origins.within");
  file.read("origins.branch", origins.branch);
  file.read("origins.node", origins.node);
  file.read("origins.offsets", origins.offsets);
  std::vector<Index> segment;
  std::vector<double> begin, t_first, t_last;
  file.read("origins.pieces.segment", segment);
  file.read("origins.pieces.begin", begin);
  file.read("origins.pieces.t_first", t_first);
  file.read("origins.pieces.t_last", t_last);
  const std::size_t count = begin.size();
  file.require(segment.size() == count && t_first.size() == count && t_last.size() == count &&
                   origins.within.size() == count && origins.stretch.size() == cones &&
                   origins.branch.size() == cones && origins.offsets.size() == cones + 1 &&
                   origins.node.size() == nodes,
               "is damaged: what its cones stand for is inconsistent");
  require_offsets(file, "origins", origins.offsets, count);
  file.require(std::adjacent_find(origins.offsets.begin(), origins.offsets.end()) == origins.offsets.end(),
               "is damaged: a cone stands for nothing");
  for (std::size_t i = 0; i < count; ++i) origins.pieces.push_back({segment[i], begin[i], t_first[i], t_last[i]});
  return origins;
}

}  // namespace

void write_part(const std::filesystem::path& path, const StoredPart& stored) {
  const SurfacePart& part = stored.part;
  ArrayWriter file(
      {{"schema", kSchema}, {"id", stored.id}, {"options", to_json(part.options)}, {"first_piece", part.first_piece}});
  const FieldColumns field(part.field);
  field.add_to(file);
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
  std::vector<Index> seams;
  for (const SurfacePart::Seam& seam : part.seams)
    seams.insert(seams.end(), {seam.place.branch, seam.place.ring, seam.number});
  file.add("seams", seams);
  const OriginColumns origins(stored.origins);
  origins.add_to(file);
  file.write(path);
}

StoredPart read_part(const std::filesystem::path& path) {
  ArrayFile file(path, kSchema);
  file.verify();
  StoredPart stored;
  SurfacePart& part = stored.part;
  read_header(file, [&](const json& header) {
    stored.id = header.at("id").get<std::string>();
    part.options = options_of(header.at("options"));
    part.first_piece = header.at("first_piece").get<Index>();
  });
  part.field = read_field(file);
  part.field.blend = part.options.blend;
  std::vector<std::vector<Index>> nodes = read_lists(file, "branches.nodes");
  std::vector<std::vector<Index>> segments = read_lists(file, "branches.segments");
  file.require(nodes.size() == segments.size(), "is damaged: the branches are inconsistent");
  for (std::size_t b = 0; b < nodes.size(); ++b) part.branches.push_back({std::move(nodes[b]), std::move(segments[b])});
  part.pieces = read_plans(file);
  std::vector<Index> seams;
  file.read("seams", seams);
  for (std::size_t i = 0; i + 2 < seams.size(); i += 3) part.seams.push_back({{seams[i], seams[i + 1]}, seams[i + 2]});
  stored.origins = read_origins(file, part.field.cone.size(), part.field.node.size());
  return stored;
}

}  // namespace vmesh
