#include <sstream>

#include "vmesh/io/volume_io.h"

#include "command_line/outputs.h"
#include "command_line/verb.h"
#include "report/summary.h"

namespace vmesh::tool::formats_verb {
namespace {

struct FormatsArguments {
  CommonArguments common;
};

std::vector<std::string> options_of(const CenterlineFormat& format) {
  std::vector<std::string> options = format.options;
  options.insert(options.end(), {"radius", "tolerance", "unit", "space"});
  return options;
}
std::vector<std::string> options_of(const SurfaceFormat&) { return {"unit", "space"}; }
std::vector<std::string> options_of(const VolumeFormat&) { return {}; }
std::vector<std::string> options_of(const ImageFormat& format) { return format.options; }

bool is_read(const CenterlineFormat& format) { return format.parse || format.parse_pair || format.read; }
bool is_read(const SurfaceFormat& format) { return format.parse || format.read; }
bool is_read(const VolumeFormat&) { return false; }  // by no verb
bool is_read(const ImageFormat& format) {
  const bool is_dicom = format.extensions.empty();
  return format.parse_header || format.read || (is_dicom && VMESH_TOOL_WITH_DICOM);
}

bool is_mostly_another(const CenterlineFormat& format) { return format.holds_lines != nullptr; }
bool is_mostly_another(const SurfaceFormat&) { return false; }
bool is_mostly_another(const VolumeFormat&) { return false; }
bool is_mostly_another(const ImageFormat&) { return false; }

/// With the endings of the names of folders.
std::vector<std::string> endings_of(const VolumeFormat& format) {
  return format.is_folder() ? std::vector<std::string>{format.folder} : format.extensions;
}
std::vector<std::string> endings_of(const auto& format) { return format.extensions; }

template <class Format>
Json to_json(const std::vector<Format>& formats) {
  return list_json(formats, [](const Format& format) {
    return Json{{"name", format.name},
                {"extensions", endings_of(format)},
                {"read", is_read(format)},
                {"written", format.is_written()},
                {"mostly_another_kind", is_mostly_another(format)},
                {"options", options_of(format)}};
  });
}

/// "centerline .gxl .xml: VascuSynth; read; --voxel-size, --radius, --unit, --space"
std::string line_of(const std::string& kind, const Json& format) {
  std::string line = kind, options;
  for (const std::string extension : format["extensions"]) line += " " + extension;
  for (const std::string option : format["options"]) options += (options.empty() ? "; --" : ", --") + option;
  return line + ": " + format["name"].get<std::string>() +
         (format["read"]      ? "; read"
          : format["written"] ? ""
                              : "; not built in") +
         (format["written"] ? "; written" : "") + options + "\n";
}

int run(const FormatsArguments& arguments, Console&) {
  check_outputs({{arguments.common.json, PlannedOutput::Kind::summary}}, {});
  const Json formats = {{"schema", "vmesh.formats/1"},
                        {"centerline", to_json(centerline_formats())},
                        {"surface", to_json(surface_formats())},
                        {"volume", to_json(volume_formats())},
                        {"image", to_json(image_formats())}};
  if (arguments.common.json != "-") {
    std::string text;
    for (const char* kind : {"centerline", "surface", "volume", "image"}) {
      for (const Json& format : formats[kind]) text += line_of(kind, format);
    }
    write_text("-", text);
  }
  write_json(arguments.common.json, formats);
  return kOk;
}

const VerbRegistration<FormatsArguments> kRegistration({
    .rank = 45,
    .name = "formats",
    .help = "List the file formats, and which options say how to read them",
    .examples = R"(Examples:
  vmesh formats
  vmesh formats --json -)",
    .add_options = [](CLI::App&, FormatsArguments&) {},
    .run = run,
});

}  // namespace
}  // namespace vmesh::tool::formats_verb
