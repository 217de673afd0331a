#pragma once

#include <string>
#include <variant>
#include <vector>

#include "vmesh/core/error.h"
#include "vmesh/image/image_io.h"
#include "vmesh/io/centerline_io.h"
#include "vmesh/io/surface_io.h"

#include "command_line/arguments.h"
#include "command_line/console.h"

namespace vmesh::tool {

/// What a file says of its numbers.
struct FileFrame {
  LengthUnit unit = LengthUnit::unknown;
  Space space = Space::unknown;
};

/// A centerline as its file tells it, in mm and LPS; warnings are appended, what the file says of its
/// numbers goes to `said`. Files of another kind are refused with the command that makes a centerline of them.
RawCenterline load_raw_centerline(const InputArguments& input, std::vector<std::string>& warnings,
                                  FileFrame* said = nullptr);

/// A surface in mm and LPS, likewise. Attributes that are lengths are converted too.
LoadedSurface load_surface(const InputArguments& input, FileFrame* said = nullptr);

/// The same, cleaned; warnings and what cleaning did are told.
LoadedCenterline load_clean_centerline(const InputArguments& input, Console& console);

/// An image; --unit and --space are refused, as images say where they lie. Throws UsageError.
LoadedImage load_image(const InputArguments& input, Console& console);

/// Throws Unsupported, with the verbs that take images, if it is one.
void check_is_no_image(const InputArguments& input);

/// Either of the two, by extension; what a .vtp holds, its content decides. What the file says of itself goes to
/// `said`.
using AnyInput = std::variant<RawCenterline, LoadedSurface>;
AnyInput load_any(const InputArguments& input, std::vector<std::string>& warnings, FileFrame* said = nullptr);

/// Calls `function` and names the file in what it finds wrong with it.
template <class Function>
auto naming(const std::filesystem::path& path, Function function) {
  try {
    return function();
  } catch (const InvalidInput& error) {
    const std::string what = error.what(), name = path.string();
    throw InvalidInput(what.starts_with(name) ? what : name + ": " + what);
  }
}

/// Puts the branches in the place of a folder that holds files with one each (.mrk.json, .ctgr or .pth), in the order
/// of their names. A folder of DICOM files remains: it is an image. Others are refused (ReadError), with files that
/// could be meant.
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

/// All files behind an input or output: a CSV centerline has two.
std::vector<std::filesystem::path> files_of(const std::filesystem::path& input);
/// The same of an input, which may be a folder of DICOM files.
std::vector<std::filesystem::path> files_of_input(const std::filesystem::path& input);
std::vector<std::filesystem::path> files_of(const InputArguments& input);

/// For metadata: the name of the file, or the names of all; its SHA-256, or the SHA-256 of all theirs, one after
/// another.
std::string file_name_of(const InputArguments& input);
std::string sha256_of(const InputArguments& input);
/// Of a file, or of a folder of DICOM files likewise.
std::string sha256_of_input(const std::filesystem::path& path);

}  // namespace vmesh::tool
