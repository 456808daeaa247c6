#pragma once
/// A session with numbered AUTD3 units: frames in sequence, heartbeats, the common clock.

#include <array>
#include <chrono>
#include <stop_token>
#include <string>
#include <vector>

#include "prostm/device/autd3_sdk/detail/autd3_sdk_discovery.hpp"
#include "prostm/device/autd3_sdk/detail/autd3_sdk_wire.hpp"
#include "prostm/device/autd3_sdk/detail/udp_socket.hpp"

namespace prostm::sdk {

struct SessionSettings {
  std::string address;  ///< in the form of group_address()
  int units = 0;        ///< expected number of units; 0: as many as answer the first time
  int failsafe_ms = 80;
};

/// Sends frames to every unit, up to seven ahead of its acknowledgement, resends lost frames, and
/// sends heartbeats. The session fails if a unit refuses a frame or does not answer for 100 ms;
/// then problem() gives the reason in one sentence, and open() or resume() must be called. After
/// open() the functions do not allocate until the session fails. Not thread-safe.
class Session {
 public:
  using Clock = UdpSocket::Clock;

  /// @throws std::invalid_argument for an address that cannot be used.
  explicit Session(const SessionSettings& settings);

  /// Finds and numbers the units, starts their clock, and prepares them. @return false if any step
  /// failed.
  bool open(const std::stop_token& stop = {});
  /// Prepares units that still have their numbers, in a few milliseconds. @return false on a
  /// failure.
  bool resume();
  /// Whether any unit answers within 50 ms.
  bool units_answer();
  /// Silences the units.
  void close() noexcept;
  /// Whether nothing has failed since open() or resume().
  bool works() const { return is_open_ && !failed_; }
  /// Fails for the caller's reason: a clause that follows "autd3-sdk://ADDRESS". @return false.
  bool give_up(std::string clause) noexcept { return fail(std::move(clause)); }

  std::size_t units() const { return peers_.size(); }
  /// Returns a unit's next frame, to be written; waits for room. @return null if the session
  /// failed.
  Datagram* room(std::size_t unit) noexcept;
  /// Sends the frame written into room().
  void post(std::size_t unit) noexcept;
  /// Sends the same frame to all units, written by write(Datagram&).
  template <class Write>
  bool post_all(Write&& write) {
    for (std::size_t u = 0; u < units(); ++u) {
      Datagram* frame = room(u);
      if (frame == nullptr) return false;
      write(*frame);
      post(u);
    }
    return true;
  }
  /// Waits until all frames are acknowledged. @return false if the session failed.
  bool finish() noexcept;
  /// Receives answers and sends heartbeats until a time. @return false if the session failed.
  bool listen(Clock::time_point until) noexcept;
  /// Reads the FPGA state of all units. @return false if the session failed.
  bool read_state() noexcept;
  /// The flags of a unit's FPGA state, FpgaFlag.
  std::uint8_t state(std::size_t unit) const { return peers_[unit].state; }
  /// Makes all units switch to a bank once they have executed the frames posted before, and waits
  /// for that. Tries both forms of the command until the firmware accepts one. @return false if the
  /// session failed.
  bool activate(int bank) noexcept;
  /// Returns the number of frames that a unit takes in 1 ms while all units are written to: the
  /// best of a few rounds, since other work may slow some down; 0 if the session failed. @pre bank
  /// 1 is silent and not playing.
  double measure();
  /// Sets the silencer. Call it before a pattern with this divider.
  bool set_silencer(int steps) noexcept;
  /// Unmutes units that the failsafe muted. @return false also if a unit refuses temporarily.
  bool release_failsafe() noexcept;

  /// Converts a time of the host to the units' time [ns], and back.
  std::int64_t unit_time(Clock::time_point host) const;
  Clock::time_point host_time(std::int64_t unit) const;

  const std::string& problem() const { return problem_; }
  /// Versions of the first unit's firmware, as "CPU 0.10.0, FPGA 0.10.0".
  const std::string& firmware() const { return firmware_; }
  /// Number of frames that were sent again.
  std::int64_t sent_again() const { return sent_again_; }

  static constexpr int kAhead = 7;  ///< most frames in flight
  static constexpr std::chrono::milliseconds kHeartbeat{10}, kAckTime{10}, kLost{100};

 private:
  struct Sent {
    Datagram frame;
    std::uint16_t id = 0;
    Clock::time_point at;
  };
  struct Peer {
    UdpAddress address;
    std::array<Sent, kAhead + 1> ring;  // frames in flight, and room for the next
    std::size_t oldest = 0, count = 0;
    std::uint8_t sequence = 0;  // of the oldest frame
    int tries = 0;              // of the oldest frame
    std::uint16_t reset = 0;    // id of the pending Reset, or 0
    Clock::time_point reset_at;
    Clock::time_point heard, done_at, resent, beat_at;
    std::uint16_t beat = 0;
    std::uint8_t state = 0;  // of its FPGA
    std::array<std::uint8_t, 6> versions{};
    Clock::time_point alone;  // time when its clock lost synchronisation; 0: it is synchronised

    Sent& sent(std::size_t i) { return ring[(oldest + i) % ring.size()]; }
  };
  struct Beat {
    Clock::duration trip = Clock::duration::max();
    std::int64_t offset = 0;  // units' time minus the host's [ns]
  };

  std::string number_units(const std::stop_token& stop);
  bool prepare();
  bool fail(std::string clause);
  void lose(std::size_t unit, const char* clause) noexcept;
  bool step(Clock::time_point until) noexcept;
  void hear(const Reply& reply, const UdpAddress& from, Clock::time_point now) noexcept;
  void acknowledge(Peer& peer, const Reply& reply, const FrameReply& answer,
                   Clock::time_point now) noexcept;
  void keep_time(const Peer& peer, const FrameReply& answer, Clock::time_point now) noexcept;
  void watch(std::size_t unit, const FrameReply& answer, Clock::time_point now) noexcept;
  void take(Peer& peer, Command command, const FrameReply& answer) noexcept;
  void send_again(Peer& peer, Clock::time_point now) noexcept;
  void reset(Peer& peer, Clock::time_point now) noexcept;
  void service_peers(Clock::time_point now) noexcept;
  Clock::time_point next_due() const;

  SessionSettings settings_;
  const UdpAddress group_;
  UdpSocket socket_;
  std::vector<Peer> peers_;
  std::uint16_t id_ = 0;
  bool is_open_ = false, failed_ = false;
  bool margin_field_ = false, margin_known_ = false;
  int refused_unit_ = -1;  // unit of the last refusal
  std::uint8_t refusal_ = kNoError;
  Clock::time_point stepped_;  // time when it last received
  Beat best_, last_best_;      // fastest heartbeats of the current half second and of the last one
  Clock::time_point best_since_;
  std::int64_t sent_again_ = 0;
  std::string problem_, firmware_;
  std::array<std::uint8_t, kMostDatagram> in_{};
};

}  // namespace prostm::sdk
