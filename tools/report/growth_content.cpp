#include "report/growth_content.h"

#include <algorithm>
#include <limits>
#include <span>

#include "vmesh/evaluation/vessel_distance.h"

#include "report/page_content.h"

namespace vmesh::tool {
namespace {

constexpr std::size_t kMostDefects = 10;

template <class T>
std::span<const T> first_of(const std::vector<T>& list, std::size_t most) {
  return std::span(list).first(std::min(most, list.size()));
}

/// "crossing faces"
std::string words(std::string_view name) {
  std::string text(name);
  std::replace(text.begin(), text.end(), '_', ' ');
  return text;
}

}  // namespace

void add_vessel_distances(const GenerateResult& result, const VesselField& field, std::size_t wall_vertices,
                          MeshAttributes& attributes) {
  MeshAttribute mm{"volume_distance", vertex_vessel_distances(result.mesh, field)}, radii{"relative_distance", {}};
  for (std::size_t v = wall_vertices; v < mm.values.size(); ++v)
    mm.values[v] = std::numeric_limits<double>::quiet_NaN();
  for (std::size_t v = 0; v < mm.values.size(); ++v) radii.values.push_back(mm.values[v] / result.radius[v]);
  attributes.vertex.push_back(std::move(mm));
  attributes.vertex.push_back(std::move(radii));
}

void add_facts_of(Page& page, const Deviation& deviation) {
  page.facts.push_back({"Faces to the vessels, mm, mean / max", mean_and_max(deviation.mean_mm, deviation.max_mm)});
  page.facts.push_back(
      {"The same in radii, mean / max", mean_and_max(deviation.mean_relative, deviation.max_relative)});
}

void add_defects(Page& page, const std::vector<Defect>& defects) {
  for (const Defect& defect : first_of(defects, kMostDefects))
    page.places.push_back(
        {"Defect: " + words(to_string(defect.kind)), std::to_string(defect.count), defect.position, "", ""});
}

void add_farthest_from_vessels(Page& page, const Deviation& deviation, const PageSurface& surface) {
  page.places.push_back({"Farthest from the vessels, in their radii", short_number(deviation.max_relative) + " radii",
                         deviation.max_at, "relative_distance", ""});
  add_largest(page, surface, "volume_distance", "Vertex far from the vessels", " mm", kMarksOfEach);
}

void add_unproven(Page& page, const ErrorSummary& error) {
  for (const UnprovenPlace& place : error.unproven_places)
    page.places.push_back({"Limit not proven", std::to_string(place.faces) + " faces", place.position, "", ""});
}

void add_contacts(Page& page, const std::vector<Contact>& contacts, const char* label) {
  for (const Contact& contact : first_of(contacts, kMarksOfEach))
    page.places.push_back({label, short_number(contact.depth) + " mm deep", contact.position, "", ""});
}

void add_separation(Page& page, const SeparationReport& separation) {
  add_contacts(page, separation.left, "Vessels still touch");
  for (const VesselMove& move : first_of(separation.moves, kMarksOfEach))
    page.places.push_back(
        {"Vessel moved aside", short_number(move.displacement.norm()) + " mm", move.position, "", ""});
}

}  // namespace vmesh::tool
