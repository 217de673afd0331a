#include "quality/triangle_tree.h"

#include <cmath>
#include <limits>
#include <string>

#include <tbb/task_arena.h>

#if VMESH_EMBREE == 3
#include <embree3/rtcore.h>
#else
#include <embree4/rtcore.h>
#endif

#include "vmesh/core/error.h"
#include "vmesh/mesh/embree_device.h"

namespace vmesh {
namespace {

// A handful of float roundings of a coordinate, of a box and of a distance, each 2^-24 of the largest number involved.
constexpr double kFloatSlack = 0x1p-20;

[[noreturn]] void refuse(const TriMesh& mesh, std::size_t face, Index vertex) {
  const std::string name = "face " + std::to_string(face);
  if (vertex >= mesh.vertices.size()) {
    throw InvalidInput(name + " names vertex " + std::to_string(vertex) + ", but the mesh has " +
                       std::to_string(mesh.vertices.size()) + " vertices");
  }
  throw InvalidInput("vertex " + std::to_string(vertex) + " of " + name +
                     " is not finite or farther than 1e15 mm from the origin; remove the face or repair the file");
}

float up(double value) { return std::nextafter(static_cast<float>(value), std::numeric_limits<float>::infinity()); }

RTCPointQuery point_query(const Vec3& local, double radius) {
  RTCPointQuery query;
  query.x = static_cast<float>(local.x());
  query.y = static_cast<float>(local.y());
  query.z = static_cast<float>(local.z());
  query.radius = up(radius);
  query.time = 0;
  return query;
}

struct NearestSearch {
  const TriangleFrame* frames;
  const std::function<bool(Index)>* accepts;  // null: all faces
  Vec3 p;
  double slack;
  double squared;
  Index face;

  static bool visit(RTCPointQueryFunctionArguments* arguments) {
    auto& search = *static_cast<NearestSearch*>(arguments->userPtr);
    const double squared = search.frames[arguments->primID].squared_distance(search.p);
    if (!(squared < search.squared)) return false;
    if (search.accepts && !(*search.accepts)(arguments->primID)) return false;
    search.squared = squared;
    search.face = arguments->primID;
    arguments->query->radius = up(std::sqrt(squared) + search.slack);
    return true;
  }
};

}  // namespace

Extent measure_extent(const TriMesh& mesh) {
  if (mesh.faces.empty()) throw InvalidInput("the mesh has no faces, so there is nothing to measure a distance to");
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  Extent extent{Vec3::Constant(kInfinity), Vec3::Constant(-kInfinity)};
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    for (const Index v : mesh.faces[f]) {
      if (v >= mesh.vertices.size() || !within_reach(mesh.vertices[v])) refuse(mesh, f, v);
      extent.low = extent.low.cwiseMin(mesh.vertices[v]);
      extent.high = extent.high.cwiseMax(mesh.vertices[v]);
    }
  }
  return extent;
}

struct TriangleTree::Embree {
  RTCDevice device = nullptr;
  RTCScene scene = nullptr;

  ~Embree() {
    if (scene) rtcReleaseScene(scene);
    if (device) rtcReleaseDevice(device);
  }

  void walk(const Vec3& local, NearestSearch& search) const {
    RTCPointQuery query = point_query(local, std::sqrt(search.squared) + search.slack);
    RTCPointQueryContext context;
    rtcInitPointQueryContext(&context);
    rtcPointQuery(scene, &query, &context, NearestSearch::visit, &search);
  }

  void build(const TriMesh& mesh, const Vec3& center) {
    device = rtcNewDevice(kEmbreeConfig);
    if (!device) fail_with_embree(rtcGetDeviceError(nullptr));
    leave_threads_to_tbb(rtcNewDevice);
    scene = rtcNewScene(device);
    // Builds three times as fast and searches hardly slower.
    rtcSetSceneBuildQuality(scene, RTC_BUILD_QUALITY_LOW);
    const RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    auto* positions = static_cast<float*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3 * sizeof(float), mesh.vertices.size()));
    auto* indices = static_cast<unsigned*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                                                   3 * sizeof(unsigned), mesh.faces.size()));
    if (!positions || !indices) {
      rtcReleaseGeometry(geometry);
      fail_with_embree(rtcGetDeviceError(device));
    }
    for (const Vec3& p : mesh.vertices) {
      const bool used = within_reach(p);  // a loose vertex may be anything
      for (int d = 0; d < 3; ++d) *positions++ = used ? static_cast<float>(p[d] - center[d]) : 0;
    }
    for (const Triangle& face : mesh.faces) indices = std::copy(face.begin(), face.end(), indices);
    rtcSetGeometryBuildQuality(geometry, RTC_BUILD_QUALITY_LOW);
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene, geometry);
    rtcReleaseGeometry(geometry);
    tbb::task_arena(1).execute([&] { rtcCommitScene(scene); });
    if (const RTCError error = rtcGetDeviceError(device); error != RTC_ERROR_NONE) fail_with_embree(error);
  }
};

TriangleTree::TriangleTree(const TriMesh& mesh)
    : extent_(measure_extent(mesh)),
      center_(0.5 * (extent_.low + extent_.high)),
      half_diagonal_(0.5 * extent_.diagonal()),
      embree_(std::make_unique<Embree>()) {
  frames_.reserve(mesh.faces.size());
  for (const auto& [a, b, c] : mesh.faces) {
    frames_.emplace_back(mesh.vertices[a], mesh.vertices[b], mesh.vertices[c]);
  }
  embree_->build(mesh, center_);
}

TriangleTree::~TriangleTree() = default;

double TriangleTree::float_slack(const Vec3& local) const { return kFloatSlack * (half_diagonal_ + local.lpNorm<1>()); }

NearestFace TriangleTree::nearest(const Vec3& p, Index near) const {
  const Vec3 local = p - center_;
  NearestSearch search{frames_.data(), nullptr, p, float_slack(local), 0, near == kNone ? 0 : near};
  search.squared = frames_[search.face].squared_distance(p);
  embree_->walk(local, search);
  return {search.face, std::sqrt(search.squared)};
}

NearestFace TriangleTree::nearest_among(const Vec3& p, double limit, const std::function<bool(Index)>& accepts,
                                        Index near) const {
  const Vec3 local = p - center_;
  NearestSearch search{frames_.data(), &accepts, p, float_slack(local), limit * limit, kNone};
  if (near != kNone) {
    const double squared = frames_[near].squared_distance(p);
    if (squared < search.squared && accepts(near)) {
      search.squared = squared;
      search.face = near;
    }
  }
  embree_->walk(local, search);
  return {search.face, std::sqrt(search.squared)};
}

}  // namespace vmesh
