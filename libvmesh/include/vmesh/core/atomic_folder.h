#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <ostream>
#include <string>

#include "vmesh/core/atomic_file.h"

namespace vmesh {

/// A folder of files that appears under its name with all of them or not at all: written beside it under a temporary
/// name and renamed by commit(). Without commit() nothing is left behind and an existing folder of that name stays as
/// it was.
class AtomicFolder {
 public:
  /// `is_ours`: whether a file of an existing folder, by its path within it, is one of those that are replaced. Throws
  /// WriteError if the folder holds others, if `path` is a file, and if the folder around it does not exist or cannot
  /// be written.
  AtomicFolder(const std::filesystem::path& path, const std::function<bool(const std::string& name)>& is_ours);
  ~AtomicFolder();
  AtomicFolder(const AtomicFolder&) = delete;
  AtomicFolder& operator=(const AtomicFolder&) = delete;

  /// A new file, "surfaces/wall.vtp" say; finishes the one before. Throws WriteError like AtomicFile.
  std::ostream& open(const std::string& name);

  /// Finishes the folder. Throws WriteError when any byte could not be written.
  void commit();

 private:
  void finish_file();
  void put_in_place() const;
  [[noreturn]] void fail(const std::string& name, const char* what) const;

  std::filesystem::path path_, temporary_;
  std::string file_name_;
  std::unique_ptr<AtomicFile> file_;
};

}  // namespace vmesh
