#pragma once
/// State of the stand-in's service.

#include <atomic>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "ultraleap/haptics/stand_in.hpp"

namespace ultraleap_stand_in {

struct Entry {
  Array array;
  bool connected = true;
  std::string owner;  // of the claim; "" if unclaimed
};

constexpr const char* kUs = "prostm (this client)";

struct World {
  std::recursive_mutex mutex;  // guards the members below, except atomic ones
  std::vector<Entry> entries;
  std::vector<std::shared_ptr<ulh::LibraryEventListener>> listeners;
  std::map<std::string, std::string> refusals;
  Sink sink;
  bool service = true, manual = false, last_call_in_destructor = true;
  ulh::Streamer* streamer = nullptr;  // the newest one
  std::string violation;

  std::atomic<int> violations{0}, emitters{0}, to_miss{0};
  std::atomic<bool> late{false};
  std::atomic<long> callbacks{0};

  Entry* find(const std::string& identifier);
  /// Returns an error if calls of that name have to fail.
  std::optional<ulh::Unexpected> refusal(const std::string& call);
  void violate(const char* what);
};

World& world();
/// Whether this thread is inside a callback.
bool& in_callback();
inline ulh::Unexpected failed(const std::string& message) {
  return {ulh::Error(message)};
}

}  // namespace ultraleap_stand_in

namespace Ultraleap::Haptics {

/// The engine of an emitter: samples are numbered; sample k leaves at origin + k / rate.
class Streamer {
 public:
  explicit Streamer(const StreamingEmitter& emitter) : emitter_(emitter) {}
  ~Streamer();

  void start();
  void stop();
  void call_back();
  void skip_interval();
  LocalTimePoint time_of(std::int64_t sample) const;
  std::int64_t first_from(LocalTimePoint time) const;
  /// Changes the rate, starting with the next interval.
  void change_rate(double rate);
  void commit(std::int64_t sample);

  const StreamingEmitter& emitter_;
  std::string device;
  EmissionCallback callback = nullptr;
  void* user = nullptr;
  float callback_rate = 1000.0F;
  double rate = 0.0;
  std::vector<ControlPoint> points;
  std::atomic<std::int64_t> missed{0};
  bool running = false;

 private:
  void run(const std::stop_token& stop);
  LocalDuration period() const;

  LocalTimePoint origin_{}, next_begin_{};
  std::int64_t origin_sample_ = 0;
  std::mutex walk_mutex_;
  std::jthread thread_;
};

}  // namespace Ultraleap::Haptics
