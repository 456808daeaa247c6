#pragma once
/// Crossings of closed polygons, and the repair of a plan's paths. All lengths in mm.

#include <span>

#include "prostm/core/geometry.hpp"

namespace prostm::planning {

/// Distance below which segments count as crossing [mm]: 1 µm, far above rounding errors and far
/// below what is perceptible.
inline constexpr double kClearance = 1e-3;

/// Whether segments (a, b) and (c, d) cross, or come nearer than kClearance.
bool segments_cross(const Vec2& a, const Vec2& b, const Vec2& c, const Vec2& d);

/// Length of the closed polygon.
double loop_length(std::span<const Vec2> loop);

/// Mean of the samples.
Vec2 centroid(std::span<const Vec2> loop);

/// Scales a loop that is longer than `most_length` down to it, about its centroid.
void shorten(std::span<Vec2> loop, double most_length);

/// Makes the loop a regular polygon of `length` about `centre`: the replacement of a path that
/// cannot be mended.
void make_circle(std::span<Vec2> loop, const Vec2& centre, double length);

/// Counts the pairs of non-adjacent segments of one closed polygon that cross.
int count_self_crossings(std::span<const Vec2> loop);

/// Counts the pairs of segments of two closed polygons that cross.
int count_crossings(std::span<const Vec2> a, std::span<const Vec2> b);

/// Whether a segment folds back on its neighbour, or their points coincide.
bool folds_back(std::span<const Vec2> loop);

/// Whether no two non-adjacent segments cross, no segment folds back on its neighbour and no points
/// coincide.
bool is_simple(std::span<const Vec2> loop);

/// Makes paths valid, the heaviest first. A path that crosses itself is untangled by reversing the
/// section between two crossing segments (2-opt). A path longer than `max_length` is scaled down to
/// it about its centroid. A path that crosses a heavier one is pushed away or shrunk (not below a
/// quarter of `max_length`), and dropped if that does not help. Every path that remains is simple,
/// at most `max_length` long and crosses no other; the first always remains.
/// @param x paths of `samples` points each, by descending mass; the kept ones are moved to the
/// front. @return the number of paths kept.
int make_valid(std::span<Vec2> x, int samples, double max_length);

}  // namespace prostm::planning
