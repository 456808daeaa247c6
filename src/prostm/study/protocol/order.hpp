#pragma once
/// The order of methods and trials: balanced over participants, and reproducible from the seed.

#include <cstdint>
#include <optional>
#include <vector>

#include "prostm/core/random.hpp"
#include "prostm/study/protocol/protocol.hpp"

namespace prostm {

/// A trial, as indices into a protocol's lists.
struct Trial {
  int method = 0, scene = 0;
  int question = 0;  ///< the scene in question
  int track = 0;     ///< from 1; 0: the trial has no level
  std::optional<double> level = {};
  int level_at = 0;  ///< the interval that presents the level, from 1; 0: none does
  /// Whether the trial begins with the level's interval.
  bool level_first() const { return level_at == 1; }
  bool operator==(const Trial&) const = default;
};

/// The methods of one participant, in order.
///
/// Between participants: each n consecutive participants, n the number of methods, get different
/// methods, drawn at random. Within: a row of a Latin square in which every method follows every
/// other equally often (Williams, Aust. J. Sci. Res. A 2, 149 (1949); two squares for odd n); each
/// n (2n for odd n) consecutive participants get different rows, drawn at random.
/// @param participant from 1.
std::vector<int> method_order(const Protocol& protocol, int participant);

/// Random numbers for one purpose, independent of those for other purposes.
enum class Purpose : std::uint32_t { Methods = 1, Trials, Tracks, Intervals, ExtraTrials };
Random random_for(const Protocol& protocol, Purpose purpose, std::uint32_t number);

/// All trials of one participant in an identification study, in order: for each of their methods,
/// every scene `repeats` times, shuffled.
std::vector<Trial> trial_order(const Protocol& protocol, int participant);

/// Rows of the Latin square, or of both squares: n, or 2n for odd n > 1.
std::vector<std::vector<int>> williams_rows(int n);

}  // namespace prostm
