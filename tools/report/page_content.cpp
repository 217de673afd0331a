#include "report/page_content.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <span>

#include "vmesh/core/text.h"
#include "vmesh/mesh/find_attribute.h"
#include "vmesh/mesh/triangle_quality.h"

namespace vmesh::tool {
namespace {

constexpr std::size_t kPageBins = 40;
/// Places closer to each other than this share of the diagonal of the surface's box are shown as one.
constexpr double kApart = 0.03;

struct FoundAttribute {
  const MeshAttribute* attribute = nullptr;
  bool on_faces = false;
};

FoundAttribute find(const PageSurface& surface, const std::string& name) {
  if (const MeshAttribute* a = find_attribute(surface.attributes.vertex, name)) return {a, false};
  return {find_attribute(surface.attributes.face, name), true};
}

std::vector<double> finite(std::vector<double> values) {
  std::erase_if(values, [](double value) { return !std::isfinite(value); });
  return values;
}

PageHistogram histogram(const std::string& title, const std::string& unit, std::vector<double> values, double low,
                        double high) {
  PageHistogram result{title, unit, make_histogram(values, low, high, kPageBins), {}};
  result.distribution = summarize(std::move(values));
  return result;
}

double angle_deg(const Vec3& at, const Vec3& b, const Vec3& c) {
  const Vec3 u = b - at, v = c - at;
  return std::atan2(u.cross(v).norm(), u.dot(v)) * 180 / std::numbers::pi;
}

std::vector<double> angles_deg(const TriMesh& mesh) {
  std::vector<double> angles;
  for (const auto& [a, b, c] : mesh.faces) {
    const Vec3 &p = mesh.vertices[a], &q = mesh.vertices[b], &r = mesh.vertices[c];
    for (const double angle : {angle_deg(p, q, r), angle_deg(q, r, p), angle_deg(r, p, q)}) angles.push_back(angle);
  }
  return finite(std::move(angles));
}

Vec3 position_of(const TriMesh& mesh, std::size_t element, bool is_face) {
  if (!is_face) return mesh.vertices[element];
  const auto& [a, b, c] = mesh.faces[element];
  return (mesh.vertices[a] + mesh.vertices[b] + mesh.vertices[c]) / 3;
}

double diagonal(const TriMesh& mesh) {
  if (mesh.vertices.empty()) return 0;
  Eigen::AlignedBox3d box;
  for (const Vec3& p : mesh.vertices) box.extend(p);
  return box.diagonal().norm();
}

/// Elements in the order of their sizes, the largest first, ties by number.
std::vector<std::size_t> by_size(const std::vector<double>& values) {
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < values.size(); ++i)
    if (std::isfinite(values[i])) order.push_back(i);
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return std::abs(values[a]) > std::abs(values[b]); });
  return order;
}

void add_distances(Page& page, const PageSurface& surface, const char* name, const char* title) {
  const auto [attribute, on_faces] = find(surface, name);
  if (!attribute) return;
  std::vector<double> values = finite(attribute->values);
  for (double& value : values) value = std::abs(value);
  if (values.empty()) return;
  const double high = *std::max_element(values.begin(), values.end());
  page.histograms.push_back(histogram(title, "mm", std::move(values), 0, high > 0 ? high : 1));
}

}  // namespace

Page make_page(const char* verb, const std::filesystem::path& title, const CommonArguments& common) {
  Page page;
  page.verb = verb;
  page.title = title.filename().string();
  page.command_line = common.command_line;
  return page;
}

std::string short_number(double value) { return formatted("%.3f", value); }

std::string mean_and_max(double mean, double max) { return short_number(mean) + " / " + short_number(max); }

PlacesApart::PlacesApart(const TriMesh& mesh) : distance_(kApart * diagonal(mesh)) {}

bool PlacesApart::take(const Vec3& place) {
  for (const Vec3& other : taken_)
    if ((other - place).norm() < distance_) return false;
  taken_.push_back(place);
  return true;
}

void add_histograms(Page& page, const PageSurface& surface) {
  std::vector<double> skewness = finite(equiangle_skewness(surface.mesh)), angles = angles_deg(surface.mesh);
  if (!skewness.empty()) {
    const double high = std::ceil(20 * *std::max_element(skewness.begin(), skewness.end())) / 20;
    page.histograms.push_back(histogram("Skewness of faces", "", std::move(skewness), 0, high > 0 ? high : 1));
  }
  if (!angles.empty()) page.histograms.push_back(histogram("Angles of faces", "degrees", std::move(angles), 0, 180));
  add_distances(page, surface, "distance", "Distance of vertices to the reference");
  add_distances(page, surface, "volume_distance", "Distance of vertices to the vessels");
}

void add_largest(Page& page, const PageSurface& surface, const std::string& name, const std::string& label,
                 const std::string& unit, std::size_t count) {
  const auto [attribute, on_faces] = find(surface, name);
  if (!attribute) return;
  PlacesApart apart(surface.mesh);
  std::size_t chosen = 0;
  for (const std::size_t element : by_size(attribute->values)) {
    if (chosen == count) break;
    const double value = attribute->values[element];
    if (value == 0) break;
    const Vec3 at = position_of(surface.mesh, element, on_faces);
    if (!at.allFinite() || !apart.take(at)) continue;
    ++chosen;
    page.places.push_back({label, short_number(value) + unit, at, attribute->name, surface.name});
  }
}

void add_farthest(Page& page, const Hausdorff& hausdorff) {
  const OneSidedHausdorff &forward = hausdorff.forward, &backward = hausdorff.backward;
  page.places.push_back(
      {"Farthest from the reference", short_number(forward.upper) + " mm", forward.witness.from, "distance", ""});
  page.places.push_back({"Of the reference, farthest from the surface", short_number(backward.upper) + " mm",
                         backward.witness.from, "distance", ""});
}

void add_unmatched(Page& page, const FitReport& fit, std::size_t count) {
  const auto add = [&](const std::vector<UnmatchedPart>& parts, const char* label) {
    for (const UnmatchedPart& part : std::span(parts).first(std::min(count, parts.size())))
      page.places.push_back({label, short_number(part.distance) + " mm", part.position, "distance", ""});
  };
  add(fit.uncovered, "Region of the reference that no vessel covers");
  add(fit.unsupported, "Region of the surface that the reference lacks");
  add(fit.beyond, "Farther than the largest error");
}

}  // namespace vmesh::tool
