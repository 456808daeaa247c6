#pragma once
/// The order of methods and trials: balanced over participants, and the same for the same seed.

#include <cstdint>
#include <optional>
#include <vector>

#include "prostm/core/random.hpp"
#include "prostm/study/protocol/protocol.hpp"

namespace prostm {

/// Places in a protocol's lists.
struct Trial {
  int method = 0, scene = 0;
  int question = 0;  ///< the scene that is asked for
  int track = 0;     ///< from 1; 0: the trial has no level
  std::optional<double> level = {};
  int level_at = 0;  ///< the interval that is the level's, from 1; 0: none is
  /// Whether the trial begins with the level's interval.
  bool level_first() const { return level_at == 1; }
  bool operator==(const Trial&) const = default;
};

/// The methods of one participant, in order.
///
/// Between participants: of every n in a row, n the number of methods, each has another one, drawn
/// at random. Within: a row of a Latin square in which every method follows every other equally
/// often (Williams, Aust. J. Sci. Res. A 2, 149 (1949); two squares for odd n); of every n (2n) in
/// a row each has another row, drawn at random.
/// @param participant from 1.
std::vector<int> method_order(const Protocol& protocol, int participant);

/// Numbers for one purpose: independent of those for others, whatever these draw.
enum class Purpose : std::uint32_t { Methods = 1, Trials, Tracks, Intervals };
Random random_for(const Protocol& protocol, Purpose purpose, std::uint32_t number);

/// All trials of one participant in an identification, in order: for each of their methods the
/// scenes, `repeats` times each, shuffled.
std::vector<Trial> trial_order(const Protocol& protocol, int participant);

/// Rows of the square, or of both squares: n, or 2n for odd n > 1.
std::vector<std::vector<int>> williams_rows(int n);

}  // namespace prostm
