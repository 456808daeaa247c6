#pragma once
/// Finds the frames of a recording whose times do not fit. Private to io.

#include <cstddef>
#include <span>
#include <vector>

namespace prostm {

/// A frame's time [s], and its place in the file, which counts frames that could not be read, too.
struct FrameTime {
  double time;
  std::size_t place;
};

/// Returns the indices of the most frames whose times increase. Of two frames that exclude each
/// other, the one is left out whose time fits worse between its neighbours at the usual interval;
/// the later one if neither does.
std::vector<std::size_t> frames_in_order(std::span<const FrameTime> frames);

/// Median of the intervals between frames whose times increase [s]; 0 for fewer than two frames.
double usual_interval(std::span<const double> times);

}  // namespace prostm
