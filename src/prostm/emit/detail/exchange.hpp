#pragma once
/// The exchange between the planner's thread and the device's. Private to emit.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <span>

#include "prostm/core/latest.hpp"
#include "prostm/emit/detail/take_over_log.hpp"
#include "prostm/emit/emitter.hpp"

namespace prostm {

/// A message to the device's thread.
struct Message {
  LiftedPlan plan;
  bool lost = false;
  bool refused = false;
};

/// The longest step between two samples of an audible focal point: max_focus_step.
class LongestStep {
 public:
  void look(const FocusSample& before, const FocusSample& now) {
    constexpr float kSounding = 0.01F;  // intensity above which a focal point must not jump
    if (std::max(now.intensity, before.intensity) <= kSounding) return;
    const double squared = (now.p_D.cast<double>() - before.p_D.cast<double>()).squaredNorm();
    squared_ = std::max(squared_, squared);
  }
  double length() const { return std::sqrt(squared_); }  ///< [m]

 private:
  double squared_ = 0.0;
};

/// Event for an emitter at the start of a block.
enum class News : std::uint8_t { None, Plan, Lost };

struct Emitter::Exchange {
  Exchange(const EmitSettings& s, Method m) : settings(s), method(m) {}
  const EmitSettings settings;
  const Method method;
  Latest<Message> inbox;
  Latest<EmitStats> published;
  TakeOverLog log;
  std::shared_ptr<const Mute> mute;  // may be null

  /// Takes the newest message, if any; counts refused plans. Device's thread.
  News receive(EmitStats& stats) {
    const bool fresh = inbox.refresh();
    const Message& message = inbox.value();
    stats.refused_plans += fresh && message.refused ? 1 : 0;
    if (mute && mute->on()) return News::Lost;
    if (!fresh) return News::None;
    return message.lost ? News::Lost : News::Plan;
  }

  /// Lets an emitter handle the newest event, then fills a block with its samples. Device's thread.
  template <class Impl>
  void fill(Impl& impl, std::int64_t first, std::span<FocusSample> out) {
    const auto foci = static_cast<std::size_t>(settings.foci);
    const std::size_t samples = out.size() / foci;
    impl.receive(first);
    for (std::size_t i = 0; i < samples; ++i) {
      impl.emit(first + static_cast<std::int64_t>(i), out.subspan(i * foci, foci));
    }
    publish(impl.stats, samples * foci, impl.longest_step);
  }

 private:
  /// Adds `samples`, summed over focal points, to the counters and publishes them.
  void publish(EmitStats& stats, std::size_t samples, const LongestStep& longest) {
    stats.samples += static_cast<std::int64_t>(samples);
    stats.max_focus_step = longest.length();
    published.draft() = stats;
    published.publish();
  }
};

}  // namespace prostm
