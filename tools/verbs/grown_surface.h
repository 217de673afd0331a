// A surface as `vmesh generate` makes it, for all verbs that begin with one.
#pragma once

#include <memory>

#include "vmesh/surface/surface_attributes.h"

#include "command_line/console.h"
#include "report/summary.h"
#include "verbs/generate_input.h"

namespace CLI {  // NOLINT(readability-identifier-naming): a library's
class App;
}

namespace vmesh::tool {

/// Adds --ends, --open-ends and --flow-extensions.
void add_ends(CLI::App& verb, ProductionOptions& options);

/// With --ends, --open-ends all means that all are open. Throws UsageError.
void settle_ends(ProductionOptions& options);

/// Refuses options that do not go together (UsageError), before anything is read.
void check_growth(const GenerateArguments& arguments);

/// A surface around the vessels of an input, and all there is to report of it.
struct GrownSurface {
  explicit GrownSurface(const GenerateArguments& given) : arguments(given) {}
  GrownSurface(const GrownSurface&) = delete;  // the report refers to the others
  GrownSurface& operator=(const GrownSurface&) = delete;

  GenerateArguments arguments;  ///< a budget may have changed some of them
  GenerateInput input;
  Production production;
  GenerateReport report;
  bool kept_limits = true;  ///< budget and error

  const GenerateResult& result() const { return production.result; }
  /// Those that are written with it.
  MeshAttributes attributes() const;
  /// Whether these are those of surface_attributes() alone; then attribute_blocks() has them, too.
  bool has_plain_attributes() const { return report.ends.ends.empty() && !arguments.wall_by_branch; }
  AttributeBlocks attribute_blocks() const;
};

/// Reads the input, extracts a centerline if it is a segmentation, grows the surface, fits it and finishes its ends.
/// Sound or not: `vmesh generate` writes only what is, and so should others. Throws like the library, and UsageError.
std::unique_ptr<GrownSurface> grow_surface(const GenerateArguments& given, Console& console);

}  // namespace vmesh::tool
