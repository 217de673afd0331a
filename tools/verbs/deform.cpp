#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <limits>
#include <optional>
#include <sstream>

#include "vmesh/core/text.h"
#include "vmesh/deform/surface_binding.h"
#include "vmesh/io/sha256.h"

#include "command_line/interrupt.h"
#include "command_line/outputs.h"
#include "command_line/verb.h"
#include "page/live/live_page.h"
#include "report/pages.h"
#include "verbs/cut_plan.h"
#include "verbs/frame_series.h"
#include "verbs/moving_volume.h"
#include "verbs/scene.h"

namespace vmesh::tool::deform_verb {
namespace {

namespace fs = std::filesystem;

struct DeformArguments {
  CommonArguments common;
  InputArguments input;
  InputArguments surface;
  std::filesystem::path volume;                 ///< mesh that follows, or empty
  std::filesystem::path script, live;           ///< either may be empty
  std::filesystem::path output, volume_output;  ///< folders
  std::filesystem::path forces;                 ///< CSV, or empty
  bool allow_defects = false;
  std::string format = "vtp";  ///< extension of the frames
  WritingArguments writing;
};

void add_options(CLI::App& verb, DeformArguments& arguments) {
  add_input(verb, arguments.input, "centerline");
  add_centerline_reading(verb, arguments.input, "");
  verb.add_option("SURFACE", arguments.surface.path, "surface around it, grown by vmesh or not")->required();
  add_reading(verb, arguments.surface, "surface-");
  verb.add_option("--script", arguments.script, "scene: what is held, dragged and pushed (tools/README.md, Scenes)")
      ->type_name("FILE.json");
  verb.add_option("--live", arguments.live,
                  "write a page to this file in which the tree moves under your hands, for any browser, without a "
                  "network (.html); with material, options and held nodes of the --script, if any")
      ->type_name("FILE.html|.htm");
  add_output(verb, arguments.output, kFolder, "new or empty folder for the frames");
  verb.add_option("--format", arguments.format, "of the frames")
      ->check(CLI::IsMember({"vtp", "obj", "ply", "stl", "off", "glb"}))
      ->capture_default_str();
  verb.add_option("--volume", arguments.volume,
                  "volume mesh in the surface (" + read_volume_files() + "), moved with it; of vmesh volume or not")
      ->type_name(kFile);
  verb.add_option("--volume-output", arguments.volume_output, "new or empty folder for its frames")->type_name(kFolder);
  verb.add_option("--forces", arguments.forces,
                  "force and torque on what is dragged, on jaws and on instruments after every step, as CSV")
      ->type_name("FILE.csv");
  verb.add_flag("--allow-defects", arguments.allow_defects,
                "write frames even if cells of the volume mesh turn over; the summary tells how many, and where");
  add_writing(verb, arguments.writing);
  add_html(verb, arguments.common);
}

/// A vertex farther from its place than this many local radii must be bound to another centerline.
constexpr double kFarthestPlace = 4;

bool is_place(const Centerline& centerline, double segment, double t, const Vec3& vertex) {
  if (!(segment >= 0 && segment < static_cast<double>(centerline.segments().size()) && t >= 0 && t <= 1)) return false;
  const Index s = static_cast<Index>(segment);
  return (vertex - centerline.point_at(s, t)).norm() <= kFarthestPlace * centerline.radius_at(s, t);
}

/// The places on the centerline stored in the surface's file, if they belong to this centerline.
std::optional<std::vector<SurfacePlace>> places_in_file(const Centerline& centerline, const LoadedSurface& surface) {
  const MeshAttribute* segment = find_attribute(surface.attributes.vertex, "segment");
  const MeshAttribute* t = find_attribute(surface.attributes.vertex, "parameter");
  if (!segment || !t) return std::nullopt;
  std::vector<SurfacePlace> places;
  for (std::size_t v = 0; v < surface.mesh.vertices.size(); ++v) {
    if (!is_place(centerline, segment->values[v], t->values[v], surface.mesh.vertices[v])) return std::nullopt;
    places.push_back({static_cast<Index>(segment->values[v]), t->values[v]});
  }
  return places;
}

std::vector<SurfacePlace> places_of(const Centerline& centerline, const LoadedSurface& surface, Console& console) {
  if (auto places = places_in_file(centerline, surface)) return *places;
  console.log("the surface's file has no places on this centerline; every vertex is bound to the nearest segment");
  return nearest_places(centerline, surface.mesh.vertices);
}

BoundTree bound_tree(const Centerline& centerline, LoadedSurface surface, Console& console) {
  std::vector<CenterlineBinding> binding;
  for (const auto& [segment, t] : places_of(centerline, surface, console)) binding.push_back({segment, t});
  return {centerline, std::move(surface.mesh), std::move(surface.attributes), std::move(binding)};
}

/// Plays a scene on a simulation.
class Stage {
 public:
  Stage(const Centerline& centerline, const Scene& scene)
      : scene_(scene), simulation_(centerline, segment_properties(centerline, scene.material), scene.options) {
    for (const Index node : scene.fix) simulation_.fix(node);
    for (const Index node : scene.clamp) simulation_.clamp(node);
    for (const Scene::Drag& drag : scene.drags) dragged_from_.push_back(simulation_.position(drag.node));
    if (scene.touching.exists()) touching_.emplace(scene.touching, centerline, simulation_);
  }

  void step(double time) {
    for (std::size_t i = 0; i < scene_.drags.size(); ++i) pull(scene_.drags[i], dragged_from_[i], time);
    for (const Scene::Force& force : scene_.forces) simulation_.set_force(force.node, force.force_N.at(time));
    for (const Scene::Profile& scale : scene_.scales) simulation_.set_radial_scale(scale.node, scale.value.at(time));
    for (const Scene::Profile& squeeze : scene_.squeezes) simulation_.set_squeeze(squeeze.node, squeeze.value.at(time));
    if (touching_) touching_->act(simulation_, time, [this](const SegmentPlace& place) { return now(place); });
    const StepReport report = simulation_.step();
    check_range(time);
    note_forces(time);
    work_J_ += report.work_J;
    last_movement_mm_ = report.movement_mm;
  }

  /// Numbers of the scene still are those of the centerline of before.
  void cut(const CenterlineCut& cut) {
    simulation_.cut(cut);
    since_.push_back([cut](const SegmentPlace& place) { return cut.after(place); });
  }
  void divide(const InsertedNode& node) {
    simulation_.divide(node);
    since_.push_back([node](const SegmentPlace& place) { return node.after(place); });
  }

  CenterlineSimulation& simulation() { return simulation_; }
  double work_J() const { return work_J_; }
  double last_movement_mm() const { return last_movement_mm_; }
  const HandForces& forces() const { return forces_; }

 private:
  SegmentPlace now(SegmentPlace place) const {
    for (const auto& step : since_) place = step(place);
    return place;
  }

  void note_forces(double time) {
    for (const Scene::Drag& drag : scene_.drags)
      forces_.add(time, "node " + std::to_string(drag.node), simulation_.drag_force(drag.node));
    const SceneTouching& touching = scene_.touching;
    for (std::size_t i = 0; i < touching.grasps.size(); ++i)
      if (touching_->jaws()[i] != kNone)
        forces_.add(time, touching.grasps[i].name, simulation_.jaw_force(touching_->jaws()[i]));
    for (std::size_t i = 0; i < touching.instruments.size(); ++i)
      forces_.add(time, touching.instruments[i].name, simulation_.instrument_force(static_cast<Index>(i)));
  }

  void pull(const Scene::Drag& drag, const Vec3& from, double time) {
    const double step = scene_.options.step_s;
    if (time < drag.start_s) return;
    if (time <= drag.release_s)
      simulation_.drag(drag.node, from + drag.offset_mm.at(time));
    else if (time - step <= drag.release_s)
      simulation_.release(drag.node);
  }

  /// Segments stretched to more than this many times their length or radius, whichever is longer, are no longer
  /// vessels.
  static constexpr double kMostStretched = 100;

  void check_range(double time) const {
    const RodTree& tree = simulation_.tree();
    const std::vector<Vec3>& position = simulation_.pose().position;
    for (Index j = 0; j < tree.size(); ++j) {
      const Index parent = tree.parent[j];
      const bool is_root = parent == kNone;
      const double stretch =
          is_root ? 0 : (position[j] - position[parent]).norm() / std::max(tree.length[j], tree.radius[j]);
      if (position[j].allFinite() && stretch <= kMostStretched) continue;
      std::ostringstream text;
      text << "the motion leaves its physical range at " << time << " s, at node " << tree.node[j] << ": ";
      if (position[j].allFinite()) {
        text << "segment " << tree.segment[j] << " is stretched to " << stretch << " times its length or radius";
      } else {
        text << "its position is not finite";
      }
      text << "; shorten step_s, or check the forces, the paths and the material";
      throw InvalidInput(text.str());
    }
  }

  const Scene& scene_;
  CenterlineSimulation simulation_;
  std::vector<Vec3> dragged_from_;
  std::vector<std::function<SegmentPlace(const SegmentPlace&)>> since_;  // cuts and divisions
  std::optional<TouchingStage> touching_;
  HandForces forces_;
  double work_J_ = 0, last_movement_mm_ = 0;
};

struct Timing {
  double simulate_s = 0, synchronise_s = 0;
};

std::vector<SurfacePlace> places_on(const std::vector<CenterlineBinding>& binding) {
  std::vector<SurfacePlace> places;
  for (const CenterlineBinding& b : binding) places.push_back({b.segment, b.t});
  return places;
}

/// Writes the moved input surface with the displacements of its vertices.
class FrameWriter {
 public:
  explicit FrameWriter(const DeformArguments& arguments) : writing_(arguments.writing) {
    metadata_ = {generator_name(), "deform --script " + arguments.script.filename().string(),
                 arguments.surface.path.filename().string(), sha256_of_file(arguments.surface.path)};
  }

  /// The surface that moves from now on, at rest; it is to outlive this.
  void begin(const BoundTree& rest) {
    rest_ = &rest.mesh;
    mesh_ = rest.mesh;
    attributes_ = rest.attributes;
    std::erase_if(attributes_.vertex, [](const MeshAttribute& a) { return a.name == "displacement"; });
    attributes_.vertex.push_back({"displacement", std::vector<double>(mesh_.vertices.size())});
  }

  void write(const fs::path& path, const DeformedSurface& surface, const std::vector<Index>& lane_of_vertex) {
    std::vector<double>& displacement = attributes_.vertex.back().values;
    for (std::size_t v = 0; v < mesh_.vertices.size(); ++v) {
      mesh_.vertices[v] = surface.position(lane_of_vertex[v]);
      displacement[v] = (mesh_.vertices[v] - rest_->vertices[v]).norm();
      largest_mm_ = std::max(largest_mm_, displacement[v]);
    }
    write_surface(path, mesh_, attributes_, metadata_, writing_);
  }

  double largest_displacement_mm() const { return largest_mm_; }
  /// The mesh of the last frame written.
  const TriMesh& mesh() const { return mesh_; }
  const MeshAttributes& attributes() const { return attributes_; }

 private:
  const TriMesh* rest_ = nullptr;
  const WritingArguments& writing_;
  TriMesh mesh_;
  MeshAttributes attributes_;
  SurfaceMetadata metadata_;
  double largest_mm_ = 0;
};

std::size_t steps_of(const Scene& scene) {
  return static_cast<std::size_t>(std::llround(scene.duration_s / scene.options.step_s));
}

/// Number of frames: at rest, then after every few steps, and the last.
std::size_t frames_of(const Scene& scene) {
  const auto every = static_cast<std::size_t>(scene.frame_every);
  return 1 + (steps_of(scene) + every - 1) / every;
}

/// The surface that moves with a stage, cut when it is time.
class MovingSurface {
 public:
  MovingSurface(const CutPlan& plan, Stage& stage, FrameWriter& writer) : plan_(plan), stage_(stage), writer_(writer) {
    begin();
  }

  /// Makes the cuts that are due; the surface stays where it is.
  void cut_until(double time_s) {
    const std::size_t before = cuts_;
    for (; cuts_ < plan_.cuts().size() && plan_.cuts()[cuts_].time_s <= time_s; ++cuts_) {
      const CutPlan::Made& made = plan_.cuts()[cuts_];
      naming(made.element, [&] { stage_.cut(made.cut); });
    }
    if (cuts_ > before) begin();
  }
  void follow() { binding_->apply(stage_.simulation().pose(), stage_.simulation().moved(), lanes_); }
  void write(const fs::path& path) { writer_.write(path, lanes_, binding_->lane_of_vertex()); }

  /// The last of all stages where it is now, before it was cut.
  std::vector<Vec3> last_vertices() {
    if (plan_.cuts().empty()) return writer_.mesh().vertices;
    if (!last_) {
      const BoundTree &tree = plan_.stages()[cuts_], &last = plan_.stages().back();
      last_.emplace(tree.centerline, stage_.simulation().tree(), last.mesh.vertices, vertex_normals(last.mesh),
                    places_on(plan_.last_on(cuts_)));
    }
    DeformedSurface lanes = last_->make_surface();
    last_->apply(stage_.simulation().pose(), lanes);
    std::vector<Vec3> vertices;
    for (const Index lane : last_->lane_of_vertex()) vertices.push_back(lanes.position(lane));
    return vertices;
  }
  std::vector<Vec3> last_nodes() const {
    const Centerline& now = plan_.stages()[cuts_].centerline;
    const CenterlineSimulation& simulation = stage_.simulation();
    std::vector<Vec3> positions;
    for (Index n = 0; n < plan_.stages().back().centerline.nodes().size(); ++n) {
      if (n < now.nodes().size()) {
        positions.push_back(simulation.position(n));
        continue;
      }
      const auto [segment, t] = plan_.place_of_node(n, cuts_);
      const auto& [a, b] = now.segment(segment);
      positions.push_back((1 - t) * simulation.position(a) + t * simulation.position(b));
    }
    return positions;
  }

 private:
  void begin() {
    const BoundTree& tree = plan_.stages()[cuts_];
    binding_.emplace(tree.centerline, stage_.simulation().tree(), tree.mesh.vertices, vertex_normals(tree.mesh),
                     places_on(tree.binding));
    lanes_ = binding_->make_surface();
    if (cuts_ > 0) binding_->apply(stage_.simulation().pose(), lanes_);
    writer_.begin(tree);
    last_.reset();
  }

  const CutPlan& plan_;
  Stage& stage_;
  FrameWriter& writer_;
  std::size_t cuts_ = 0;
  std::optional<SurfaceBinding> binding_, last_;
  DeformedSurface lanes_;
};

/// The surface's frames, and the volume's if there is one.
struct Frames {
  MovingSurface& surface;
  FrameSeries& series;
  MovingVolume* volume = nullptr;
  FrameSeries* volume_series = nullptr;
  std::vector<double> times_s = {};

  void write(double time_s) {
    surface.write(series.next());
    times_s.push_back(time_s);
    if (volume != nullptr) volume->write(volume_series->next(), time_s);
  }
};

constexpr double kNever = std::numeric_limits<double>::infinity();

/// Calls `show(time)` after every frame that is written, and stops early if that is false.
template <class Show>
Timing play(const Scene& scene, Stage& stage, Frames& frames, const Progress& progress, Show show) {
  Timing timing;
  const std::size_t steps = steps_of(scene);
  // A cut is due in the step that reaches its time, but for rounding; in the last one at the latest.
  const auto due = [&](std::size_t i) {
    return i == steps ? kNever : (static_cast<double>(i) + 1e-6) * scene.options.step_s;
  };
  frames.surface.cut_until(due(0));
  frames.write(0);
  if (!show(0.0)) return timing;
  for (std::size_t i = 1; i <= steps; ++i) {
    report_progress(progress, "deforming", static_cast<double>(i - 1) / static_cast<double>(steps));
    Stopwatch watch;
    stage.step(static_cast<double>(i) * scene.options.step_s);
    timing.simulate_s += watch.lap();
    frames.surface.follow();
    if (frames.volume != nullptr) frames.volume->follow(stage.simulation().pose(), stage.simulation().moved());
    stage.simulation().clear_moved();
    timing.synchronise_s += watch.lap();
    frames.surface.cut_until(due(i));
    if (i % static_cast<std::size_t>(scene.frame_every) != 0 && i != steps) continue;
    const double time_s = static_cast<double>(i) * scene.options.step_s;
    frames.write(time_s);
    if (!show(time_s)) return timing;
  }
  return timing;
}

/// Whether two folders, which need not exist, are one.
bool same_folder(const fs::path& a, const fs::path& b) {
  const auto full = [](const fs::path& path) { return fs::weakly_canonical(path / ""); };
  return full(a) == full(b);
}

/// Frames are written where there is a folder for them, and always without --live.
void settle(DeformArguments& arguments) {
  if (arguments.live.empty()) {
    if (arguments.script.empty())
      throw UsageError("give the scene to play (--script FILE.json), or a page to pull vessels in (--live FILE.html)");
    settle_output(arguments);
    return;
  }
  if (!arguments.output.empty()) {
    if (arguments.script.empty()) throw UsageError("-o is for the frames of a scene: give one (--script FILE.json)");
  } else if (!arguments.volume.empty() || !arguments.volume_output.empty() || !arguments.common.html.empty() ||
             !arguments.common.json.empty() || !arguments.forces.empty()) {
    throw UsageError(
        "--volume, --volume-output, --forces, --html and --json are about frames: give a --script, and -o for them");
  }
}

void check_frames(const DeformArguments& arguments) {
  if (arguments.volume.empty() != arguments.volume_output.empty())
    throw UsageError("--volume names the mesh and --volume-output the folder for its frames: give both, or none");
  if (arguments.volume.empty() && arguments.allow_defects)
    throw UsageError("--allow-defects is about the cells of a --volume");
  if (!arguments.volume.empty() && same_folder(arguments.output, arguments.volume_output))
    throw UsageError(arguments.volume_output.string() +
                     ": is the folder for the surface's frames; give another one for those of the volume");
  surface_output_format("frame." + arguments.format);
  check_writing("frame." + arguments.format, arguments.writing);
}

void check_files(const DeformArguments& arguments) {
  if (!arguments.output.empty()) check_frames(arguments);
  std::vector<fs::path> inputs = files_of(arguments.input.path);
  inputs.push_back(arguments.surface.path);
  if (!arguments.script.empty()) inputs.push_back(arguments.script);
  if (!arguments.volume.empty()) inputs.push_back(arguments.volume);
  check_outputs({{arguments.common.json, PlannedOutput::Kind::summary},
                 {arguments.common.html, PlannedOutput::Kind::page},
                 {arguments.live, PlannedOutput::Kind::live_page},
                 {arguments.forces, PlannedOutput::Kind::report}},
                inputs);
}

/// The volume mesh, if there is one.
std::optional<MovingVolume> load_moving_volume(const DeformArguments& arguments, const Centerline& centerline,
                                               const RodTree& tree, const BoundTree& surface, Console& console) {
  if (arguments.volume.empty()) return std::nullopt;
  return naming(arguments.volume, [&] {
    LoadedVolume volume = load_volume(arguments.volume, console);
    const VolumePlaces at =
        volume_places(centerline, volume.mesh, surface.mesh.vertices, places_on(surface.binding), kFarthestPlace);
    console.log(std::to_string(at.shared) + " points of the volume are vertices of the surface and stay on it; the " +
                "others follow the nearest vessel");
    const VolumeMetadata metadata = {generator_name(),
                                     "deform --script " + arguments.script.filename().string(),
                                     arguments.volume.filename().string(),
                                     sha256_of_file(arguments.volume),
                                     arguments.writing.unit,
                                     arguments.writing.space};
    return std::optional<MovingVolume>(std::in_place, std::move(volume), centerline, tree, at, metadata);
  });
}

std::vector<double> times_of(const std::vector<VolumeFrame>& frames) {
  std::vector<double> times;
  for (const VolumeFrame& frame : frames) times.push_back(frame.time_s);
  return times;
}

std::string inverted_text(const VolumeFrame& frame) {
  return counted(frame.inverted_cells, "cell is", "cells are") + " flat or turned over somewhere at " +
         formatted("%g s, the first at ", frame.time_s) + point_text(frame.first_inverted);
}

/// Whether frames may be written; tells of the first one in which cells turn over.
bool is_good(const std::vector<VolumeFrame>& frames, const DeformArguments& arguments, Console& console) {
  const auto first =
      std::find_if(frames.begin(), frames.end(), [](const VolumeFrame& frame) { return frame.inverted_cells > 0; });
  if (first == frames.end()) return true;
  const std::string name = arguments.volume.string() + ": ", text = inverted_text(*first);
  if (arguments.allow_defects) {
    console.warn(name + text);
    return true;
  }
  console.error(name + "cannot follow: " + text +
                "; no frames are written. Bend less, make a mesh that is coarser there or has thinner layers, or have "
                "frames written as they are with --allow-defects");
  return false;
}

/// What pages begin with where no scene says otherwise: a step for every frame of a usual screen, and the lowest node
/// of every component clamped, as vessels hang from something.
Scene scene_of_hands(const Centerline& centerline) {
  Scene scene;
  scene.options.step_s = 1.0 / 60;
  std::vector<char> seen(centerline.component_count());
  for (Index n = 0; n < centerline.nodes().size(); ++n) {
    char& has_one = seen[centerline.component_of_node()[n]];
    if (!has_one && centerline.degree(n) > 0) scene.clamp.push_back(n);
    has_one = 1;
  }
  return scene;
}

/// The material, the options and what is held from the start.
Scene live_scene(const DeformArguments& arguments, const Centerline& centerline, Console& console) {
  if (arguments.script.empty()) return scene_of_hands(centerline);
  Scene scene = read_scene(arguments.script, centerline.nodes().size(), centerline.segments().size());
  const std::string name = arguments.script.string();
  if (scene.options.integrator != Integrator::implicit)
    throw InvalidInput(name + ": integrator: pages that move have \"implicit\" only; leave \"paper\" out for --live");
  if (scene.touching.exists() || !scene.cuts.empty() || !scene.clips.empty())
    throw InvalidInput(name +
                       ": pages that move have no contact, instruments, grasp, tissue, cut and clip; leave them " +
                       "out for --live");
  if (!scene.drags.empty() || !scene.forces.empty() || !scene.scales.empty() || !scene.squeezes.empty())
    console.warn(name + ": the page leaves drag, force, radial_scale and squeeze to your hands; it takes the rest");
  return scene;
}

/// The page that moves; empty if none is asked for.
std::string live_page(const DeformArguments& arguments, const BoundTree& tree, Console& console) {
  if (arguments.live.empty()) return {};
  const Scene scene = live_scene(arguments, tree.centerline, console);
  return to_html(LivePage{arguments.input.path, arguments.surface.path, tree.centerline, tree.mesh,
                          vertex_normals(tree.mesh), places_on(tree.binding), scene.material, scene.options, scene.fix,
                          scene.clamp});
}

void write_live_page(const std::filesystem::path& path, const std::string& html, Console& console) {
  write_text(path, html);
  console.log("wrote " + path.string() + formatted(", %.1f MB", static_cast<double>(html.size()) / 1e6) +
              ": open it in a browser");
}

int play_scene(const DeformArguments& arguments, BoundTree bound, Console& console) {
  const Centerline centerline = bound.centerline;
  Scene scene = read_scene(arguments.script, centerline.nodes().size(), centerline.segments().size());
  if (!scene.cuts.empty() && !arguments.volume.empty())
    throw InvalidInput(arguments.script.string() + ": " + scene.cuts.front().place.element +
                       ": the cells of a --volume cannot be cut; leave out one of the two");
  const CutPlan plan(scene, arguments.script.string(), std::move(bound));
  const BoundTree& rest = plan.stages().front();
  scene.scales.insert(scene.scales.end(), plan.profiles().begin(), plan.profiles().end());
  Stage stage = naming(arguments.script, [&] { return Stage(centerline, scene); });
  for (const InsertedNode& node : plan.inserted()) stage.divide(node);
  std::optional<MovingVolume> volume =
      load_moving_volume(arguments, rest.centerline, stage.simulation().tree(), rest, console);
  stop_if_interrupted();
  FrameSeries series(arguments.output, "." + arguments.format);
  std::optional<FrameSeries> volume_series;
  if (volume) volume_series.emplace(arguments.volume_output, ".vtu");
  FrameWriter writer(arguments);
  MovingSurface moving(plan, stage, writer);
  Frames written{moving, series, volume ? &*volume : nullptr, volume_series ? &*volume_series : nullptr};
  const BoundTree& last = plan.stages().back();
  std::optional<PageFrames> frames;
  if (!arguments.common.html.empty()) frames.emplace(last.mesh, last.centerline, frames_of(scene));
  const auto show = [&](double time_s) {
    if (frames) frames->add(time_s, moving.last_vertices(), moving.last_nodes());
    return !volume || arguments.allow_defects || volume->frames().back().inverted_cells == 0;
  };
  const Timing timing = naming(arguments.script, [&] { return play(scene, stage, written, console.progress(), show); });
  if (volume) {
    if (!is_good(volume->frames(), arguments, console)) return kDefective;
    volume_series->write_collection(times_of(volume->frames()));
    volume_series->keep();
  }
  if (!plan.cuts().empty() && arguments.format == "vtp") series.write_collection(written.times_s);
  series.keep();
  console.log("wrote " + std::to_string(series.size()) + " frames to " + arguments.output.string());
  if (volume)
    console.log("wrote " + std::to_string(volume_series->size()) + " frames of the volume to " +
                arguments.volume_output.string());
  Json summary = {{"schema", "vmesh.deform/1"},
                  {"generator", generator_json()},
                  {"centerline", to_json(centerline)},
                  {"vertices", rest.mesh.vertices.size()},
                  {"frames", series.size()},
                  {"largest_displacement_mm", writer.largest_displacement_mm()},
                  {"last_movement_mm", stage.last_movement_mm()},
                  {"work_J", stage.work_J()},
                  {"kinetic_energy_J", stage.simulation().kinetic_energy_J()},
                  {"elastic_energy_J", stage.simulation().elastic_energy_J()},
                  {"simulate_s", timing.simulate_s},
                  {"synchronise_s", timing.synchronise_s}};
  if (!plan.cuts().empty()) summary["cuts"] = plan.cuts_json();
  if (!scene.clips.empty()) summary["clips"] = plan.clips_json();
  if (scene.touching.exists()) {
    summary["contact_energy_J"] = stage.simulation().contact_energy_J();
    summary["torn_nodes"] = stage.simulation().torn();
  }
  if (scene.touching.exists() || !arguments.forces.empty()) summary["hands"] = stage.forces().to_json();
  if (!arguments.forces.empty()) write_text(arguments.forces, stage.forces().csv());
  if (volume) summary["volume"] = volume->to_json();
  write_json(arguments.common.json, summary);
  if (frames)
    write_page(arguments.common.html,
               page_of(arguments.common, arguments.script, summary, last.mesh, writer.mesh(), writer.attributes(),
                       last.centerline, std::move(*frames)),
               console);
  return kOk;
}

int run(const DeformArguments& arguments, Console& console) {
  check_files(arguments);
  const Centerline centerline = load_clean_centerline(arguments.input, console).cleaned.centerline;
  LoadedSurface loaded = load_surface(arguments.surface);
  console.warn(loaded.warnings);
  BoundTree bound = bound_tree(centerline, std::move(loaded), console);
  const std::string page = live_page(arguments, bound, console);
  const int code = arguments.output.empty() ? kOk : play_scene(arguments, std::move(bound), console);
  if (code == kOk && !page.empty()) write_live_page(arguments.live, page, console);
  return code;
}

const VerbRegistration<DeformArguments> kRegistration({
    .rank = 120,
    .name = "deform",
    .help = "Move a centerline under forces, and its surface with it",
    .examples = R"(Examples:
  vmesh deform tree.json tree.ply --script scene.json -o frames/
  vmesh deform tree.swc tree.vtp --script scene.json -o frames/ --volume tree.vtu --volume-output cells/
  vmesh deform tree.swc scan.stl --script scene.json -o frames/ --format obj --html moved.html
  vmesh deform tree.json tree.ply --live pull.html)",
    .add_options = add_options,
    .settle = settle,
    .run = run,
});

}  // namespace
}  // namespace vmesh::tool::deform_verb
