#include "vmesh/parts/part_files.h"

#include <algorithm>
#include <cstdio>

#include "vmesh/core/atomic_file.h"
#include "vmesh/core/error.h"
#include "vmesh/core/input_file.h"

#include "parts/array_file.h"

namespace vmesh {
namespace {

using nlohmann::json;

constexpr const char* kPartSchema = "vmesh.part/1";
constexpr const char* kSurfaceSchema = "vmesh.part-surface/1";
constexpr const char* kManifestSchema = "vmesh.parts/1";

// A list of lists as one, and where each begins.
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
               "is damaged: the lists of " + name + " do not fit together");
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
  return {{"beta", o.beta},     {"blend", o.blend},
          {"around", o.around}, {"max_center_distance", o.max_center_distance},
          {"sweeps", o.sweeps}, {"placement", to_string(o.placement)}};
}

GenerateOptions options_of(const json& j) {
  GenerateOptions o;
  o.beta = j.at("beta").get<double>();
  o.blend = j.at("blend").get<double>();
  o.around = j.at("around").get<int>();
  o.max_center_distance = j.at("max_center_distance").get<double>();
  o.sweeps = j.at("sweeps").get<int>();
  o.placement = parse_placement(j.at("placement").get<std::string>());
  o.simplification = 0;
  if (!(o.around >= 3 && o.around <= 200 && o.sweeps >= 0)) throw InvalidInput("its options are out of range");
  return o;
}

Index around_of(const json& j) {
  const Index around = j.get<Index>();
  if (!(around >= 3 && around <= 200)) throw InvalidInput("the number of vertices around a vessel is out of range");
  return around;
}

json to_json(const Vec3& p) { return {p.x(), p.y(), p.z()}; }
Vec3 point_of(const json& j) { return {j.at(0).get<double>(), j.at(1).get<double>(), j.at(2).get<double>()}; }

json to_json(const GrowthSimplification& note) {
  return {{"kind", static_cast<int>(note.kind)},
          {"position", to_json(note.position)},
          {"nodes", note.nodes},
          {"segments", note.segments},
          {"message", note.message}};
}

GrowthSimplification note_of(const json& j) {
  const int kind = j.at("kind").get<int>();
  if (kind < 0 || kind > static_cast<int>(GrowthSimplification::Kind::filled_loop))
    throw InvalidInput("a note is of no known kind");
  return {static_cast<GrowthSimplification::Kind>(kind), point_of(j.at("position")),
          j.at("nodes").get<std::vector<Index>>(), j.at("segments").get<std::vector<Index>>(),
          j.at("message").get<std::string>()};
}

// What is wrong with a header is said with the file's name.
template <class Read>
auto from_header(const ArrayFile& file, Read&& read) {
  try {
    return read(file.header());
  } catch (const json::exception&) {
    file.refuse("is damaged: its header lacks something, or it is of another kind");
  } catch (const InvalidInput& error) {
    file.refuse(std::string("is damaged: ") + error.what());
  }
}

void add_field(ArrayWriter& file, const FieldExcerpt& field, std::vector<std::vector<double>>& doubles,
               std::vector<std::vector<Index>>& numbers) {
  std::vector<double>& nodes = doubles.emplace_back();
  for (const CenterlineNode& n : field.nodes)
    nodes.insert(nodes.end(), {n.position.x(), n.position.y(), n.position.z(), n.radius});
  std::vector<Index>& segments = numbers.emplace_back();
  for (const auto& [a, b] : field.segments) segments.insert(segments.end(), {a, b});
  std::vector<Index>& apart = numbers.emplace_back();
  for (const auto& [i, j] : field.apart) apart.insert(apart.end(), {i, j});
  std::vector<double>& rounding = doubles.emplace_back();
  for (const auto& shares : field.rounding) rounding.insert(rounding.end(), shares.begin(), shares.end());
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

// The pieces' nodes and stretches, five numbers for each of these.
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
  file.require(nodes.size() == stretches.size(), "is damaged: the pieces do not fit together");
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

// Columns of the pieces of binding and the like.
struct PlaceColumns {
  std::vector<Index> segment;
  std::vector<double> t;

  void add(Index s, double u) {
    segment.push_back(s);
    t.push_back(u);
  }
};

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

// In an ascending list that has it.
Index place_of(const std::vector<Index>& list, Index number) {
  return static_cast<Index>(std::lower_bound(list.begin(), list.end(), number) - list.begin());
}

}  // namespace

std::string part_name(std::size_t number) {
  char name[32];
  std::snprintf(name, sizeof name, "part_%05zu", number + 1);
  return name;
}

SimplifiedCenterline::Place ConeOrigins::original(Index cone, double t) const {
  const double u = stretch[cone].at(t);
  const auto of_cone = std::span(pieces).subspan(offsets[cone], offsets[cone + 1] - offsets[cone]);
  const auto [segment, v] = place_on(of_cone, u);
  return {segment, within[offsets[cone] + piece_at(of_cone, u)].at(v)};
}

void ConeOrigins::refer_to_original(GrowthSimplification& note) const {
  for (Index& n : note.nodes) n = node[n];
  std::erase(note.nodes, kNone);
  std::vector<Index> segments;
  for (const Index cone : note.segments) {
    for (Index p = offsets[cone]; p < offsets[cone + 1]; ++p) segments.push_back(pieces[p].segment);
  }
  std::sort(segments.begin(), segments.end());
  segments.erase(std::unique(segments.begin(), segments.end()), segments.end());
  note.segments = std::move(segments);
}

void write_manifest(const std::filesystem::path& path, const PartsManifest& m) {
  json notes = json::array();
  for (const GrowthSimplification& note : m.simplifications) notes.push_back(to_json(note));
  const json text = {{"schema", kManifestSchema},
                     {"id", m.id},
                     {"generator", m.source.generator},
                     {"options", m.source.options},
                     {"input", m.source.input_name},
                     {"input_sha256", m.source.input_sha256},
                     {"parts", m.parts},
                     {"pieces", m.pieces},
                     {"seams", m.seams},
                     {"around", m.around},
                     {"components", m.components},
                     {"cycle_rank", m.cycle_rank},
                     {"expected_vertices", m.expected_vertices},
                     {"simplifications", notes}};
  AtomicFile file(path);
  file.write(text.dump(2) + "\n");
  file.commit();
}

PartsManifest read_manifest(const std::filesystem::path& path) {
  const json j = json::parse(read_file(path), nullptr, false);
  if (!j.is_object() || j.value("schema", std::string()) != kManifestSchema)
    throw InvalidInput(path.string() + ": is no list of parts; vmesh split writes it");
  try {
    PartsManifest m;
    m.id = j.at("id").get<std::string>();
    m.source = {j.at("generator").get<std::string>(), j.at("options").get<std::string>(),
                j.at("input").get<std::string>(), j.at("input_sha256").get<std::string>()};
    m.parts = j.at("parts").get<std::size_t>();
    m.pieces = j.at("pieces").get<std::size_t>();
    m.seams = j.at("seams").get<std::size_t>();
    m.around = around_of(j.at("around"));
    m.components = j.at("components").get<std::size_t>();
    m.cycle_rank = j.at("cycle_rank").get<std::size_t>();
    m.expected_vertices = j.at("expected_vertices").get<double>();
    for (const json& note : j.at("simplifications")) m.simplifications.push_back(note_of(note));
    return m;
  } catch (const json::exception&) {
    throw InvalidInput(path.string() + ": is damaged: something is missing or of another kind");
  } catch (const InvalidInput& error) {
    throw InvalidInput(path.string() + ": is damaged: " + error.what());
  }
}

void write_part(const std::filesystem::path& path, const StoredPart& stored) {
  const SurfacePart& part = stored.part;
  ArrayWriter file({{"schema", kPartSchema},
                    {"id", stored.id},
                    {"options", to_json(part.options)},
                    {"blend", part.field.blend},
                    {"first_piece", part.first_piece}});
  std::vector<std::vector<double>> doubles;
  std::vector<std::vector<Index>> numbers;
  doubles.reserve(2);
  numbers.reserve(2);
  add_field(file, part.field, doubles, numbers);
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
  const ConeOrigins& origins = stored.origins;
  const std::vector<double> stretch = numbers_of(origins.stretch), within = numbers_of(origins.within);
  PlaceColumns places;
  std::vector<double> begin, t_last;
  for (const SimplifiedCenterline::Piece& piece : origins.pieces) {
    places.add(piece.segment, piece.t_first);
    begin.push_back(piece.begin);
    t_last.push_back(piece.t_last);
  }
  file.add("origins.stretch", stretch);
  file.add("origins.branch", origins.branch);
  file.add("origins.offsets", origins.offsets);
  file.add("origins.pieces.segment", places.segment);
  file.add("origins.pieces.begin", begin);
  file.add("origins.pieces.t_first", places.t);
  file.add("origins.pieces.t_last", t_last);
  file.add("origins.within", within);
  file.add("origins.node", origins.node);
  file.write(path);
}

StoredPart read_part(const std::filesystem::path& path) {
  ArrayFile file(path, kPartSchema);
  file.verify();
  StoredPart stored;
  SurfacePart& part = stored.part;
  from_header(file, [&](const json& header) {
    stored.id = header.at("id").get<std::string>();
    part.options = options_of(header.at("options"));
    part.first_piece = header.at("first_piece").get<Index>();
    return header.at("blend").get<double>();
  });
  part.field = read_field(file);
  part.field.blend = part.options.blend;
  std::vector<std::vector<Index>> nodes = read_lists(file, "branches.nodes");
  std::vector<std::vector<Index>> segments = read_lists(file, "branches.segments");
  file.require(nodes.size() == segments.size(), "is damaged: the branches do not fit together");
  for (std::size_t b = 0; b < nodes.size(); ++b) part.branches.push_back({std::move(nodes[b]), std::move(segments[b])});
  part.pieces = read_plans(file);
  std::vector<Index> seams;
  file.read("seams", seams);
  for (std::size_t i = 0; i + 2 < seams.size(); i += 3) part.seams.push_back({{seams[i], seams[i + 1]}, seams[i + 2]});
  ConeOrigins& origins = stored.origins;
  origins.stretch = read_stretches(file, "origins.stretch");
  origins.within = read_stretches(file, "origins.within");
  file.read("origins.branch", origins.branch);
  file.read("origins.node", origins.node);
  file.read("origins.offsets", origins.offsets);
  PlaceColumns places;
  std::vector<double> begin, t_last;
  file.read("origins.pieces.segment", places.segment);
  file.read("origins.pieces.begin", begin);
  file.read("origins.pieces.t_first", places.t);
  file.read("origins.pieces.t_last", t_last);
  const std::size_t cones = part.field.cone.size(), count = begin.size();
  file.require(places.segment.size() == count && places.t.size() == count && t_last.size() == count &&
                   origins.within.size() == count && origins.stretch.size() == cones &&
                   origins.branch.size() == cones && origins.offsets.size() == cones + 1 &&
                   origins.node.size() == part.field.node.size(),
               "is damaged: what its cones stand for does not fit together");
  require_offsets(file, "origins", origins.offsets, count);
  file.require(std::adjacent_find(origins.offsets.begin(), origins.offsets.end()) == origins.offsets.end(),
               "is damaged: a cone stands for nothing");
  for (std::size_t i = 0; i < count; ++i)
    origins.pieces.push_back({places.segment[i], begin[i], places.t[i], t_last[i]});
  return stored;
}

void write_part_surface(const std::filesystem::path& path, const StoredPartSurface& stored) {
  const PartSurface& surface = stored.surface;
  json notes = json::array();
  std::vector<Index> pieces;
  std::vector<double> worst;
  for (const PartSurface::Piece& piece : surface.pieces) {
    pieces.insert(pieces.end(),
                  {piece.vertex_count, piece.face_count, piece.junctions, piece.tubes, piece.filled_loops, piece.rung});
    worst.push_back(piece.worst_skewness);
    if (!piece.faults.empty()) throw InvalidInput(path.string() + ": a part that is not sound is not written");
  }
  for (const GrowthSimplification& note : surface.simplifications) notes.push_back(to_json(note));
  ArrayWriter file({{"schema", kSurfaceSchema},
                    {"id", stored.id},
                    {"first_piece", surface.first_piece},
                    {"around", surface.around},
                    {"simplifications", notes}});
  PlaceColumns binding, place;
  for (const CenterlineBinding& b : surface.binding) binding.add(b.segment, b.t);
  for (const SimplifiedCenterline::Place& p : stored.place) place.add(p.segment, p.t);
  std::vector<Index> faces, crossings;
  for (const Triangle& f : surface.mesh.faces) faces.insert(faces.end(), f.begin(), f.end());
  for (const auto& [f, g] : surface.crossings) crossings.insert(crossings.end(), {f, g});
  file.add("seams", surface.seams);
  file.add("pieces", pieces);
  file.add("pieces.worst_skewness", worst);
  file.add("crossings", crossings);
  file.add("vertices", surface.mesh.vertices);
  file.add("faces", faces);
  file.add("radius", surface.radius);
  file.add("cone", binding.segment);
  file.add("t", binding.t);
  file.add("segment", place.segment);
  file.add("parameter", place.t);
  file.add("branch", stored.branch);
  file.write(path);
}

StoredPartSurface read_part_surface(const std::filesystem::path& path, bool verify) {
  ArrayFile file(path, kSurfaceSchema);
  if (verify) file.verify();
  StoredPartSurface stored;
  PartSurface& surface = stored.surface;
  std::vector<Index> pieces, faces, crossings;
  std::vector<double> worst;
  file.read("pieces", pieces);
  file.read("pieces.worst_skewness", worst);
  file.require(pieces.size() == 6 * worst.size(), "is damaged: its pieces do not fit together");
  for (std::size_t p = 0; p < worst.size(); ++p) {
    const Index* n = pieces.data() + 6 * p;
    surface.pieces.push_back({n[0], n[1], n[2], n[3], n[4], n[5], worst[p], {}});
  }
  from_header(file, [&](const json& header) {
    stored.id = header.at("id").get<std::string>();
    surface.first_piece = header.at("first_piece").get<Index>();
    surface.around = around_of(header.at("around"));
    for (const json& note : header.at("simplifications")) surface.simplifications.push_back(note_of(note));
    return 0;
  });
  file.read("seams", surface.seams);
  file.read("vertices", surface.mesh.vertices);
  file.read("faces", faces);
  for (std::size_t i = 0; i + 2 < faces.size(); i += 3)
    surface.mesh.faces.push_back({faces[i], faces[i + 1], faces[i + 2]});
  file.read("crossings", crossings);
  for (std::size_t i = 0; i + 1 < crossings.size(); i += 2)
    surface.crossings.emplace_back(crossings[i], crossings[i + 1]);
  file.read("radius", surface.radius);
  PlaceColumns binding, place;
  file.read("cone", binding.segment);
  file.read("t", binding.t);
  file.read("segment", place.segment);
  file.read("parameter", place.t);
  file.read("branch", stored.branch);
  const std::size_t count = surface.mesh.vertices.size();
  std::size_t own = surface.seams.size() * std::size_t{surface.around}, face_count = 0;
  for (const PartSurface::Piece& piece : surface.pieces) {
    own += piece.vertex_count;
    face_count += piece.face_count;
  }
  const auto is_vertex = [&](Index v) { return v < count; };
  const auto is_face = [&](const auto& pair) { return pair.first < pair.second && pair.second < face_count; };
  file.require(own == count && face_count == surface.mesh.faces.size() && surface.radius.size() == count &&
                   binding.segment.size() == count && binding.t.size() == count && place.segment.size() == count &&
                   place.t.size() == count && stored.branch.size() == count &&
                   std::all_of(faces.begin(), faces.end(), is_vertex) &&
                   std::all_of(surface.crossings.begin(), surface.crossings.end(), is_face),
               "is damaged: vertices, faces and pieces do not fit together");
  for (std::size_t v = 0; v < count; ++v) {
    surface.binding.push_back({binding.segment[v], binding.t[v]});
    stored.place.push_back({place.segment[v], place.t[v]});
  }
  return stored;
}

StoredPartSurface refer_to_read(const StoredPart& part, PartSurface surface) {
  StoredPartSurface stored;
  stored.id = part.id;
  const std::vector<Index>& cones = part.part.field.cone;
  for (const CenterlineBinding& binding : surface.binding) {
    const Index cone = place_of(cones, binding.segment);
    stored.place.push_back(part.origins.original(cone, binding.t));
    stored.branch.push_back(part.origins.branch[cone]);
  }
  for (GrowthSimplification& note : surface.simplifications) {
    for (Index& n : note.nodes) n = place_of(part.part.field.node, n);
    for (Index& c : note.segments) c = place_of(cones, c);
    part.origins.refer_to_original(note);
  }
  stored.surface = std::move(surface);
  return stored;
}

}  // namespace vmesh
