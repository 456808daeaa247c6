#pragma once
/// Questions on a terminal, which wait for an answer or a signal, whichever comes first.

#include <cstdio>
#include <optional>
#include <string>

#include "common.hpp"

namespace prostm::app {

/// Standard input, line by line.
class Terminal {
 public:
  /// @param out stream for the questions.
  Terminal(std::FILE* out, const Interrupt& interrupt) : out_(out), interrupt_(interrupt) {}

  /// Whether there is a person to ask.
  static bool is_there(std::FILE* out);

  /// Asks. @return the answer in lower case, or nothing at a signal or the end of the input.
  std::optional<std::string> ask(const std::string& question);
  /// Waits for a line. @return whether one came within `seconds`.
  bool enter_within(double seconds);

 private:
  std::optional<std::string> line(double seconds);

  std::FILE* out_;
  const Interrupt& interrupt_;
  std::string waiting_;  // characters after the last whole line
  bool ended_ = false;
};

}  // namespace prostm::app
