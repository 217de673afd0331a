#include "run_vmesh.h"

#include <algorithm>
#include <fstream>
#include <sstream>

#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

extern char** environ;

namespace vmesh::testing {
namespace fs = std::filesystem;
namespace {

fs::path new_folder() {
  std::string name = (fs::temp_directory_path() / "vmesh_test_XXXXXX").string();
  if (mkdtemp(name.data()) == nullptr) throw std::runtime_error("cannot make a temporary folder");
  return name;
}

}  // namespace

std::string read_file(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  std::ostringstream content;
  content << in.rdbuf();
  return content.str();
}

Process::Process(const fs::path& folder, const std::vector<std::string>& arguments)
    : out_path_(folder / "stdout"), err_path_(folder / "stderr") {
  std::vector<char*> argv;
  std::string program = VMESH_COMMAND;
  argv.push_back(program.data());
  std::vector<std::string> copies = arguments;
  for (std::string& argument : copies) argv.push_back(argument.data());
  argv.push_back(nullptr);

  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, out_path_.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0644);
  posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, err_path_.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0644);
  const int error = posix_spawn(&pid_, program.c_str(), &actions, nullptr, argv.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  if (error != 0) throw std::runtime_error("cannot run " + program);
}

Process::~Process() {
  if (pid_ <= 0) return;
  kill(pid_, SIGKILL);
  waitpid(pid_, nullptr, 0);
}

void Process::send(int signal) const { kill(pid_, signal); }

std::string Process::err() const { return read_file(err_path_); }

Outcome Process::finish() {
  int status = 0;
  waitpid(pid_, &status, 0);
  pid_ = -1;
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status), read_file(out_path_), read_file(err_path_)};
}

CommandTest::CommandTest() : folder_(new_folder()), logs_(new_folder()) {}

CommandTest::~CommandTest() {
  std::error_code ignored;
  fs::remove_all(folder_, ignored);
  fs::remove_all(logs_, ignored);
}

std::vector<std::string> CommandTest::arguments_in(const std::vector<std::string>& arguments) const {
  std::vector<std::string> expanded;
  expanded.reserve(arguments.size());
  for (const std::string& argument : arguments)
    expanded.push_back(argument.starts_with('@') ? path(argument.substr(1)).string() : argument);
  return expanded;
}

void CommandTest::write(const std::string& name, const std::string& content) const {
  std::ofstream(path(name), std::ios::binary) << content;
}

std::string CommandTest::read(const std::string& name) const { return read_file(path(name)); }

std::vector<std::string> CommandTest::files() const {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder_)) names.push_back(entry.path().filename().string());
  std::sort(names.begin(), names.end());
  return names;
}

void CommandTest::write_y(const std::string& name) const {
  write(name,
        "# SPACE=LPS\n# UNIT=mm\n"
        "1 0 0 0 0 3.0 -1\n2 0 0 0 20 2.8 1\n3 0 -9 0 32 2.1 2\n4 0 8 3 33 2.3 2\n");
}

}  // namespace vmesh::testing
