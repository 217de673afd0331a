#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <sys/types.h>

namespace vmesh::testing {

/// The results of running the command.
struct Outcome {
  int exit_code = -1;  ///< minus the signal's number when a signal ended it
  std::string out, err;
};

/// The command in the background.
class Process {
 public:
  /// Starts it in `folder`, stdout and stderr into files there.
  Process(const std::filesystem::path& folder, const std::vector<std::string>& arguments);
  ~Process();
  Process(const Process&) = delete;
  Process& operator=(const Process&) = delete;

  void send(int signal) const;
  /// What it has written to stderr so far.
  std::string err() const;
  /// Waits for its end.
  Outcome finish();

 private:
  std::filesystem::path out_path_, err_path_;
  pid_t pid_ = -1;
};

/// Tests that run the command in a folder of their own.
class CommandTest : public ::testing::Test {
 protected:
  CommandTest();
  ~CommandTest() override;

  Outcome vmesh(const std::vector<std::string>& arguments) const {
    return Process(logs_, arguments_in(arguments)).finish();
  }
  /// The same in the background.
  Process start(const std::vector<std::string>& arguments) const { return {logs_, arguments_in(arguments)}; }

  /// Arguments that begin with "@" name files of the folder: "@tree.swc".
  std::vector<std::string> arguments_in(const std::vector<std::string>& arguments) const;
  std::filesystem::path path(const std::string& name) const { return folder_ / name; }
  bool exists(const std::string& name) const { return std::filesystem::exists(path(name)); }
  void write(const std::string& name, const std::string& content) const;
  std::string read(const std::string& name) const;
  /// Names of all files in the folder, sorted.
  std::vector<std::string> files() const;

  /// A small tree under the name given (.swc).
  void write_y(const std::string& name) const;

 private:
  std::filesystem::path folder_, logs_;
};

std::string read_file(const std::filesystem::path& path);

}  // namespace vmesh::testing
