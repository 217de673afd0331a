#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include <zlib.h>

#include "vmesh/image/voxel_image.h"

namespace vmesh::testing {

/// A small image lying obliquely in space, and the bytes it has in files. Placed in LPS.
struct SampleImage {
  std::array<int, 3> size = {7, 6, 5};
  Vec3 spacing = Vec3(0.75, 1.25, 2.5);
  Eigen::Matrix3d direction = oblique();
  Vec3 origin = Vec3(10, -20, 30);

  static Eigen::Matrix3d oblique() {
    return (Eigen::AngleAxisd(0.5, Vec3::UnitX()) * Eigen::AngleAxisd(-0.3, Vec3::UnitY()) *
            Eigen::AngleAxisd(0.2, Vec3::UnitZ()))
        .toRotationMatrix();
  }
  int count() const { return size[0] * size[1] * size[2]; }
  Vec3 position(int i, int j, int k) const { return origin + direction * spacing.cwiseProduct(Vec3(i, j, k)); }

  /// A different number for every voxel.
  static int value(int i, int j, int k) { return i + 10 * j + 100 * k - 3; }
  std::vector<double> values() const {
    std::vector<double> all;
    for (int k = 0; k < size[2]; ++k)
      for (int j = 0; j < size[1]; ++j)
        for (int i = 0; i < size[0]; ++i) all.push_back(value(i, j, k));
    return all;
  }
};

template <class T>
std::string bytes_of(T value, bool big_endian) {
  auto buffer = std::bit_cast<std::array<char, sizeof(T)>>(value);
  if (big_endian != (std::endian::native == std::endian::big)) std::reverse(buffer.begin(), buffer.end());
  return {buffer.data(), buffer.size()};
}

template <class T>
std::string voxel_bytes(const std::vector<double>& values, bool big_endian = false) {
  std::string bytes;
  for (const double value : values) bytes += bytes_of(static_cast<T>(value), big_endian);
  return bytes;
}

/// A TIFF stack, a page and strip per slice, uncompressed; with a resolution if it is above 0.
template <class T>
std::string tiff_file(const SampleImage& image, const std::vector<double>& values, const std::string& description = "",
                      double resolution = 0, bool big_endian = false) {
  const std::string voxels = voxel_bytes<T>(values, big_endian);
  const std::size_t page_size = voxels.size() / static_cast<std::size_t>(image.size[2]);
  const auto word = [&](std::size_t value) { return bytes_of(static_cast<std::uint32_t>(value), big_endian); };
  const auto half = [&](int value) { return bytes_of(static_cast<std::uint16_t>(value), big_endian); };
  std::string file = big_endian ? std::string("MM\0*", 4) : std::string("II*\0", 4);
  std::size_t next = file.size();  // where the place of the next directory goes
  file += word(0);
  for (int k = 0; k < image.size[2]; ++k) {
    const std::size_t data = file.size();
    file += voxels.substr(static_cast<std::size_t>(k) * page_size, page_size);
    if (file.size() % 2 == 1) file += '\0';
    const std::size_t ratio = file.size();
    file += word(static_cast<std::size_t>(resolution * 1000)) + word(1000);
    const std::size_t text = file.size();
    file += description + std::string(8, '\0');
    if (file.size() % 2 == 1) file += '\0';
    const auto number = [&](int tag, std::size_t value) { return half(tag) + half(4) + word(1) + word(value); };
    const auto small = [&](int tag, int value) { return half(tag) + half(3) + word(1) + half(value) + half(0); };
    std::vector<std::string> entries = {number(256, static_cast<std::size_t>(image.size[0])),
                                        number(257, static_cast<std::size_t>(image.size[1])),
                                        small(258, 8 * static_cast<int>(sizeof(T))),
                                        small(259, 1),
                                        small(262, 1),
                                        half(270) + half(2) + word(description.size() + 5) + word(text),
                                        number(273, data),
                                        small(277, 1),
                                        number(278, static_cast<std::size_t>(image.size[1])),
                                        number(279, page_size),
                                        half(282) + half(5) + word(1) + word(ratio),
                                        half(283) + half(5) + word(1) + word(ratio),
                                        small(339, std::is_floating_point_v<T> ? 3
                                                   : std::is_signed_v<T>       ? 2
                                                                               : 1)};
    if (resolution == 0) entries.erase(entries.begin() + 10, entries.begin() + 12);
    if (description.empty()) entries.erase(entries.begin() + 5);
    file.replace(next, 4, word(file.size()));
    file += half(static_cast<int>(entries.size()));
    for (const std::string& entry : entries) file += entry;
    next = file.size();
    file += word(0);
  }
  return file;
}

/// A segmentation of 3D Slicer of 3 x 2 x 2 voxels, with two layers of the given values.
inline std::string layered_nrrd(const std::vector<int>& first, const std::vector<int>& second,
                                const std::string& more = "") {
  std::string file =
      "NRRD0005\ntype: uchar\ndimension: 4\nspace: left-posterior-superior\nsizes: 2 3 2 2\n"
      "space directions: none (1,0,0) (0,1,0) (0,0,2)\nkinds: list domain domain domain\nencoding: raw\n"
      "space origin: (5,6,7)\nSegment0_Name:=Portal\nSegment0_LabelValue:=1\nSegment0_Layer:=0\n"
      "Segment1_Name:=hepatic vein\nSegment1_LabelValue:=2\nSegment1_Layer:=0\nSegment1_Color:=1 0 0\n"
      "Segment2_Name:=tumor\nSegment2_LabelValue:=1\nSegment2_Layer:=1\n" +
      more + "\n";
  for (std::size_t v = 0; v < first.size(); ++v) {
    file += static_cast<char>(first[v]);
    file += static_cast<char>(second[v]);
  }
  return file;
}

/// NIfTI-1 data types by number.
template <class T>
constexpr int nifti_type() {
  if (std::is_same_v<T, std::uint8_t>) return 2;
  if (std::is_same_v<T, std::int16_t>) return 4;
  if (std::is_same_v<T, float>) return 16;
  if (std::is_same_v<T, double>) return 64;
  if (std::is_same_v<T, std::uint16_t>) return 512;
  throw std::logic_error("no such type here");
}

enum class NiftiPlace { sform, qform };

/// A NIfTI-1 file (n+1). Its frame is RAS.
template <class T>
std::string nifti_file(const SampleImage& image, const std::vector<double>& values,
                       NiftiPlace place = NiftiPlace::sform, bool big_endian = false) {
  std::string header(352, '\0');
  const auto put = [&](std::size_t at, auto value) {
    const std::string bytes = bytes_of(value, big_endian);
    header.replace(at, bytes.size(), bytes);
  };
  put(0, std::int32_t{348});
  put(40, std::int16_t{3});
  for (int a = 0; a < 7; ++a) put(42 + 2 * a, static_cast<std::int16_t>(a < 3 ? image.size[a] : 1));
  put(70, static_cast<std::int16_t>(nifti_type<T>()));
  put(72, static_cast<std::int16_t>(8 * sizeof(T)));
  put(76, 1.0f);
  for (int a = 0; a < 3; ++a) put(80 + 4 * a, static_cast<float>(image.spacing[a]));
  put(108, 352.0f);
  put(112, 1.0f);
  header[123] = 2;  // millimetres
  const Eigen::DiagonalMatrix<double, 3> flip(-1, -1, 1);
  const Eigen::Matrix3d ras = flip * image.direction;
  const Vec3 origin = flip * image.origin;
  if (place == NiftiPlace::sform) {
    put(254, std::int16_t{1});
    for (int row = 0; row < 3; ++row) {
      for (int a = 0; a < 3; ++a) put(280 + 16 * row + 4 * a, static_cast<float>(ras(row, a) * image.spacing[a]));
      put(280 + 16 * row + 12, static_cast<float>(origin[row]));
    }
  } else {
    const double handed = ras.determinant() < 0 ? -1 : 1;
    Eigen::Matrix3d rotation = ras;
    rotation.col(2) *= handed;
    Eigen::Quaterniond q(rotation);
    if (q.w() < 0) q.coeffs() *= -1;
    put(252, std::int16_t{1});
    put(76, static_cast<float>(handed));
    put(256, static_cast<float>(q.x()));
    put(260, static_cast<float>(q.y()));
    put(264, static_cast<float>(q.z()));
    for (int a = 0; a < 3; ++a) put(268 + 4 * a, static_cast<float>(origin[a]));
  }
  header.replace(344, 4, std::string("n+1\0", 4));
  return header + voxel_bytes<T>(values, big_endian);
}

/// The same as NIfTI-2 (n+2), placed by its sform.
template <class T>
std::string nifti2_file(const SampleImage& image, const std::vector<double>& values, bool big_endian = false) {
  std::string header(544, '\0');
  const auto put = [&](std::size_t at, auto value) {
    const std::string bytes = bytes_of(value, big_endian);
    header.replace(at, bytes.size(), bytes);
  };
  put(0, std::int32_t{540});
  header.replace(4, 8, std::string("n+2\0\r\n\032\n", 8));
  put(12, static_cast<std::int16_t>(nifti_type<T>()));
  put(14, static_cast<std::int16_t>(8 * sizeof(T)));
  put(16, std::int64_t{3});
  for (int a = 0; a < 7; ++a) put(24 + 8 * a, static_cast<std::int64_t>(a < 3 ? image.size[a] : 1));
  put(104, 1.0);
  for (int a = 0; a < 3; ++a) put(112 + 8 * a, image.spacing[a]);
  put(168, std::int64_t{544});
  put(176, 1.0);
  put(348, std::int32_t{1});
  const Eigen::DiagonalMatrix<double, 3> to_ras(-1, -1, 1);
  const Eigen::Matrix3d ras = to_ras * image.direction;
  const Vec3 origin = to_ras * image.origin;
  for (int row = 0; row < 3; ++row) {
    for (int a = 0; a < 3; ++a) put(400 + 32 * row + 8 * a, ras(row, a) * image.spacing[a]);
    put(400 + 32 * row + 24, origin[row]);
  }
  put(500, std::int32_t{2});  // millimetres
  return header + voxel_bytes<T>(values, big_endian);
}

inline std::string text_of(const Vec3& p, const char* separator) {
  std::ostringstream text;
  text.precision(17);
  text << p.x() << separator << p.y() << separator << p.z();
  return text.str();
}

inline std::string text_of(const std::array<int, 3>& n) {
  return std::to_string(n[0]) + " " + std::to_string(n[1]) + " " + std::to_string(n[2]);
}

/// `space`: left-posterior-superior or right-anterior-superior.
inline std::string nrrd_header(const SampleImage& image, const std::string& type,
                               const std::string& more = "encoding: raw\n", bool ras = false) {
  const Eigen::DiagonalMatrix<double, 3> flip(ras ? -1 : 1, ras ? -1 : 1, 1);
  std::string header = "NRRD0004\n# a comment\ntype: " + type +
                       "\ndimension: 3\nspace: " + (ras ? "right-anterior-superior" : "left-posterior-superior") +
                       "\nsizes: " + text_of(image.size) + "\nspace directions:";
  for (int a = 0; a < 3; ++a) header += " (" + text_of(flip * (image.spacing[a] * image.direction.col(a)), ",") + ")";
  return header + "\nkinds: domain domain domain\nendian: little\nspace origin: (" + text_of(flip * image.origin, ",") +
         ")\n" + more + "\n";
}

inline std::string mha_header(const SampleImage& image, const std::string& type, const std::string& more = "") {
  return "ObjectType = Image\nNDims = 3\nBinaryData = True\nBinaryDataByteOrderMSB = False\n" + more +
         "TransformMatrix = " + text_of(image.direction.col(0), " ") + " " + text_of(image.direction.col(1), " ") +
         " " + text_of(image.direction.col(2), " ") + "\nOffset = " + text_of(image.origin, " ") +
         "\nElementSpacing = " + text_of(image.spacing, " ") + "\nDimSize = " + text_of(image.size) +
         "\nElementType = " + type + "\nElementDataFile = LOCAL\n";
}

/// Compressed with zlib, or with gzip.
inline std::string packed(const std::string& bytes, bool gzip, int level = 6) {
  z_stream stream{};
  if (deflateInit2(&stream, level, Z_DEFLATED, gzip ? 31 : 15, 8, Z_DEFAULT_STRATEGY) != Z_OK) throw std::bad_alloc();
  std::string result(deflateBound(&stream, static_cast<uLong>(bytes.size())) + 64, '\0');
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));
  stream.avail_in = static_cast<uInt>(bytes.size());
  stream.next_out = reinterpret_cast<Bytef*>(result.data());
  stream.avail_out = static_cast<uInt>(result.size());
  deflate(&stream, Z_FINISH);
  result.resize(stream.total_out);
  deflateEnd(&stream);
  return result;
}

}  // namespace vmesh::testing
