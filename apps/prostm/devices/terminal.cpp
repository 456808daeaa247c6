#include "devices/terminal.hpp"

#include <fmt/format.h>
#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <limits>

#include "prostm/core/stage_timer.hpp"
#include "prostm/core/text/lower_case.hpp"

namespace prostm::app {

bool Terminal::is_there(std::FILE* out) {
  return isatty(STDIN_FILENO) != 0 && isatty(fileno(out)) != 0;
}

std::optional<std::string> Terminal::ask(const std::string& question) {
  fmt::print(out_, "{} ", question);
  std::fflush(out_);
  auto answer = line(std::numeric_limits<double>::infinity());
  if (!answer) {
    fmt::print(out_, "\n");
    return answer;
  }
  const std::size_t first = std::min(answer->find_first_not_of(" \t\r"), answer->size());
  return lower_case(answer->substr(first));
}

bool Terminal::enter_within(double seconds) {
  return line(seconds).has_value();
}

std::optional<std::string> Terminal::line(double seconds) {
  constexpr double kLook = 0.02;  // for signals [s]
  const double end = steady_now() + seconds;
  for (;;) {
    if (const std::size_t newline = waiting_.find('\n'); newline != waiting_.npos) {
      std::string whole = waiting_.substr(0, newline);
      waiting_.erase(0, newline + 1);
      return whole;
    }
    const double left = std::min(kLook, end - steady_now());
    if (left <= 0.0 || interrupt_.requested()) return std::nullopt;
    if (ended_) {
      // at the end of the input a pause is still a pause
      if (seconds == std::numeric_limits<double>::infinity()) return std::nullopt;
      poll(nullptr, 0, static_cast<int>(1e3 * left) + 1);
      continue;
    }
    pollfd input{STDIN_FILENO, POLLIN, 0};
    if (poll(&input, 1, static_cast<int>(1e3 * left) + 1) <= 0) continue;
    std::array<char, 256> bytes{};
    const ssize_t count = read(STDIN_FILENO, bytes.data(), bytes.size());
    if (count > 0) {
      waiting_.append(bytes.data(), static_cast<std::size_t>(count));
    } else if (count == 0) {
      ended_ = true;
    }
  }
}

}  // namespace prostm::app
