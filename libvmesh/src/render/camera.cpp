#include "render/camera.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>

#include <Eigen/Geometry>

#include "vmesh/core/error.h"

namespace vmesh {
namespace {

constexpr double kMargin = 0.06;  // on every side, as a share of the picture
constexpr double kDegree = std::numbers::pi / 180;

std::optional<double> parse_number(std::string_view text) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value)) return std::nullopt;
  return value;
}

}  // namespace

ViewDirection view_direction(std::string_view name) {
  if (name == "front") return {0, 0};
  if (name == "back") return {180, 0};
  if (name == "left") return {90, 0};
  if (name == "right") return {-90, 0};
  if (name == "top") return {0, 90};
  if (name == "bottom") return {0, -90};
  if (name == "iso") return {-35, 30};
  if (const auto comma = name.find(','); comma != name.npos) {
    const auto azimuth = parse_number(name.substr(0, comma)), elevation = parse_number(name.substr(comma + 1));
    if (azimuth && elevation) return {*azimuth, *elevation};
  }
  throw InvalidInput("view \"" + std::string(name) +
                     "\": give front, back, left, right, top, bottom, iso or AZIMUTH,ELEVATION in degrees");
}

Camera::Camera(const TriMesh& mesh, const RenderOptions& options, int reserved_columns)
    : usable_width_(options.width - reserved_columns), height_(options.height) {
  const double azimuth = options.view.azimuth_deg * kDegree, elevation = options.view.elevation_deg * kDegree;
  towards_ = {std::sin(azimuth) * std::cos(elevation), -std::cos(azimuth) * std::cos(elevation), std::sin(elevation)};
  right_ = {std::cos(azimuth), std::sin(azimuth), 0};
  up_ = towards_.cross(right_);
  middle_ = {usable_width_ / 2, height_ / 2};
  fit(mesh, options);
}

void Camera::fit(const TriMesh& mesh, const RenderOptions& options) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  Vec3 low = Vec3::Constant(kInfinity), high = Vec3::Constant(-kInfinity);  // right, up, towards
  for (const auto& face : mesh.faces) {
    for (const Index v : face) {
      const Vec3& p = mesh.vertices[v];
      const Vec3 q(p.dot(right_), p.dot(up_), p.dot(towards_));
      low = low.cwiseMin(q);
      high = high.cwiseMax(q);
    }
  }
  const Vec3 middle = 0.5 * (low + high);
  center_ = options.look_at ? *options.look_at : Vec3(middle.x() * right_ + middle.y() * up_ + middle.z() * towards_);
  front_ = high.z() - center_.dot(towards_);
  depth_ = std::max(high.z() - low.z(), 1e-12);

  const double room_x = usable_width_ * (1 - 2 * kMargin), room_y = height_ * (1 - 2 * kMargin);
  const bool perspective = options.field_of_view_deg > 0;
  const double tangent_per_pixel = 2 * std::tan(options.field_of_view_deg * kDegree / 2) / height_;
  if (options.view_height_mm > 0) {
    mm_per_pixel_ = options.view_height_mm / height_;
  } else if (!perspective) {
    mm_per_pixel_ = std::max((high.x() - low.x()) / room_x, (high.y() - low.y()) / room_y);
  } else {
    double distance = 0;  // so that every vertex of a face is visible
    for (const auto& face : mesh.faces) {
      for (const Index v : face) {
        const Vec3 d = mesh.vertices[v] - center_;
        const double needed_x = std::abs(d.dot(right_)) / (tangent_per_pixel * room_x / 2);
        const double needed_y = std::abs(d.dot(up_)) / (tangent_per_pixel * room_y / 2);
        distance = std::max(distance, d.dot(towards_) + std::max(needed_x, needed_y));
      }
    }
    mm_per_pixel_ = distance * tangent_per_pixel;
  }
  if (!(mm_per_pixel_ > 0)) mm_per_pixel_ = 1;  // a single point
  mm_per_pixel_ /= options.zoom;
  if (perspective) distance_ = mm_per_pixel_ / tangent_per_pixel;
}

Ray Camera::ray(double x, double y) const {
  const Vec3 offset = mm_per_pixel_ * ((x - middle_.x()) * right_ - (y - middle_.y()) * up_);
  if (distance_ == 0) return {center_ + offset + (front_ + 0.01 * depth_) * towards_, -towards_};
  return {center_ + distance_ * towards_, (offset - distance_ * towards_).normalized()};
}

Vec2 Camera::project(const Vec3& p) const {
  const Vec3 d = p - center_;
  double scale = 1 / mm_per_pixel_;
  if (distance_ > 0) scale *= distance_ / std::max(distance_ - d.dot(towards_), kNearest * distance_);
  return {middle_.x() + scale * d.dot(right_), middle_.y() - scale * d.dot(up_)};
}

}  // namespace vmesh
