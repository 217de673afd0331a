#include "vmesh/core/child_process.h"

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <new>

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "vmesh/core/error.h"
#include "vmesh/core/memory.h"

namespace vmesh {
namespace {

/// First byte of the answer.
constexpr char kDone = 'd', kInvalid = 'i', kUnsupported = 'u', kNoMemory = 'm', kFailed = 'f';

bool write_all(int to, const char* data, std::size_t size) {
  while (size > 0) {
    const ssize_t written = ::write(to, data, size);
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) return false;
    data += written;
    size -= static_cast<std::size_t>(written);
  }
  return true;
}

std::string read_all(int from) {
  std::string all;
  char buffer[1 << 16];
  for (;;) {
    const ssize_t got = ::read(from, buffer, sizeof buffer);
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) return all;
    all.append(buffer, static_cast<std::size_t>(got));
  }
}

void limit(decltype(RLIMIT_CPU) resource, std::size_t most) {
  rlimit limits{};
  ::getrlimit(resource, &limits);
  limits.rlim_cur = std::min<rlim_t>(limits.rlim_max, most);
  ::setrlimit(resource, &limits);
}

std::string answer_of(const std::function<std::string()>& work) {
  try {
    return kDone + work();
  } catch (const InvalidInput& error) {
    return kInvalid + std::string(error.what());
  } catch (const Unsupported& error) {
    return kUnsupported + std::string(error.what());
  } catch (const std::bad_alloc&) {
    return std::string(1, kNoMemory);
  } catch (const std::exception& error) {
    return kFailed + std::string(error.what());
  }
}

[[noreturn]] void work_in_child(int to, std::size_t file_size, const std::function<std::string()>& work) {
  for (const int signal : {SIGINT, SIGTERM, SIGSEGV, SIGABRT, SIGBUS, SIGFPE, SIGXCPU}) ::signal(signal, SIG_DFL);
  // Neither the library's output on failure nor unflushed output of this process may appear.
  const int nowhere = ::open("/dev/null", O_WRONLY);
  for (const int stream : {STDOUT_FILENO, STDERR_FILENO}) ::dup2(nowhere, stream);
  limit(RLIMIT_CORE, 0);
  limit(RLIMIT_CPU, 30 + 2 * (file_size >> 20u));
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)  // their own memory would count
  if (const auto available = available_memory()) limit(RLIMIT_DATA, static_cast<std::size_t>(*available) / 2);
#endif
  const std::string answer = answer_of(work);
  const bool written = write_all(to, answer.data(), answer.size());
  ::_exit(written ? 0 : 1);
}

}  // namespace

std::string in_child_process(const std::string& source, std::size_t file_size,
                             const std::function<std::string()>& work) {
  int ends[2];
  if (::pipe(ends) != 0) throw Unsupported(source + ": cannot be read now: " + std::strerror(errno));
  const pid_t child = ::fork();
  if (child < 0) {
    const std::string reason = std::strerror(errno);
    ::close(ends[0]);
    ::close(ends[1]);
    throw Unsupported(source + ": cannot be read now: " + reason);
  }
  if (child == 0) {
    ::close(ends[0]);
    work_in_child(ends[1], file_size, work);
  }
  ::close(ends[1]);
  std::string answer = read_all(ends[0]);
  ::close(ends[0]);
  int status = 0;
  while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  if (WIFSIGNALED(status) && WTERMSIG(status) == SIGXCPU)
    throw InvalidInput(source + ": reading it took too long; the file may be damaged");
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0 || answer.empty())
    throw InvalidInput(source + ": the library that reads such files crashed; the file is damaged or of another kind");
  const char kind = answer.front();
  answer.erase(0, 1);
  if (kind == kNoMemory) throw InvalidInput(source + ": reading it takes more than half of the free memory");
  if (kind == kInvalid) throw InvalidInput(answer);
  if (kind == kFailed)
    throw InvalidInput(source + ": the library that reads such files failed; the file may be damaged: " + answer);
  if (kind == kUnsupported) throw Unsupported(answer);
  return answer;
}

}  // namespace vmesh
