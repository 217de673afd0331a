// Small DICOM files (explicit VR, little endian), written without a library.
#pragma once

#include <cstdio>
#include <string>
#include <vector>

#include "image_files.h"

namespace vmesh::testing {

/// An element; `text` values are padded to an even length.
inline std::string element(unsigned group, unsigned number, const std::string& vr, std::string value) {
  if (value.size() % 2 != 0) value += vr == "UI" || vr == "OB" ? '\0' : ' ';
  const bool long_form = vr == "OB" || vr == "OW" || vr == "SQ";
  std::string bytes =
      bytes_of(static_cast<std::uint16_t>(group), false) + bytes_of(static_cast<std::uint16_t>(number), false) + vr;
  bytes += long_form ? std::string(2, '\0') + bytes_of(static_cast<std::uint32_t>(value.size()), false)
                     : bytes_of(static_cast<std::uint16_t>(value.size()), false);
  return bytes + value;
}

inline std::string short_element(unsigned group, unsigned number, int value) {
  return element(group, number, "US", bytes_of(static_cast<std::uint16_t>(value), false));
}

inline std::string sequence(unsigned group, unsigned number, const std::vector<std::string>& items) {
  std::string bytes;
  for (const std::string& item : items)
    bytes += bytes_of(std::uint16_t{0xfffe}, false) + bytes_of(std::uint16_t{0xe000}, false) +
             bytes_of(static_cast<std::uint32_t>(item.size()), false) + item;
  return element(group, number, "SQ", bytes);
}

/// Numbers as DICOM's decimal strings, of at most 16 characters.
inline std::string decimals(std::initializer_list<double> numbers) {
  std::string text;
  for (const double number : numbers) {
    char buffer[32];
    std::snprintf(buffer, sizeof buffer, "%.9g", number);
    text += (text.empty() ? "" : "\\") + std::string(buffer);
  }
  return text;
}

inline std::string decimals(const Vec3& p) { return decimals({p.x(), p.y(), p.z()}); }

/// With preamble and file meta information before the elements.
inline std::string dicom_file(const std::string& sop_class, const std::string& instance, const std::string& elements) {
  const std::string meta = element(2, 1, "OB", std::string("\0\1", 2)) + element(2, 2, "UI", sop_class) +
                           element(2, 3, "UI", instance) + element(2, 0x10, "UI", "1.2.840.10008.1.2.1") +
                           element(2, 0x12, "UI", "1.2.3.4");
  return std::string(128, '\0') + "DICM" +
         element(2, 0, "UL", bytes_of(static_cast<std::uint32_t>(meta.size()), false)) + meta + elements;
}

struct DicomTags {
  std::string series = "1.2.3.5", description = "vessels", modality = "CT";
  double slope = 1, intercept = -1024;
};

inline std::string orientation_of(const SampleImage& image) {
  const Vec3 row = image.direction.col(0), column = image.direction.col(1);
  return decimals({row.x(), row.y(), row.z(), column.x(), column.y(), column.z()});
}

inline std::string pixel_spacing_of(const SampleImage& image) {
  return decimals({image.spacing.y(), image.spacing.x()});
}

/// Slice k; `values` are those of the whole image after rescaling.
inline std::string dicom_slice(const SampleImage& image, const std::vector<double>& values, int k,
                               const DicomTags& tags = {}) {
  const std::string ct = "1.2.840.10008.5.1.4.1.1.2", instance = tags.series + "." + std::to_string(k + 1);
  const std::size_t area = static_cast<std::size_t>(image.size[0]) * image.size[1];
  std::vector<double> stored;
  for (std::size_t v = 0; v < area; ++v) stored.push_back((values[k * area + v] - tags.intercept) / tags.slope);
  return dicom_file(
      ct, instance,
      element(8, 0x16, "UI", ct) + element(8, 0x18, "UI", instance) + element(8, 0x60, "CS", tags.modality) +
          element(8, 0x103e, "LO", tags.description) + element(0x20, 0xd, "UI", "1.2.3") +
          element(0x20, 0xe, "UI", tags.series) + element(0x20, 0x13, "IS", std::to_string(k + 1)) +
          element(0x20, 0x32, "DS", decimals(image.position(0, 0, k))) +
          element(0x20, 0x37, "DS", orientation_of(image)) + short_element(0x28, 2, 1) +
          element(0x28, 4, "CS", "MONOCHROME2") + short_element(0x28, 0x10, image.size[1]) +
          short_element(0x28, 0x11, image.size[0]) + element(0x28, 0x30, "DS", pixel_spacing_of(image)) +
          short_element(0x28, 0x100, 16) + short_element(0x28, 0x101, 16) + short_element(0x28, 0x102, 15) +
          short_element(0x28, 0x103, 1) + element(0x28, 0x1052, "DS", decimals({tags.intercept})) +
          element(0x28, 0x1053, "DS", decimals({tags.slope})) +
          element(0x7fe0, 0x10, "OW", voxel_bytes<std::int16_t>(stored)));
}

/// All slices in one file, in the order given; each is stored with a slope of its own.
inline std::string dicom_frames(const SampleImage& image, const std::vector<double>& values,
                                const std::vector<int>& order) {
  const std::string enhanced_ct = "1.2.840.10008.5.1.4.1.1.2.1";
  const std::size_t area = static_cast<std::size_t>(image.size[0]) * image.size[1];
  std::vector<std::string> places;
  std::vector<double> stored;
  for (const int k : order) {
    const double slope = k % 2 == 0 ? 1 : 2, intercept = -1024;
    places.push_back(sequence(0x20, 0x9113, {element(0x20, 0x32, "DS", decimals(image.position(0, 0, k)))}) +
                     sequence(0x28, 0x9145,
                              {element(0x28, 0x1052, "DS", decimals({intercept})) +
                               element(0x28, 0x1053, "DS", decimals({slope}))}));
    for (std::size_t v = 0; v < area; ++v) stored.push_back((values[k * area + v] - intercept) / slope);
  }
  const std::string shared = sequence(0x20, 0x9116, {element(0x20, 0x37, "DS", orientation_of(image))}) +
                             sequence(0x28, 0x9110, {element(0x28, 0x30, "DS", pixel_spacing_of(image))});
  return dicom_file(
      enhanced_ct, "1.2.3.9",
      element(8, 0x16, "UI", enhanced_ct) + element(8, 0x18, "UI", "1.2.3.9") + element(8, 0x60, "CS", "CT") +
          element(0x20, 0xd, "UI", "1.2.3") + element(0x20, 0xe, "UI", "1.2.3.8") + short_element(0x28, 2, 1) +
          element(0x28, 4, "CS", "MONOCHROME2") + element(0x28, 8, "IS", std::to_string(order.size())) +
          short_element(0x28, 0x10, image.size[1]) + short_element(0x28, 0x11, image.size[0]) +
          short_element(0x28, 0x100, 16) + short_element(0x28, 0x101, 16) + short_element(0x28, 0x102, 15) +
          short_element(0x28, 0x103, 1) + sequence(0x5200, 0x9229, {shared}) + sequence(0x5200, 0x9230, places) +
          element(0x7fe0, 0x10, "OW", voxel_bytes<std::int16_t>(stored)));
}

/// A frame of a segmentation: where `labels` are `segment` in slice k.
struct SegmentFrame {
  int segment, k;
};

/// A segmentation with a bit for each voxel.
inline std::string dicom_segmentation(const SampleImage& image, const std::vector<double>& labels,
                                      const std::vector<SegmentFrame>& frames) {
  const std::string seg = "1.2.840.10008.5.1.4.1.1.66.4";
  const std::size_t area = static_cast<std::size_t>(image.size[0]) * image.size[1];
  std::vector<std::string> places;
  std::string bits((frames.size() * area + 7) / 8, '\0');
  for (std::size_t f = 0; f < frames.size(); ++f) {
    places.push_back(sequence(0x20, 0x9113, {element(0x20, 0x32, "DS", decimals(image.position(0, 0, frames[f].k)))}) +
                     sequence(0x62, 0xa, {short_element(0x62, 0xb, frames[f].segment)}));
    for (std::size_t v = 0; v < area; ++v) {
      const std::size_t bit = f * area + v;
      if (labels[frames[f].k * area + v] == frames[f].segment) bits[bit / 8] |= static_cast<char>(1 << bit % 8);
    }
  }
  const std::string shared = sequence(0x20, 0x9116, {element(0x20, 0x37, "DS", orientation_of(image))}) +
                             sequence(0x28, 0x9110,
                                      {element(0x18, 0x88, "DS", decimals({image.spacing.z()})) +
                                       element(0x28, 0x30, "DS", pixel_spacing_of(image))});
  return dicom_file(
      seg, "1.2.3.9",
      element(8, 0x16, "UI", seg) + element(8, 0x18, "UI", "1.2.3.9") + element(8, 0x60, "CS", "SEG") +
          element(0x20, 0xd, "UI", "1.2.3") + element(0x20, 0xe, "UI", "1.2.3.8") + short_element(0x28, 2, 1) +
          element(0x28, 4, "CS", "MONOCHROME2") + element(0x28, 8, "IS", std::to_string(frames.size())) +
          short_element(0x28, 0x10, image.size[1]) + short_element(0x28, 0x11, image.size[0]) +
          short_element(0x28, 0x100, 1) + short_element(0x28, 0x101, 1) + short_element(0x28, 0x102, 0) +
          short_element(0x28, 0x103, 0) + element(0x62, 1, "CS", "BINARY") + sequence(0x5200, 0x9229, {shared}) +
          sequence(0x5200, 0x9230, places) + element(0x7fe0, 0x10, "OB", bits));
}

/// Tubes about polylines, as a scanner with contrast agent sees them: 400 inside, 0 outside, blurred between.
inline std::vector<double> vessels_in(const SampleImage& image,
                                      const std::vector<std::vector<std::pair<Vec3, double>>>& tubes) {
  std::vector<double> values;
  for (int k = 0; k < image.size[2]; ++k)
    for (int j = 0; j < image.size[1]; ++j)
      for (int i = 0; i < image.size[0]; ++i) {
        const Vec3 p = image.position(i, j, k);
        double depth = -1e9;
        for (const auto& tube : tubes)
          for (std::size_t s = 1; s < tube.size(); ++s) {
            const auto& [a, ra] = tube[s - 1];
            const auto& [b, rb] = tube[s];
            const double t = std::clamp((p - a).dot(b - a) / (b - a).squaredNorm(), 0.0, 1.0);
            depth = std::max(depth, ra + t * (rb - ra) - (p - a - t * (b - a)).norm());
          }
        values.push_back(std::round(std::clamp(200 + 200 * depth, 0.0, 400.0)));
      }
  return values;
}

/// A scan of 48 x 40 x 36 voxels, askew, with a Y and a bent tube in it.
inline SampleImage scan_place() {
  SampleImage image;
  image.size = {48, 40, 36};
  image.spacing = Vec3(0.8, 0.9, 1.25);
  return image;
}

inline std::vector<double> scan_of_vessels(const SampleImage& image, bool y = true, bool bent = true) {
  const auto at = [&](double x, double up, double z) -> Vec3 {
    return image.position(0, 0, 0) + image.direction * Vec3(x, up, z);
  };
  std::vector<std::vector<std::pair<Vec3, double>>> tubes;
  if (y) {
    tubes.push_back({{at(12, 15, 6), 3.5}, {at(13, 16, 20), 3.2}});
    tubes.push_back({{at(13, 16, 20), 2.6}, {at(7, 20, 38), 2.2}});
    tubes.push_back({{at(13, 16, 20), 2.4}, {at(20, 11, 38), 2.0}});
  }
  std::vector<std::pair<Vec3, double>> arc;
  for (int s = 0; s <= 12; ++s) arc.push_back({at(22 + 9 * std::sin(0.15 * s), 28, 8 + 2 * s), 2.5});
  if (bent) tubes.push_back(arc);
  return vessels_in(image, tubes);
}

}  // namespace vmesh::testing
