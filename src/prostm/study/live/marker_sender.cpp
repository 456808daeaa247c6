#include "prostm/study/live/marker_sender.hpp"

#include <fmt/format.h>

#include <chrono>
#include <utility>

#include "prostm/core/stage_timer.hpp"
#include "prostm/study/task/line_keys.hpp"

namespace prostm {
namespace {

constexpr std::chrono::milliseconds kLook{1};  // polling interval, shorter than any device's queue
constexpr int kDelays = 10;  // largest number of times that a sample is delayed while waiting

double utc_now() {
  return std::chrono::duration<double>(std::chrono::system_clock::now().time_since_epoch()).count();
}

void sleep_until(double time) {
  using Clock = std::chrono::steady_clock;
  const std::chrono::duration<double> since_start(time);
  std::this_thread::sleep_until(
      Clock::time_point(std::chrono::duration_cast<Clock::duration>(since_start)));
}

}  // namespace

MarkerSender::MarkerSender(std::vector<OpenTarget> targets, const Protocol& protocol,
                           const MarkerRun& run, const Device& device, SoundWatch& sound)
    : protocol_(protocol), run_(run), device_(device), sound_(sound) {
  for (OpenTarget& target : targets) targets_.push_back({std::move(target)});
  sound_.begin_reading();
  thread_ = std::jthread([this](const std::stop_token& stop) { work(stop); });
}

void MarkerSender::stop() {
  if (!thread_.joinable()) return;
  thread_.request_stop();
  thread_.join();
}

void MarkerSender::present(const Presentation& now, const std::optional<StudyPlayed>& played) {
  {
    const std::lock_guard hold(lock_);
    emission_ = {now.number, played};
  }
  sound_.label(now.label());
}

void MarkerSender::tell(const StudyPlayed& played) {
  const std::lock_guard hold(lock_);
  emission_.played = played;
}

/// Emission of a presentation; none unless the condition is disclosed, which it would reveal.
std::optional<StudyPlayed> MarkerSender::emission_of(const Presentation& presentation) {
  if (presentation.condition == 0) return {};
  const std::lock_guard hold(lock_);
  return emission_.presentation == presentation.number ? emission_.played : std::nullopt;
}

void MarkerSender::work(const std::stop_token& stop) {
  for (;;) {
    const bool last = stop.stop_requested();
    while (const SoundChange* found = sound_.front()) {
      const SoundChange change = *found;
      Marker marker = marker_of(change);
      sound_.pop();  // from here on the device may stop
      wait(change, marker);
      send(marker);
      if (!markers_.push(marker))
        news_.push(
            "A marker was sent but not recorded in the participant's file: the study has stalled.");
    }
    if (last) return;
    std::this_thread::sleep_for(kLook);
  }
}

Marker MarkerSender::marker_of(const SoundChange& change) {
  Marker marker;
  marker.played = play_time(change);
  marker.presentation = Presentation::of_label(change.label);
  if (marker.presentation != last_) part_ = 0;
  last_ = marker.presentation;
  if (change.on) ++part_;
  marker.part = part_;
  marker.emission = emission_of(marker.presentation);
  marker.on = change.on;
  marker.sequence = ++sent_;
  marker.stream = change.stream;
  marker.sample = change.sample;
  marker.sample_rate = device_.info().sample_rate;
  return marker;
}

/// Play time of the sample; nothing if the device has stopped or restarted since.
std::optional<double> MarkerSender::play_time(const SoundChange& change) const {
  if (device_.status() != DeviceStatus::Running) return {};
  const double time = device_.play_time(change.sample);
  if (sound_.stream() != change.stream) return {};
  return time;
}

/// Waits until the sample leaves the array, which may be later than first predicted.
void MarkerSender::wait(const SoundChange& change, Marker& marker) const {
  for (int i = 0; i < kDelays && marker.played && *marker.played > steady_now(); ++i) {
    sleep_until(*marker.played);
    const std::optional<double> now = play_time(change);
    if (now) marker.played = now;
  }
}

void MarkerSender::send(Marker& marker) {
  marker.sent = steady_now();
  marker.utc_offset = utc_now() - marker.sent;
  nlohmann::ordered_json json = {{"type", "marker"},
                                 {"participant", std::to_string(run_.participant)}};
  json.update(marker_json(marker, protocol_, run_.run));
  const std::string line = json.dump() + "\n";
  for (std::size_t i = 0; i < targets_.size(); ++i) {
    Target& target = targets_[i];
    const std::string problem = target.to.target->send(line, code_of(marker));
    if (!problem.empty()) marker.failed |= 1U << i;
    if (problem.empty() == !target.failed) continue;
    target.failed = !problem.empty();
    news_.push(
        target.failed
            ? fmt::format("Markers do not reach {}: {}. The study continues; all markers are "
                          "in the participant's file.",
                          target.to.address, problem)
            : fmt::format("Markers reach {} again.", target.to.address));
  }
}

ResponseLine MarkerSender::line(const Marker& marker) const {
  ResponseLine line = {{line::kKind, line::kMarker}};
  line.update(marker_json(marker, protocol_, run_.run));
  if (marker.failed == 0) return line;
  line["failed"] = nlohmann::ordered_json::array();
  for (std::size_t i = 0; i < targets_.size(); ++i)
    if ((marker.failed >> i & 1U) != 0) line["failed"].push_back(targets_[i].to.address);
  return line;
}

}  // namespace prostm
