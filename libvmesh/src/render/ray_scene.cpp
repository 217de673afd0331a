#include "render/ray_scene.h"

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

/// Four rays that take about the same way.
void intersect_coherent(const int* valid, RTCScene scene, RTCRayHit4& packet) {
#if VMESH_EMBREE == 3
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  rtcIntersect4(valid, scene, &context, &packet);
#else
  RTCIntersectArguments arguments;
  rtcInitIntersectArguments(&arguments);
  arguments.flags = RTC_RAY_QUERY_FLAG_COHERENT;
  rtcIntersect4(valid, scene, &packet, &arguments);
#endif
}

}  // namespace

struct RayScene::Embree {
  RTCDevice device = nullptr;
  RTCScene scene = nullptr;
  Vec3 origin = Vec3::Zero();  // Embree computes in float: coordinates are relative to this point

  ~Embree() {
    if (scene) rtcReleaseScene(scene);
    if (device) rtcReleaseDevice(device);
  }
};

RayScene::RayScene(const TriMesh& mesh) : embree_(std::make_unique<Embree>()) {
  embree_->device = rtcNewDevice(kEmbreeConfig);
  if (!embree_->device) fail_with_embree(rtcGetDeviceError(nullptr));
  leave_threads_to_tbb(rtcNewDevice);
  const RTCDevice device = embree_->device;
  embree_->scene = rtcNewScene(device);
  rtcSetSceneFlags(embree_->scene, RTC_SCENE_FLAG_ROBUST);
  embree_->origin = mesh.vertices[mesh.faces[0][0]];

  const RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
  auto* positions = static_cast<float*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                                                3 * sizeof(float), mesh.vertices.size()));
  auto* indices = static_cast<unsigned*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                                                 3 * sizeof(unsigned), mesh.faces.size()));
  if (!positions || !indices) {
    rtcReleaseGeometry(geometry);
    fail_with_embree(rtcGetDeviceError(device));
  }
  for (const Vec3& p : mesh.vertices) {
    for (int d = 0; d < 3; ++d) *positions++ = static_cast<float>(p[d] - embree_->origin[d]);
  }
  for (const auto& face : mesh.faces) {
    for (const Index v : face) *indices++ = v;
  }
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(embree_->scene, geometry);
  rtcReleaseGeometry(geometry);
  tbb::task_arena(1).execute([&] { rtcCommitScene(embree_->scene); });
  if (const RTCError error = rtcGetDeviceError(device); error != RTC_ERROR_NONE) fail_with_embree(error);
}

RayScene::~RayScene() = default;

std::array<RayHit, 4> RayScene::cast(const Packet& rays, double reach) const {
  alignas(16) RTCRayHit4 packet;
  for (std::size_t i = 0; i < 4; ++i) {
    const Vec3 origin = rays[i].origin - embree_->origin;
    packet.ray.org_x[i] = static_cast<float>(origin.x());
    packet.ray.org_y[i] = static_cast<float>(origin.y());
    packet.ray.org_z[i] = static_cast<float>(origin.z());
    packet.ray.dir_x[i] = static_cast<float>(rays[i].direction.x());
    packet.ray.dir_y[i] = static_cast<float>(rays[i].direction.y());
    packet.ray.dir_z[i] = static_cast<float>(rays[i].direction.z());
    packet.ray.tnear[i] = 0;
    packet.ray.tfar[i] = static_cast<float>(reach);
    packet.ray.time[i] = 0;
    packet.ray.mask[i] = ~0u;
    packet.ray.id[i] = 0;
    packet.ray.flags[i] = 0;
    packet.hit.geomID[i] = RTC_INVALID_GEOMETRY_ID;
    packet.hit.instID[0][i] = RTC_INVALID_GEOMETRY_ID;
  }
  alignas(16) const int all[4] = {-1, -1, -1, -1};
  intersect_coherent(all, embree_->scene, packet);

  std::array<RayHit, 4> hits;
  for (std::size_t i = 0; i < 4; ++i) {
    if (packet.hit.geomID[i] == RTC_INVALID_GEOMETRY_ID) continue;
    hits[i] = {packet.hit.primID[i], packet.ray.tfar[i], packet.hit.u[i], packet.hit.v[i]};
  }
  return hits;
}

}  // namespace vmesh
