#pragma once
/// Progress of long work on a terminal.

#include <condition_variable>
#include <cstdio>
#include <mutex>
#include <string>
#include <thread>

namespace prostm::app {

/// One line on standard error, rewritten a few times a second: the counts of show(), or the elapsed
/// time of a stage without counts. Silent unless standard error is a terminal whose lines can be
/// erased.
class Progress {
 public:
  /// Begins the first stage, as next() does.
  explicit Progress(std::string what);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// @param unit of `done` and `all`.
  void show(double done, double all, const char* unit);
  /// Begins a stage: its time is shown from two seconds on, until show() or clear().
  void next(std::string what);
  /// Prints a permanent line above the one that is rewritten.
  void say(std::FILE* out, const std::string& line);
  void clear();  ///< clears the line, so that something else can be printed

 private:
  void watch(const std::stop_token& stop);
  void write(const std::string& line);  // with mutex_ held
  void erase();                         // likewise

  const bool on_terminal_;
  std::mutex mutex_;  // guards what follows, and the terminal's line
  std::string what_;
  bool times_ = true;               // whether the stage's time is shown
  double begun_, shown_at_ = -1.0;  // of the stage; of its counts [s]
  bool shown_ = false;
  std::condition_variable_any ended_;
  std::jthread watcher_;  // last: it uses the others
};

}  // namespace prostm::app
