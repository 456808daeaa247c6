#pragma once
/// Practice of the task before the trials of a method, to a criterion.

#include <cstddef>
#include <vector>

#include "prostm/study/protocol/protocol.hpp"

namespace prostm {

/// Counts the answers of one practice. It ends once a share of the last answers is right, or after
/// the largest number of trials.
class Practice {
 public:
  explicit Practice(const PracticeSettings& settings) : settings_(settings) {}

  /// Begins again, without answers.
  void begin() { right_.clear(); }
  /// @param right whether the answer was right; any value in a practice without a criterion.
  void answer(bool right) { right_.push_back(right); }

  bool is_done() const { return trials() >= settings_.trials || (has_criterion() && passed()); }
  /// Whether the criterion was reached; true in a practice without one.
  bool passed() const;
  int trials() const { return static_cast<int>(right_.size()); }
  /// Share of right answers among the last PracticeSettings::window; 0 before the first.
  double share() const;

 private:
  bool has_criterion() const { return settings_.right > 0.0; }
  std::size_t window() const { return static_cast<std::size_t>(settings_.window); }

  PracticeSettings settings_;
  std::vector<bool> right_;
};

}  // namespace prostm
