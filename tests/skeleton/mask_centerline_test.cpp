// Centerlines of known vessels that were made into voxels.
#include <cmath>
#include <random>

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include "vmesh/core/error.h"
#include "vmesh/image/image_io.h"
#include "vmesh/skeleton/extract_centerline.h"
#include "vmesh/volume/round_cone.h"
#include "vmesh/volume/vessel_field.h"

namespace vmesh {
namespace {

struct Grid {
  Vec3 spacing = Vec3::Ones();
  double margin = 3;  // mm around the vessels; negative: the image cuts them
};

/// Signed distances to the vessels at the voxels' centres.
LoadedImage sampled(const Centerline& vessels, const Grid& grid) {
  const VesselField field(vessels);
  Eigen::AlignedBox3d box;
  for (const CenterlineNode& node : vessels.nodes()) {
    box.extend((node.position.array() - node.radius).matrix());
    box.extend((node.position.array() + node.radius).matrix());
  }
  LoadedImage loaded;
  VoxelImage& image = loaded.image;
  image.origin = box.min().array() - grid.margin;
  image.steps = grid.spacing.asDiagonal();
  for (int a = 0; a < 3; ++a)
    image.size[static_cast<std::size_t>(a)] =
        static_cast<std::size_t>((box.sizes()[a] + 2 * grid.margin) / grid.spacing[a]) + 1;
  for (std::size_t k = 0; k < image.size[2]; ++k)
    for (std::size_t j = 0; j < image.size[1]; ++j)
      for (std::size_t i = 0; i < image.size[0]; ++i)
        image.values.push_back(
            static_cast<float>(-field
                                    .sample_global(image.position(
                                        Vec3(static_cast<double>(i), static_cast<double>(j), static_cast<double>(k))))
                                    .distance));
  return loaded;
}

LoadedImage mask_of(const Centerline& vessels, const Grid& grid = {}) {
  LoadedImage loaded = sampled(vessels, grid);
  for (float& value : loaded.image.values) value = value >= 0 ? 1.0f : 0.0f;
  loaded.integer = true;
  return loaded;
}

ExtractedCenterline extracted(const LoadedImage& image, const ExtractOptions& options = {},
                              const ReferenceOptions& inside = {}) {
  return extract_centerline(vessel_mask(image, inside), options);
}

std::size_t end_count(const Centerline& centerline) {
  std::size_t ends = 0;
  for (Index n = 0; n < centerline.nodes().size(); ++n) ends += centerline.degree(n) == 1;
  return ends;
}

/// The largest distance from a node of `a` to the axes of `b`, in the radii there.
double farthest(const Centerline& a, const Centerline& b) {
  double most = 0;
  for (const CenterlineNode& node : a.nodes()) {
    double least = std::numeric_limits<double>::infinity();
    for (Index s = 0; s < b.segments().size(); ++s) {
      const CenterlineNode &first = b.node(b.segment(s).a), &last = b.node(b.segment(s).b);
      const Vec3 axis = last.position - first.position;
      const double t = std::clamp((node.position - first.position).dot(axis) / axis.squaredNorm(), 0.0, 1.0);
      least = std::min(least, (node.position - b.point_at(s, t)).norm() / b.radius_at(s, t));
    }
    most = std::max(most, least);
  }
  return most;
}

Centerline y_shape(double radius) {
  const double r = radius;
  return {
      {{{0, 0, 0}, 1.2 * r}, {{0, 0, 10 * r}, 1.2 * r}, {{6 * r, r, 19 * r}, r}, {{-7 * r, 2 * r, 18 * r}, 0.9 * r}},
      {{0, 1}, {1, 2}, {1, 3}}};
}

Centerline ring(double size, double radius) {
  std::vector<CenterlineNode> nodes;
  std::vector<CenterlineSegment> segments;
  constexpr Index kCount = 24;
  for (Index n = 0; n < kCount; ++n) {
    const double angle = 2 * M_PI * n / kCount;
    nodes.push_back({Vec3(size * std::cos(angle), size * std::sin(angle), 2 * std::sin(2 * angle)), radius});
    segments.push_back({n, (n + 1) % kCount});
  }
  return {nodes, segments};
}

TEST(MaskCenterline, FollowsTheVesselsToAFractionOfAVoxel) {
  for (const double voxels : {1.5, 3.0, 6.0}) {
    const Centerline truth = y_shape(voxels);
    const ExtractedCenterline found = extracted(mask_of(truth));
    EXPECT_EQ(end_count(found.centerline), 3u) << voxels;
    EXPECT_EQ(found.centerline.cycle_rank(), 0u);
    // A third of a voxel anywhere, where the branching is the worst place.
    EXPECT_LT(farthest(found.centerline, truth), 0.05 + 0.4 / voxels) << voxels;
    EXPECT_GT(found.report.coverage, 0.999);
    EXPECT_EQ(found.report.length_coverage, 1);
  }
}

TEST(MaskCenterline, GreyValuesGiveRadiiBelowTheVoxel) {
  const Centerline truth{{{{0, 0, 0}, 2.3}, {{20, 7, 11}, 2.3}}, {{0, 1}}};
  ReferenceOptions inside;
  inside.threshold = 0;
  const ExtractedCenterline found = extracted(sampled(truth, {Vec3(1, 1, 1), 3}), {}, inside);
  // Values are exact distances, so that crossings between voxels are off by the curvature only: h^2 / 8r, .05 mm.
  for (const CenterlineNode& node : found.centerline.nodes()) EXPECT_NEAR(node.radius, 2.3, 0.06);
  EXPECT_LT(farthest(found.centerline, truth), 0.03);
}

/// By the length between the nodes of a vessel whose radius is the same everywhere.
double mean_radius(const Centerline& centerline) {
  double sum = 0, length = 0;
  for (Index s = 0; s < centerline.segments().size(); ++s) {
    const CenterlineSegment& segment = centerline.segment(s);
    const double l = (centerline.node(segment.a).position - centerline.node(segment.b).position).norm();
    sum += l * centerline.radius_at(s, 0.5);
    length += l;
  }
  return sum / length;
}

TEST(MaskCenterline, RadiiOfThinVesselsAreThoseOfTheirVolume) {
  // The voxels of a vessel of length l and radius r are l pi r^2 to within the chance of which centres lie in it: the
  // root of their number, 57 to 510 here, is 13 to 4.4 %, and half of that in the radius; centres in rows on a slanted
  // line are more even than chance. The wall half a voxel around the centres would be 12 % off at .6.
  for (const double radius : {0.6, 1.0, 1.8}) {
    const Centerline truth{{{{0, 0, 0}, radius}, {{41, 17, 24}, radius}}, {{0, 1}}};
    EXPECT_NEAR(mean_radius(extracted(mask_of(truth)).centerline), radius, 0.04 * radius) << radius;
  }
}

TEST(MaskCenterline, RadiiOfARoughMaskAreNotLarger) {
  const Centerline truth{{{{0, 0, 0}, 2}, {{41, 17, 24}, 2}}, {{0, 1}}};
  LoadedImage image = sampled(truth, {});
  std::mt19937 random(7);
  for (float& value : image.image.values) {  // a quarter of the voxels beside the wall are on its wrong side
    const bool wrong = std::abs(value) < 0.7 && random() % 4 == 0;
    value = (value >= 0) != wrong ? 1 : 0;
  }
  image.integer = true;
  const Centerline found = extracted(image).centerline;
  EXPECT_EQ(end_count(found), 2u);
  EXPECT_NEAR(mean_radius(found), 2, 0.04 * 2);
}

TEST(MaskCenterline, ThickSlicesKeepTheirMillimetres) {
  const Centerline truth{{{{0, 0, 0}, 5}, {{20, 10, 60}, 5}, {{60, 10, 90}, 4}}, {{0, 1}, {1, 2}}};
  const ExtractedCenterline found = extracted(mask_of(truth, {Vec3(1, 1, 5), 6}));
  EXPECT_EQ(end_count(found.centerline), 2u);
  EXPECT_LT(farthest(found.centerline, truth), 0.3);
}

TEST(MaskCenterline, AVesselOfOneVoxelIsNeverCut) {
  LoadedImage image;
  image.image.size = {60, 40, 40};
  image.image.values.assign(60u * 40 * 40, 0);
  for (std::size_t i = 5; i < 55; ++i)  // neighbours touch at edges and corners
    image.image.values[image.image.offset(i, 5 + i / 2, 5 + i / 3)] = 1;
  const ExtractedCenterline found = extracted(image);
  EXPECT_EQ(found.centerline.component_count(), 1u);
  EXPECT_EQ(end_count(found.centerline), 2u);
  EXPECT_GT(found.centerline.length_in_radii(), 50);
}

TEST(MaskCenterline, KeepsEveryComponentAndNamesWhatItLeavesOut) {
  const Centerline two{{{{0, 0, 0}, 2}, {{30, 0, 0}, 2}, {{0, 20, 0}, 2}, {{30, 20, 0}, 2}, {{15, 40, 0}, 3}},
                       {{0, 1}, {2, 3}}};
  const ExtractedCenterline found = extracted(mask_of(two));
  EXPECT_EQ(found.report.components, 3u);
  EXPECT_EQ(found.report.left_out, 1u);  // the ball
  EXPECT_EQ(found.centerline.component_count(), 2u);
  ASSERT_EQ(found.report.missed.size(), 1u);
  EXPECT_NEAR(found.report.missed[0].area, 4 * M_PI * 9, 0.1 * 4 * M_PI * 9);  // of the ball, in voxels
  EXPECT_NEAR(found.report.missed[0].place.y(), 40, 3.5);
  EXPECT_LT(found.report.coverage, 0.9);
  ExtractOptions options;
  options.largest = true;
  EXPECT_EQ(extracted(mask_of(two), options).centerline.component_count(), 1u);
  options.largest = false;
  options.least_length = 50;
  EXPECT_THROW(extracted(mask_of(two), options), InvalidInput);
}

TEST(MaskCenterline, JoinsAnOcclusionAheadButNotAVesselBeside) {
  const Centerline gap{{{{0, 0, 0}, 3}, {{20, 0, 0}, 3}, {{28, 1, 0}, 3}, {{50, 1, 0}, 3}}, {{0, 1}, {2, 3}}};
  const ExtractedCenterline joined = extracted(mask_of(gap));
  EXPECT_EQ(joined.centerline.component_count(), 1u);
  ASSERT_EQ(joined.report.joined.size(), 1u);
  EXPECT_NEAR(joined.report.joined[0].gap, 2, 1);  // voxels of 1 mm at either end
  const Centerline beside{{{{0, 0, 0}, 3}, {{40, 0, 0}, 3}, {{0, 11, 0}, 3}, {{40, 11, 0}, 3}}, {{0, 1}, {2, 3}}};
  EXPECT_EQ(extracted(mask_of(beside)).centerline.component_count(), 2u);
  ExtractOptions options;
  options.join = 0;
  EXPECT_EQ(extracted(mask_of(gap), options).centerline.component_count(), 2u);
}

TEST(MaskCenterline, ALoopStaysALoop) {
  for (const double radius : {1.2, 3.0}) {
    const Centerline truth = ring(20, radius);
    const ExtractedCenterline found = extracted(mask_of(truth));
    EXPECT_EQ(found.centerline.cycle_rank(), 1u);
    EXPECT_EQ(end_count(found.centerline), 0u);
    ASSERT_EQ(found.report.loops.size(), 1u);
    EXPECT_FALSE(found.report.loops[0].opened);
    EXPECT_NEAR(found.report.loops[0].length, 2 * M_PI * 20, 0.15 * 2 * M_PI * 20);
    EXPECT_LT(farthest(found.centerline, truth), 0.1 + 0.4 / radius);
  }
}

TEST(MaskCenterline, ATreeOpensLoopsWhereVesselsKiss) {
  // Two vessels from one root that touch again, by less than a voxel, where they are 30 mm from it.
  const Centerline truth{{{{0, 0, 0}, 4},
                          {{10, 0, 0}, 4},
                          {{25, 14, 0}, 3},
                          {{40, 3, 0}, 3},
                          {{55, 14, 0}, 3},
                          {{25, -14, 0}, 3},
                          {{40, -2.8, 0}, 3},
                          {{55, -14, 0}, 3}},
                         {{0, 1}, {1, 2}, {2, 3}, {3, 4}, {1, 5}, {5, 6}, {6, 7}}};
  const LoadedImage mask = mask_of(truth);
  const ExtractedCenterline kept = extracted(mask);
  EXPECT_EQ(kept.centerline.cycle_rank(), 1u);
  ASSERT_EQ(kept.report.loops.size(), 1u);
  EXPECT_NEAR((kept.report.loops[0].neck - Vec3(40, 0, 0)).norm(), 0, 2.5);
  EXPECT_LT(kept.report.loops[0].neck_radius, kept.report.loops[0].radius);
  ExtractOptions tree;
  tree.tree = true;
  const ExtractedCenterline opened = extracted(mask, tree);
  EXPECT_EQ(opened.centerline.cycle_rank(), 0u);
  EXPECT_EQ(end_count(opened.centerline), 3u);
  EXPECT_LT(farthest(opened.centerline, truth), 0.4);
}

TEST(MaskCenterline, ACutByTheImagesBorderIsAFlatEnd) {
  const Centerline truth{{{{0, 0, 0}, 4}, {{0, 0, 60}, 4}}, {{0, 1}}};
  Grid grid;
  grid.margin = -10;  // cuts both ends, and would cut the sides
  LoadedImage image = mask_of(truth, {Vec3::Ones(), 8});
  // The slices of 10 mm at either end are not there.
  VoxelImage& v = image.image;
  const std::size_t slice = v.size[0] * v.size[1], cut = 22;
  v.values.erase(v.values.begin(), v.values.begin() + static_cast<std::ptrdiff_t>(cut * slice));
  v.values.resize(v.values.size() - cut * slice);
  v.origin.z() += static_cast<double>(cut);
  v.size[2] -= 2 * cut;
  const ExtractedCenterline found = extracted(image);
  ASSERT_EQ(found.end_sections.size(), 2u);
  for (const EndSection& section : found.end_sections) {
    EXPECT_EQ(found.centerline.degree(section.node), 1u);
    EXPECT_NEAR(std::abs(section.normal.z()), 1, 1e-12);
    EXPECT_NEAR(section.area, M_PI * 16, 4);  // pixels
    EXPECT_FALSE(section.open);
    const double border =
        section.normal.z() < 0 ? v.origin.z() - 0.5 : v.origin.z() + static_cast<double>(v.size[2]) - 0.5;
    EXPECT_NEAR(found.centerline.node(section.node).position.z(), border, 1e-5);  // rounded to 1e-6
  }
  for (const CenterlineNode& node : found.centerline.nodes()) EXPECT_NEAR(node.radius, 4, 0.2);
}

TEST(MaskCenterline, SeveralLabelsAreOneVessel) {
  const Centerline truth{{{{0, 0, 0}, 3}, {{40, 0, 0}, 3}}, {{0, 1}}};
  LoadedImage image = mask_of(truth);
  for (std::size_t k = 0; k < image.image.size[2]; ++k)
    for (std::size_t j = 0; j < image.image.size[1]; ++j)
      for (std::size_t i = image.image.size[0] / 2; i < image.image.size[0]; ++i)
        image.image.values[image.image.offset(i, j, k)] *= 5;
  EXPECT_THROW(extracted(image), InvalidInput);
  ReferenceOptions inside;
  inside.labels = {1, 5};
  const double both = extracted(image, {}, inside).centerline.length_in_radii();
  inside.labels = {5};
  EXPECT_LT(extracted(image, {}, inside).centerline.length_in_radii(), 0.6 * both);
  inside.labels = {7};
  EXPECT_THROW(extracted(image, {}, inside), InvalidInput);
}

TEST(MaskCenterline, IsTheSameForAnyNumberOfThreads) {
  const LoadedImage image = mask_of(y_shape(3));
  const Centerline all = extracted(image).centerline;
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  const Centerline single = extracted(image).centerline;
  ASSERT_EQ(all.nodes().size(), single.nodes().size());
  for (Index n = 0; n < all.nodes().size(); ++n) {
    EXPECT_EQ(all.node(n).position, single.node(n).position);
    EXPECT_EQ(all.node(n).radius, single.node(n).radius);
  }
}

TEST(MaskCenterline, CanBeCancelledAtAnyReport) {
  const LoadedImage image = mask_of(y_shape(2));
  int all = 0;
  extract_centerline(vessel_mask(image, {}), {}, [&](std::string_view, double fraction) {
    EXPECT_GE(fraction, 0);
    EXPECT_LE(fraction, 1);
    return ++all > 0;
  });
  for (const int stop : {1, all / 2, all}) {
    int calls = 0;
    EXPECT_THROW(
        extract_centerline(vessel_mask(image, {}), {}, [&](std::string_view, double) { return ++calls < stop; }),
        Cancelled);
  }
}

}  // namespace
}  // namespace vmesh
