// A folder of files that are the frames of one motion.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace vmesh::tool {

/// Files of a series. All are removed again unless kept.
class FrameSeries {
 public:
  /// Throws WriteError for a folder that cannot be made, UsageError for one that is not empty. `extension` with its
  /// dot.
  FrameSeries(std::filesystem::path folder, std::string extension);
  ~FrameSeries();
  FrameSeries(const FrameSeries&) = delete;
  FrameSeries& operator=(const FrameSeries&) = delete;

  /// The path of the next frame, frame_000000 and so on.
  std::filesystem::path next();
  /// Writes frames.pvd, with which ParaView opens all frames at their times (s), one for each.
  void write_collection(const std::vector<double>& times_s);
  std::size_t size() const { return frames_.size(); }
  const std::filesystem::path& folder() const { return folder_; }
  void keep() { kept_ = true; }

 private:
  std::filesystem::path folder_;
  std::string extension_;
  std::vector<std::filesystem::path> frames_, others_;
  bool made_folder_ = false, kept_ = false;
};

}  // namespace vmesh::tool
