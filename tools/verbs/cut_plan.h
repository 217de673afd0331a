// The cuts and clips of a scene, made before it is played.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "vmesh/surface/cut_surface.h"

#include "report/json.h"
#include "verbs/bound_tree.h"
#include "verbs/scene.h"

namespace vmesh::tool {

/// All cuts of a scene, made at rest, in the order of their times, and the nodes that clips need.
class CutPlan {
 public:
  struct Made {
    std::string element;  ///< of the scene: "cut[0]"
    double time_s;
    SegmentPlace place;  ///< on the centerline of before all cuts and clips
    CenterlineCut cut;
    std::array<std::string, 2> caps;
    double cap_area_mm2;
    std::vector<double> volumes_mm3;  ///< of the parts; one: they still hang together
  };

  /// Throws InvalidInput naming `source` and the element for places that do not exist, cannot be cut or have no room.
  CutPlan(const Scene& scene, const std::string& source, BoundTree rest);

  /// Nodes put on segments for clips, one after the other, before all cuts.
  const std::vector<InsertedNode>& inserted() const { return inserted_; }
  /// At rest, and after every cut.
  const std::vector<BoundTree>& stages() const { return stages_; }
  const std::vector<Made>& cuts() const { return cuts_; }
  /// What clips do to nodes of all stages.
  const std::vector<Scene::Profile>& profiles() const { return profiles_; }

  /// Where vertices of the last stage belong on the centerline of another one.
  std::vector<CenterlineBinding> last_on(std::size_t stage) const;
  /// Where the nodes of the last stage were then: on a segment, or themselves.
  SegmentPlace place_of_node(Index node, std::size_t stage) const;

  Json cuts_json() const;
  Json clips_json() const;

 private:
  [[noreturn]] void fail(const Scene::Place& place, const std::string& what) const;
  template <class Function>
  auto naming_element(const Scene::Place& place, Function function) const;
  SegmentPlace resolved(const Scene::Place& place) const;
  SegmentPlace now(SegmentPlace place) const;
  SegmentPlace original(SegmentPlace place) const;

  void add_clip(const Scene& scene, const Scene::Clip& clip);
  void add_cut(const Scene::Cut& cut);
  CenterlineCut cut_there(const Scene::Place& place, const SegmentPlace& at) const;

  struct Clipped {
    Scene::Clip clip;
    SegmentPlace place;
    Vec3 position;
    double width_mm;
  };

  std::string source_;
  Centerline original_;
  std::vector<InsertedNode> inserted_;
  std::vector<BoundTree> stages_;
  std::vector<Made> cuts_;
  std::vector<Clipped> clips_;
  std::vector<Scene::Profile> profiles_;
};

}  // namespace vmesh::tool
