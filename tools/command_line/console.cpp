#include "command_line/console.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include <unistd.h>

#include "command_line/interrupt.h"

namespace vmesh::tool {

Console::Console(bool quiet) : quiet_(quiet), terminal_(isatty(STDERR_FILENO) == 1) {}

void Console::set_quiet(bool quiet) { quiet_ = quiet; }

void Console::print(std::string_view prefix, std::string_view line) {
  clear_bar();
  std::fprintf(stderr, "%.*s%.*s\n", static_cast<int>(prefix.size()), prefix.data(), static_cast<int>(line.size()),
               line.data());
}

void Console::log(std::string_view line) {
  if (!quiet_) print("", line);
}

void Console::warn(std::string_view line) { print("warning: ", line); }

void Console::warn(const std::vector<std::string>& lines) {
  for (const std::string& line : lines) warn(line);
}

void Console::error(std::string_view line) { print("vmesh: ", line); }

Progress Console::progress() {
  const bool visible = terminal_ && !quiet_;
  return [this, visible](std::string_view stage, double fraction) {
    if (visible) draw_bar(stage, fraction);
    return !interrupted();
  };
}

void Console::draw_bar(std::string_view stage, double fraction) {
  const auto now = std::chrono::steady_clock::now();
  if (now < next_draw_) return;
  next_draw_ = now + std::chrono::milliseconds(100);
  constexpr int kWidth = 30;
  const double done = std::isfinite(fraction) ? std::clamp(fraction, 0.0, 1.0) : 0.0;
  const int filled = static_cast<int>(done * kWidth);
  bar_.assign(static_cast<std::size_t>(filled), '#').append(static_cast<std::size_t>(kWidth - filled), '.');
  std::fprintf(stderr, "\r\x1b[K[%s] %3.0f %% %.*s", bar_.c_str(), 100 * done, static_cast<int>(stage.size()),
               stage.data());
  std::fflush(stderr);
  bar_drawn_ = true;
}

void Console::clear_bar() {
  if (!bar_drawn_) return;
  std::fputs("\r\x1b[K", stderr);
  bar_drawn_ = false;
}

double Stopwatch::lap() {
  const auto now = std::chrono::steady_clock::now();
  const double seconds = std::chrono::duration<double>(now - start_).count();
  start_ = now;
  return seconds;
}

}  // namespace vmesh::tool
