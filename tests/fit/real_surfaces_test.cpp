// Walls of real vessels, with the required figures.
#include <algorithm>
#include <cmath>
#include <map>

#include <gtest/gtest.h>

#include "vmesh/centerline/branches.h"
#include "vmesh/centerline/round_ends.h"
#include "vmesh/fit/fit_surface.h"
#include "vmesh/image/image_io.h"
#include "vmesh/io/centerline_io.h"
#include "vmesh/io/surface_io.h"
#include "vmesh/mesh/topology.h"
#include "vmesh/mesh/triangle_quality.h"
#include "vmesh/reference/reference_surface.h"
#include "vmesh/skeleton/extract_centerline.h"
#include "vmesh/surface/flat_ends.h"
#include "vmesh/surface/flat_reference.h"
#include "vmesh/volume/contacts.h"
#include "vmesh/volume/vessel_field.h"

#include "draw.h"
#include "shared_data.h"

namespace vmesh {
namespace {

[[maybe_unused]] const char* const kPortalVein = "liver_segmentations/hepaticvessel_008_vsnet.nii.gz";

struct Demand {
  double mean, p95, hausdorff;  // mm
};

void expect_fitted(const TriMesh& reference, const Centerline& centerline, const GenerateOptions& options,
                   const Demand& demand) {
  GenerateResult result = generate_surface(centerline, options);
  ASSERT_TRUE(result.is_sound());
  const auto before = static_cast<double>(result.mesh.vertices.size());
  const FitReport report = fit_surface(result, centerline, reference);
  EXPECT_TRUE(result.is_sound());
  EXPECT_LE(static_cast<double>(result.mesh.vertices.size()), 1.05 * before);
  EXPECT_LE(report.after.mean(), demand.mean);
  EXPECT_LE(report.after.p95(), demand.p95);
  EXPECT_LE(report.after.hausdorff.upper(), demand.hausdorff);
  const SkewnessSummary skewness = summarize_skewness(result.mesh);
  EXPECT_LE(skewness.mean, 0.14);
  EXPECT_LT(skewness.max, 0.5);
}

// Starting from surfaces that are equally good but different.
void expect_fitted(const std::string& file, const Demand& demand) {
  const TriMesh reference = read_surface(testing::shared_data(file)).mesh;
  const ExtractedCenterline extracted = extract_centerline(reference);
  const Centerline centerline =
      separate_contacts(with_round_ends(extracted.centerline, extracted.end_sections)).centerline;
  GenerateOptions options;
  for (const double simplification : {0.0, 0.1, 0.2, 0.33, 0.35, 0.5, 0.65, 0.8}) {
    SCOPED_TRACE(simplification);
    options.simplification = simplification;
    expect_fitted(reference, centerline, options, demand);
  }
}

TEST(FitRealSurfaces, PulmonaryArteries) {
  const char* const file = "pairs_centerline_surface/generate-1d-mesh_example_SU201_2005_RPA1_exterior.vtp";
  VMESH_NEED_SHARED_DATA(file);
  expect_fitted(file, {0.035, 0.09, 0.35});
}

TEST(FitRealSurfaces, Aorta) {
  const char* const file = "pairs_centerline_surface/aorta-surface.stl";
  VMESH_NEED_SHARED_DATA(file);
  expect_fitted(file, {0.19, 0.49, 1.0});
}

/// The caps of flow models, by ModelFaceID.
std::map<int, ReferenceCap> caps_of(const LoadedSurface& model) {
  const auto id = std::find_if(model.attributes.face.begin(), model.attributes.face.end(),
                               [](const MeshAttribute& a) { return a.name == "ModelFaceID"; });
  std::map<int, ReferenceCap> caps;
  for (Index f = 0; f < model.mesh.faces.size(); ++f) {
    ReferenceCap& cap = caps[static_cast<int>(id->values[f])];
    const Vec3 area = area_normal(model.mesh, f) / 2;
    const auto& [a, b, c] = model.mesh.faces[f];
    cap.normal += area;
    cap.area += area.norm();
    cap.center += area.norm() * (model.mesh.vertices[a] + model.mesh.vertices[b] + model.mesh.vertices[c]) / 3;
  }
  std::erase_if(caps, [](const auto& cap) { return cap.second.normal.norm() < 0.95 * cap.second.area; });  // walls
  for (auto& [number, cap] : caps) cap.center /= cap.area;
  return caps;
}

void expect_caps(const std::string& name, const std::string& model_name, std::size_t count) {
  SCOPED_TRACE(model_name);
  const std::string folder = "pairs_centerline_surface/";
  const LoadedSurface model = read_surface(testing::shared_data(folder + model_name));
  const Centerline centerline =
      separate_contacts(load_centerline(testing::shared_data(folder + name)).cleaned.centerline).centerline;
  GenerateOptions options;
  options.open_ends.all = true;
  GenerateResult result = generate_surface(centerline, options);
  const FlatReference flat = end_at_caps(result, model.mesh);
  fit_surface(result, centerline, flat.mesh);
  match_cap_areas(result, centerline, flat.caps);
  FlatEndOptions ends;
  ends.fitted = true;
  const FlatEnds found = finish_ends(result, centerline, ends);
  EXPECT_TRUE(result.is_sound());
  ASSERT_EQ(found.ends.size(), count);
  std::map<int, ReferenceCap> theirs = caps_of(model);
  ASSERT_EQ(theirs.size(), count);
  for (const FlatEnd& end : found.ends) {
    const auto nearest = std::min_element(theirs.begin(), theirs.end(), [&](const auto& a, const auto& b) {
      return (a.second.center - end.center).norm() < (b.second.center - end.center).norm();
    });
    ASSERT_NE(nearest, theirs.end());
    EXPECT_NEAR(end.area, nearest->second.area, 0.05 * nearest->second.area) << "their face " << nearest->first;
    EXPECT_LT((end.center - nearest->second.center).norm(), 0.1 * std::sqrt(nearest->second.area));
    EXPECT_GT(end.normal.dot(nearest->second.normal.normalized()), 0.99);
    theirs.erase(nearest);
  }
}

TEST(FitRealSurfaces, EndInTheCapsOfTheModelsThatFlowIsComputedIn) {
  VMESH_NEED_SHARED_DATA("pairs_centerline_surface");
  expect_caps("generate-1d-mesh_example_SU201_2005_RPA1_cl.vtp",
              "generate-1d-mesh_example_SU201_2005_RPA1_exterior.vtp", 6);
  expect_caps("centerline-based-material-props_c++_aorta_cl.vtp", "centerline-based-material-props_c++_aorta.vtp", 3);
  expect_caps("project-node-onto-centerline_c++_demo-centerlines.vtp", "sv-paths_python_demo.vtp", 3);
}

TriMesh portal_vein() {
  ReferenceOptions options;
  options.labels = {2};
  options.spacing = options.smooth = 1;
  return reference_surface(read_image(testing::shared_data(kPortalVein)), options).mesh;
}

Centerline tree_of(const TriMesh& reference) {
  ExtractOptions options;
  options.tree = true;
  return extract_centerline(reference, options).centerline;
}

Centerline without(const Centerline& whole, const std::vector<char>& cut) {
  std::vector<Index> number(whole.nodes().size(), kNone);
  std::vector<CenterlineNode> nodes;
  std::vector<CenterlineSegment> segments;
  const auto kept = [&](Index n) {
    if (number[n] == kNone) {
      number[n] = static_cast<Index>(nodes.size());
      nodes.push_back(whole.node(n));
    }
    return number[n];
  };
  for (Index s = 0; s < cut.size(); ++s) {
    if (!cut[s]) segments.push_back({kept(whole.segment(s).a), kept(whole.segment(s).b)});
  }
  return {std::move(nodes), std::move(segments)};
}

// Nodes off by 0.2 radii and all radii by 15 %, wider or narrower.
TEST(FitRealSurfaces, MendsACenterlineThatIsWrong) {
  VMESH_NEED_SHARED_DATA(kPortalVein);
  const TriMesh reference = portal_vein();
  const Centerline right = tree_of(reference);
  for (const double factor : {0.85, 1.15}) {
    testing::Draw draw(7);
    std::vector<CenterlineNode> nodes = right.nodes();
    for (CenterlineNode& node : nodes) {
      node.position += 0.2 * node.radius * draw.direction();
      node.radius *= factor;
    }
    const Centerline wrong = separate_contacts(Centerline(nodes, right.segments())).centerline;
    GenerateResult result = generate_surface(wrong);
    const FitReport report = fit_surface(result, wrong, reference);
    EXPECT_TRUE(result.is_sound()) << factor;
    EXPECT_GT(report.before.mean(), 0.4) << factor;  // mm
    EXPECT_LT(report.after.mean(), 0.13) << factor;
  }
}

// Every third end of the tree is cut off at its branching.
TEST(FitRealSurfaces, TellsTwigsThatTheCenterlineDoesNotHave) {
  VMESH_NEED_SHARED_DATA(kPortalVein);
  const TriMesh reference = portal_vein();
  const Centerline whole = tree_of(reference);
  std::vector<char> cut(whole.segments().size(), 0);
  std::vector<CenterlineNode> lost;  // the ends
  std::size_t ends = 0;
  for (const Branch& branch : find_branches(whole)) {
    const bool last_ends = whole.degree(branch.nodes.back()) == 1;
    if (!last_ends && whole.degree(branch.nodes.front()) != 1) continue;
    double length = 0;
    for (const Index s : branch.segments) length += whole.length(s);
    const Index root = last_ends ? branch.nodes.front() : branch.nodes.back();
    if (length < 3 * whole.node(root).radius) continue;  // a fit may follow the bump of a vessel
    if (ends++ % 3 != 0) continue;
    lost.push_back(whole.node(last_ends ? branch.nodes.back() : branch.nodes.front()));
    for (const Index s : branch.segments) cut[s] = 1;
  }
  const Centerline rest = without(whole, cut);
  // What other vessels reach as well is not lost.
  const VesselField field(rest);
  std::erase_if(lost,
                [&](const CenterlineNode& end) { return field.sample_global(end.position).distance < 2 * end.radius; });
  ASSERT_GT(lost.size(), 5u);
  GenerateResult result = generate_surface(rest);
  const FitReport report = fit_surface(result, rest, reference);
  EXPECT_TRUE(result.is_sound());
  for (const CenterlineNode& end : lost) {  // where a part is farthest, which is at the end of the wall around it
    const bool told = std::any_of(report.uncovered.begin(), report.uncovered.end(), [&](const UnmatchedPart& part) {
      return (part.position - end.position).norm() < 2 * end.radius;
    });
    EXPECT_TRUE(told) << end.position.transpose();
  }
}

}  // namespace
}  // namespace vmesh
