// NIfTI-1 and NIfTI-2 (fields as in the NIfTI project's nifti1.h and nifti2.h), in one file or two, and Analyze 7.5,
// from which they came. Their frame is RAS.
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>

#include "vmesh/core/error.h"

#include "image_header.h"

namespace vmesh::image {
namespace {

/// Offsets of the fields that the two versions have in common.
struct Layout {
  bool wide;  // version 2: sizes and offsets of 8 bytes, numbers double
  std::size_t dim, datatype, pixdim, vox_offset, slope, intercept, qform, sform, quaternion, offset, rows, units, magic;
};

constexpr Layout kNifti1 = {false, 40, 70, 76, 108, 112, 116, 252, 254, 256, 268, 280, 123, 344};
constexpr Layout kNifti2 = {true, 16, 12, 104, 168, 176, 184, 344, 348, 352, 376, 400, 500, 4};
constexpr std::size_t kHeader1 = 348, kHeader2 = 540;

class Fields {
 public:
  Fields(std::string_view bytes, const Layout& which, bool big_endian)
      : layout(which), bytes_(bytes), big_endian_(big_endian) {}

  template <class T>
  T get(std::size_t at) const {
    std::array<char, sizeof(T)> buffer;
    std::memcpy(buffer.data(), bytes_.data() + at, sizeof(T));
    if (big_endian_ != (std::endian::native == std::endian::big)) std::reverse(buffer.begin(), buffer.end());
    return std::bit_cast<T>(buffer);
  }
  double real(std::size_t at, int i = 0) const {
    return layout.wide ? get<double>(at + 8 * i) : static_cast<double>(get<float>(at + 4 * i));
  }
  double size(int i) const {
    return layout.wide ? static_cast<double>(get<std::int64_t>(layout.dim + 8 * i))
                       : get<std::int16_t>(layout.dim + 2 * i);
  }
  int code(std::size_t at) const { return layout.wide ? get<std::int32_t>(at) : get<std::int16_t>(at); }
  int type() const { return get<std::int16_t>(layout.datatype); }  // of two bytes in both versions
  int units() const { return layout.wide ? get<std::int32_t>(layout.units) : bytes_[layout.units]; }
  double data_begin() const {
    return layout.wide ? static_cast<double>(get<std::int64_t>(layout.vox_offset)) : real(layout.vox_offset);
  }
  std::string_view magic() const { return bytes_.substr(layout.magic, 3); }

  const Layout& layout;

 private:
  std::string_view bytes_;
  bool big_endian_;
};

NumberType number_type(int code, const std::string& name) {
  switch (code) {
    case 2:
      return NumberType::u8;
    case 4:
      return NumberType::i16;
    case 8:
      return NumberType::i32;
    case 16:
      return NumberType::f32;
    case 64:
      return NumberType::f64;
    case 256:
      return NumberType::i8;
    case 512:
      return NumberType::u16;
    case 768:
      return NumberType::u32;
    case 1024:
      return NumberType::i64;
    case 1280:
      return NumberType::u64;
    default:
      throw Unsupported(name + ": NIfTI data type " + std::to_string(code) +
                        " is not supported; store integers or real numbers, one per voxel");
  }
}

double millimetres(int units, const std::string& name) {
  switch (units & 7) {
    case 0:
    case 2:
      return 1;
    case 1:
      return 1000;
    case 3:
      return 0.001;
    default:
      throw InvalidInput(name + ": the header gives an unknown unit of length");
  }
}

struct Place {
  Eigen::Matrix3d steps;
  Vec3 origin;
};

Place sform_of(const Fields& fields) {
  Place place;
  for (int row = 0; row < 3; ++row) {
    for (int a = 0; a < 3; ++a) place.steps(row, a) = fields.real(fields.layout.rows, 4 * row + a);
    place.origin[row] = fields.real(fields.layout.rows, 4 * row + 3);
  }
  return place;
}

Vec3 spacing_of(const Fields& fields) {
  Vec3 spacing;
  for (int a = 0; a < 3; ++a) spacing[a] = std::abs(fields.real(fields.layout.pixdim, a + 1));
  return spacing;
}

Place qform_of(const Fields& fields) {
  const auto component = [&](int i) { return fields.real(fields.layout.quaternion, i); };
  const Vec3 v(component(0), component(1), component(2));
  Eigen::Quaterniond q(std::sqrt(std::max(0.0, 1 - v.squaredNorm())), v.x(), v.y(), v.z());
  q.normalize();
  Place place{q.toRotationMatrix() * spacing_of(fields).asDiagonal(), Vec3::Zero()};
  if (fields.real(fields.layout.pixdim) < 0) place.steps.col(2) *= -1;
  for (int a = 0; a < 3; ++a) place.origin[a] = fields.real(fields.layout.offset, a);
  return place;
}

bool is_skewed(const Place& place) {
  const Eigen::Matrix3d unit = place.steps.colwise().normalized();
  // ITK, and hence 3D Slicer, test for skew with about this tolerance; float rounding is far below.
  return !((unit.transpose() * unit).isIdentity(1e-3));
}

enum class Kind { one_file, two_files, analyze };

Kind kind_of(const Fields& fields, const std::string& name) {
  const std::string_view magic = fields.magic();
  if (magic == "n+1" || magic == "n+2") return Kind::one_file;
  if (magic == "ni1" || magic == "ni2") return Kind::two_files;
  const std::string extension = folded(std::filesystem::path(name).extension().string());
  if (!fields.layout.wide && extension == ".hdr") return Kind::analyze;  // has no magic number
  throw InvalidInput(name + ": this is not a NIfTI file: it has no magic number");
}

/// As in 3D Slicer: the sform, unless it is skewed and there is a qform. Analyze has neither.
Place place_of(const Fields& fields, Kind kind, ImageHeader& header, const std::string& name) {
  const bool is_nifti = kind != Kind::analyze;
  const bool has_qform = is_nifti && fields.code(fields.layout.qform) > 0;
  const bool has_sform = is_nifti && fields.code(fields.layout.sform) > 0;
  if (has_sform && !(has_qform && is_skewed(sform_of(fields)))) return sform_of(fields);
  if (has_qform) return qform_of(fields);
  header.warnings.push_back(name +
                            (is_nifti ? ": gives no position in space (neither qform nor sform)"
                                      : ": Analyze files do not say which side is left and where they lie") +
                            "; its axes are assumed to run to the left, back and top, as in ITK");
  const Vec3 spacing = spacing_of(fields);
  return {Vec3(-spacing.x(), -spacing.y(), spacing.z()).asDiagonal(), Vec3::Zero()};
}

void set_data(ImageHeader& header, const Fields& fields, Kind kind, const std::string& name) {
  header.type = number_type(fields.type(), name);
  const double begin = fields.data_begin();
  const double header_size = static_cast<double>(fields.layout.wide ? kHeader2 : kHeader1);
  if (!(begin >= (kind == Kind::one_file ? header_size : 0) && begin <= 1e9))
    throw InvalidInput(name + ": the header does not say where the voxels begin");
  header.data_begin = static_cast<std::uint64_t>(begin);
  if (kind != Kind::one_file)
    header.data_file = other_of_pair(std::filesystem::path(name).filename(), ".img", ".IMG").string();
  if (kind == Kind::analyze) return;
  const double slope = fields.real(fields.layout.slope), intercept = fields.real(fields.layout.intercept);
  if (slope != 0 && std::isfinite(slope) && std::isfinite(intercept)) {
    header.slope = slope;
    header.intercept = intercept;
  }
}

Fields fields_of(std::string_view bytes, const std::string& name, bool& big_endian) {
  if (bytes.size() >= kHeader1) {
    for (const bool big : {false, true}) {
      big_endian = big;
      const std::int32_t size = Fields(bytes, kNifti1, big).get<std::int32_t>(0);
      if (size == kHeader1) return {bytes, kNifti1, big};
      if (size == kHeader2 && bytes.size() >= kHeader2) return {bytes, kNifti2, big};
    }
  }
  throw InvalidInput(name + ": this is not a NIfTI file, or only the beginning of one");
}

}  // namespace

ImageHeader parse_nifti_header(std::string_view bytes, const std::string& name) {
  ImageHeader header;
  const Fields fields = fields_of(bytes, name, header.big_endian);
  const Kind kind = kind_of(fields, name);
  const double dimensions = fields.size(0);
  if (!(dimensions >= 1 && dimensions <= 7)) throw InvalidInput(name + ": the header gives no number of dimensions");
  std::vector<double> sizes;
  for (int a = 1; a <= static_cast<int>(dimensions); ++a) sizes.push_back(fields.size(a));
  set_size(header, sizes, name);

  set_data(header, fields, kind, name);
  const Eigen::DiagonalMatrix<double, 3> to_lps(-1, -1, 1);
  const Place place = place_of(fields, kind, header, name);
  const double scale = kind == Kind::analyze ? 1 : millimetres(fields.units(), name);
  header.steps = scale * (to_lps * place.steps);
  header.origin = scale * (to_lps * place.origin);
  return header;
}

}  // namespace vmesh::image
