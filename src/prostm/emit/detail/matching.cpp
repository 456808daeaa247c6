#include "prostm/emit/detail/matching.hpp"

#include <cstdint>
#include <limits>

namespace prostm {

std::array<int, kMaxPaths> match_paths(const MatchCosts& cost, int foci, int paths) noexcept {
  constexpr std::size_t kSets = std::size_t{1} << kMaxPaths;
  constexpr double kNever = std::numeric_limits<double>::max();
  const std::size_t sets = std::size_t{1} << static_cast<std::size_t>(paths);

  // least[t]: least cost at which the focal points so far take exactly the paths of set t
  std::array<double, kSets> least, next;
  std::array<std::array<std::int8_t, kSets>, kMaxPaths> choice;
  least.fill(kNever);
  least[0] = 0.0;
  for (std::size_t f = 0; f < static_cast<std::size_t>(foci); ++f) {
    next.fill(kNever);
    const auto offer = [&](std::size_t set, double total, int path) {
      if (total >= next[set]) return;
      next[set] = total;
      choice[f][set] = static_cast<std::int8_t>(path);
    };
    for (std::size_t set = 0; set < sets; ++set) {
      if (least[set] == kNever) continue;
      for (int p = 0; p < paths; ++p) {
        const std::size_t bit = std::size_t{1} << static_cast<std::size_t>(p);
        if ((set & bit) == 0)
          offer(set | bit, least[set] + cost[f][static_cast<std::size_t>(p)], p);
      }
      offer(set, least[set] + cost[f][kMaxPaths], kNoPath);
    }
    least = next;
  }

  // walk back from the set of all paths
  std::array<int, kMaxPaths> out;
  out.fill(kNoPath);
  std::size_t set = sets - 1;
  for (int f = foci - 1; f >= 0; --f) {
    const int path = choice[static_cast<std::size_t>(f)][set];
    out[static_cast<std::size_t>(f)] = path;
    if (path != kNoPath) set ^= std::size_t{1} << static_cast<std::size_t>(path);
  }
  return out;
}

}  // namespace prostm
