#include "prostm/plan/detail/fit/felt/path_count.hpp"

#include <algorithm>

namespace prostm::planning {

RegionCounter::RegionCounter(std::size_t max_cells) {
  open_.reserve(max_cells);
  next_.reserve(max_cells);
}

int RegionCounter::count(const TargetField& target, double maximum) {
  open_.resize(target.size());
  for (std::size_t i = 0; i < target.size(); ++i)
    open_[i] = target.skin[i] != 0 && target.pressure[i] >= kLeast * maximum ? 1 : 0;
  int regions = 0;
  for (std::size_t first = 0; first < open_.size(); ++first) {
    if (open_[first] == 0) continue;
    ++regions;
    open_[first] = 0;
    next_.assign(1, static_cast<std::uint32_t>(first));
    while (!next_.empty()) {
      const int row = static_cast<int>(next_.back()) / target.cols;
      const int col = static_cast<int>(next_.back()) % target.cols;
      next_.pop_back();
      for (int r = std::max(row - 1, 0); r <= std::min(row + 1, target.rows - 1); ++r) {
        for (int c = std::max(col - 1, 0); c <= std::min(col + 1, target.cols - 1); ++c) {
          const std::size_t i = target.index(r, c);
          if (open_[i] == 0) continue;
          open_[i] = 0;
          next_.push_back(static_cast<std::uint32_t>(i));
        }
      }
    }
  }
  return regions;
}

void PathCount::begin(int regions, double time) {
  // a time before the last one is that of another recording
  if (regions != regions_ || time < time_) held_until_ = time;
  regions_ = regions;
  time_ = time;
}

void PathCount::take(int paths) {
  if (paths != paths_) held_until_ = time_ + kHold;
  paths_ = paths;
}

}  // namespace prostm::planning
