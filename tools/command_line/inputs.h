#pragma once

#include <string>
#include <variant>
#include <vector>

#include "vmesh/core/error.h"
#include "vmesh/image/image_io.h"
#include "vmesh/image/image_summary.h"
#include "vmesh/io/centerline_io.h"
#include "vmesh/io/surface_io.h"
#include "vmesh/skeleton/vessel_mask.h"

#include "command_line/arguments.h"
#include "command_line/console.h"

namespace vmesh::tool {

/// Unit and frame as stated in a file.
struct FileFrame {
  LengthUnit unit = LengthUnit::unknown;
  Space space = Space::unknown;
};

/// Whether the file may contain a centerline: by its extension, or by its content where nearly all files with that
/// extension contain surfaces.
bool may_be_centerline(const std::filesystem::path& path);

/// A centerline as in its file, in mm and LPS; warnings are appended, the file's unit and frame go to `said`. Files of
/// another kind are refused with the command that makes a centerline from them.
RawCenterline load_raw_centerline(const InputArguments& input, std::vector<std::string>& warnings,
                                  FileFrame* said = nullptr);

/// A surface in mm and LPS, likewise. Attributes that are lengths are converted too.
LoadedSurface load_surface(const InputArguments& input, FileFrame* said = nullptr);

/// The same, cleaned; reports warnings and what cleaning did.
LoadedCenterline load_clean_centerline(const InputArguments& input, Console& console);

/// An image; --unit and --space are refused (UsageError), as images contain their position and unit.
LoadedImage load_image(const InputArguments& input, const ReferenceOptions& options, Console& console);

/// The vessels' voxels of an image, likewise.
VesselMask load_vessel_mask(const InputArguments& input, const ReferenceOptions& options, Console& console);
/// What an image holds, read slice by slice; likewise.
ImageSummary load_image_summary(const InputArguments& input, Console& console);

/// Whether a file is an image or a surface, of which a centerline can be extracted, and not a centerline.
bool is_segmentation(const InputArguments& input);

/// Throws Unsupported, naming the verbs that take images, if it is one.
void check_is_no_image(const InputArguments& input);

/// Either of the two, by extension, or for a .vtp by content. The file's unit and frame go to `said`.
using AnyInput = std::variant<RawCenterline, LoadedSurface>;
AnyInput load_any(const InputArguments& input, std::vector<std::string>& warnings, FileFrame* said = nullptr);

/// Calls `function` and adds the file's name to its errors.
template <class Function>
auto naming(const std::filesystem::path& path, Function function) {
  try {
    return function();
  } catch (const InvalidInput& error) {
    const std::string what = error.what(), name = path.string();
    throw InvalidInput(what.starts_with(name) ? what : name + ": " + what);
  }
}

/// Replaces a folder of files with one branch each (.mrk.json, .ctgr or .pth) by these files, ordered by name. A folder
/// of DICOM files stays: it is an image. Others are refused (ReadError), suggesting files that could be meant.
void expand_folders(InputArguments& input);

/// The same for all inputs of a verb.
template <class VerbArguments>
void expand_all_folders(VerbArguments& verb) {
  if constexpr (requires { verb.input; }) expand_folders(verb.input);
  if constexpr (requires { verb.centerline; }) expand_folders(verb.centerline);
  if constexpr (requires { verb.reference; }) expand_folders(verb.reference);
  if constexpr (requires { verb.surface; }) expand_folders(verb.surface);
  if constexpr (requires { verb.fitting; }) expand_folders(verb.fitting.reference);
}

/// All files of an input or output: a CSV centerline has two.
std::vector<std::filesystem::path> files_of(const std::filesystem::path& input);
/// The same for an input, which may be a folder of DICOM files.
std::vector<std::filesystem::path> files_of_input(const std::filesystem::path& input);
std::vector<std::filesystem::path> files_of(const InputArguments& input);
/// The same for all of several inputs that are given.
std::vector<std::filesystem::path> files_of(std::initializer_list<const InputArguments*> inputs);

/// For metadata: the name of the file, or of all files; its SHA-256, or the SHA-256 of their concatenated SHA-256s.
std::string file_name_of(const InputArguments& input);
std::string sha256_of(const InputArguments& input);
/// The same for a file or a folder of DICOM files.
std::string sha256_of_input(const std::filesystem::path& path);

}  // namespace vmesh::tool
