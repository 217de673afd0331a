#include "vmesh/skeleton/vessel_mask.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "vmesh/core/error.h"
#include "vmesh/core/memory.h"
#include "vmesh/image/image_io.h"
#include "vmesh/image/image_slices.h"

#include "mask_content.h"
#include "voxel_cleaning.h"

namespace vmesh {
namespace {

using skeleton::Crossing;
using skeleton::MaskContent;
using skeleton::Voxel;

bool is_inside(const ReferenceOptions& options, float value) {
  if (options.threshold) return value >= *options.threshold;
  if (options.labels.empty()) return value != 0;
  return std::find(options.labels.begin(), options.labels.end(), static_cast<double>(value)) != options.labels.end();
}

/// Inserts the runs of a row that are inside.
void insert_row(MaskContent& mask, std::span<const float> row, int j, int k) {
  const auto size = static_cast<int>(row.size());
  for (int i = 0; i < size;) {
    if (!is_inside(mask.options, row[i])) {
      ++i;
      continue;
    }
    int end = i + 1;
    while (end < size && row[end] == row[i]) ++end;
    mask.voxels.insert_row(i, end, j, k);
    i = end;
  }
}

void add_values(MaskContent& mask, std::span<const float> values) {
  float last = 0;
  for (const float value : values) {
    if (value == last || value == 0) continue;
    last = value;
    mask.highest = std::max(mask.highest, value);
    if (mask.values.size() <= kListedValues) mask.values.insert(value);
  }
}

/// Between a voxel and the next one along an axis.
void add_crossing(MaskContent& mask, const Voxel& v, int axis, float value, float next) {
  const double threshold = *mask.options.threshold;
  const bool inside = value >= threshold, next_inside = next >= threshold;
  if (inside == next_inside) return;
  Crossing crossing{v, static_cast<signed char>(axis), static_cast<signed char>(inside ? 1 : -1), 0};
  if (!inside) ++crossing.inside[axis];
  const double in = inside ? value : next, out = inside ? next : value;
  crossing.share = static_cast<float>((in - threshold) / (in - out));
  mask.crossings.push_back(crossing);
}

void add_crossings(MaskContent& mask, std::span<const float> values, int k) {
  const auto [ni, nj, nk] = mask.voxels.grid_size();
  const auto wide = static_cast<int>(ni), high = static_cast<int>(nj);
  const bool has_last = !mask.last_slice.empty();
  std::size_t at = 0;
  for (int j = 0; j < high; ++j) {
    for (int i = 0; i < wide; ++i, ++at) {
      if (i + 1 < wide) add_crossing(mask, {i, j, k}, 0, values[at], values[at + 1]);
      if (j + 1 < high) add_crossing(mask, {i, j, k}, 1, values[at], values[at + ni]);
      if (has_last) add_crossing(mask, {i, j, k - 1}, 2, mask.last_slice[at], values[at]);
    }
  }
  mask.last_slice.assign(values.begin(), values.end());
}

}  // namespace

VesselMask::VesselMask(const VoxelImage& frame, const ReferenceOptions& options)
    : content_(std::make_unique<MaskContent>()) {
  constexpr double kMostPerAxis = 1 << 30;
  double blocks = 1;
  for (const std::size_t count : frame.size) {
    if (static_cast<double>(count) > kMostPerAxis)
      throw Unsupported("an image of " + std::to_string(count) + " voxels along an axis; crop it to the vessels");
    blocks *= std::ceil(static_cast<double>(count) / skeleton::VoxelSet::kSide) + 2;
  }
  require_memory(sizeof(Index) * blocks,
                 "the vessels of an image of " + std::to_string(frame.size[0]) + " x " + std::to_string(frame.size[1]) +
                     " x " + std::to_string(frame.size[2]) + " voxels",
                 "crop it to them");
  content_->voxels = skeleton::VoxelSet(frame.size);
  content_->frame = {frame.origin, frame.steps};
  content_->options = options;
  content_->highest = -std::numeric_limits<float>::infinity();
}
VesselMask::~VesselMask() = default;
VesselMask::VesselMask(VesselMask&&) noexcept = default;
VesselMask& VesselMask::operator=(VesselMask&&) noexcept = default;

void VesselMask::add_slice(std::size_t k, std::span<const float> values) {
  MaskContent& mask = *content_;
  const auto [ni, nj, nk] = mask.voxels.grid_size();
  add_values(mask, values);
  for (std::size_t j = 0; j < nj; ++j)
    insert_row(mask, values.subspan(j * ni, ni), static_cast<int>(j), static_cast<int>(k));
  if (mask.options.threshold) add_crossings(mask, values, static_cast<int>(k));
}

void VesselMask::finish() {
  MaskContent& mask = *content_;
  mask.last_slice = {};
  const ReferenceOptions& options = mask.options;
  if (!options.threshold && options.labels.empty() && mask.values.size() > 1)
    throw InvalidInput("there is more than one value besides 0 (" + list_of_values(mask.values) +
                       "); choose one with --label, or --threshold for grey values");
  mask.voxels.number_voxels();
  if (mask.voxels.size() > 0) return;
  if (options.threshold)
    throw InvalidInput("no voxel is inside: the highest value is " + std::to_string(mask.highest) +
                       "; choose a lower threshold");
  throw InvalidInput("no voxel is inside: " + list_of_values(mask.values) +
                     "; choose a label or a threshold that occurs");
}

std::size_t VesselMask::voxel_count() const { return content_->voxels.size(); }

VesselMask vessel_mask(const LoadedImage& loaded, const ReferenceOptions& options) {
  if (options.spacing > 0 || options.smooth > 0) {
    const PreparedImage prepared = prepared_image(loaded, options);
    ReferenceOptions inside;
    inside.threshold = prepared.isovalue;
    return vessel_mask(LoadedImage{prepared.image, false, {}}, inside);
  }
  check(options);
  const VoxelImage& image = loaded.image;
  VesselMask mask(image, with_labels(options, loaded.segments));
  const std::size_t slice = image.size[0] * image.size[1];
  for (std::size_t k = 0; k < image.size[2]; ++k) mask.add_slice(k, std::span(image.values).subspan(k * slice, slice));
  mask.finish();
  return mask;
}

VesselMask read_vessel_mask(const std::filesystem::path& path, const ReferenceOptions& options,
                            std::vector<std::string>& warnings) {
  check(options);
  if (options.spacing > 0 || options.smooth > 0) {
    LoadedImage loaded = read_image(path, read_options_of(options));
    warnings.insert(warnings.end(), loaded.warnings.begin(), loaded.warnings.end());
    return vessel_mask(loaded, options);
  }
  std::unique_ptr<VesselMask> mask;
  read_image_slices(
      path,
      [&](const ImageFrame& image) {
        warnings.insert(warnings.end(), image.warnings.begin(), image.warnings.end());
        mask = std::make_unique<VesselMask>(image.frame, with_labels(options, image.segments));
      },
      [&](std::size_t k, std::span<const float> values) { mask->add_slice(k, values); }, read_options_of(options));
  mask->finish();
  return std::move(*mask);
}

namespace skeleton {
namespace {

/// Out of the vessels, by the voxels around.
Vec3 normal_at(const VoxelSet& voxels, const Voxel& v, const Vec3& spacing) {
  Vec3 normal = Vec3::Zero();
  visit_around(v, [&](const Voxel& near) {
    if (!voxels.contains(near)) normal += Vec3(near[0] - v[0], near[1] - v[1], near[2] - v[2]).cwiseProduct(spacing);
  });
  return normal;
}

class WallBuilder {
 public:
  WallBuilder(const MaskContent& mask, std::vector<Index>& component_of_sample)
      : mask_(mask), component_of_sample_(component_of_sample), spacing_(mask.frame.spacing()) {
    for (int a = 0; a < 3; ++a) face_[a] = spacing_.prod() / spacing_[a];
  }

  void add(const Voxel& v, int axis, int way, double share, double slack, Index component) {
    Vec3 normal = normal_at(mask_.as_given, v, spacing_);
    const double norm = normal.norm();
    // In a vessel of one voxel the sum is zero: every face counts as a side of a square tube.
    const double facing = norm > 1e-9 * spacing_.norm() ? std::abs(normal[axis]) / norm : std::sqrt(0.5);
    Vec3 at(v[0], v[1], v[2]);
    at[axis] += way * share;
    samples.points.push_back(mask_.frame.origin + mask_.frame.steps * at);
    samples.areas.push_back(face_[axis] * std::max(facing, 1e-3));
    samples.slack.push_back(slack * spacing_[axis] * facing);
    component_of_sample_.push_back(component);
  }

  FitSamples samples;

 private:
  const MaskContent& mask_;
  std::vector<Index>& component_of_sample_;
  Vec3 spacing_;
  Vec3 face_ = Vec3::Zero();  // area of the voxels' faces, mm^2
};

bool is_beyond(const VoxelSet& voxels, const Voxel& v) {
  for (int a = 0; a < 3; ++a)
    if (v[a] < 0 || v[a] >= static_cast<int>(voxels.grid_size()[a])) return true;
  return false;
}

}  // namespace

FitSamples wall_of(const MaskContent& mask, const std::vector<BorderEnd>& ends, const std::vector<Index>& component,
                   std::vector<Index>& component_of_sample) {
  WallBuilder wall(mask, component_of_sample);
  const VoxelSet& set = mask.as_given;
  const auto is_cut = [&](const Voxel& v, int axis, int way) {
    return std::any_of(ends.begin(), ends.end(), [&](const BorderEnd& end) {
      if (end.axis != axis || end.way != way) return false;
      const Vec3 away = Vec3(v[0] - end.middle[0], v[1] - end.middle[1], v[2] - end.middle[2]);
      return away.cwiseProduct(mask.frame.spacing()).norm() < 2 * end.end.radius;
    });
  };
  const bool grey = mask.options.threshold.has_value();
  for (const Crossing& crossing : mask.crossings) {
    Voxel outside = crossing.inside;
    outside[crossing.axis] += crossing.way;
    const Index n = mask.voxels.number(crossing.inside);
    if (n != kNone && set.contains(crossing.inside) && !set.contains(outside))
      wall.add(crossing.inside, crossing.axis, crossing.way, crossing.share, 0, component[n]);
  }
  for (const Voxel& v : set.voxels()) {
    const Index n = mask.voxels.number(v);
    for (int axis = 0; axis < 3; ++axis) {
      for (const int way : {-1, 1}) {
        Voxel outside = v;
        outside[axis] += way;
        if (set.contains(outside)) continue;
        const bool beyond = is_beyond(set, outside);
        if (beyond ? !is_cut(v, axis, way) : !grey) wall.add(v, axis, way, 0.5, 0.5, component[n]);
      }
    }
  }
  return std::move(wall.samples);
}

FitVoxels voxels_beside_wall(const MaskContent& mask, const std::vector<Index>& component,
                             std::vector<Index>& component_of_voxel) {
  const VoxelSet& set = mask.as_given;
  FitVoxels beside;
  beside.volume = mask.frame.spacing().prod();
  VoxelSet listed(set.grid_size());  // of those outside
  const auto add = [&](const Voxel& v, bool inside, Index c) {
    beside.points.push_back(mask.frame.position(v));
    beside.inside.push_back(inside);
    component_of_voxel.push_back(c);
  };
  for (const Voxel& v : set.voxels()) {
    const Index c = component[mask.voxels.number(v)];
    bool has_neighbour_outside = false;
    visit_around(v, [&](const Voxel& neighbour) {
      if (set.contains(neighbour) || is_beyond(set, neighbour)) return;
      has_neighbour_outside = true;
      if (listed.contains(neighbour)) return;
      listed.insert(neighbour);
      add(neighbour, false, c);
    });
    if (has_neighbour_outside) add(v, true, c);
  }
  return beside;
}

namespace {

/// Voxels at one side of the grid that touch each other.
std::vector<Voxel> patch_at(const VoxelSet& voxels, Index first, int axis, const std::vector<Voxel>& all,
                            std::vector<char>& seen) {
  std::vector<Voxel> patch = {all[first]};
  seen[first] = 1;
  const int u = (axis + 1) % 3, w = (axis + 2) % 3;
  for (std::size_t i = 0; i < patch.size(); ++i) {
    for (int du = -1; du <= 1; ++du)
      for (int dw = -1; dw <= 1; ++dw) {
        Voxel next = patch[i];
        next[u] += du;
        next[w] += dw;
        const Index n = voxels.number(next);
        if (n == kNone || seen[n]) continue;
        seen[n] = 1;
        patch.push_back(next);
      }
  }
  return patch;
}

}  // namespace

std::vector<BorderEnd> border_ends(const VoxelSet& voxels, const VoxelFrame& frame) {
  constexpr double kRound = 0.4;   // of the circle around it
  constexpr double kGoesOn = 0.6;  // of its voxels, a radius further in
  const std::vector<Voxel> all = voxels.voxels();
  const Vec3 spacing = frame.spacing();
  std::vector<BorderEnd> ends;
  std::vector<char> seen;
  for (int axis = 0; axis < 3; ++axis) {
    for (const int way : {-1, 1}) {
      const int border = way < 0 ? 0 : static_cast<int>(voxels.grid_size()[axis]) - 1;
      const int u = (axis + 1) % 3, w = (axis + 2) % 3;
      seen.assign(all.size(), 0);
      for (Index n = 0; n < all.size(); ++n) {
        if (all[n][axis] != border || seen[n]) continue;
        const std::vector<Voxel> patch = patch_at(voxels, n, axis, all, seen);
        const double area = static_cast<double>(patch.size()) * spacing[u] * spacing[w];
        const double radius = std::sqrt(area / std::numbers::pi);
        Vec3 middle = Vec3::Zero();
        for (const Voxel& v : patch) middle += Vec3(v[0], v[1], v[2]) / static_cast<double>(patch.size());
        double reach = 0;
        std::size_t further = 0;
        const Voxel* nearest = &patch.front();
        double least = std::numeric_limits<double>::infinity();
        for (const Voxel& v : patch) {
          const double away = (Vec3(v[0], v[1], v[2]) - middle).cwiseProduct(spacing).norm();
          reach = std::max(reach, away + 0.5 * std::min(spacing[u], spacing[w]));
          if (away < least) least = away, nearest = &v;
          Voxel in = v;
          in[axis] -= way * static_cast<int>(std::ceil(radius / spacing[axis]));
          further += !is_beyond(voxels, in) && voxels.contains(in);
        }
        if (area < kRound * std::numbers::pi * reach * reach ||
            static_cast<double>(further) < kGoesOn * static_cast<double>(patch.size()))
          continue;
        ends.push_back({{voxels.number(*nearest), radius}, *nearest, axis, way, area});
      }
    }
  }
  return ends;
}

}  // namespace skeleton
}  // namespace vmesh
