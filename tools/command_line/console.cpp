#include "command_line/console.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include <unistd.h>

#include "command_line/interrupt.h"

namespace vmesh::tool {
namespace {

constexpr std::chrono::seconds kBetweenLines(3);

}  // namespace

Console::Console(bool quiet) : quiet_(quiet), terminal_(isatty(STDERR_FILENO) == 1) {}

Console::~Console() {
  clear_bar();
  end_tags();
}

void Console::set_quiet(bool quiet) { quiet_ = quiet; }

void Console::tell_by_tags(const std::string& verb) { tagged_verb_ = verb; }

std::string printable(std::string_view text) {
  std::string shown;
  shown.reserve(text.size());
  for (std::size_t i = 0; i < text.size(); ++i) {
    const auto byte = static_cast<unsigned char>(text[i]);
    const auto next = static_cast<unsigned char>(i + 1 < text.size() ? text[i + 1] : 0);
    const bool wide = byte == 0xc2 && next >= 0x80 && next < 0xa0;  // U+0080 to U+009F in UTF-8
    if (wide) ++i;
    const bool listed = byte == '\n' && text.substr(i + 1).starts_with("  ");
    shown += !listed && (wide || byte < 0x20 || byte == 0x7f) ? '?' : text[i];
  }
  return shown;
}

void Console::print(std::string_view prefix, std::string_view line) {
  clear_bar();
  const std::string text = std::string(prefix) + printable(line) + "\n";
  std::fwrite(text.data(), 1, text.size(), stderr);
}

void Console::log(std::string_view line) {
  if (!quiet_) print("", line);
}

void Console::warn(std::string_view line) {
  if (warned_.emplace(line).second) print("warning: ", line);
}

void Console::warn(const std::vector<std::string>& lines) {
  for (const std::string& line : lines) warn(line);
}

void Console::error(std::string_view line) { print("vmesh: ", line); }

Progress Console::progress() {
  return [this](std::string_view stage, double fraction) {
    if (stage != stage_) {
      end_tags();
      stage_ = stage;
      stage_began_ = std::chrono::steady_clock::now();
    }
    if (!tagged_verb_.empty()) {
      tell_tags(fraction);
    } else if (!quiet_)
      terminal_ ? draw_bar(stage, fraction) : tell_progress(stage, fraction);
    return !interrupted();
  };
}

void Console::tell_progress(std::string_view stage, double fraction) {
  const auto now = std::chrono::steady_clock::now();
  if (next_draw_ == std::chrono::steady_clock::time_point()) next_draw_ = now + kBetweenLines;
  if (now < next_draw_) return;
  next_draw_ = now + kBetweenLines;
  const double done = std::isfinite(fraction) ? std::clamp(fraction, 0.0, 1.0) : 0.0;
  print("", std::string(stage) + ": " + std::to_string(static_cast<int>(100 * done)) + " %" + time_left(done));
}

void Console::tell_tags(double fraction) {
  const auto now = std::chrono::steady_clock::now();
  if (!tags_open_) {
    std::printf("<filter-start><filter-name>vmesh %s</filter-name><filter-comment>%s</filter-comment></filter-start>\n",
                tagged_verb_.c_str(), stage_.c_str());
    tags_open_ = true;
  } else if (now < next_draw_) {
    return;
  }
  next_draw_ = now + std::chrono::milliseconds(100);
  const double done = std::isfinite(fraction) ? std::clamp(fraction, 0.0, 1.0) : 0.0;
  std::printf("<filter-progress>%.3f</filter-progress>\n", done);
  std::fflush(stdout);
}

void Console::end_tags() {
  if (!tags_open_) return;
  std::printf("<filter-end><filter-comment>%s</filter-comment></filter-end>\n", stage_.c_str());
  std::fflush(stdout);
  tags_open_ = false;
}

std::string Console::time_left(double done) const {
  constexpr double kLeastDone = 0.02, kLeastSeconds = 1;  // before that, it is a guess
  const double passed = std::chrono::duration<double>(std::chrono::steady_clock::now() - stage_began_).count();
  if (done < kLeastDone || passed < kLeastSeconds) return "";
  return ", about " + std::to_string(static_cast<long>(std::ceil(passed * (1 - done) / done))) + " s left";
}

void Console::draw_bar(std::string_view stage, double fraction) {
  const auto now = std::chrono::steady_clock::now();
  if (now < next_draw_) return;
  next_draw_ = now + std::chrono::milliseconds(100);
  constexpr int kWidth = 30;
  const double done = std::isfinite(fraction) ? std::clamp(fraction, 0.0, 1.0) : 0.0;
  const int filled = static_cast<int>(done * kWidth);
  bar_.assign(static_cast<std::size_t>(filled), '#').append(static_cast<std::size_t>(kWidth - filled), '.');
  std::fprintf(stderr, "\r\x1b[K[%s] %3.0f %% %.*s%s", bar_.c_str(), 100 * done, static_cast<int>(stage.size()),
               stage.data(), time_left(done).c_str());
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
