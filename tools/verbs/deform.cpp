#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "vmesh/core/text.h"
#include "vmesh/deform/surface_binding.h"
#include "vmesh/io/sha256.h"

#include "command_line/interrupt.h"
#include "command_line/outputs.h"
#include "command_line/verb.h"
#include "page/live/live_page.h"
#include "report/pages.h"
#include "verbs/bound_tree.h"
#include "verbs/frame_series.h"
#include "verbs/live_scene.h"
#include "verbs/moving_surface.h"
#include "verbs/moving_volume.h"

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
                  "network (.html); with material, options, tissue and held nodes of the --script, if any")
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

struct Timing {
  double simulate_s = 0, synchronise_s = 0;
};

std::size_t steps_of(const Scene& scene) {
  return static_cast<std::size_t>(std::llround(scene.duration_s / scene.options.step_s));
}

/// Number of frames: at rest, then after every few steps, and the last.
std::size_t frames_of(const Scene& scene) {
  const auto every = static_cast<std::size_t>(scene.frame_every);
  return 1 + (steps_of(scene) + every - 1) / every;
}

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

/// The page that moves; empty if none is asked for.
std::string live_page(const DeformArguments& arguments, const BoundTree& tree, Console& console) {
  if (arguments.live.empty()) return {};
  const Scene scene = live_scene(arguments.script, tree.centerline, console);
  const std::vector<SceneTouching::Tissue>& tissues = scene.touching.tissues;
  return to_html(LivePage{arguments.input.path, arguments.surface.path, tree.centerline, tree.mesh,
                          vertex_normals(tree.mesh), places_on(tree.binding), scene.material, scene.options, scene.fix,
                          scene.clamp, scene.touching.contact,
                          tissues.empty() ? std::nullopt : std::optional(tissues.front().properties)});
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
  const bool with_forces = scene.touching.exists() || !arguments.forces.empty();
  Stage stage = naming(arguments.script, [&] { return Stage(centerline, scene, with_forces); });
  for (const InsertedNode& node : plan.inserted()) stage.divide(node);
  std::optional<MovingVolume> volume =
      load_moving_volume(arguments, rest.centerline, stage.simulation().tree(), rest, console);
  stop_if_interrupted();
  FrameSeries series(arguments.output, "." + arguments.format);
  std::optional<FrameSeries> volume_series;
  if (volume) volume_series.emplace(arguments.volume_output, ".vtu");
  FrameWriter writer({generator_name(), "deform --script " + arguments.script.filename().string(),
                      arguments.surface.path.filename().string(), sha256_of_file(arguments.surface.path)},
                     arguments.writing);
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
  if (with_forces) summary["hands"] = stage.forces().to_json();
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
