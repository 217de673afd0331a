#include "command_line/inputs.h"

#include <algorithm>
#include <map>

#include "vmesh/core/input_file.h"
#include "vmesh/io/sha256.h"

#include "command_line/interrupt.h"
#include "command_line/outputs.h"
#include "command_line/usage_error.h"

namespace vmesh::tool {
namespace {

/// VTK's files may contain a surface or a centerline, PLY and OBJ lines.
bool may_be_both(const std::filesystem::path& path) {
  return find_surface_format(path) != nullptr && may_be_centerline(path);
}

/// Whether the file can only contain a surface.
bool has_surface_extension(const std::filesystem::path& path) {
  return find_surface_format(path) != nullptr && !may_be_centerline(path);
}

std::vector<std::filesystem::path> paths_of(const InputArguments& input) {
  std::vector<std::filesystem::path> paths = {input.path};
  paths.insert(paths.end(), input.more.begin(), input.more.end());
  return paths;
}

/// Renames --unit and --space in the library's warnings to the options for this file.
void name_options(std::vector<std::string>& warnings, const InputArguments& input) {
  for (std::string& warning : warnings) {
    for (const char* option : {"--unit", "--space"}) {
      const std::size_t at = warning.rfind(option);
      if (at != std::string::npos) warning.insert(at + 2, input.options_of);
    }
  }
}

/// Whether the file can only contain a centerline, not a surface.
bool holds_only_a_centerline(const std::filesystem::path& path) {
  return find_centerline_format(path) != nullptr && find_surface_format(path) == nullptr;
}

/// "wall.stl: this is a surface; ...": what to do with a file of the wrong kind, with the command.
std::string make_centerline_first(const std::filesystem::path& path, const std::string& kind) {
  const std::string made = path.stem().stem().string() + ".centerline.json";
  return path.string() + ": this is " + kind + ", and a centerline is needed; extract one first: vmesh centerline " +
         path.string() + " -o " + made;
}

std::string make_surface_first(const std::filesystem::path& path, const std::string& what, const std::string& verb) {
  return path.string() + ": this " + what + ", and a surface is needed; make one first: vmesh " + verb + " " +
         path.string() + " -o " + path.stem().stem().string() + ".ply";
}

/// The same where a surface or a centerline would be accepted.
std::string make_either_first(const std::filesystem::path& path) {
  const std::string made = path.stem().stem().string();
  return path.string() +
         ": this is an image, and a surface or a centerline is needed; make one first: vmesh reference " +
         path.string() + " -o " + made + ".ply, or vmesh centerline " + path.string() + " -o " + made +
         ".centerline.json";
}

bool holds_centerline(const std::filesystem::path& path) {
  try {
    CenterlineReadOptions any;
    any.radius = 1;
    return !read_centerline(path, any).segments.empty();
  } catch (const Error&) {
    return false;
  }
}

bool holds_surface(const std::filesystem::path& path) {
  try {
    return !read_surface(path).mesh.faces.empty();
  } catch (const Error&) {
    return false;
  }
}

/// The files in a folder by name, without hidden ones.
std::vector<std::filesystem::path> files_in(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> files;
  std::error_code error;
  for (std::filesystem::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) {
    if (entry->is_regular_file(error) && !entry->path().filename().string().starts_with('.'))
      files.push_back(entry->path());
  }
  if (error) throw ReadError(folder.string() + ": the folder cannot be read: " + error.message());
  std::sort(files.begin(), files.end());
  return files;
}

/// ".pth", say, for files that contain one branch of a tree each; empty for others.
std::string branch_extension(const std::filesystem::path& path) {
  const CenterlineFormat* format = find_centerline_format(path);
  return format != nullptr && format->one_branch ? longest_extension(path, format->extensions) : "";
}

bool is_readable(const std::filesystem::path& path) {
  return find_centerline_format(path) || find_surface_format(path) || is_image_path(path);
}

/// "a.swc, b.swc and 7 more": readable files that could have been meant.
std::string names_of_readable(const std::vector<std::filesystem::path>& files) {
  constexpr std::size_t kNamed = 3;
  std::string names;
  std::size_t count = 0;
  for (const std::filesystem::path& file : files) {
    if ((is_readable(file) || is_image(file)) && count++ < kNamed) names += (names.empty() ? "" : ", ") + file.string();
  }
  return count > kNamed ? names + " and " + std::to_string(count - kNamed) + " more" : names;
}

/// Subfolders with DICOM files: a study's series are often stored so.
std::vector<std::filesystem::path> scans_in(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> scans;
  std::error_code error;
  for (std::filesystem::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) {
    if (entry->is_directory(error) && is_image(entry->path())) scans.push_back(entry->path());
  }
  std::sort(scans.begin(), scans.end());
  return scans;
}

/// The files meant by a path: itself, unless it is a folder of branches. A folder of DICOM files is an image.
std::vector<std::filesystem::path> expanded_folder(const std::filesystem::path& path) {
  std::error_code error;
  if (!std::filesystem::is_directory(path, error)) return {path};
  const std::filesystem::path folder = path.has_filename() ? path : path.parent_path();
  const std::vector<std::filesystem::path> files = files_in(folder);
  std::map<std::string, std::vector<std::filesystem::path>> branches;
  for (const std::filesystem::path& file : files) {
    if (const std::string extension = branch_extension(file); !extension.empty()) branches[extension].push_back(file);
  }
  if (branches.size() == 1) return branches.begin()->second;
  if (branches.size() > 1) {
    const auto& [first, second] = std::pair(*branches.begin(), *std::next(branches.begin()));
    throw InvalidInput(folder.string() + ": this folder contains branches of several kinds (" + first.first + ", " +
                       second.first + "); name the files of one, as in " + folder.string() + "/*" + first.first);
  }
  if (is_image(folder)) return {folder};  // of DICOM slices
  std::vector<std::filesystem::path> meant = files;
  for (std::filesystem::path& scan : scans_in(folder)) meant.push_back(std::move(scan));
  const std::string names = names_of_readable(meant);
  throw ReadError(
      folder.string() + ": this is a folder, and " +
      (names.empty() ? "it contains no file that vmesh can read" : "one of its files is needed; there are " + names));
}

/// The extensions of the formats on which an option for reading acts.
std::string extensions_with(const std::string& option) {
  return listed(extensions_of(centerline_formats(), [&](const CenterlineFormat& format) {
    return option == "radius" || option == "tolerance" ||
           std::ranges::find(format.options, option) != format.options.end();
  }));
}

/// Throws UsageError for options that act on none of these centerlines; `kind` says what the input is.
void refuse_without_effect(const InputArguments& input, const std::vector<std::filesystem::path>& centerlines,
                           const std::string& kind) {
  for (const std::string& option : options_without_effect(input.read, centerlines))
    throw UsageError(input.path.string() + ": this is " + kind + "; --" + input.options_of + option +
                     " is for centerlines in " + extensions_with(option));
}

RawCenterline read_centerline_of(const InputArguments& input) {
  const std::vector<std::filesystem::path> paths = paths_of(input);
  for (const std::filesystem::path& path : paths) {
    if (has_surface_extension(path)) throw Unsupported(make_centerline_first(path, "a surface"));
    if (is_image(path)) throw Unsupported(make_centerline_first(path, "an image"));
  }
  refuse_without_effect(input, paths, "a centerline in " + centerline_format(input.path).extensions.front());
  try {
    return read_centerline(paths, input.read);
  } catch (const InvalidInput&) {
    for (const std::filesystem::path& path : paths) {
      if (may_be_both(path) && !holds_centerline(path) && holds_surface(path))
        throw InvalidInput(make_centerline_first(path, "a surface"));
    }
    throw;
  }
}

/// Throws UsageError for options that say how to read a file that is not given.
void refuse_without_file(const InputArguments& input) {
  if (!input.path.empty()) return;
  std::vector<std::string> given = options_without_effect(input.read, {});
  if (input.unit) given.push_back("unit");
  if (input.space) given.push_back("space");
  if (!given.empty()) throw UsageError("--" + input.options_of + given.front() + " is for a file that is not given");
}

ReferenceOptions with_voxel_size(ReferenceOptions options, const InputArguments& input) {
  options.voxel_size = input.read.voxel_size;
  return options;
}

/// Calls `read` to read an image.
template <class Read>
auto reading_image(const InputArguments& input, Read read) {
  if (input.unit || input.space)
    throw UsageError(input.path.string() +
                     ": an image contains its position and unit; --unit and --space do not apply");
  InputArguments others = input;
  if (takes_voxel_size(input.path)) others.read.voxel_size.reset();
  refuse_without_effect(others, {}, "an image");
  try {
    return read();
  } catch (const InvalidInput&) {
    stop_if_interrupted();  // which also ends the reading process
    throw;
  }
}

}  // namespace

bool may_be_centerline(const std::filesystem::path& path) {
  const CenterlineFormat* format = find_centerline_format(path);
  if (format == nullptr || format->holds_lines == nullptr) return format != nullptr;
  try {
    return format->holds_lines(read_file(path));
  } catch (const Error&) {
    return false;
  }
}

RawCenterline load_raw_centerline(const InputArguments& input, std::vector<std::string>& warnings, FileFrame* said) {
  RawCenterline raw = read_centerline_of(input);
  if (said != nullptr) *said = {raw.unit, raw.space};
  std::vector<std::string> of_reading;
  raw = convert_read(std::move(raw), input.read, input.unit, input.space, of_reading);
  name_options(of_reading, input);
  warnings.insert(warnings.end(), of_reading.begin(), of_reading.end());
  return raw;
}

LoadedSurface load_surface(const InputArguments& input, FileFrame* said) {
  if (!input.more.empty())
    throw UsageError(input.more.front().string() + ": several files can form a centerline, but not a surface");
  if (is_image(input.path)) throw Unsupported(make_surface_first(input.path, "is an image", "reference"));
  if (holds_only_a_centerline(input.path))
    throw Unsupported(make_surface_first(input.path, "is a centerline", "generate"));
  try {
    LoadedSurface surface = read_surface(input.path);
    refuse_without_effect(input, {}, "a surface");
    if (said != nullptr) *said = {surface.unit, surface.space};
    convert_to_internal(surface, input.path.string(), input.unit, input.space);
    name_options(surface.warnings, input);
    return surface;
  } catch (const InvalidInput&) {
    if (may_be_both(input.path) && holds_centerline(input.path))
      throw InvalidInput(make_surface_first(input.path, "file holds lines, no faces", "generate"));
    throw;
  }
}

LoadedCenterline load_clean_centerline(const InputArguments& input, Console& console) {
  std::vector<std::string> warnings;
  RawCenterline raw = load_raw_centerline(input, warnings);
  CleanedCenterline cleaned = clean(raw);
  LoadedCenterline loaded{std::move(cleaned), std::move(warnings), names_of(std::move(raw))};
  console.warn(loaded.warnings);
  for (const std::string& line : loaded.cleaned.report.summary()) console.log("cleaning: " + line);
  return loaded;
}

LoadedImage load_image(const InputArguments& input, const ReferenceOptions& options, Console& console) {
  const ReferenceOptions all = with_voxel_size(options, input);
  LoadedImage loaded = reading_image(input, [&] { return read_image(input.path, read_options_of(all)); });
  console.warn(loaded.warnings);
  return loaded;
}

VesselMask load_vessel_mask(const InputArguments& input, const ReferenceOptions& options, Console& console) {
  std::vector<std::string> warnings;
  VesselMask mask =
      reading_image(input, [&] { return read_vessel_mask(input.path, with_voxel_size(options, input), warnings); });
  console.warn(warnings);
  return mask;
}

ImageSummary load_image_summary(const InputArguments& input, Console& console) {
  ImageSummary summary = reading_image(input, [&] {
    return summarize_image(input.path, console.progress(), read_options_of(with_voxel_size({}, input)));
  });
  console.warn(summary.image.warnings);
  return summary;
}

bool is_segmentation(const InputArguments& input) {
  if (is_image(input.path)) return true;
  if (!input.more.empty()) return false;
  if (has_surface_extension(input.path)) return true;
  return may_be_both(input.path) && !holds_centerline(input.path) && holds_surface(input.path);
}

void check_is_no_image(const InputArguments& input) {
  if (is_image(input.path)) throw Unsupported(make_either_first(input.path));
}

AnyInput load_any(const InputArguments& input, std::vector<std::string>& warnings, FileFrame* said) {
  check_is_no_image(input);
  if (input.more.empty() && (may_be_both(input.path) || has_surface_extension(input.path))) {
    try {
      LoadedSurface surface = load_surface(input, said);
      warnings.insert(warnings.end(), surface.warnings.begin(), surface.warnings.end());
      return surface;
    } catch (const InvalidInput&) {
      if (!may_be_both(input.path)) throw;  // a file without faces may contain a centerline
    }
  }
  return load_raw_centerline(input, warnings, said);
}

void expand_folders(InputArguments& input) {
  refuse_without_file(input);
  std::vector<std::filesystem::path> expanded;
  for (const std::filesystem::path& path : paths_of(input)) {
    for (std::filesystem::path& file : expanded_folder(path)) expanded.push_back(std::move(file));
  }
  input.path = expanded.front();
  input.more.assign(expanded.begin() + 1, expanded.end());
}

std::vector<std::filesystem::path> files_of(const std::filesystem::path& input) {
  const CenterlineFormat* format = find_centerline_format(input);
  if (format != nullptr && format->second_file) return {input, format->second_file(input)};
  return {input};
}

std::vector<std::filesystem::path> files_of_input(const std::filesystem::path& input) {
  std::error_code error;
  if (std::filesystem::is_directory(input, error)) return files_in(input);
  const CenterlineFormat* format = find_centerline_format(input);
  if (format != nullptr && format->second_file) return {input, second_file_to_read(*format, input)};
  return {input};
}

std::vector<std::filesystem::path> files_of(const InputArguments& input) {
  std::vector<std::filesystem::path> files;
  for (const std::filesystem::path& path : paths_of(input)) {
    for (const std::filesystem::path& file : files_of_input(path)) files.push_back(file);
  }
  return files;
}

std::vector<std::filesystem::path> files_of(std::initializer_list<const InputArguments*> inputs) {
  std::vector<std::filesystem::path> files;
  for (const InputArguments* input : inputs) {
    if (input->path.empty()) continue;
    for (std::filesystem::path& file : files_of(*input)) files.push_back(std::move(file));
  }
  return files;
}

std::string file_name_of(const InputArguments& input) {
  std::string names = input.path.filename().string();
  for (const std::filesystem::path& path : input.more) names += ", " + path.filename().string();
  return names;
}

std::string sha256_of(const InputArguments& input) {
  if (input.more.empty()) return sha256_of_input(input.path);
  std::string all;
  for (const std::filesystem::path& path : paths_of(input)) all += sha256_of_file(path);
  return vmesh::sha256_of(all);
}

std::string sha256_of_input(const std::filesystem::path& path) {
  std::error_code error;
  if (!std::filesystem::is_directory(path, error)) return sha256_of_file(path);
  std::string all;
  for (const std::filesystem::path& file : files_in(path)) all += sha256_of_file(file);
  return vmesh::sha256_of(all);
}

}  // namespace vmesh::tool
