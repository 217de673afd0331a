#include "dicom_stack.h"

#include <algorithm>
#include <cmath>

#include "vmesh/core/ascending.h"
#include "vmesh/core/error.h"
#include "vmesh/core/text.h"

namespace vmesh::image {
namespace {

/// Of the distance between slices: how far a slice may be from its regular position.
constexpr double kTolerance = 0.1;
/// Slices nearer than this are at the same position (mm).
constexpr double kSamePlace = 1e-3;

Vec3 normal_of(const DicomSlice& slice) { return slice.steps.col(0).cross(slice.steps.col(1)).normalized(); }

std::string text_of(double mm) { return formatted("%.5g", mm); }

void check_alike(const std::vector<DicomSlice>& slices, const std::string& name) {
  const DicomSlice& first = slices.front();
  const double rounding = 1e-3 * first.steps.norm();
  std::size_t turned = 0, resized = 0;
  const DicomSlice* other = nullptr;
  for (const DicomSlice& slice : slices) {
    const bool is_resized = slice.columns != first.columns || slice.rows != first.rows ||
                            std::abs(slice.steps.norm() - first.steps.norm()) > rounding;
    const bool is_turned = !is_resized && (slice.steps - first.steps).norm() > rounding;
    resized += is_resized ? 1 : 0;
    turned += is_turned ? 1 : 0;
    if (other == nullptr && (is_turned || is_resized)) other = &slice;
  }
  if (other == nullptr) return;
  throw InvalidInput(name + ": " + std::to_string(turned + resized) + " of the " + std::to_string(slices.size()) +
                     " slices of this series " +
                     (turned > 0 ? "are rotated relative to the first one (localizers, or several stacks in one series)"
                                 : "differ from the first one in size or spacing") +
                     ": compare " + first.path.string() + " with " + other->path.string() +
                     "; put the slices of one stack into a folder of their own");
}

/// Positions of the slices along the normal; the slices are in ascending order.
std::vector<double> heights_of(const std::vector<DicomSlice>& slices, const Vec3& normal) {
  std::vector<double> heights;
  for (const DicomSlice& slice : slices) heights.push_back(slice.position.dot(normal));
  return heights;
}

void check_complete(const std::vector<DicomSlice>& slices, const std::vector<double>& heights,
                    const std::string& name) {
  std::vector<double> gaps;
  for (std::size_t s = 1; s < heights.size(); ++s) gaps.push_back(heights[s] - heights[s - 1]);
  const auto shared =
      static_cast<std::size_t>(std::count_if(gaps.begin(), gaps.end(), [](double gap) { return gap < kSamePlace; }));
  if (shared > 0)
    throw InvalidInput(name + ": " + std::to_string(shared) + " of the " + std::to_string(slices.size()) +
                       " slices of this series lie where another one does (several phases or echoes, or copies); put "
                       "those of one stack into a separate folder");
  const double usual = median(gaps);
  for (std::size_t s = 0; s < gaps.size(); ++s) {
    if (gaps[s] <= 1.5 * usual) continue;
    throw InvalidInput(name + ": slices are missing: there are " + text_of(gaps[s]) + " mm between " +
                       slices[s].path.string() + " and " + slices[s + 1].path.string() + " and " + text_of(usual) +
                       " mm between others; fetch the series again");
  }
}

/// Equidistant layers from the first slice to the last, with each slice assigned to its layer.
void set_layers(DicomStack& stack, const std::string& name) {
  const std::vector<DicomSlice>& slices = stack.slices;
  const auto gaps = static_cast<double>(slices.size() - 1);
  const Vec3 step = (slices.back().position - slices.front().position) / gaps;
  for (std::size_t s = 0; s < slices.size(); ++s) {
    const double off = (slices[s].position - stack.origin - static_cast<double>(s) * step).norm();
    if (off > kTolerance * step.norm())
      throw InvalidInput(name + ": its slices are not evenly spaced: " + slices[s].path.string() + " is " +
                         text_of(off) + " mm from where it should be with " + text_of(step.norm()) +
                         " mm between slices; resample the series, in 3D Slicer say, and store it as .nii.gz");
    stack.layer.push_back(s);
  }
  stack.steps.col(2) = step;
  stack.size[2] = slices.size();
}

/// The same for a segmentation, whose layers may hold several frames or none.
void set_segmented_layers(DicomStack& stack, const std::vector<double>& heights, double slice_step,
                          const std::string& name) {
  double step = slice_step > 0 ? slice_step : heights.back() - heights.front();
  for (std::size_t s = 1; slice_step == 0 && s < heights.size(); ++s)
    if (const double gap = heights[s] - heights[s - 1]; gap >= kSamePlace) step = std::min(step, gap);
  if (!(step >= kSamePlace)) throw InvalidInput(name + ": does not say how far apart its slices are");
  const Vec3 normal = normal_of(stack.slices.front());
  for (std::size_t s = 0; s < heights.size(); ++s) {
    const double layer = std::round((heights[s] - heights.front()) / step);
    const Vec3 place = stack.origin + layer * step * normal;
    if (layer > 1e6 || (stack.slices[s].position - place).norm() > kTolerance * step)
      throw InvalidInput(name + ": its frames are not evenly spaced, " + text_of(step) +
                         " mm apart; store the segmentation as .nii.gz, in 3D Slicer say");
    stack.layer.push_back(static_cast<std::size_t>(layer));
  }
  stack.steps.col(2) = step * normal;
  stack.size[2] = stack.layer.back() + 1;
}

}  // namespace

DicomStack stacked(std::vector<DicomSlice> slices, double slice_step, const std::string& name) {
  check_alike(slices, name);
  const bool segmented = slices.front().segment > 0;
  const Vec3 normal = normal_of(slices.front());
  std::stable_sort(slices.begin(), slices.end(), [&](const DicomSlice& a, const DicomSlice& b) {
    return a.position.dot(normal) < b.position.dot(normal);
  });
  const std::vector<double> heights = heights_of(slices, normal);
  if (slices.size() == 1 && !(segmented && slice_step > 0))
    throw InvalidInput(name + ": contains only one slice, which is not a volume; give the folder of the whole series");
  DicomStack stack;
  stack.slices = std::move(slices);
  stack.origin = stack.slices.front().position;
  stack.steps.leftCols<2>() = stack.slices.front().steps;
  stack.size = {stack.slices.front().columns, stack.slices.front().rows, 0};
  if (segmented) {
    set_segmented_layers(stack, heights, slice_step, name);
  } else {
    check_complete(stack.slices, heights, name);
    set_layers(stack, name);
  }
  return stack;
}

}  // namespace vmesh::image
