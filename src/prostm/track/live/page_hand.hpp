#pragma once
/// The hand that a page moves with mouse, touch or keys, and the switch between it and other hands.

#include <array>
#include <atomic>
#include <cstdint>
#include <memory>
#include <string_view>

#include "prostm/core/latest.hpp"
#include "prostm/core/text/names.hpp"
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

/// State of the page's hand.
enum class PageHandState : std::uint8_t {
  Free,   ///< no page controls it
  Held,   ///< a page controls it
  Late,   ///< lapsed: its poses arrive too late
  Hidden  ///< released because its page is hidden
};
template <>
inline constexpr std::array<std::string_view, 4> kNames<PageHandState> = {"free", "held", "late",
                                                                          "hidden"};

/// State of the page's hand, and how often it was released without a request.
struct PageHandReport {
  PageHandState state = PageHandState::Free;
  std::int64_t late = 0;    ///< lapses
  std::int64_t hidden = 0;  ///< releases because the page was hidden
};

/// The page's hand. It follows the placed poses like a critically damped spring, (H19) of
/// docs/design/hands.md, so that 60 unevenly timed messages a second make a smooth motion with a
/// true velocity.
///
/// A hand that is not placed for 0.5 s of run time lapses. Browsers throttle the timers of a hidden
/// page to once a second or less, so a lapsed hand returns only after it has been placed at least
/// every 0.4 s for a whole second, or again after release(): throttled timers release it once and
/// do not switch the output on and off.
class PageHand {
 public:
  /// @throws std::invalid_argument for a setting outside its bounds.
  explicit PageHand(const TrackSettings& settings);

  /// Sets the requested pose; the newest wins. Returns false and changes nothing if a number is not
  /// finite or the palm is outside its bounds; angles and closure are clamped (yaw and roll ±180°,
  /// pitch ±90°). One thread, the same for place() and release(); lock-free.
  bool place(const PagePose& pose) noexcept;
  /// Releases the hand. @param hidden whether because its page is hidden, which is counted.
  void release(bool hidden = false) noexcept;

  /// Sets `out` to the hand at run time `time` [s], in D; false if no page controls it. Sets `age`
  /// to `time` minus the time when the newest pose was first seen here [s]. The hand gets a new id
  /// each time a page takes control. Times must not decrease. One other thread; allocates nothing.
  bool sample(double time, Hand& out, double& age) noexcept;

  /// As of the last sample(). Any thread; lock-free.
  PageHandReport report() const noexcept;

 private:
  static constexpr int kFreedom = 7;  // x, y, z, yaw, pitch, roll, closure
  struct Message {
    PagePose pose;
    bool held = false, hidden = false;
  };
  struct Motion {
    std::array<double, kFreedom> value{}, rate{};
  };
  void receive(const Message& message, double time) noexcept;
  void enter(PageHandState state) noexcept;
  void follow(double dt) noexcept;
  void pose_at(double offset, Hand& out) const noexcept;

  TrackSettings settings_;
  Latest<Message> newest_;
  Motion motion_;
  std::array<double, kFreedom> target_{};
  Side side_ = Side::Right;
  std::atomic<PageHandState> state_{PageHandState::Free};  // written by the sampling thread
  std::atomic<std::int64_t> late_{0}, hidden_{0};          // likewise
  double last_time_ = 0.0, arrival_ = 0.0;                 // [s]
  double steady_since_ = 0.0;  // poses have arrived without a gap since then [s]
  std::int64_t id_;
};

/// The page's hand while a page controls it, else the hands of `base`. One thread samples both.
class HandSwitch final : public HandSource {
 public:
  /// @param X_DT pose of the tracker of `base`: like every source, the switch gives hands in T.
  HandSwitch(std::unique_ptr<HandSource> base, std::shared_ptr<PageHand> page, const Pose& X_DT);

  void sample(double time, HandFrame& out) override;
  double recording_length() const override { return base_->recording_length(); }
  double recording_time() const override { return base_->recording_time(); }
  void seek(double time) override { base_->seek(time); }
  const HandReading* reading() const override { return base_->reading(); }
  std::optional<TrackerStatus> tracker_status() const override { return base_->tracker_status(); }

  /// Sets another pose of the tracker, from the next sample() on. The sampling thread only.
  void set_tracker_pose(const Pose& X_DT) { X_TD_ = X_DT.inverse(); }

 private:
  std::unique_ptr<HandSource> base_;
  std::shared_ptr<PageHand> page_;
  Pose X_TD_;
};

/// A source that never has a hand: the base of the page's hand for `--hand page`.
std::unique_ptr<HandSource> make_absent_hand();

}  // namespace prostm
