// Results of the presets on real and synthetic trees: triangles, errors and the time of every stage, as a table in
// Markdown or as JSON. Usage: bench_presets [--json] [FILE...]; without files all trees that the shared data has.
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <string>

#include <nlohmann/json.hpp>

#include "vmesh/core/error.h"
#include "vmesh/io/centerline_io.h"
#include "vmesh/mesh/topology.h"
#include "vmesh/quality/distribution.h"
#include "vmesh/quality/quality_report.h"
#include "vmesh/surface/deviation.h"
#include "vmesh/surface/generate.h"
#include "vmesh/synth/synthetic_tree.h"
#include "vmesh/volume/vessel_field.h"

namespace {

using namespace vmesh;
using Json = nlohmann::ordered_json;

constexpr const char* kTrees[] = {"portal1",   "portal3",    "portal15",      "hepatic1",       "hepatic3",
                                  "hepatic15", "arterial15", "vessel_portal", "vessel_hepatic", "vessel_arterial"};

std::vector<std::string> shared_trees() {
  const std::string data = VMESH_SHARED_DATA;
  std::vector<std::string> files;
  for (const char* tree : kTrees)
    files.push_back(data + "/liver_portal_centerlines/liverModelPatient1__" + tree + "_1.swc");
  for (const char* tree : {"BG0002", "BG001", "BG04", "BG07"})
    files.push_back(data + "/brain_brava_swc/" + tree + ".CNG.swc");
  files.push_back(data + "/synthetic_trees/tree1560.swc");
  std::erase_if(files, [](const std::string& file) {
    if (std::filesystem::exists(file)) return false;
    std::fprintf(stderr, "left out, there is no such file: %s\n", file.c_str());
    return true;
  });
  return files;
}

Json measure(const std::string& name, const Centerline& centerline, Preset preset) {
  GenerateOptions options;
  options.around = vertices_around(preset);
  options.threads = 1;
  const GenerateResult result = generate_surface(centerline, options);
  const FaceMeasures faces = measure_faces(result.mesh);
  const Distribution skewness = summarize(faces.equiangle_skewness);
  const Deviation error = measure_deviation(result.mesh, result.binding, VesselField(centerline, options.blend));
  Json row = {
      {"tree", name},
      {"preset", preset == Preset::low ? "low" : "high"},
      {"vertices", result.mesh.vertices.size()},
      {"vertices_per_length_in_radii", static_cast<double>(result.mesh.vertices.size()) / centerline.length_in_radii()},
      {"skewness_mean", skewness.mean},
      {"skewness_p95", skewness.p95},
      {"skewness_max", skewness.max},
      {"min_angle_deg", *std::min_element(faces.min_angle_deg.begin(), faces.min_angle_deg.end())},
      {"error_mean_mm", error.mean_mm},
      {"error_rms_mm", error.rms_mm},
      {"error_max_mm", error.max_mm},
      {"error_mean_relative", error.mean_relative},
      {"error_rms_relative", error.rms_relative},
      {"error_max_relative", error.max_relative},
      {"self_intersections", self_intersections(result.mesh).size()}};
  for (const StageTime& stage : result.stages) row[stage.stage + "_ms"] = 1e3 * stage.seconds;
  return row;
}

std::string text_of(const Json& value) {
  if (value.is_string()) return value.get<std::string>();
  if (!value.is_number_float()) return value.dump();
  char text[64];
  std::snprintf(text, sizeof text, "%.3f", value.get<double>());
  return text;
}

void print_markdown(const Json& rows) {
  bool first = true;
  for (const Json& row : rows) {
    std::string titles = "|", rule = "|", values = "|";
    for (const auto& [key, value] : row.items()) {
      titles.append(" ").append(key).append(" |");
      rule += "---|";
      values.append(" ").append(text_of(value)).append(" |");
    }
    if (first) std::printf("%s\n%s\n", titles.c_str(), rule.c_str());
    first = false;
    std::printf("%s\n", values.c_str());
  }
}

}  // namespace

int main(int argc, char** argv) {
  std::vector<std::string> files(argv + 1, argv + argc);
  const bool as_json = std::erase(files, "--json") > 0;
  if (files.empty()) files = shared_trees();
  try {
    Json rows = Json::array();
    const auto add = [&](const std::string& name, const Centerline& centerline) {
      for (const Preset preset : {Preset::low, Preset::high}) rows.push_back(measure(name, centerline, preset));
    };
    for (const std::string& file : files)
      add(std::filesystem::path(file).stem().string(), load_centerline(file).cleaned.centerline);
    SyntheticTreeOptions synthetic;
    synthetic.vertices = 1560;
    add("synthetic 1560", synthetic_tree(synthetic));
    if (as_json) {
      std::printf("%s\n", rows.dump(2).c_str());
    } else {
      print_markdown(rows);
    }
  } catch (const Error& error) {
    std::fprintf(stderr, "bench_presets: %s\n", error.what());
    return 1;
  }
}
