#pragma once
/// The hand that a page moves with mouse, touch or keys, and the switch between it and other hands.

#include <atomic>
#include <cstdint>
#include <memory>

#include "prostm/core/latest.hpp"
#include "prostm/track/hand_source.hpp"

namespace prostm {

/// The pose that a page requests. With all angles 0 the palm is down and the fingers point along +y
/// of D; yaw turns about z of D (positive to the left, seen from above), then pitch about the
/// hand's x (positive: fingers up), then roll about its fingers (positive: the right side goes
/// down).
struct PagePose {
  Vec3 p_D = Vec3(0.0, 0.0, 0.2);             ///< palm joint [m], within ±0.5 m along each axis
  double yaw = 0.0, pitch = 0.0, roll = 0.0;  ///< [rad]
  double closure = 0.0;                       ///< 0 open, 1 a loose fist
  Side side = Side::Right;
};

/// The page's hand. It follows the placed poses like a critically damped spring, (H19) of
/// docs/design.md, so that 60 unevenly timed messages a second make a smooth motion with a true
/// velocity. A hand that is not placed for 0.5 s of run time is released.
class PageHand {
 public:
  /// @throws std::invalid_argument for a setting outside its bounds.
  explicit PageHand(const TrackSettings& settings);

  /// Sets the requested pose; the newest wins. Returns false and changes nothing if a number is not
  /// finite or the palm is outside its bounds; angles and closure are clamped (yaw and roll ±180°,
  /// pitch ±90°). One thread, the same for place() and release(); lock-free.
  bool place(const PagePose& pose) noexcept;
  /// Releases the hand.
  void release() noexcept;

  /// Sets `out` to the hand at run time `time` [s], in D; false if no page holds it. Sets `age` to
  /// `time` less the time when the newest pose was first seen here [s]. The hand gets a new id each
  /// time a page takes it. Times must not decrease. One other thread; allocates nothing.
  bool sample(double time, Hand& out, double& age) noexcept;

 private:
  static constexpr int kFreedom = 7;  // x, y, z, yaw, pitch, roll, closure
  struct Message {
    PagePose pose;
    bool held = false;
  };
  struct Motion {
    std::array<double, kFreedom> value{}, rate{};
  };
  void follow(double dt) noexcept;
  void pose_at(double offset, Hand& out) const noexcept;

  TrackSettings settings_;
  Latest<Message> newest_;
  Motion motion_;
  std::array<double, kFreedom> target_{};
  Side side_ = Side::Right;
  bool held_ = false;
  double last_time_ = 0.0, arrival_ = 0.0;  // [s]
  std::int64_t id_;
};

/// The page's hand while a page holds it, else the hands of `base`. A single thread samples both.
class HandSwitch final : public HandSource {
 public:
  /// @param X_DT pose of the tracker of `base`: like every source, the switch gives hands in T.
  HandSwitch(std::unique_ptr<HandSource> base, std::shared_ptr<PageHand> page, const Pose& X_DT);

  void sample(double time, HandFrame& out) override;
  double recording_length() const override { return base_->recording_length(); }
  double recording_time() const override { return base_->recording_time(); }
  void seek(double time) override { base_->seek(time); }
  std::optional<TrackerStatus> tracker_status() const override { return base_->tracker_status(); }

  /// Whether the last sample() was the page's. Any thread.
  bool page_in_charge() const { return in_charge_.load(std::memory_order_relaxed); }
  /// Sets another pose of the tracker, from the next sample() on. The sampling thread only.
  void set_tracker_pose(const Pose& X_DT) { X_TD_ = X_DT.inverse(); }

 private:
  std::unique_ptr<HandSource> base_;
  std::shared_ptr<PageHand> page_;
  Pose X_TD_;
  std::atomic<bool> in_charge_{false};
};

/// A source that never has a hand; the fallback behind the page's hand (`--hand page`).
std::unique_ptr<HandSource> make_absent_hand();

}  // namespace prostm
