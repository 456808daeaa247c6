#pragma once
/// A connection to the vendor's SDK, with one array claimed. Needs the SDK.

#include <atomic>
#include <memory>
#include <mutex>
#include <string>
#include <ultraleap/haptics/streaming.hpp>

#include "prostm/device/ultraleap/detail/ultraleap_emission.hpp"
#include "prostm/device/ultraleap/ultraleap.hpp"

namespace prostm {

/// Message of a failed result<T>.
template <class Result>
std::string message_of(const Result& result) {
  return std::string(result.error().message());
}

/// Handles the events of one array that end its emission. The SDK calls it on its own threads.
class UltraleapEvents final : public Ultraleap::Haptics::LibraryEventListener {
 public:
  /// @param emission is muted at the end; outlives this.
  UltraleapEvents(std::string device, UltraleapEmission& emission);

  void onDeviceDisconnected(const char* identifier) override;
  void onDeviceModificationRightsRescinded(const char* identifier) override;
  void onDeviceErrorDetected(const char* identifier,
                             Ultraleap::Haptics::DeviceError error) override;
  void onLibraryDisconnected(const Ultraleap::Haptics::EndpointInfo& service) override;

  /// Stops listening, before prostm itself closes the array.
  void close() { closed_ = true; }
  bool is_gone() const { return gone_.load(std::memory_order_acquire); }
  /// Says in one sentence why the array is gone.
  std::string problem() const;

 private:
  bool is_ours(const char* identifier) const { return device_ == identifier; }
  void end(const std::string& sentence);

  const std::string device_;
  UltraleapEmission& emission_;
  std::atomic<bool> closed_{false}, gone_{false};
  mutable std::mutex mutex_;  // guards problem_
  std::string problem_;
};

/// Library, array and emitter, acquired together and released together.
class UltraleapSession {
 public:
  /// Connects, claims the array, and selects its fastest rate with `foci` control points.
  /// @param emission is called back; outlives this. @throws std::invalid_argument with a sentence.
  UltraleapSession(const UltraleapAddress& address, int foci, UltraleapEmission& emission);
  ~UltraleapSession();
  UltraleapSession(const UltraleapSession&) = delete;
  UltraleapSession& operator=(const UltraleapSession&) = delete;

  /// Changes the number of control points and keeps the rate. @throws std::invalid_argument with a
  /// sentence if the array cannot.
  void set_foci(int foci, double rate);
  /// @throws std::invalid_argument with a sentence.
  void start();
  void stop();

  int foci() const { return foci_; }
  double rate() const { return rate_; }  ///< samples per second
  double least_separation() const { return least_separation_; }
  int most_foci() const;
  int samples_a_call() const;
  const std::string& identifier() const { return identifier_; }
  std::int64_t missed_calls() const;
  const UltraleapEvents& events() const { return *events_; }

 private:
  void claim(Ultraleap::Haptics::Device& device);
  void set_rate(const Ultraleap::Haptics::Device& device, int foci);
  double emitter_rate() const;
  void check_place(const Ultraleap::Haptics::Device& device) const;

  Ultraleap::Haptics::Library library_;
  std::shared_ptr<UltraleapEvents> events_;
  std::unique_ptr<Ultraleap::Haptics::StreamingEmitter> emitter_;
  std::string identifier_;
  int foci_ = 0;
  double rate_ = 0.0, least_separation_ = 0.0;
};

/// Connects a library. @throws std::invalid_argument with a sentence.
void connect_ultraleap(Ultraleap::Haptics::Library& library, const std::string& connection);
/// Returns the name of another program that has claimed the array; empty if no other has.
std::string ultraleap_owner(const Ultraleap::Haptics::Device& device);

}  // namespace prostm
