#include "progress.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <string_view>
#include <utility>

#include "prostm/core/stage_timer.hpp"

namespace prostm::app {
namespace {

constexpr double kBetween = 0.2;   // least time between two lines [s]
constexpr double kPatience = 2.0;  // the time of a stage is shown from here on [s]

/// Whether standard error is a terminal whose lines can be erased.
bool can_erase_lines() {
  const char* const kind = std::getenv("TERM");
  return isatty(STDERR_FILENO) != 0 && kind != nullptr && *kind != '\0' &&
         std::string_view(kind) != "dumb";
}

}  // namespace

Progress::Progress(std::string what)
    : on_terminal_(can_erase_lines()), what_(std::move(what)), begun_(steady_now()) {
  if (on_terminal_) watcher_ = std::jthread([this](const std::stop_token& stop) { watch(stop); });
}

Progress::~Progress() {
  if (watcher_.joinable()) {
    watcher_.request_stop();
    watcher_.join();
  }
  erase();
}

void Progress::watch(const std::stop_token& stop) {
  std::unique_lock lock(mutex_);
  const auto pause = std::chrono::duration<double>(kBetween);
  while (!ended_.wait_for(lock, stop, pause, [&] { return stop.stop_requested(); })) {
    const double time = steady_now() - begun_;
    if (times_ && time >= kPatience) write(fmt::format("{}  {:.0f} s", what_, time));
  }
}

void Progress::show(double done, double all, const char* unit) {
  if (!on_terminal_) return;
  const std::lock_guard lock(mutex_);
  times_ = false;
  const double now = steady_now();
  if (now - shown_at_ < kBetween) return;
  shown_at_ = now;
  write(fmt::format("{}  {:.0f} of {:.0f} {}", what_, done, all, unit));
}

void Progress::next(std::string what) {
  const std::lock_guard lock(mutex_);
  what_ = std::move(what);
  times_ = true;
  begun_ = steady_now();
}

void Progress::say(std::FILE* out, const std::string& line) {
  const std::lock_guard lock(mutex_);
  erase();
  fmt::print(out, "{}\n", line);
  std::fflush(out);
}

void Progress::clear() {
  const std::lock_guard lock(mutex_);
  times_ = false;
  erase();
}

/// A terminal that was closed does not end the work.
void Progress::write(const std::string& line) {
  std::fputs(("\r" + line + " \033[K").c_str(), stderr);
  std::fflush(stderr);
  shown_ = true;
}

void Progress::erase() {
  if (shown_) std::fputs("\r\033[K", stderr);
  shown_ = false;
}

}  // namespace prostm::app
