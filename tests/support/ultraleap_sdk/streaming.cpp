// Emissions of the stand-in.
#include <algorithm>
#include <chrono>
#include <cmath>

#include "world.hpp"

namespace Ultraleap::Haptics {

using ultraleap_stand_in::Entry;
using ultraleap_stand_in::failed;
using ultraleap_stand_in::in_callback;
using ultraleap_stand_in::kUs;
using ultraleap_stand_in::world;

namespace {

constexpr int kAhead = 3;  // periods between a callback and its interval

LocalDuration seconds(double s) {
  return LocalDuration(std::llround(1e9 * s));
}

bool is_finite(const ControlPoint& p) {
  const Vector3 at = p.getPosition();
  return std::isfinite(at.x) && std::isfinite(at.y) && std::isfinite(at.z) &&
         std::isfinite(p.getIntensity());
}

double distance(const ControlPoint& a, const ControlPoint& b) {
  const Vector3 p = a.getPosition(), q = b.getPosition();
  return std::hypot(static_cast<double>(p.x) - static_cast<double>(q.x),
                    static_cast<double>(p.y) - static_cast<double>(q.y),
                    static_cast<double>(p.z) - static_cast<double>(q.z));
}

/// Fastest rate for a number of points [Hz]; 0 if the array does not support it.
double rate_limit(const std::string& device, std::size_t points) {
  const auto& rates = world().find(device)->array.rates;
  return points < 1 || points > rates.size() ? 0.0 : static_cast<double>(rates[points - 1]);
}

}  // namespace

Streamer::~Streamer() {
  stop();
}

LocalDuration Streamer::period() const {
  return seconds(1.0 / static_cast<double>(callback_rate));
}

LocalTimePoint Streamer::time_of(std::int64_t sample) const {
  return origin_ + seconds(static_cast<double>(sample - origin_sample_) / rate);
}

std::int64_t Streamer::first_from(LocalTimePoint time) const {
  const double since = std::chrono::duration<double>(time - origin_).count();
  auto sample = origin_sample_ + static_cast<std::int64_t>(std::floor(since * rate)) - 1;
  while (time_of(sample) < time) ++sample;
  return sample;
}

void Streamer::change_rate(double new_rate) {
  const std::lock_guard lock(walk_mutex_);
  const std::int64_t sample = running ? first_from(next_begin_) : 0;
  if (running) origin_ = time_of(sample);
  origin_sample_ = sample;
  rate = new_rate;
}

void Streamer::start() {
  stop();
  missed = 0;
  origin_ = LocalTimeClock::now() + kAhead * period();
  origin_sample_ = 0;
  next_begin_ = origin_;
  running = true;
  if (!world().manual) thread_ = std::jthread([this](const std::stop_token& s) { run(s); });
}

void Streamer::stop() {
  if (thread_.joinable()) {
    thread_.request_stop();
    thread_.join();
  }
  running = false;
}

void Streamer::run(const std::stop_token& stop) {
  while (!stop.stop_requested()) {
    std::this_thread::sleep_until(next_begin_ - kAhead * period());
    while (world().to_miss > 0) {
      --world().to_miss;
      skip_interval();
    }
    call_back();
    // an interval that starts too late is skipped
    while (LocalTimeClock::now() > next_begin_) skip_interval();
  }
}

void Streamer::skip_interval() {
  const std::lock_guard lock(walk_mutex_);
  next_begin_ += period();
  ++missed;
}

void Streamer::call_back() {
  const std::lock_guard lock(walk_mutex_);
  const LocalTimePoint begin = next_begin_;
  next_begin_ += period();
  OutputInterval interval(*this, begin, next_begin_);
  if (callback == nullptr) return;
  {
    const std::lock_guard world_lock(world().mutex);
    if (!device.empty() && world().find(device)->owner != kUs && running)
      world().violate("a callback with an array that was not claimed");
  }
  const LocalTimePoint now = LocalTimeClock::now();
  const LocalTimePoint deadline =
      world().late ? now - period() : now + (world().manual ? 1'000'000 : kAhead - 1) * period();
  in_callback() = true;
  callback(emitter_, interval, deadline, user);
  in_callback() = false;
  ++world().callbacks;
  if (interval.walks_ != 1) world().violate("an interval was not walked exactly once");
}

void Streamer::commit(std::int64_t sample) {
  const double least = static_cast<double>(world().find(device)->array.separation);
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!is_finite(points[i])) world().violate("a number is not finite");
    for (std::size_t j = 0; j < i; ++j) {
      const bool sound = points[i].getIntensity() > 0.0F && points[j].getIntensity() > 0.0F;
      if (sound && distance(points[i], points[j]) < least * (1.0 - 1e-4))
        world().violate("two points are closer than the least separation");
    }
  }
  if (world().sink) world().sink(time_of(sample), points);
}

OutputInterval::OutputInterval(Streamer& streamer, LocalTimePoint begin, LocalTimePoint end)
    : streamer_(streamer),
      begin_(begin),
      end_(end),
      step_(seconds(1.0 / streamer.rate)),
      first_(streamer.first_from(begin)),
      past_(streamer.first_from(end)) {
  first_time_ = streamer.time_of(first_);
}

OutputIntervalIterator OutputInterval::begin() {
  if (++walks_ > 1) world().violate("an interval was walked twice");
  return {first_, *this};
}

OutputIntervalIterator OutputInterval::end() {
  return {past_, *this};
}

OutputIntervalIterator::OutputIntervalIterator(std::int64_t sample, OutputInterval& interval)
    : sample_(sample), point_(interval.streamer_.time_of(sample), interval) {}

OutputIntervalIterator& OutputIntervalIterator::operator++() {
  Streamer& streamer = point_.interval_->streamer_;
  streamer.commit(sample_);
  ++sample_;
  static_cast<LocalTimePoint&>(point_) = streamer.time_of(sample_);
  return *this;
}

ControlPoint& TimePointOnOutputInterval::controlPoint(std::size_t index) {
  auto& points = interval_->streamer_.points;
  if (index >= points.size()) {
    world().violate("a point that does not exist was set");
    index = 0;
  }
  return points[index];
}

StreamingEmitter::StreamingEmitter(const Library& /*library*/)
    : streamer_(std::make_unique<Streamer>(*this)) {
  ++world().emitters;
  world().streamer = streamer_.get();
}

StreamingEmitter::~StreamingEmitter() {
  streamer_->stop();
  // the real thing may still call back here
  if (world().last_call_in_destructor && !streamer_->device.empty() && streamer_->rate > 0.0)
    streamer_->call_back();
  const std::lock_guard lock(world().mutex);
  if (world().streamer == streamer_.get()) world().streamer = nullptr;
  Entry* entry = world().find(streamer_->device);
  if (entry != nullptr && entry->owner == kUs) entry->owner.clear();
  --world().emitters;
}

result<void> StreamingEmitter::addDevice(const Device& device, const Transform& transform) {
  const Transform identity;
  if (!std::equal(std::begin(identity.element), std::end(identity.element), transform.element))
    world().violate("the array is not at the origin");
  if (auto refused = world().refusal("addDevice")) return *refused;
  {
    const std::lock_guard lock(world().mutex);
    Entry* entry = world().find(device.getIdentifier());
    if (entry == nullptr || !entry->connected) return failed("the device is not connected");
    if (!entry->owner.empty()) return failed("the device is claimed");
    entry->owner = kUs;
  }
  streamer_->device = device.getIdentifier();
  streamer_->points.resize(1);
  streamer_->change_rate(rate_limit(streamer_->device, 1));
  return {};
}

result<void> StreamingEmitter::setControlPointCount(std::size_t count, AdjustRate adjust) {
  if (auto refused = world().refusal("setControlPointCount")) return *refused;
  const double limit = rate_limit(streamer_->device, count);
  if (limit == 0.0) return failed("the device cannot focus on so many points");
  const bool too_fast = streamer_->rate > limit;
  if (too_fast && adjust == AdjustRate::None) return failed("the rate is too high");
  const bool follows = world().find(streamer_->device)->array.emitter_follows;
  if (!follows) {
    streamer_->points.resize(count);
    return {};
  }
  if (adjust == AdjustRate::All || (adjust == AdjustRate::AsRequired && too_fast))
    streamer_->change_rate(limit);
  streamer_->points.resize(count);
  return {};
}

result<void> StreamingEmitter::setEmissionCallback(EmissionCallback callback, void* user) {
  if (auto refused = world().refusal("setEmissionCallback")) return *refused;
  streamer_->callback = callback;
  streamer_->user = user;
  return {};
}

result<void> StreamingEmitter::setCallbackRate(float rate) {
  if (auto refused = world().refusal("setCallbackRate")) return *refused;
  streamer_->callback_rate = rate;
  return {};
}

float StreamingEmitter::getCallbackRate() const {
  return streamer_->callback_rate;
}

result<float> StreamingEmitter::getEmitterUpdateRate() const {
  if (auto refused = world().refusal("getEmitterUpdateRate")) return *refused;
  return static_cast<float>(streamer_->rate);
}

result<void> StreamingEmitter::setEmitterUpdateRate(float rate) {
  const double limit = rate_limit(streamer_->device, streamer_->points.size());
  if (static_cast<double>(rate) > limit * 1.00001) return failed("the rate is too high");
  streamer_->change_rate(static_cast<double>(rate));
  return {};
}

result<float> StreamingEmitter::getDeviceUpdateRateLimit(const Device& device,
                                                         std::size_t count) const {
  if (auto refused = world().refusal("getDeviceUpdateRateLimit")) return *refused;
  const double limit = rate_limit(device.getIdentifier(), count);
  if (limit == 0.0) return failed("the device cannot focus on so many points");
  return static_cast<float>(limit);
}

std::size_t StreamingEmitter::getControlPointLimit() const {
  const auto& rates = world().find(streamer_->device)->array.rates;
  std::size_t most = 0;
  while (most < rates.size() && static_cast<double>(rates[most]) >= streamer_->rate) ++most;
  return most;
}

result<void> StreamingEmitter::start() {
  if (auto refused = world().refusal("start")) return *refused;
  streamer_->start();
  return {};
}

result<void> StreamingEmitter::stop() {
  streamer_->stop();
  return {};
}

result<std::size_t> StreamingEmitter::getMissedCallbackIterations() const {
  return static_cast<std::size_t>(streamer_->missed.load());
}

}  // namespace Ultraleap::Haptics

namespace ultraleap_stand_in {

void step(int n) {
  for (int i = 0; i < n; ++i) {
    ulh::Streamer* streamer = world().streamer;
    if (streamer == nullptr || !streamer->running) return;
    while (world().to_miss > 0) {
      --world().to_miss;
      streamer->skip_interval();
    }
    streamer->call_back();
  }
}

void change_rate(float rate) {
  world().streamer->change_rate(static_cast<double>(rate));
}

std::size_t control_points() {
  return world().streamer == nullptr ? 0 : world().streamer->points.size();
}

}  // namespace ultraleap_stand_in
