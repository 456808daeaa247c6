#include "prostm/device/autd3/detail/autd3_stream.hpp"

#include <algorithm>
#include <cmath>
#include <thread>

#include "prostm/device/autd3/detail/autd3_timing.hpp"

namespace prostm::autd3 {
namespace {

using Clock = Session::Clock;
using Seconds = std::chrono::duration<double>;

constexpr double kBeforeTurn = 0.3e-3;  // polling starts this long before a turn is expected [s]
constexpr double kLongestWait = 0.5;    // longest wait for a turn [s],
constexpr int kMostPolls = 40;          // with at least this many polls
// share of a block's time: if the link took longer for a late block, the link made it late
constexpr double kSlowLink = 0.5;

Clock::duration to_duration(double seconds) {
  return std::chrono::round<Clock::duration>(Seconds(seconds));
}

}  // namespace

void Stream::start(SampleSource& source) {
  source_ = &source;
  samples_.assign(static_cast<std::size_t>(budget_.block_samples * source.foci()), FocusSample());
  words_.resize(static_cast<std::size_t>(encoder_.units() * encoder_.slots()));
  block_ = 0;
  const std::lock_guard lock(mutex_);
  stats_ = {};
  loss_ = {};
  stats_.queue_blocks = 1;
  anchor_block_ = 0;
  anchor_time_ = Clock::now() + to_duration(2.0 * budget_.block_time);
}

bool Stream::begin() {
  turns_.start(Clock::now(), 0, to_duration(budget_.block_time));
  if (!output_.begin(&turns_)) return false;
  encoder_.reset();
  for (int u = 0; u < encoder_.units(); ++u) {
    std::vector<SlotWord>& words = output_.words(static_cast<std::size_t>(u));
    std::fill(words.begin(), words.end(), SlotWord{0});
  }
  const auto as_it_is = [](int) {};
  const int samples = budget_.block_samples;
  if (!output_.write(1, Transition::Immediate, samples, as_it_is)) return false;
  if (!output_.write(0, Transition::Immediate, samples, as_it_is)) return false;
  alternate(session_.frame(0), 1);
  if (!session_.exchange_for_all() || !session_.poll()) return false;
  turns_.start(Clock::now(), std::max(0, session_.playing_segment()),
               to_duration(budget_.block_time));
  written_ = 1 - turns_.playing();
  const std::lock_guard lock(mutex_);
  loss_.found(Clock::now(), budget_.block_time, stats_);
  return true;
}

bool Stream::play_block(const std::stop_token& stop) {
  if (!wait_for_turn(stop)) return false;
  if (stop.stop_requested()) return true;
  const std::int64_t turn = turns_.turns();
  // audible not before the block can begin, and not after it can end
  const Clock::time_point next = turns_.next_latest(), due = turns_.next_earliest(),
                          end = due + to_duration(budget_.block_time);
  {
    const std::lock_guard lock(mutex_);
    anchor_block_ = block_;
    anchor_time_ = next;
  }
  written_ = 1 - turns_.playing();
  fill_time_ = {};
  const Clock::time_point begun = Clock::now();
  if (!write_block(written_)) return false;
  const double link_time = Seconds(Clock::now() - begun - fill_time_).count();
  ++block_;
  const bool late = turns_.turns() != turn || Clock::now() > due;
  const bool quiet = late || !output_.is_in_time(next, end);
  {
    const std::lock_guard lock(mutex_);
    stats_.blocks = block_;
    stats_.late_blocks += late ? 1 : 0;
    stats_.missed_blocks += quiet ? 1 : 0;
    stats_.slow_blocks += quiet && link_time > kSlowLink * budget_.block_time ? 1 : 0;
  }
  return quiet || output_.sound(next, end);
}

/// Waits until the segment that was written last is playing.
bool Stream::wait_for_turn(const std::stop_token& stop) {
  const Clock::time_point end = Clock::now() + to_duration(kLongestWait);
  int polls = 0;
  while (turns_.playing() != written_ && !stop.stop_requested()) {
    if (turns_.turns() > 0)
      std::this_thread::sleep_until(turns_.next_earliest() - to_duration(kBeforeTurn));
    if (!session_.poll()) return false;
    if (turns_.playing() == written_) break;
    if (++polls > kMostPolls && Clock::now() > end)
      return session_.give_up("does not switch from block to block");
    std::this_thread::sleep_for(Session::kPolls);
  }
  return true;
}

bool Stream::write_block(int segment) {
  int filled = 0;
  return output_.write(segment, Transition::Later, budget_.block_samples, [&](int needed) {
    fill(filled, needed);
    filled = needed;
  });
}

/// Pulls samples of the block and encodes them.
void Stream::fill(int from, int to) {
  const Clock::time_point begun = Clock::now();
  const auto width = static_cast<std::size_t>(source_->foci()),
             slots = static_cast<std::size_t>(encoder_.slots());
  const auto count = static_cast<std::size_t>(to - from);
  const std::span<FocusSample> part = std::span(samples_).first(count * width);
  source_->fill(block_ * budget_.block_samples + from, part);
  for (std::size_t s = 0; s < count; ++s) {
    encoder_.encode(part.subspan(s * width, width), words_);
    const auto at = static_cast<std::ptrdiff_t>((static_cast<std::size_t>(from) + s) * slots);
    for (std::size_t u = 0; u < static_cast<std::size_t>(encoder_.units()); ++u)
      std::copy_n(words_.begin() + static_cast<std::ptrdiff_t>(u * slots), slots,
                  output_.words(u).begin() + at);
  }
  fill_time_ += Clock::now() - begun;
}

void Stream::lose() {
  const std::lock_guard lock(mutex_);
  loss_.lose(std::min(anchor_time_, Clock::now()), stats_);
}

DeviceStats Stream::stats() const {
  const std::lock_guard lock(mutex_);
  DeviceStats now = stats_;
  loss_.add(Clock::now(), budget_.block_time, now);
  return now;
}

std::int64_t Stream::samples() const {
  const std::lock_guard lock(mutex_);
  const double since = Seconds(Clock::now() - anchor_time_).count() * budget_.sample_rate();
  const auto of_block = static_cast<std::int64_t>(
      std::floor(std::min(since, static_cast<double>(budget_.block_samples))));
  return std::max<std::int64_t>(0, anchor_block_ * budget_.block_samples + of_block);
}

double Stream::play_time(std::int64_t sample) const {
  const std::lock_guard lock(mutex_);
  const auto from = static_cast<double>(sample - anchor_block_ * budget_.block_samples);
  return Seconds(anchor_time_.time_since_epoch()).count() + from / budget_.sample_rate();
}

double Stream::ask_time(std::int64_t sample) const {
  // while a block plays, the next one is requested
  return play_time(sample - sample % budget_.block_samples) - budget_.block_time;
}

}  // namespace prostm::autd3
