#include "verbs/frame_series.h"

#include "vmesh/core/atomic_file.h"
#include "vmesh/core/error.h"
#include "vmesh/core/text.h"

#include "command_line/usage_error.h"

namespace vmesh::tool {

namespace fs = std::filesystem;

FrameSeries::FrameSeries(fs::path folder, std::string extension)
    : folder_(std::move(folder)), extension_(std::move(extension)) {
  std::error_code error;
  made_folder_ = fs::create_directory(folder_, error);
  if (!fs::is_directory(folder_, error))
    throw WriteError(folder_.string() + ": is not a folder and cannot be made one");
  if (!fs::is_empty(folder_, error) || error)
    throw UsageError(folder_.string() + ": the folder is not empty; give an empty or a new one for the frames");
}

FrameSeries::~FrameSeries() {
  if (kept_) return;
  std::error_code ignored;
  for (const fs::path& file : frames_) fs::remove(file, ignored);
  for (const fs::path& file : others_) fs::remove(file, ignored);
  if (made_folder_) fs::remove(folder_, ignored);
}

fs::path FrameSeries::next() {
  frames_.push_back(folder_ / (formatted("frame_%06zu", frames_.size()) + extension_));
  return frames_.back();
}

void FrameSeries::write_collection(const std::vector<double>& times_s) {
  std::string text = "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\">\n  <Collection>\n";
  for (std::size_t i = 0; i < times_s.size(); ++i)
    text += formatted("    <DataSet timestep=\"%.12g\" part=\"0\" file=\"", times_s[i]) +
            frames_.at(i).filename().string() + "\"/>\n";
  others_.push_back(folder_ / "frames.pvd");
  AtomicFile file(others_.back());
  file.write(text + "  </Collection>\n</VTKFile>\n");
  file.commit();
}

}  // namespace vmesh::tool
