#include "vmesh/core/atomic_folder.h"

#include <cerrno>
#include <cstring>
#include <system_error>

#include <fcntl.h>
#include <stdio.h>  // renameat2()

#include "vmesh/core/error.h"

#include "replacing.h"

namespace vmesh {

namespace fs = std::filesystem;

namespace {

/// "mesh/" is "mesh".
fs::path without_slash(const fs::path& path) { return path.has_filename() ? path : path.parent_path(); }

/// Throws WriteError if an existing folder holds anything else than what will be replaced.
void check_replaceable(const fs::path& path, const std::function<bool(const std::string& name)>& is_ours) {
  if (!fs::exists(path)) return;
  if (!fs::is_directory(path))
    throw WriteError(path.string() + ": this is a file; a folder is to be written; remove it or choose another name");
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(path)) {
    const fs::path name = entry.path().lexically_relative(path);
    const bool is_link = entry.is_symlink();
    if ((entry.is_directory() && !is_link) || (entry.is_regular_file() && !is_link && is_ours(name.string()))) continue;
    throw WriteError(path.string() + ": the folder is there and holds " + name.string() +
                     ", which would be lost; remove it or choose another name");
  }
}

}  // namespace

AtomicFolder::AtomicFolder(const fs::path& path, const std::function<bool(const std::string& name)>& is_ours)
    : path_(behind_links(without_slash(path))) {
  try {
    check_replaceable(path_, is_ours);
    temporary_ = temporary_name(path_);
    fs::create_directory(temporary_);
  } catch (const fs::filesystem_error& error) {
    temporary_.clear();
    errno = error.code().value();
    fail("", "cannot be created");
  }
}

AtomicFolder::~AtomicFolder() {
  file_.reset();
  std::error_code ignored;
  if (!temporary_.empty()) fs::remove_all(temporary_, ignored);
}

void AtomicFolder::fail(const std::string& name, const char* what) const {
  throw WriteError((name.empty() ? path_ : path_ / name).string() + ": " + what + ": " + std::strerror(errno) +
                   "; check the name, the folder, its permissions and the free space");
}

std::ostream& AtomicFolder::open(const std::string& name) {
  finish_file();
  file_name_ = name;
  try {
    fs::create_directories((temporary_ / name).parent_path());
    file_ = std::make_unique<AtomicFile>(temporary_ / name);
  } catch (const std::exception&) {
    fail(name, "cannot be created");
  }
  return file_->stream();
}

void AtomicFolder::finish_file() {
  if (!file_) return;
  try {
    file_->commit();
  } catch (const WriteError&) {  // which names the temporary folder
    fail(file_name_, "cannot be written completely");
  }
  file_.reset();
}

void AtomicFolder::commit() {
  if (temporary_.empty()) return;
  finish_file();
  put_in_place();
  std::error_code ignored;  // what was replaced is of no use to anyone
  fs::remove_all(temporary_, ignored);
  temporary_.clear();
  sync_folder(path_.parent_path());
}

/// Leaves what was there under the temporary name.
void AtomicFolder::put_in_place() const {
  if (::rename(temporary_.c_str(), path_.c_str()) == 0) return;  // there was none, or an empty one
#ifdef RENAME_EXCHANGE
  if (::renameat2(AT_FDCWD, temporary_.c_str(), AT_FDCWD, path_.c_str(), RENAME_EXCHANGE) == 0) return;
#endif
  // Some systems and file systems cannot exchange.
  const fs::path aside = temporary_name(path_);
  if (::rename(path_.c_str(), aside.c_str()) != 0) fail("", "cannot be replaced");
  if (::rename(temporary_.c_str(), path_.c_str()) != 0) {
    const int reason = errno;
    ::rename(aside.c_str(), path_.c_str());
    errno = reason;
    fail("", "cannot be put in place");
  }
  ::rename(aside.c_str(), temporary_.c_str());
}

}  // namespace vmesh
