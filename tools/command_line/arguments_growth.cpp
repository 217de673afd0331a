#include "command_line/arguments_growth.h"

#include "vmesh/tuning/budget.h"

#include "command_line/arguments_common.h"

namespace vmesh::tool {
namespace {

// The values of a preset can be overridden by their own options, wherever these are on the line.
void add_preset(CLI::App& verb, GenerateOptions& options) {
  CLI::Option* preset = verb.add_option("--preset", "low: 6 vertices around; high: 12, about four times as many in all")
                            ->check(CLI::IsMember({"low", "high"}))
                            ->default_str("low");
  verb.parse_complete_callback([&verb, &options, preset] {
    if (preset->count() == 0 || verb.get_option("--around")->count() > 0) return;
    options.around = vertices_around(preset->as<std::string>() == "high" ? Preset::high : Preset::low);
  });
}

}  // namespace

void add_growth(CLI::App& verb, ProductionOptions& options) {
  for_each_generate_option(options.growth,
                           [&verb](const char* flag, auto& member, auto low, auto high, const char* help) {
                             add_number(verb, flag, member, low, high, help);
                           });
  add_preset(verb, options.growth);
  add_choice(
      verb, "--placement", {"inscribed", "balanced"},
      [&options](const std::string& text) { options.growth.placement = parse_placement(text); },
      "inscribed: vertices on the boundary; balanced: lifted off it, so that the volume is kept")
      ->default_str("balanced");
  add_threads(verb, options.growth.threads);
  add_choice(
      verb, "--overlap", {"keep", "separate"},
      [&options](const std::string& text) { options.preparation.separate = text == "separate"; },
      "vessels that touch without being neighbours: separate them by narrowing, and by moving those that cross; or "
      "keep them: the surface then intersects itself there and is refused")
      ->default_str("separate");
  add_number(verb, "--gap", options.preparation.gap, 0.001, 1.0,
             "gap between vessels below which they count as touching, in smaller radii");
}

}  // namespace vmesh::tool
