#include "vmesh/image/image_summary.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "slice_runs.h"
#include "value_histogram.h"

namespace vmesh {
namespace {

using image::Run;
using image::SliceRuns;

/// Counts the voxels and components of an image's labels, slice by slice, as long as there are few.
class LabelCounter {
 public:
  /// Counts the next slice, or returns false: it has a value that is not whole, or there are too many. Nothing of it is
  /// counted then, and no further slice may follow.
  bool add(std::span<const float> slice, std::size_t row_length) {
    SliceRuns runs;
    for (std::size_t begin = 0; begin < slice.size(); begin += row_length)
      if (!add_row(slice.subspan(begin, row_length), runs)) return false;
    counts_.resize(values_.size());
    std::uint64_t labelled = 0;
    for (const Run& run : runs.runs) {
      counts_[run.label] += run.last - run.first + 1;
      labelled += run.last - run.first + 1;
    }
    zeros_ += slice.size() - labelled;
    components_.add(std::move(runs));
    return true;
  }

  std::uint64_t zeros() const { return zeros_; }

  /// Of the slices so far, ascending.
  std::vector<ImageLabel> labels(double voxel_mm3) {
    components_.end();
    std::vector<ImageLabel> labels;
    for (std::size_t n = 0; n < counts_.size(); ++n)
      labels.push_back({values_[n], counts_[n], components_.ended()[n], static_cast<double>(counts_[n]) * voxel_mm3});
    std::ranges::sort(labels, {}, &ImageLabel::value);
    return labels;
  }

 private:
  bool add_row(std::span<const float> row, SliceRuns& slice) {
    for (std::size_t first = 0, end = 0; first < row.size(); first = end) {
      const float value = row[first];
      end = first + 1;
      while (end < row.size() && row[end] == value) ++end;
      if (value == 0) continue;
      if (!find(value)) return false;
      slice.runs.push_back({first, end - 1, found_, 0});
    }
    slice.row_end.push_back(slice.runs.size());
    return true;
  }

  /// Sets found_ to the value's label, a new one if need be; false if it cannot have one.
  bool find(float value) {
    if (found_ < values_.size() && values_[found_] == value) return true;
    found_ = static_cast<std::size_t>(std::ranges::find(values_, value) - values_.begin());
    if (found_ < values_.size()) return true;
    if (values_.size() == ImageSummary::kMostLabels || value != std::floor(value)) return false;
    values_.push_back(value);
    return true;
  }

  std::vector<float> values_;  ///< of every label
  std::size_t found_ = 0;
  std::vector<std::uint64_t> counts_;
  std::uint64_t zeros_ = 0;
  image::ComponentCounter components_;
};

class GreyCounter {
 public:
  void add(float value, std::uint64_t count) {
    if (count == 0) return;
    histogram_.add(value, count);
    least_ = std::min(least_, value);
    greatest_ = std::max(greatest_, value);
    sum_ += static_cast<double>(value) * static_cast<double>(count);
    voxels_ += count;
    if (value == 0) zeros_ += count;
  }

  void add(std::span<const float> slice) {
    double sum = 0;
    for (const float value : slice) {
      histogram_.add(value);
      least_ = std::min(least_, value);
      greatest_ = std::max(greatest_, value);
      sum += value;
      zeros_ += value == 0 ? 1 : 0;
    }
    sum_ += sum;
    voxels_ += slice.size();
  }

  std::uint64_t zeros() const { return zeros_; }

  GreyValues values() const {
    GreyValues values;
    values.least = least_;
    values.greatest = greatest_;
    values.mean = sum_ / static_cast<double>(voxels_);
    for (Percentile& percentile : values.percentiles) percentile.value = histogram_.quantile(percentile.percent / 100);
    return values;
  }

 private:
  image::ValueHistogram histogram_;
  float least_ = std::numeric_limits<float>::infinity(), greatest_ = -least_;
  double sum_ = 0;
  std::uint64_t voxels_ = 0, zeros_ = 0;
};

/// Takes the slices for labels until that is refuted, then for grey values.
class Summarizer {
 public:
  void begin(const ImageFrame& image) { summary_.image = image; }

  void add(std::span<const float> slice) {
    if (!grey_ && labels_.add(slice, summary_.image.frame.size[0])) return;
    if (!grey_) become_grey();
    grey_->add(slice);
  }

  ImageSummary end() {
    summary_.zeros = grey_ ? grey_->zeros() : labels_.zeros();
    if (grey_) {
      summary_.grey = grey_->values();
    } else {
      summary_.labels = labels_.labels(voxel_mm3());
    }
    return std::move(summary_);
  }

 private:
  double voxel_mm3() const { return std::abs(summary_.image.frame.steps.determinant()); }

  void become_grey() {
    grey_.emplace();
    grey_->add(0, labels_.zeros());
    for (const ImageLabel& label : labels_.labels(voxel_mm3())) grey_->add(label.value, label.voxels);
  }

  ImageSummary summary_;
  LabelCounter labels_;
  std::optional<GreyCounter> grey_;
};

}  // namespace

ImageSummary summarize_image(const std::filesystem::path& path, const Progress& progress,
                             const ImageReadOptions& options) {
  Summarizer summarizer;
  double slices = 1;
  const auto begin = [&](const ImageFrame& image) {
    summarizer.begin(image);
    slices = static_cast<double>(image.frame.size[2]);
  };
  read_image_slices(
      path, begin,
      [&](std::size_t k, std::span<const float> slice) {
        report_progress(progress, "reading", static_cast<double>(k) / slices);
        summarizer.add(slice);
      },
      options);
  return summarizer.end();
}

ImageSummary summarize_image(const LoadedImage& image) {
  Summarizer summarizer;
  ImageFrame frame;
  frame.integer = image.integer;
  frame.warnings = image.warnings;
  frame.frame.size = image.image.size;
  frame.frame.origin = image.image.origin;
  frame.frame.steps = image.image.steps;
  summarizer.begin(frame);
  visit_slices(image.image, [&](std::size_t, std::span<const float> slice) { summarizer.add(slice); });
  return summarizer.end();
}

}  // namespace vmesh
