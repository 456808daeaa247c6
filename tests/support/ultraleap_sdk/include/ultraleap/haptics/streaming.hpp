#pragma once
/// A stand-in for the interface of Ultraleap's Haptics SDK 3, as far as prostm's adapter uses it:
/// names and behaviour only, written for the tests. The SDK itself is its vendor's and not here.

#include <cstddef>
#include <cstdint>
#include <memory>

#include "ultraleap/haptics/geometry.hpp"
#include "ultraleap/haptics/library.hpp"

namespace Ultraleap::Haptics {

enum class AdjustRate : std::uint32_t { None, AsRequired, All };

class OutputInterval;

/// Time of a sample, at which the control points can be set.
class TimePointOnOutputInterval : public LocalTimePoint {
 public:
  TimePointOnOutputInterval(LocalTimePoint time, OutputInterval& interval)
      : LocalTimePoint(time), interval_(&interval) {}
  ControlPoint& controlPoint(std::size_t index);

 private:
  friend class OutputIntervalIterator;
  OutputInterval* interval_;
};

class OutputIntervalIterator {
 public:
  OutputIntervalIterator(std::int64_t sample, OutputInterval& interval);
  OutputIntervalIterator& operator++();
  bool operator!=(const OutputIntervalIterator& other) const { return sample_ != other.sample_; }
  TimePointOnOutputInterval& operator*() { return point_; }

 private:
  std::int64_t sample_;
  TimePointOnOutputInterval point_;
};

class Streamer;

/// The samples that a callback must set, from `begin` to `end`.
class OutputInterval {
 public:
  OutputInterval(Streamer& streamer, LocalTimePoint begin, LocalTimePoint end);
  const LocalTimePoint& intervalBegin() const { return begin_; }
  const LocalTimePoint& intervalEnd() const { return end_; }
  const LocalTimePoint& firstSample() const { return first_time_; }
  const LocalDuration& iteratorTimeInterval() const { return step_; }
  OutputIntervalIterator begin();
  OutputIntervalIterator end();

 private:
  friend class OutputIntervalIterator;
  friend class TimePointOnOutputInterval;
  friend class Streamer;
  Streamer& streamer_;
  LocalTimePoint begin_, end_, first_time_;
  LocalDuration step_;
  std::int64_t first_, past_;  // samples
  int walks_ = 0;
};

class StreamingEmitter;
using EmissionCallback = void (*)(const StreamingEmitter&, OutputInterval&, const LocalTimePoint&,
                                  void*);

class StreamingEmitter {
 public:
  explicit StreamingEmitter(const Library& library);
  ~StreamingEmitter();
  StreamingEmitter(const StreamingEmitter&) = delete;
  StreamingEmitter& operator=(const StreamingEmitter&) = delete;

  result<void> addDevice(const Device& device, const Transform& transform);
  result<void> setControlPointCount(std::size_t count, AdjustRate adjust);
  result<void> setEmissionCallback(EmissionCallback callback, void* user);
  result<void> setCallbackRate(float rate);
  float getCallbackRate() const;
  result<float> getEmitterUpdateRate() const;
  result<void> setEmitterUpdateRate(float rate);
  result<float> getDeviceUpdateRateLimit(const Device& device, std::size_t count) const;
  std::size_t getControlPointLimit() const;
  result<void> start();
  result<void> stop();
  result<std::size_t> getMissedCallbackIterations() const;

 private:
  std::unique_ptr<Streamer> streamer_;
};

}  // namespace Ultraleap::Haptics
