#pragma once
/// Progress of the plans that are being drawn.

#include <array>
#include <cstdint>

#include "prostm/core/spsc_ring.hpp"
#include "prostm/emit/emitter.hpp"

namespace prostm {

/// Tracks each plan from the moment when the first focal point takes it over until 90 % of its path
/// length has been drawn, or no focal point follows it any more, and then reports it. Device's
/// thread, except for next().
class TakeOverLog {
 public:
  using Entry = int;  ///< index of an open plan
  static constexpr Entry kNone = -1;

  TakeOverLog();
  /// Records that a plan arrived before this sample; its paths have this length in all [m]. Earlier
  /// plans can no longer be taken over.
  void arrive(std::int64_t plan, double total_length, std::int64_t sample) noexcept;
  /// Records that a focal point takes the newest plan over at this sample.
  Entry follow(std::int64_t sample) noexcept;
  /// Records that a focal point has drawn this length of the plan [m], no part twice.
  void draw(Entry entry, double length, std::int64_t sample) noexcept;
  /// Records that a focal point stops following the plan.
  void leave(Entry entry) noexcept;

  /// Takes the oldest unread report; false if all are read. Reader's thread.
  bool next(TakeOver& out) { return reports_.pop(out); }

 private:
  struct Plan {
    TakeOver report;
    std::int64_t serial = 0;
    double length = 0.0, drawn = 0.0;  // [m]
    int followers = 0;
    bool reported = false;
  };
  // share of the path length, as in the run summary's redraw_ms
  static constexpr double kRedrawn = 0.9;
  static constexpr std::size_t kReports = 1024;

  void report(Plan& plan, std::int64_t redrawn_sample) noexcept;

  std::array<Plan, kMaxPaths + 1> plans_{};  // each focal point follows one, and one can be new
  std::int64_t serial_ = 0, plan_ = 0, arrival_ = 0;
  double total_length_ = 0.0;
  SpscRing<TakeOver> reports_;
};

}  // namespace prostm
