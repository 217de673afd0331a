#pragma once

#include <chrono>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "vmesh/core/progress.h"

namespace vmesh::tool {

/// `text` with a ? for every control character, as file names may contain terminal escapes. Line breaks before two
/// blanks, the lists in messages, are kept.
std::string printable(std::string_view text);

/// Everything the command says that is not data. All of it goes to stderr, each line printable().
class Console {
 public:
  /// Quiet: neither log lines nor progress; warnings and errors remain.
  explicit Console(bool quiet = false);
  ~Console();
  Console(const Console&) = delete;
  Console& operator=(const Console&) = delete;

  void set_quiet(bool quiet);
  /// Progress as tags of 3D Slicer's execution model on stdout, each stage as a filter, instead.
  void tell_by_tags(const std::string& verb);
  void log(std::string_view line);
  /// Every warning is shown once, however often it occurs.
  void warn(std::string_view line);
  void warn(const std::vector<std::string>& lines);
  void error(std::string_view line);

  /// Cancels once the process was interrupted; draws a bar if stderr is a terminal, else writes a line every few
  /// seconds, both with the time that the stage will still take. Must not outlive the console.
  Progress progress();

 private:
  void draw_bar(std::string_view stage, double fraction);
  void tell_progress(std::string_view stage, double fraction);
  void tell_tags(double fraction);
  void end_tags();
  /// ", about 12 s left", once the speed of a stage is known; else nothing.
  std::string time_left(double done) const;
  void clear_bar();
  void print(std::string_view prefix, std::string_view line);

  bool quiet_;
  std::string tagged_verb_;  // empty without tags
  bool tags_open_ = false;
  bool terminal_;
  bool bar_drawn_ = false;
  std::string bar_;
  std::set<std::string, std::less<>> warned_;
  std::chrono::steady_clock::time_point next_draw_;
  std::string stage_;  // that was last reported, and when it was first
  std::chrono::steady_clock::time_point stage_began_;
};

/// Measures the wall time of stages.
class Stopwatch {
 public:
  /// Seconds since construction or the last lap.
  double lap();

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

}  // namespace vmesh::tool
