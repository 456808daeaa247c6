#pragma once
/// The answers to practice, catch and attention trials in a participant's file.

#include <span>
#include <string>
#include <vector>

#include "prostm/study/session/response_file.hpp"

namespace prostm {

struct ExtraAnswers {
  struct Count {
    int given = 0, right = 0;
  };
  Count catches, attention;
  /// Methods whose last practice ended without its criterion.
  std::vector<std::string> failed_practice;

  /// Share of wrong answers to catch and attention trials; 0 without any.
  double wrong_share() const;
};

/// @throws nlohmann::json::exception: a line of these kinds lacks a value.
ExtraAnswers extra_answers(std::span<const ResponseLine> lines);

/// A sentence for each kind of trial with wrong answers, and for each failed practice.
std::vector<std::string> sentences(const ExtraAnswers& answers, const std::string& participant);

}  // namespace prostm
