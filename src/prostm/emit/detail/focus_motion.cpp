#include "prostm/emit/detail/focus_motion.hpp"

#include <algorithm>
#include <cmath>

namespace prostm {
namespace {

// a lap longer than n samples by up to this share of a sample still takes n
constexpr double kRounding = 1e-6;
constexpr double kNothing = 1e-9;  // an offset that counts as zero [m]

/// Step along a path with a period of its own [m].
double own_step(const LiftedPath& path, double sample_rate, double max_step) {
  return std::min(path.speed / sample_rate, max_step);
}

}  // namespace

std::int64_t lap_samples(const LiftedPath& path, double sample_rate, double max_step) {
  if (path.speed <= kSlowest) return 1;
  const double step = own_step(path, sample_rate, max_step);
  return std::max<std::int64_t>(
      1, static_cast<std::int64_t>(std::ceil(path.length / step - kRounding)));
}

void FocusMotion::configure(double sample_rate, double max_step) {
  sample_rate_ = sample_rate;
  max_step_ = max_step;
}

double FocusMotion::step_of(const LiftedPath& path, const InStep& in_step) const {
  if (in_step.samples > 0) {
    return path.length * static_cast<double>(in_step.laps) / static_cast<double>(in_step.samples);
  }
  return own_step(path, sample_rate_, max_step_);
}

bool FocusMotion::reaches(const LiftedPath& path, const PathPlace& place,
                          const InStep& in_step) const {
  // (E3) shrinks the offset by at least the spare step
  const double spare = max_step_ - step_of(path, in_step);
  return place.distance <= std::min(kMaxOffset, spare * kMaxTransit * sample_rate_);
}

void FocusMotion::start(const LiftedPath& path, const PathPlace& place, const InStep& in_step) {
  path_ = path;
  arc_start_ = place.s;
  lap_end_ = base_ = place.p_D;
  direction_ = last_step_.dot(place.tangent) < 0.0 ? -1.0 : 1.0;
  edge_ = 0;
  sample_ = 0;
  lap_ = lap_samples(path);
  in_step_ = in_step;
  if (is_in_step()) {
    const std::int64_t n = in_step.samples;
    arc_start_ = 0.0;  // and forwards: its place has no tangent
    sample_ = (in_step.count % n + n) % n;
    turn_ = n;  // the lap's last sample is still to come
    lap_ = at_rest() ? 1 : std::max<std::int64_t>(1, n / in_step.laps);
  }
  if (path.speed <= kSlowest) {
    path_.length = 0.0;
    path_.p_D[0] = place.p_D;
    path_.pressure[0] = point_at(path, place.s).pressure;
  }
}

void FocusMotion::join(const LiftedPath& path, const PathPlace& place, const InStep& in_step) {
  start(path, place, in_step);
  offset_ = p_D_ - base_;
  moving_over_ = true;
}

void FocusMotion::jump(const LiftedPath& path, const PathPlace& place, const InStep& in_step) {
  last_step_.setZero();
  start(path, place, in_step);
  offset_.setZero();
  moving_over_ = false;
  p_D_ = base_;
}

/// Returns the distance from the start of the lap after this many samples, as a share of the lap.
double FocusMotion::share_at(std::int64_t sample) const {
  if (!is_in_step()) return static_cast<double>(sample) / static_cast<double>(lap_);
  return static_cast<double>(sample * in_step_.laps % in_step_.samples) /
         static_cast<double>(in_step_.samples);
}

Vec3 FocusMotion::ahead(std::int64_t samples) const {
  const std::int64_t sample = (sample_ + samples) % (is_in_step() ? in_step_.samples : lap_);
  return point_at(path_, arc_start_ + direction_ * path_.length * share_at(sample)).p_D;
}

std::int64_t FocusMotion::samples_left() const {
  if (!is_in_step()) return lap_ - sample_;
  const std::int64_t since = sample_ % in_step_.base;
  return since > 0 ? in_step_.base - since : 0;
}

Vec3 FocusMotion::leaving_place() const {
  return is_in_step() ? ahead(samples_left()) : lap_end_;
}

double FocusMotion::advance() {
  // integer count to arc length
  if (sample_ == (is_in_step() ? in_step_.samples : lap_)) sample_ = 0;
  ++sample_;
  if (is_in_step()) turn_ = sample_ * in_step_.laps % in_step_.samples;
  double s = arc_start_ + direction_ * path_.length * share_at(sample_);
  if (s < 0.0) s += path_.length;
  if (s >= path_.length) s -= path_.length;  // also where the line above rounds up to it

  // position: on the path, plus the remaining offset
  const PathPoint point = sample_at(s);
  if (moving_over_) shrink_offset(point.p_D - base_);
  base_ = point.p_D;
  const Vec3 p_D = base_ + offset_;
  last_step_ = p_D - p_D_;
  p_D_ = p_D;
  return point.pressure;
}

// The step is path_step − d·u with u the offset's direction and d the length by which it shrinks.
// Its norm is the largest step when d² − 2 d (path_step·u) + |path_step|² − max² = 0, whose larger
// root is at least max − |path_step| >= 0. Half of the largest step bounds d, so that a focal point
// which runs ahead of its path slows down and does not turn back.
void FocusMotion::shrink_offset(const Vec3& path_step) {
  const double distance = offset_.norm();
  if (distance < kNothing) {
    offset_.setZero();
    moving_over_ = false;
    return;
  }
  const double along = path_step.dot(offset_) / distance;
  const double spare = std::max(0.0, max_step_ * max_step_ - path_step.squaredNorm());
  const double shrink = std::min(along + std::sqrt(along * along + spare), 0.5 * max_step_);
  if (shrink >= distance) {
    offset_.setZero();
    moving_over_ = false;
  } else {
    offset_ *= 1.0 - std::max(shrink, 0.0) / distance;
  }
}

// The same as point_at(), but the edge is found from the last one.
PathPoint FocusMotion::sample_at(double s) {
  if (path_.length <= 0.0) return {path_.p_D[0], path_.pressure[0]};
  const std::size_t n = path_.s.size();
  const auto end_of = [&](std::size_t i) { return i + 1 < n ? path_.s[i + 1] : path_.length; };
  for (std::size_t tried = 0; tried < n && !(path_.s[edge_] <= s && s < end_of(edge_)); ++tried) {
    if (direction_ > 0.0) {
      edge_ = edge_ + 1 < n ? edge_ + 1 : 0;
    } else {
      edge_ = edge_ > 0 ? edge_ - 1 : n - 1;
    }
  }
  const std::size_t next = edge_ + 1 < n ? edge_ + 1 : 0;
  const double e = end_of(edge_) - path_.s[edge_];
  const double t = e > 0.0 ? std::clamp((s - path_.s[edge_]) / e, 0.0, 1.0) : 0.0;
  return {path_.p_D[edge_] + t * (path_.p_D[next] - path_.p_D[edge_]),
          path_.pressure[edge_] + t * (path_.pressure[next] - path_.pressure[edge_])};
}

}  // namespace prostm
