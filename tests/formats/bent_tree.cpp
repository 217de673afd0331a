// bent_tree TREE SURFACE.ply POSE.json: bends a tree by 40 degrees at a branching node and writes the deformer's
// result: the joints of make_linear_skin() in the frame of GLB files, and the surface's vertices, mm.
#include <algorithm>
#include <fstream>
#include <iostream>

#include <nlohmann/json.hpp>

#include "vmesh/core/error.h"
#include "vmesh/deform/linear_skin.h"
#include "vmesh/io/centerline_io.h"
#include "vmesh/io/surface_io.h"

namespace vmesh {
namespace {

using nlohmann::json;

constexpr double kAngle = 0.698;  // 40 degrees

/// x to the left, y superior, z anterior, as vmesh writes GLB.
const Mat3& y_up() {
  static const Mat3 turn = (Mat3() << 1, 0, 0, 0, 0, 1, 0, -1, 0).finished();
  return turn;
}

/// Number of slots from `first` on that descend from it; a subtree is contiguous.
Index end_of_subtree(const RodTree& tree, Index first) {
  Index end = first + 1;
  while (end < tree.size() && tree.parent[end] != kNone && tree.parent[end] >= first) ++end;
  return end;
}

/// The slot with the largest subtree that contains less than half of the tree.
Index hinge_of(const RodTree& tree) {
  Index best = kNone;
  std::size_t most = 0;
  for (Index j = 0; j < tree.size(); ++j) {
    const std::size_t size = end_of_subtree(tree, j) - j;
    if (tree.parent[j] == kNone || size <= most || 2 * size > tree.size()) continue;
    most = size;
    best = j;
  }
  return best;
}

/// Everything beyond the parent of `hinge` turned about it.
Pose bent(const RodTree& tree, Index hinge) {
  Pose pose = rest_pose(tree);
  const Vec3 pivot = tree.position[tree.parent[hinge]];
  const Mat3 turn = Eigen::AngleAxisd(kAngle, Vec3(1, 2, 3).normalized()).toRotationMatrix();
  for (Index j = hinge; j < end_of_subtree(tree, hinge); ++j) {
    pose.position[j] = pivot + turn * (tree.position[j] - pivot);
    pose.frame[j] = turn * tree.frame[j];
  }
  return pose;
}

const MeshAttribute& attribute(const LoadedSurface& surface, const std::string& name) {
  const auto& all = surface.attributes.vertex;
  const auto found = std::find_if(all.begin(), all.end(), [&](const MeshAttribute& a) { return a.name == name; });
  if (found == all.end()) throw InvalidInput("the surface has no attribute " + name);
  return *found;
}

json numbers(const Vec3& v) { return {v.x(), v.y(), v.z()}; }

json joints_json(const SurfaceSkin& skin, const std::vector<JointPose>& poses) {
  json joints = json::array();
  for (std::size_t j = 0; j < skin.joints.size(); ++j) {
    const Eigen::Quaterniond turn(y_up() * poses[j].rotation * y_up().transpose());
    joints.push_back({{"name", skin.joints[j].name},
                      {"position", numbers(1e-3 * (y_up() * poses[j].position))},
                      {"quaternion", {turn.x(), turn.y(), turn.z(), turn.w()}}});
  }
  return joints;
}

void run(const char* tree_path, const char* surface_path, const char* pose_path) {
  const Centerline centerline = load_centerline(tree_path).cleaned.centerline;
  const LoadedSurface surface = read_surface(surface_path);
  const MeshAttribute &segment = attribute(surface, "segment"), &parameter = attribute(surface, "parameter");
  std::vector<SurfacePlace> places;
  for (std::size_t v = 0; v < surface.mesh.vertices.size(); ++v)
    places.push_back({static_cast<Index>(segment.values[v]), parameter.values[v]});
  const RodTree tree = make_rod_tree(centerline);
  const Pose pose = bent(tree, hinge_of(tree));
  const SurfaceBinding binding(centerline, tree, surface.mesh.vertices, vertex_normals(surface.mesh), places);
  DeformedSurface deformed = binding.make_surface();
  binding.apply(pose, deformed);
  json vertices = json::array(), radii = json::array();
  for (std::size_t v = 0; v < places.size(); ++v) {
    vertices.push_back(numbers(deformed.position(binding.lane_of_vertex()[v])));
    radii.push_back(centerline.radius_at(places[v].segment, places[v].t));
  }
  const SurfaceSkin skin = make_linear_skin(centerline, tree, places);
  std::ofstream(pose_path) << json{
      {"joints", joints_json(skin, joint_poses(tree, pose))}, {"vertices", vertices}, {"radii", radii}};
}

}  // namespace
}  // namespace vmesh

int main(int argc, char** argv) {
  if (argc != 4) {
    std::cerr << "usage: bent_tree TREE SURFACE.ply POSE.json\n";
    return 2;
  }
  try {
    vmesh::run(argv[1], argv[2], argv[3]);
    return 0;
  } catch (const std::exception& error) {
    std::cerr << "bent_tree: " << error.what() << '\n';
    return 1;
  }
}
