#pragma once
/// Finds frames of a recording with inconsistent times. Private to io.

#include <cstddef>
#include <span>
#include <vector>

namespace prostm {

/// A frame's time [s], and its index in the file, including unreadable frames.
struct FrameTime {
  double time;
  std::size_t place;
};

/// Returns the indices of the largest set of frames with increasing times. Of two frames that
/// exclude each other, the one whose time fits worse between its neighbours, by the usual interval,
/// is omitted; the later one if neither fits.
std::vector<std::size_t> frames_in_order(std::span<const FrameTime> frames);

/// Median of the intervals between frames whose times increase [s]; 0 for fewer than two frames.
double usual_interval(std::span<const double> times);

}  // namespace prostm
